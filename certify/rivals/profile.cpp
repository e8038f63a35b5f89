// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "certify/run/judge.hpp"

namespace surefill::certify {

namespace {

using adapters::Rival;
using corpus::Image;
using corpus::Scene;

constexpr double kCertainDistance = 1.0 / 16;
// Relative error of an edge function in long double, which is a double at least, with room to spare: 2^9 roundings.
static_assert(std::numeric_limits<long double>::digits >= 53);
constexpr long double kRoundings = std::numeric_limits<long double>::digits >= 64 ? 0x1p-55L : 0x1p-44L;

// The plane equations of section 2, in long double.
struct Edges {
  std::array<std::array<long double, 3>, 3> e{}, magnitude{};
  long double d = 0, d_magnitude = 0;

  explicit Edges(const std::array<Vertex, 3>& v) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &p = v[(i + 1) % 3], &q = v[(i + 2) % 3];
      const std::array<long double, 3> m{p.x, p.y, p.w}, n{q.x, q.y, q.w};
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t j = (c + 1) % 3, k = (c + 2) % 3;
        e[i][c] = m[j] * n[k] - m[k] * n[j];
        magnitude[i][c] = std::abs(m[j] * n[k]) + std::abs(m[k] * n[j]);
      }
    }
    const std::array<long double, 3> m{v[0].x, v[0].y, v[0].w};
    for (std::size_t c = 0; c < 3; ++c) {
      d += m[c] * e[0][c];
      d_magnitude += std::abs(m[c]) * magnitude[0][c];
    }
  }
  long double at(std::size_t i, double x, double y) const { return e[i][0] * x + e[i][1] * y + e[i][2]; }
  long double error(std::size_t i, double x, double y) const {
    return kRoundings * (magnitude[i][0] * std::abs(x) + magnitude[i][1] * std::abs(y) + magnitude[i][2]);
  }
};

// 1 or 0 if everything within the distance of (x, y) is covered, or nothing; -1 if that is open.
int certain_cover(const Edges& edges, double x, double y) {
  if (!(std::abs(edges.d) > kRoundings * edges.d_magnitude)) return -1;
  const long double sign = edges.d > 0 ? 1 : -1;
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    bool positive = true, negative = true;
    for (const double dx : {-kCertainDistance, kCertainDistance}) {
      for (const double dy : {-kCertainDistance, kCertainDistance}) {
        const long double value = sign * edges.at(i, x + dx, y + dy), error = edges.error(i, x + dx, y + dy);
        positive = positive && value > error;
        negative = negative && value < -error;
      }
    }
    if (negative) return 0;
    inside = inside && positive;
  }
  return inside ? 1 : -1;
}

struct Triangle {
  const Draw* draw;
  std::array<std::uint32_t, 3> indices;
  std::array<Vertex, 3> vertices;
  Edges edges;
};

bool finite(const std::array<Vertex, 3>& vertices) {
  return std::all_of(vertices.begin(), vertices.end(), [](const Vertex& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
  });
}

// All triangles without NaNs, by identifier; an identifier that several have names none.
std::multimap<std::uint32_t, Triangle> triangles_of(std::span<const Draw> draws) {
  std::multimap<std::uint32_t, Triangle> triangles;
  for (const Draw& draw : draws) {
    for (std::size_t t = 0; 3 * t < draw.indices.size(); ++t) {
      const std::array<std::uint32_t, 3> indices{draw.indices[3 * t], draw.indices[3 * t + 1], draw.indices[3 * t + 2]};
      const std::array<Vertex, 3> vertices{draw.vertices[indices[0]], draw.vertices[indices[1]],
                                           draw.vertices[indices[2]]};
      if (!finite(vertices)) continue;
      const std::uint32_t identifier =
          draw.identifiers.empty() ? draw.first_index + static_cast<std::uint32_t>(t) : draw.identifiers[t];
      triangles.insert({identifier, Triangle{&draw, indices, vertices, Edges(vertices)}});
    }
  }
  return triangles;
}

// The count of a sample as far as it is certain; scissor, culling and depth are the scene's (none, by the caller).
std::optional<std::uint32_t> certain_count(const std::multimap<std::uint32_t, Triangle>& triangles, double x,
                                           double y) {
  std::uint32_t count = 0;
  for (const auto& [identifier, triangle] : triangles) {
    const int cover = certain_cover(triangle.edges, x, y);
    if (cover < 0) return std::nullopt;
    count += static_cast<std::uint32_t>(cover);
  }
  return count;
}

// The places of a value that a rasterizer finds by float32 operations: what is granted for it at a sample.
struct Range {
  double low, high;
};

// weights(i) is what E_i is multiplied with above and below the line; the quotient is the value.
Range value_range(const Triangle& triangle, const std::array<double, 3>& above, const std::array<double, 3>& below,
                  double x, double y, double distance) {
  Range range{INFINITY, -INFINITY};
  long double sign = 0;
  for (const double dx : {-distance, 0.0, distance}) {
    for (const double dy : {-distance, 0.0, distance}) {
      long double numerator = 0, denominator = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const long double e = triangle.edges.at(i, x + dx, y + dy);
        numerator += above[i] * e;
        denominator += below[i] * e;
      }
      // A pole between the places: nothing is granted, since anything is.
      if (denominator == 0 || sign * denominator < 0) return {-INFINITY, INFINITY};
      sign = denominator;
      const auto value = static_cast<double>(numerator / denominator);
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
  }
  return range;
}

// Notes the error of one value, in ULP of the largest of the vertices' values (next to 0 its own ULP says nothing of
// how it was found); true if it is more than granted.
bool note(Deviation& deviation, float expected, float actual, Range range, double largest) {
  if (std::isnan(actual)) return true;
  const double rounding = kGrantedRoundings * 0x1p-24 * largest + 0x1p-126;
  const double error = std::abs(static_cast<double>(actual) - expected);
  const double granted = std::max({range.high - expected, expected - range.low, 0.0}) + rounding;
  if (!std::isfinite(granted)) return false;
  // Numbers below 2^-32 are not judged.
  const double scale = std::max({largest, std::abs(static_cast<double>(expected)), 0x1p-32});
  deviation.ulp = std::max(deviation.ulp, error / std::ldexp(1.0, std::ilogb(scale) - 23));
  deviation.granted = std::max(deviation.granted, error / granted);
  return error > granted;
}

struct Difference {
  std::string output;
  std::size_t sample;
  std::string expected, actual;
};

std::string place(const Scene& scene, std::size_t sample) {
  const auto samples = static_cast<std::size_t>(scene.samples), width = static_cast<std::size_t>(scene.width);
  const std::size_t pixel = sample / samples;
  std::string text = fmt::format("pixel ({}, {})", pixel % width, pixel / width);
  if (scene.samples > 1) text += fmt::format(" sample {}", sample % samples);
  return text;
}

std::string named(std::uint32_t index) {
  return index == kNoTriangle ? "none" : std::to_string(index);
}

// The judge of one scene under a profile that is not exact.
class Inexact {
 public:
  Inexact(const Scene& scene, const corpus::Frame& expected, const corpus::Frame& actual, const Rival& rival,
          const RivalJudgement& judgement)
      : scene_(scene),
        expected_(expected.image()),
        actual_(actual.image()),
        outputs_(rival.info().outputs),
        profile_(rival.info().model.profile),
        judgement_(judgement),
        triangles_(triangles_of(expected.draws())) {
    if (judgement.certain_only || (judgement.coverage && leaves_open(expected.draws()))) certain_ = true;
  }

  CaseResult run() {
    result_.samples = expected_.count.size();
    for (std::size_t s = 0; s < expected_.count.size(); ++s) look_at(s);
    return std::move(result_);
  }

 private:
  void differs(const std::string& what, std::size_t sample, const std::string& expected, const std::string& actual) {
    if (result_.differences++ == 0) {
      result_.finding = fmt::format("{} at {}: expected {}, got {}", what, place(scene_, sample), expected, actual);
    }
  }

  void look_at(std::size_t s) {
    const auto samples = static_cast<std::size_t>(scene_.samples), width = static_cast<std::size_t>(scene_.width);
    const SampleLocation at = sample_location(scene_.samples, static_cast<int>(s % samples));
    const double x = static_cast<double>(s / samples % width) + at.x / 16.0;
    const double y = static_cast<double>(s / samples / width) + at.y / 16.0;
    if (judgement_.coverage) {
      std::optional<std::uint32_t> wanted = expected_.count[s];
      if (certain_) wanted = certain_count(triangles_, x, y);
      if (wanted && *wanted != actual_.count[s]) {
        differs("count", s, std::to_string(*wanted), std::to_string(actual_.count[s]));
        return;
      }
    }
    // Where one triangle covers a sample it is the visible one; where none does, the sample is empty.
    if (!judgement_.values || !scene_.initial_depth.empty() || expected_.count[s] != actual_.count[s] ||
        expected_.count[s] > 1) {
      return;
    }
    if (outputs_ & SUREFILL_ADAPTER_INDEX && expected_.index[s] != actual_.index[s]) {
      differs("index", s, named(expected_.index[s]), named(actual_.index[s]));
      return;
    }
    if (expected_.count[s] == 0) {
      if (outputs_ & SUREFILL_ADAPTER_DEPTH && expected_.depth[s] != actual_.depth[s]) {
        differs("depth of an empty sample", s, fmt::format("{}", expected_.depth[s]),
                fmt::format("{}", actual_.depth[s]));
      }
      return;
    }
    if (triangles_.count(expected_.index[s]) == 1) look_at_values(s, triangles_.find(expected_.index[s])->second, x, y);
  }

  void look_at_values(std::size_t s, const Triangle& triangle, double x, double y) {
    const double distance = granted_position(profile_);
    const auto judge = [&](const std::string& name, Deviation& deviation, float expected, float actual,
                           const std::array<double, 3>& values, const std::array<double, 3>& above,
                           const std::array<double, 3>& below) {
      const double largest = std::max({std::abs(values[0]), std::abs(values[1]), std::abs(values[2])});
      if (!std::isfinite(largest)) return;
      if (!note(deviation, expected, actual, value_range(triangle, above, below, x, y, distance), largest)) return;
      differs(name, s, fmt::format("{:a} ({:.9g})", expected, expected), fmt::format("{:a} ({:.9g})", actual, actual));
    };
    std::array<double, 3> z{}, w{}, depth{};
    for (std::size_t i = 0; i < 3; ++i) {
      z[i] = triangle.vertices[i].z;
      w[i] = triangle.vertices[i].w;
      depth[i] = z[i] / w[i];
    }
    if (outputs_ & SUREFILL_ADAPTER_DEPTH && triangle.draw->depth_mode != DepthMode::clamp) {
      judge("depth", result_.deviations.depth, expected_.depth[s], actual_.depth[s], depth, z, w);
    }
    // With several samples, where in the pixel a value is taken is for M1 to say and the standards to leave open.
    if (scene_.samples > 1) return;
    const std::array<double, 3> ones{1, 1, 1};
    if (outputs_ & SUREFILL_ADAPTER_BARYCENTRICS) {
      for (std::size_t i = 0; i < 3; ++i) {
        std::array<double, 3> unit{};
        unit[i] = 1;
        judge(fmt::format("barycentric b{}", i), result_.deviations.barycentrics, expected_.barycentrics[3 * s + i],
              actual_.barycentrics[3 * s + i], unit, unit, ones);
      }
    }
    if (!(outputs_ & SUREFILL_ADAPTER_ATTRIBUTES)) return;
    for (std::size_t k = 0; k < scene_.attributes.size(); ++k) {
      const AttributeArray& array = triangle.draw->attributes[k];
      for (std::size_t c = 0; c < array.components; ++c) {
        std::array<double, 3> u{}, above{}, below = ones;
        for (std::size_t i = 0; i < 3; ++i) {
          u[i] = array.values[std::size_t{triangle.indices[i]} * array.stride + c];
          above[i] = u[i];
        }
        if (array.interpolation == Interpolation::flat) u = above = {u[0], u[0], u[0]};
        if (array.interpolation == Interpolation::noperspective) {
          below = w;
          for (std::size_t i = 0; i < 3; ++i) above[i] = u[i] * w[i];
        }
        const std::size_t at = array.components * s + c;
        judge(scene_.attributes[k].name, result_.deviations.attributes, expected_.attributes[k][at],
              actual_.attributes[k][at], u, above, below);
      }
    }
  }

  const Scene& scene_;
  const Image &expected_, &actual_;
  std::uint32_t outputs_, profile_;
  RivalJudgement judgement_;
  std::multimap<std::uint32_t, Triangle> triangles_;
  bool certain_ = false;
  CaseResult result_;
};

// State under which the count of a sample is more than which triangles lie over it.
bool plain(const Scene& scene) {
  return std::all_of(scene.draws.begin(), scene.draws.end(), [](const corpus::SceneDraw& draw) {
    return draw.cull == Cull::none && !draw.scissor && draw.depth_mode != DepthMode::clip &&
           draw.conservative == Conservative::none;
  });
}

// Does snapping move every edge by less than the 1/16 pixel that is left open around it?
bool fine_grids(const Scene& scene) {
  return std::all_of(scene.draws.begin(), scene.draws.end(), [](const corpus::SceneDraw& draw) {
    return !draw.grid || draw.grid->bits > 4 || (draw.grid->bits == 4 && draw.grid->rounding != GridRounding::truncate);
  });
}

CaseResult skipped() {
  CaseResult result;
  result.skipped = true;
  return result;
}

}  // namespace

struct Tiling::Triangles {
  std::vector<Edges> edges;
};

Tiling::Tiling(const Scene& scene) : triangles_(std::make_unique<Triangles>()) {
  const corpus::Frame frame(scene, {false, false, false, false, false});
  for (const auto& [identifier, triangle] : triangles_of(frame.draws())) triangles_->edges.push_back(triangle.edges);
}

Tiling::~Tiling() = default;

bool Tiling::around(double x, double y) const {
  for (const double dx : {-kCertainDistance, 0.0, kCertainDistance}) {
    for (const double dy : {-kCertainDistance, 0.0, kCertainDistance}) {
      if (dx == 0 && dy == 0) continue;
      int covers = 0;
      for (const Edges& edges : triangles_->edges) {
        if (!(std::abs(edges.d) > kRoundings * edges.d_magnitude)) return false;
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const long double value = edges.at(i, x + dx, y + dy);
          if (!(std::abs(value) > edges.error(i, x + dx, y + dy))) return false;
          inside = inside && (value > 0) == (edges.d > 0);
        }
        if (inside) ++covers;
      }
      if (covers != 1) return false;
    }
  }
  return true;
}

double granted_position(std::uint32_t profile) {
  return profile == SUREFILL_ADAPTER_PROFILE_D3D11 ? 0x1p-8 : 0x1p-4;
}

bool leaves_open(std::span<const Draw> draws) {
  for (const Draw& draw : draws) {
    for (const Vertex& v : draw.vertices) {
      const double guard_band = 16385.0 * v.w;
      if (std::abs(v.x) > guard_band || std::abs(v.y) > guard_band) return true;
      if (!(v.w > 0) || !std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w)) {
        return true;
      }
    }
  }
  return false;
}

bool out_of_range(std::span<const Draw> draws) {
  const auto ordinary = [](float value) {
    return value == 0 || (std::abs(value) >= 0x1p-32f && std::abs(value) <= 0x1p32f);
  };
  for (const Draw& draw : draws) {
    for (const Vertex& v : draw.vertices) {
      if (!ordinary(v.x) || !ordinary(v.y) || !ordinary(v.z) || !ordinary(v.w)) return true;
    }
    for (const AttributeArray& array : draw.attributes) {
      for (const float value : array.values) {
        if (!ordinary(value)) return true;
      }
    }
  }
  return false;
}

bool projects_clearly(std::span<const Draw> draws) {
  const auto clear = [](double position, int offset, const Grid& grid) {
    const double steps = std::ldexp(position - std::ldexp(offset, -(grid.bits + 4)), grid.bits);
    const double turn = grid.rounding == GridRounding::truncate ? 0 : 0.5;
    const double beyond = steps - turn, distance = std::abs(beyond - std::nearbyint(beyond));
    return std::abs(position) < 0x1p10 && distance >= kClearSteps;
  };
  for (const Draw& draw : draws) {
    for (const Vertex& v : draw.vertices) {
      int exponent = 0;
      if (!(v.w > 0) || std::frexp(v.w, &exponent) == 0.5f) continue;
      if (!draw.grid) return false;
      const double x = static_cast<double>(v.x) / v.w, y = static_cast<double>(v.y) / v.w;
      if (!clear(x, draw.grid->offset_x, *draw.grid) || !clear(y, draw.grid->offset_y, *draw.grid)) return false;
    }
  }
  return true;
}

CaseResult compare_rival(const Scene& original, Rival& rival, const RivalJudgement& judgement) {
  const surefill_adapter_info& info = rival.info();
  const Scene scene = adapters::scene_under_model(original, info);
  const bool exact = info.model.profile == SUREFILL_ADAPTER_PROFILE_EXACT && !judgement.certain_only &&
                     info.model.kind != SUREFILL_ADAPTER_MODEL_UNKNOWN;
  if (!exact) {
    const corpus::Frame frame(scene, {false, false, false, false, false});
    if (out_of_range(frame.draws())) return skipped();
    const bool certain = judgement.certain_only || leaves_open(frame.draws());
    if (certain && !(plain(scene) && fine_grids(scene))) return skipped();
    if (judgement.coverage && !certain && !projects_clearly(frame.draws())) return skipped();
    // Whether a fragment near depth 0 or 1 is clipped depends on how precise its depth is.
    for (const corpus::SceneDraw& draw : scene.draws) {
      if (draw.depth_mode == DepthMode::clip) return skipped();
    }
  }
  CaseResult result;
  try {
    corpus::Outputs outputs = properties::outputs_of(scene);
    const auto has = [&info](int output) { return (info.outputs & static_cast<std::uint32_t>(output)) != 0; };
    corpus::Frame expected(scene, outputs);
    outputs.index = outputs.index && has(SUREFILL_ADAPTER_INDEX);
    outputs.depth = outputs.depth && has(SUREFILL_ADAPTER_DEPTH);
    outputs.barycentrics = outputs.barycentrics && has(SUREFILL_ADAPTER_BARYCENTRICS);
    outputs.attributes = outputs.attributes && has(SUREFILL_ADAPTER_ATTRIBUTES);
    corpus::Frame actual(scene, outputs);
    if (validate(expected.target(), expected.draws()) != Status::ok) return skipped();
    rival.draw(actual.target(), actual.draws());
    properties::oracle_renderer()(expected.target(), expected.draws());
    if (!exact) {
      result = Inexact(scene, expected, actual, rival, judgement).run();
    } else {
      Image wanted = expected.image();
      if (!outputs.index) wanted.index.clear();
      if (!outputs.depth) wanted.depth.clear();
      if (!outputs.barycentrics) wanted.barycentrics.clear();
      if (!outputs.attributes) wanted.attributes.clear();
      const properties::Comparison comparison = properties::compare(scene, wanted, actual.image(), 1);
      result.samples = comparison.samples;
      result.differences = comparison.differences;
      if (!comparison.first.empty()) result.finding = properties::describe(comparison.first.front(), scene.samples);
    }
  } catch (const adapters::RivalSkips&) {
    return skipped();
  } catch (const adapters::RivalFailure& failure) {
    result.samples = 0;
    result.differences = 1;
    result.finding = failure.what();
  }
  if (result.differences > 0) result.scene = scene;
  return result;
}

}  // namespace surefill::certify
