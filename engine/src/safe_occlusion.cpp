// SPDX-License-Identifier: Apache-2.0
//
// Occlusion queries that hold at any resolution (O4 to O6).
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "build_check.hpp"
#include "callers_code.hpp"
#include "depth_levels.hpp"
#include "facts.hpp"
#include "fast/patches.hpp"
#include "float_environment.hpp"
#include "occluder_mesh.hpp"
#include "overlap.hpp"
#include "patches.hpp"
#include "surefill/occlusion.hpp"
#if !defined(SUREFILL_REFERENCE_ONLY)
#include "fast/team.hpp"
#include "fast/tile.hpp"
#endif

namespace surefill {
namespace {

constexpr std::size_t kBandKeys = std::size_t{1} << 15;  // of one band of rows, about: they stay in a cache

// What O4 refuses of an occluder's state, and what is no state at all.
Status check_state(const DrawState& state) {
  if (state.primitive != Primitive::triangles) return Status::draw_primitive;
  if (state.fill_rule > FillRule::closed) return Status::draw_fill_rule;
  if (state.front_face > FrontFace::counter_clockwise) return Status::draw_front_face;
  if (state.cull > Cull::back) return Status::draw_cull;
  if (state.depth_mode > DepthMode::clamp) return Status::draw_depth_mode;
  if (!state.depth_write) return Status::draw_depth_write;
  if (state.conservative != Conservative::none) return Status::draw_conservative;
  if (state.scissor) return Status::draw_scissor;
  if (state.grid) return Status::draw_grid;
  if (state.depth_bias) return Status::draw_depth_bias;
  return Status::ok;
}

}  // namespace

struct SafeOcclusionBuffer::State : DepthLevels {
  PatchList patches;
  Growing<float> keys;
  Growing<std::int32_t> columns;

  static Status check_occluder(const Occluder& occluder, const Bytes& written) {
    if (occluder.mesh == nullptr) return Status::occluder_mesh;
    if (occluder.vertices.data() == nullptr && !occluder.vertices.empty()) return Status::draw_vertices;
    if (occluder.vertices.size() != occluder.mesh->vertices()) return Status::draw_vertices;
    if (const Status status = check_state(occluder); status != Status::ok) return status;
    if (written.overlaps(Bytes(occluder.vertices))) return Status::target_overlap;
    const OccluderMesh::State* const mesh = occluder.mesh->state_;
    return mesh == nullptr || places_agree(*mesh, occluder.vertices) ? Status::ok : Status::occluder_vertices;
  }

  // Not inlined: it needs the engine's floating-point state.
  [[gnu::noinline]] static Status check(const State* state, std::span<const Occluder> occluders,
                                        const Options& options) {
    if (options.threads < 1 || options.threads > kMaxThreads) return Status::options_threads;
    if (options.path > Path::reference) return Status::options_path;
    if (state == nullptr) return Status::target_size;
    if (occluders.data() == nullptr && !occluders.empty()) return Status::draws;
    const Bytes written(std::span(state->memory.get(), state->size));
    if (written.overlaps(Bytes(occluders)) || written.overlaps(Bytes::of(&options))) return Status::target_overlap;
    for (const Occluder& occluder : occluders) {
      if (const Status status = check_occluder(occluder, written); status != Status::ok) return status;
    }
    return Status::ok;
  }

  // Not inlined: it needs the engine's floating-point state.
  [[gnu::noinline]] bool draw(std::span<const Occluder> occluders, const Options& options) {
    patches.clear();
    for (const Occluder& occluder : occluders) {
      const OccluderMesh::State* const mesh = occluder.mesh->state_;
      if (mesh != nullptr && !patches.add(*mesh, occluder, width, height, sign())) return false;
    }
    const auto parallel = static_cast<std::size_t>(options.threads);
    const auto wide = static_cast<std::size_t>(width), high = static_cast<std::size_t>(height);
    const std::size_t rows = std::clamp<std::size_t>(kBandKeys / wide, 1, (high + parallel - 1) / parallel);
    const std::size_t bands = (high + rows - 1) / rows;
    return draw_bands(options, bands, rows);
  }

  bool draw_bands(const Options& options, std::size_t bands, std::size_t rows) {
    fast::PatchFrame frame = patches.frame();
    frame.sign = sign(), frame.width = width, frame.depth = levels[0].farthest;
    const auto draw_rows = fast::patch_kernels().draw;
    // Each band has memory of its own, as nobody knows which thread draws it.
    const std::size_t band_keys = rows * static_cast<std::size_t>(width);
#if defined(SUREFILL_REFERENCE_ONLY)
    const std::size_t memories = 1;
#else
    const bool alone = options.threads == 1 && options.executor.run == nullptr;
    const std::size_t memories = alone ? 1 : bands;
#endif
    const std::size_t keys_before = keys.capacity();
    if (!keys.reserve(memories * band_keys) || !columns.reserve(2 * memories * rows)) return false;
    // Patches leave keys as they find them.
    if (keys.capacity() != keys_before) std::fill_n(keys.data(), keys.capacity(), -kFarthest);
    const auto draw_band = [&](std::size_t band, std::size_t place) {
      const fast::PatchScratch scratch{keys.data() + place * band_keys, columns.data() + 2 * place * rows,
                                       columns.data() + (2 * place + 1) * rows};
      const int begin = static_cast<int>(band * rows);
      draw_rows(frame, begin, std::min(begin + static_cast<int>(rows), height), scratch);
    };
#if defined(SUREFILL_REFERENCE_ONLY)
    static_cast<void>(options);
    for (std::size_t band = 0; band < bands; ++band) draw_band(band, 0);
#else
    if (alone) {
      for (std::size_t band = 0; band < bands; ++band) draw_band(band, 0);
    } else {
      fast::Team team(options.threads, options.executor);
      team.run(bands, [&](std::size_t band) { draw_band(band, band); });
    }
#endif
    return true;
  }
};

SafeOcclusionBuffer::~SafeOcclusionBuffer() {
  delete state_;
}

SafeOcclusionBuffer::SafeOcclusionBuffer(SafeOcclusionBuffer&& other) noexcept
    : state_(std::exchange(other.state_, nullptr)), equal_is_visible_(other.equal_is_visible_) {}

SafeOcclusionBuffer& SafeOcclusionBuffer::operator=(SafeOcclusionBuffer&& other) noexcept {
  std::swap(state_, other.state_);
  std::swap(equal_is_visible_, other.equal_is_visible_);
  return *this;
}

Status SafeOcclusionBuffer::resize(int width, int height, DepthTest depth_test) noexcept {
  return State::resize(state_, width, height, depth_test);
}

void SafeOcclusionBuffer::clear() noexcept {
  if (state_ != nullptr) state_->clear();
}

Status SafeOcclusionBuffer::draw(std::span<const Occluder> occluders, const Options& options) noexcept {
  if (!is_exact_build()) return Status::bad_build;
  FloatEnvironment environment;
  if (const Status status = State::check(state_, occluders, options); status != Status::ok) return status;
#if !defined(SUREFILL_REFERENCE_ONLY)
  if (!fast::kernels().is_exact()) return Status::bad_build;
#endif
  CallersCode callers{environment, options.executor, {}};
  if (!state_->draw(occluders, callers.with_executor(options))) {
    state_->clear();
    state_->patches = {}, state_->keys = {}, state_->columns = {};
    return Status::out_of_memory;
  }
  state_->build();
  return Status::ok;
}

Status SafeOcclusionBuffer::query(std::span<const OcclusionBox> boxes, std::span<Occlusion> answers) const noexcept {
  return State::query(state_, boxes, answers, Pixels::met, equal_is_visible_);
}

Status SafeOcclusionBuffer::query(std::span<const OcclusionRectangle> rectangles,
                                  std::span<Occlusion> answers) const noexcept {
  return State::query(state_, rectangles, answers, Pixels::met, equal_is_visible_);
}

int SafeOcclusionBuffer::width() const noexcept {
  return state_ == nullptr ? 0 : state_->width;
}

int SafeOcclusionBuffer::height() const noexcept {
  return state_ == nullptr ? 0 : state_->height;
}

std::span<const float> SafeOcclusionBuffer::depth() const noexcept {
  return State::depth(state_);
}

}  // namespace surefill
