// SPDX-License-Identifier: Apache-2.0
#include "streamed.hpp"

#include <bit>
#include <memory>
#include <new>

#include "fast/frame.hpp"
#include "fragments.hpp"
#include "lines.hpp"
#include "reference.hpp"

namespace surefill::streamed {
namespace {

// What a block of the stream needs. Blocks of different tiles come on different threads, and share no sample.
struct Sink {
  const Target& target;
  std::span<const Draw> draws;  // of the frame
  std::size_t first;            // the first one that is streamed
  Layers* layers;

  static void visit(void* context, std::span<const CoverageBlock> blocks) {
    const Sink& sink = *static_cast<const Sink*>(context);
    const std::uint32_t number = static_cast<std::uint32_t>(sink.first) + blocks[0].draw, position = blocks[0].triangle;
    Rungs rungs;  // those of the fragments are not told
    DrawFragments fragments(sink.target, sink.draws[number], number, sink.layers, rungs);
    fragments.triangle().use(sink.draws[number], position);
    for (const CoverageBlock& block : blocks) {
      for (std::uint64_t bits = block.mask; bits != 0; bits &= bits - 1) {
        const int bit = std::countr_zero(bits);
        Fragment fragment{position, block.x + (bit & 7), block.y + (bit >> 3), block.sample};
        if (fragments.counts_of_covered(fragment)) fragments.take(fragment);
      }
    }
  }
};

// Overlapped and touched pixels are among those that the triangle meets.
Conservative streamed_mode(Conservative mode) {
  return mode > Conservative::inner ? Conservative::over : mode;
}

// The triangles of a draw whose D is 0, which M4b draws and no stream has.
void draw_degenerate(const Target& target, const Draw& draw, std::uint32_t number) {
  Rungs rungs;
  for (std::uint32_t position = 0; position < triangles_of(draw); ++position) {
    if (!is_finite(draw, position) || orientation(draw, position) != 0) continue;
    Draw one = draw;
    const std::uint32_t index = index_of(draw, position);
    one.indices = draw.indices.subspan(std::size_t{3} * position, 3);
    one.identifiers = {}, one.first_index = index;
    if (!draw.covered.empty()) one.covered = draw.covered.subspan(position, 1);
    reference::draw(target, one, number, nullptr, rungs);
  }
}

// The other kinds of primitives: points by the reference path, as most have one sample.
void draw_lines_or_points(const Target& target, const Draw& draw, std::uint32_t number, Layers* layers,
                          const Options& options) {
  Rungs rungs;
  if (draw.primitive == Primitive::lines) {
    draw_lines(target, draw, number, layers, options);
  } else {
    reference::draw(target, draw, number, layers, rungs);
  }
}

}  // namespace

bool supports(const Target& target, std::span<const Draw> draws) {
  return fast::streams(target, draws);
}

Status render(const Target& target, std::span<const Draw> draws, const Options& options,
              Diagnostics& diagnostics) noexcept {
  FragmentFrame frame(target, draws);
  const std::unique_ptr<Draw[]> streamed(new (std::nothrow) Draw[draws.size()]);
  if (streamed == nullptr || !frame.begin()) return Status::out_of_memory;
  for (std::size_t d = 0; d < draws.size(); ++d) {
    streamed[d] = draws[d];
    streamed[d].conservative = streamed_mode(draws[d].conservative);
  }
  Target places;  // all that a stream knows of a target
  places.width = target.width, places.height = target.height, places.samples = target.samples;
  places.origin = target.origin, places.sample_locations = target.sample_locations;
  const std::span<const Draw> coverage(streamed.get(), draws.size());
  for (std::size_t first = 0; first < draws.size();) {
    std::size_t last = first;  // of a run of draws of triangles
    while (last < draws.size() && has_triangles(draws[last])) ++last;
    if (last > first) {
      Sink sink{target, draws, first, frame.layers()};
      const Status status = fast::visit_coverage(places, coverage.subspan(first, last - first), {Sink::visit, &sink},
                                                 options, diagnostics);
      if (status != Status::ok) return status;
    } else {
      draw_lines_or_points(target, draws[first], static_cast<std::uint32_t>(first), frame.layers(), options);
      ++last;
    }
    first = last;
  }
  for (std::size_t d = 0; d < draws.size(); ++d) {
    if (draws[d].conservative != Conservative::touched) continue;
    draw_degenerate(target, draws[d], static_cast<std::uint32_t>(d));
  }
  Rungs rungs;
  frame.finish(rungs);
  return Status::ok;
}

}  // namespace surefill::streamed
