// SPDX-License-Identifier: Apache-2.0
#include "certify/drivers/driver.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <exception>
#include <numeric>
#include <utility>

namespace surefill::drivers {

Arguments parse_arguments(const std::string& text) {
  Arguments arguments;
  std::string word;
  bool quoted = false;
  const auto end_word = [&] {
    if (word.empty()) return;
    const std::size_t equals = word.find('=');
    arguments[word.substr(0, equals)] = equals == std::string::npos ? "" : word.substr(equals + 1);
    word.clear();
  };
  for (const char c : text) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ' ' && !quoted) {
      end_word();
    } else {
      word += c;
    }
  }
  end_word();
  return arguments;
}

void check_keys(const Arguments& arguments, const std::vector<std::string>& known) {
  for (const auto& [key, value] : arguments) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    throw NotJudged("unknown argument \"" + key + "\"; there are: " + list);
  }
}

std::string argument(const Arguments& arguments, const std::string& key, const std::string& otherwise) {
  const auto found = arguments.find(key);
  return found == arguments.end() ? otherwise : found->second;
}

VertexStream vertex_stream(const surefill_adapter_scene& scene, const Primitives& primitives, bool attributes) {
  VertexStream stream;
  const std::uint32_t attribute_count = attributes ? scene.attribute_count : 0;
  stream.stride = 6 + 4 * attribute_count;
  const auto add = [&stream](float value) { stream.words.push_back(std::bit_cast<std::uint32_t>(value)); };
  for (std::uint32_t d = scene.draw_count; d-- > 0;) {
    const surefill_adapter_draw& draw = scene.draws[d];
    DrawRange& batch = stream.batches.emplace_back();
    batch.draw = &draw;
    batch.primitive = primitive_of(primitives, d);
    const std::uint32_t corners = batch.primitive.corners();
    batch.first = static_cast<std::uint32_t>(stream.words.size() / stream.stride);
    batch.count = corners * draw.triangle_count;
    for (std::uint32_t k = 0; k < attribute_count; ++k) {
      batch.interpolation[k] = static_cast<std::int32_t>(draw.attributes[k].interpolation);
    }
    std::vector<std::uint32_t> order(draw.triangle_count);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&draw](std::uint32_t a, std::uint32_t b) {
      return std::pair(draw.identifiers[a], a) < std::pair(draw.identifiers[b], b);
    });
    std::reverse(order.begin(), order.end());
    for (const std::uint32_t t : order) {
      for (std::uint32_t corner = 0; corner < corners; ++corner) {
        const std::uint32_t v = draw.indices[corners * t + corner];
        for (std::uint32_t c = 0; c < 4; ++c) add(draw.clip[4 * v + c]);
        stream.words.push_back(draw.identifiers[t]);
        stream.words.push_back(corner);
        for (std::uint32_t k = 0; k < attribute_count; ++k) {
          const surefill_adapter_attribute& attribute = draw.attributes[k];
          for (std::uint32_t c = 0; c < 4; ++c) {
            add(c < attribute.components ? attribute.values[attribute.components * v + c] : 0.0f);
          }
        }
      }
    }
  }
  return stream;
}

bool depths_within_buffer(const surefill_adapter_scene& scene, const Primitives& primitives) {
  for (std::uint32_t d = 0; d < scene.draw_count; ++d) {
    const surefill_adapter_draw& draw = scene.draws[d];
    if (draw.depth_mode != SUREFILL_ADAPTER_ANY_DEPTH) continue;
    const std::uint32_t corners = primitive_of(primitives, d).corners();
    for (std::uint32_t t = 0; t < draw.triangle_count; ++t) {
      std::array<double, 3> z{}, w{};
      bool within = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t corner = std::min<std::size_t>(i, corners - 1);
        const float* v = draw.pixel + 4 * std::size_t{draw.indices[corners * t + corner]};
        z[i] = v[2];
        w[i] = v[3];
        within = within && z[i] >= 0 && z[i] <= w[i];
      }
      // Or one depth z = c w, 0 <= c <= 1, all over the triangle. Products of two float32 are exact in double.
      bool constant = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        constant =
            constant && z[i] * w[j] == z[j] * w[i] && w[i] != 0 && z[i] * w[i] >= 0 && z[i] * z[i] <= w[i] * w[i];
      }
      if (!within && !constant) return false;
    }
  }
  return true;
}

bool asks_for_visible(const surefill_adapter_image& image) {
  return image.index || image.depth || image.barycentrics || image.attributes;
}

std::array<int, 2> standard_sample(std::uint32_t samples, std::uint32_t n) {
  static constexpr std::array<std::array<int, 2>, 31> kPlaces{
      {{8, 8},                                                                      // 1
       {12, 12}, {4, 4},                                                            // 2
       {6, 2},   {14, 6}, {2, 10}, {10, 14},                                        // 4
       {9, 5},   {7, 11}, {13, 9}, {5, 3},   {3, 13}, {1, 7},   {11, 15}, {15, 1},  // 8
       {9, 9},   {7, 5},  {5, 10}, {12, 7},  {3, 6},  {10, 13}, {13, 11}, {11, 3},  // 16
       {6, 14},  {8, 1},  {4, 2},  {2, 12},  {0, 8},  {15, 4},  {14, 15}, {1, 0}}};
  return kPlaces[samples - 1 + n];
}

void set_text(char (&place)[64], const std::string& text) {
  const std::size_t length = std::min(text.size(), sizeof place - 1);
  std::memcpy(place, text.data(), length);
  place[length] = '\0';
}

namespace {

struct Instance {
  std::unique_ptr<Driver> driver;
  bool tight_viewport = false;
  std::string error;
};

std::string open_error;

// A scene under a viewport that begins at the pixel origin and is the next power of two to the target, as programs have
// it: vertices beyond are clipped at its border.
class TightScene {
 public:
  TightScene(const surefill_adapter_scene& scene, const Primitives& primitives)
      : draws_(scene.draws, scene.draws + scene.draw_count), clip_(scene.draw_count), scene_(scene) {
    const auto width = static_cast<float>(std::bit_ceil(scene.width));
    const auto height = static_cast<float>(std::bit_ceil(scene.height));
    for (std::uint32_t d = 0; d < scene.draw_count; ++d) {
      surefill_adapter_draw& draw = draws_[d];
      std::vector<float>& clip = clip_[d];
      const bool triangles = primitive_of(primitives, d).kind == SUREFILL_ADAPTER2_TRIANGLES;
      for (std::size_t v = 0; v < draw.vertex_count && !triangles; ++v) {
        const float *p = draw.pixel + 4 * v, w = p[3];
        const bool within = w > 0 && p[0] >= 0 && p[1] >= 0 && p[0] <= static_cast<float>(scene.width) * w &&
                            p[1] <= static_cast<float>(scene.height) * w;
        if (!within) throw NotJudged("lines and points that the viewport's border cuts");
      }
      clip.assign(draw.clip, draw.clip + 4 * std::size_t{draw.vertex_count});
      for (std::size_t v = 0; v < draw.vertex_count; ++v) {
        const double w = draw.pixel[4 * v + 3];
        clip[4 * v] = exactly(2.0 * draw.pixel[4 * v] / width, -w);
        clip[4 * v + 1] = exactly(-2.0 * draw.pixel[4 * v + 1] / height, w);
      }
      draw.clip = clip.data();
      draw.viewport_x = draw.viewport_y = 0;
      draw.viewport_width = width;
      draw.viewport_height = height;
    }
    scene_.draws = draws_.data();
  }
  TightScene(const TightScene&) = delete;
  TightScene& operator=(const TightScene&) = delete;
  const surefill_adapter_scene& scene() const { return scene_; }

 private:
  // a + b, where it is a float32. The sum in double of two float32, scaled by powers of two, is exact if it can be
  // taken apart again.
  static float exactly(double a, double b) {
    const double sum = a + b;
    const auto result = static_cast<float>(sum);
    if (sum - a != b || sum - b != a || result != sum) {
      throw NotJudged("vertices that have no exact clip form under a viewport of the target's size");
    }
    return result;
  }

  std::vector<surefill_adapter_draw> draws_;
  std::vector<std::vector<float>> clip_;
  surefill_adapter_scene scene_;
};

int open(const char* arguments, surefill_adapter2_info* info, void** instance) {
  try {
    auto opened = std::make_unique<Instance>();
    Arguments given = parse_arguments(arguments);
    const std::string viewport = argument(given, "viewport");
    if (!viewport.empty() && viewport != "target") {
      throw NotJudged("argument viewport=" + viewport + ": there is viewport=target");
    }
    opened->tight_viewport = !viewport.empty();
    given.erase("viewport");
    opened->driver = open_driver(given);
    const std::string problem = self_check(*opened->driver);
    if (!problem.empty()) throw NotJudged("self-check of the adapter: " + problem);
    const surefill_adapter_info first = opened->driver->info();
    info->size = sizeof *info;
    info->form = first.form;
    std::memcpy(info->name, first.name, sizeof info->name);
    std::memcpy(info->version, first.version, sizeof info->version);
    info->outputs = first.outputs;
    info->features = first.features;
    info->primitives = 1u << SUREFILL_ADAPTER2_TRIANGLES | opened->driver->primitives();
    info->profile = first.model.profile;
    info->rows = first.model.y;
    info->clip_depth = first.model.depth_range;
    info->reported_bits = first.model.grid_bits;
    info->max_width = first.max_width;
    info->max_height = first.max_height;
    info->max_vertices = first.max_vertices;
    info->max_primitives = first.max_triangles;
    info->max_attributes = first.max_attributes;
    info->max_components = first.max_components;
    *instance = opened.release();
    return SUREFILL_ADAPTER_OK;
  } catch (const NotJudged& reason) {
    open_error = reason.what();
    return SUREFILL_ADAPTER_UNSUPPORTED;
  } catch (const Misuse& misuse) {
    open_error = misuse.what();
    return SUREFILL_ADAPTER_UNSUPPORTED;
  } catch (const std::exception& error) {
    open_error = error.what();
    return SUREFILL_ADAPTER_FAILED;
  }
}

// A scene of version 2 as the structs of version 1 and what they have no place for.
struct FirstVersion {
  std::vector<surefill_adapter_draw> draws;
  std::vector<std::vector<surefill_adapter_attribute>> attributes;
  Primitives primitives;
  surefill_adapter_scene scene{};

  explicit FirstVersion(const surefill_adapter2_scene& from) : draws(from.draw_count), attributes(from.draw_count) {
    for (std::uint32_t d = 0; d < from.draw_count; ++d) {
      const surefill_adapter2_draw& draw = *from.draws[d];
      surefill_adapter_draw& to = draws[d];
      for (std::uint32_t k = 0; k < from.attribute_count; ++k) {
        const surefill_adapter2_attribute& a = *draw.attributes[k];
        attributes[d].push_back({a.values, a.components, a.interpolation});
      }
      to.vertex_count = draw.vertex_count;
      to.triangle_count = draw.primitive_count;
      to.pixel = draw.pixel;
      to.clip = draw.clip;
      to.indices = draw.indices;
      to.identifiers = draw.identifiers;
      to.attributes = attributes[d].data();
      to.clip_is_exact = draw.clip_is_exact;
      to.viewport_x = draw.viewport_x;
      to.viewport_y = draw.viewport_y;
      to.viewport_width = draw.viewport_width;
      to.viewport_height = draw.viewport_height;
      to.viewport_near = draw.viewport_near;
      to.viewport_far = draw.viewport_far;
      to.viewport_depth_range = draw.viewport_depth_range;
      to.fill_rule = draw.fill_rule;
      to.front_face = draw.front_face;
      to.cull = draw.cull;
      to.depth_mode = draw.depth_mode;
      to.depth_write = draw.depth_write;
      to.conservative = draw.conservative;
      to.has_scissor = draw.has_scissor;
      std::memcpy(to.scissor, draw.scissor, sizeof to.scissor);
      to.has_grid = draw.has_grid;
      to.grid_bits = draw.grid_bits;
      to.grid_rounding = draw.grid_rounding;
      to.grid_offset_x = draw.grid_offset_x;
      to.grid_offset_y = draw.grid_offset_y;
      primitives.push_back({draw.primitive, draw.width});
    }
    scene.width = from.width;
    scene.height = from.height;
    scene.samples = from.samples;
    scene.depth_test = from.depth_test;
    scene.attribute_location = from.attribute_location;
    scene.attribute_count = from.attribute_count;
    scene.draw_count = from.draw_count;
    scene.draws = draws.data();
    scene.initial_depth = from.initial_depth;
  }
};

int draw(void* instance, const surefill_adapter2_scene* given, const surefill_adapter2_image* place) {
  auto& self = *static_cast<Instance*>(instance);
  try {
    const FirstVersion first(*given);
    const surefill_adapter_image image{place->count, place->index, place->depth, place->barycentrics,
                                       place->attributes};
    if (asks_for_visible(image) && !depths_within_buffer(first.scene, first.primitives)) {
      throw NotJudged("depths outside 0 to 1, which a depth buffer does not hold");
    }
    if (self.tight_viewport) {
      self.driver->draw(TightScene(first.scene, first.primitives).scene(), first.primitives, image);
    } else {
      self.driver->draw(first.scene, first.primitives, image);
    }
    return SUREFILL_ADAPTER_OK;
  } catch (const NotJudged& reason) {
    self.error = reason.what();
    return SUREFILL_ADAPTER_UNSUPPORTED;
  } catch (const std::exception& error) {
    self.error = error.what();
    return SUREFILL_ADAPTER_FAILED;
  }
}

void close(void* instance) {
  delete static_cast<Instance*>(instance);
}

const char* error_text(void* instance) {
  return instance ? static_cast<Instance*>(instance)->error.c_str() : open_error.c_str();
}

constexpr surefill_adapter2_api kApi{
    sizeof(surefill_adapter2_api), SUREFILL_ADAPTER2_VERSION, open, draw, close, error_text, nullptr};

}  // namespace

}  // namespace surefill::drivers

extern "C" const surefill_adapter2_api* surefill_adapter2_entry() {
  return &surefill::drivers::kApi;
}
