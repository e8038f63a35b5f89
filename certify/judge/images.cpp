// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/images.hpp"

#include <cmath>

#include "certify/judge/shape.hpp"
#include "certify/judge/text.hpp"
#include "certify/judge/turns.hpp"

namespace surefill::judge {

namespace {

constexpr int kGrantedRoundings = 64;  // R11
constexpr double kClearSteps = 1.0 / 16;
constexpr float kWidest = 256;        // R20
constexpr std::uint32_t kPieces = 8;  // of a triangle that is cut by seven planes
constexpr Range kAnything{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

bool finite(const Vertex& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

// Beside 0, numbers of 2^-32 to 2^32: no standard says what becomes of others. Of what is not finite B1 says that its triangle
// covers nothing, to those who claim to have it so.
bool ordinary(float value) {
  return value == 0 || !std::isfinite(value) || (std::abs(value) >= 0x1p-32f && std::abs(value) <= 0x1p32f);
}

std::uint32_t identifier_of(const Draw& draw, std::size_t t) {
  return draw.identifiers.empty() ? draw.first_index + static_cast<std::uint32_t>(t) : draw.identifiers[t];
}

// A rasterizer does not snap X/W but what it has rounded before: by so much, where W is no power of two.
double divided_blur(const oracle::AxisModel& axis, double farthest) {
  const double rounding = 0x1p-21 * farthest;
  return axis.bits < 0 ? rounding : std::max(rounding, std::ldexp(kClearSteps, -axis.bits));
}

Cull in_default_facing(const Draw& draw) {
  if (draw.cull == Cull::none || draw.front_face == FrontFace::clockwise) return draw.cull;
  return draw.cull == Cull::front ? Cull::back : Cull::front;
}

bool attributes_finite(const Draw& draw, const Shape& shape) {
  for (const AttributeArray& array : draw.attributes) {
    const std::size_t stride = array.stride == 0 ? array.components : array.stride;
    for (const std::uint32_t v : shape.indices()) {
      for (std::size_t c = 0; c < array.components; ++c) {
        if (!std::isfinite(array.values[v * stride + c])) return false;
      }
    }
  }
  return true;
}

struct Place {
  double x, y;  // of the sample, as the model has it
  int pixel_x, pixel_y;
  std::size_t number;
};

Place place_of(const Model& model, const Frame& frame, std::size_t s) {
  const auto samples = static_cast<std::size_t>(frame.samples), width = static_cast<std::size_t>(frame.width);
  const SampleLocation at = sample_location(frame.samples, static_cast<int>(s % samples));
  const std::size_t pixel = s / samples;
  Place place{0, 0, static_cast<int>(pixel % width), static_cast<int>(pixel / width), s % samples};
  place.x = place.pixel_x + at.x / 16.0 - 0.5 + model.x.place - model.x.moved;
  place.y = place.pixel_y + at.y / 16.0 - 0.5 + model.y.place - model.y.moved;
  place.x *= frame.width / (frame.width - model.x.lacks);
  place.y *= frame.height / (frame.height - model.y.lacks);
  return place;
}

double format_step(const Model& model) {
  double step = model.minus_one_to_one ? 0x1p-22 : 0x1p-32;
  if (model.format == oracle::DepthFormat::unorm24) step += 1.0 / 0xFFFFFF;
  if (model.format == oracle::DepthFormat::unorm16) step += 1.0 / 0xFFFF;
  return step;
}

// How far from the sample a value may be taken, x and y, in pixels before R3: R11's p, and beside it how well its place is
// known: the blur, and of a grid a step, since coverage does not tell a sample from one a step further, if all positions
// go a step further, too.
std::array<double, 2> distance_of(const Model& model, const Frame& frame, const Shape& shape) {
  const double lost = shape.primitive() == Primitive::triangles
                          ? oracle::lost_by_cutting(model, frame.width, frame.height, shape.vertices())
                          : 0;
  const auto along = [&model, lost](const oracle::AxisModel& axis, int length) {
    const double known = std::max(axis.blur, axis.divided_blur) + axis.place_within;
    const double step = axis.bits < 0 ? 0 : std::ldexp(1.0, -axis.bits);
    return (model.distance + known + step + lost) * length / (length - axis.lacks);
  };
  return {along(model.x, frame.width), along(model.y, frame.height)};
}

// R11: by how much more is rounded where new vertices come from others of larger W.
double cut_roundings(const Model& model, const Shape& shape) {
  const std::array<Vertex, 3>& t = shape.vertices();
  const double w = shape.primitive() == Primitive::triangles ? oracle::least_w_of_cut(model, t) : 0;
  return w > 0 ? std::max({std::abs(t[0].w), std::abs(t[1].w), std::abs(t[2].w)}) / w : 1;
}

// What is granted to depth at the sample.
Range depth_range(const Model& model, const Frame& frame, const Shape& shape, const Place& at, double* value) {
  std::array<double, 3> z{}, w{};
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    z[i] = shape.vertices()[i].z;
    w[i] = shape.vertices()[i].w;
    largest = std::max(largest, std::abs(z[i] / w[i]));
  }
  const std::array<double, 2> distance = distance_of(model, frame, shape);
  const Values values = shape.values(z, w, at.x, at.y, distance);
  if (value) *value = values.value;
  largest = std::max(largest, shape.terms(z, w, at.x, at.y, distance));
  const double more =
      kGrantedRoundings * 0x1p-24 * largest * cut_roundings(model, shape) + 0x1p-126 + format_step(model);
  Range granted{values.range.low - more, values.range.high + more};
  if (!shape.in_front()) return granted;
  // Or kept between those of the vertices, as G2 has it.
  const auto [least, most] = std::minmax({z[0] / w[0], z[1] / w[1], z[2] / w[2]});
  granted.low = std::min(granted.low, most + more), granted.high = std::max(granted.high, least - more);
  return granted;
}

// R11: beyond 0 to 1 a depth is the buffer's own.
bool in_depths(double z) {
  return z >= 0 && z <= 1;
}

// Fragments that a clip to [low, high] takes away: yes or open becomes no or open.
Cover clipped(Cover cover, const Range& depth, double low, double high) {
  if (depth.high < low || depth.low > high) return Cover::no;
  if (depth.low < low || depth.high > high) return Cover::open;
  return cover;
}

std::string pixel_text(const Frame& frame, const Place& at) {
  std::string text = "pixel (" + std::to_string(at.pixel_x) + ", " + std::to_string(at.pixel_y) + ")";
  if (frame.samples > 1) text += " sample " + std::to_string(at.number);
  return text;
}

std::string number(double value) {
  return text("%a (%.9g)", value, value);
}

std::string named(std::uint32_t index) {
  return index == kNoTriangle ? "none" : std::to_string(index);
}

// The judge of one image.
class Look {
 public:
  Look(const Terms& terms, const Frame& frame, const corpus::Image& image,
       std::span<const corpus::SceneAttribute> names)
      : terms_(terms), frame_(frame), image_(image), names_(names) {
    for (std::size_t d = 0; d < frame.draws.size(); ++d) {
      models_.push_back(model_of_draw(terms, frame, frame.draws[d]));
      const std::size_t corners = corpus::corners_of(frame.draws[d].primitive);
      for (std::size_t t = 0; corners * t < frame.draws[d].indices.size(); ++t) places_.push_back({d, t});
    }
  }

  Judgement run(const Counts& counts, const Looks& looks) {
    const std::size_t total = counts.least.size();
    result_.least = counts.least;
    result_.differs.assign(total, 0);
    result_.unknown.assign(total, 0);
    for (std::size_t s = 0; s < total; ++s) {
      const bool known = counts.least[s] == counts.most[s];
      result_.unknown[s] = known ? 0 : 1;
      ++(known ? result_.samples : result_.open);
      if (looks.counts && !image_.count.empty()) {
        const std::uint32_t got = image_.count[s];
        if (got < counts.least[s] || got > counts.most[s]) {
          const std::string wanted = known ? std::to_string(counts.least[s])
                                           : std::to_string(counts.least[s]) + " to " + std::to_string(counts.most[s]);
          differs("count", s, wanted, std::to_string(got), 1, known);
          continue;
        }
      }
      if (!looks.values) continue;
      if (const auto seen = known ? seen_at(s, counts) : std::nullopt) {
        look_at_seen(s, *seen);
      } else if (counts.most[s] > 0) {
        look_at_ranges(s, counts);
      }
    }
    return std::move(result_);
  }

 private:
  void differs(const std::string& what, std::size_t s, const std::string& expected, const std::string& actual,
               double error, bool known = true) {
    if (!result_.differs[s]) {
      ++result_.differences;
      result_.values.push_back({s, what, expected, actual, std::isnan(error) ? HUGE_VAL : error});
      // What is wrong at an open sample has been judged there.
      if (!known) ++result_.samples, --result_.open;
    }
    result_.differs[s] = 1;
    if (!result_.finding.empty()) return;
    result_.sample = s;
    result_.finding = what + " at " + pixel_text(frame_, place_of(terms_.model, frame_, s)) + ": expected " + expected +
                      ", got " + actual;
  }

  // R12: which triangle is visible, and whose depth is kept, over all draws.
  struct Seen {
    std::uint32_t visible = kNoTriangle, kept = kNoTriangle;
  };

  // Where the triangles that cover the sample are known; none where what is granted to their depths leaves it open.
  std::optional<Seen> seen_at(std::size_t s, const Counts& counts) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const Model& model = terms_.model;
    const bool greater = frame_.depth_test == DepthTest::greater;
    // A depth that does not come out may have 16 bits.
    const double more = image_.depth.empty() ? 1.0 / 0xFFFF : 0;
    const auto nearest_least = [greater, more](const Range& z) {
      return greater ? Range{-z.high - more, -z.low + more} : Range{z.low - more, z.high + more};
    };
    Range kept{kInfinity, kInfinity};
    if (frame_.initial_depth) {
      // What a buffer makes of a depth out of its range is its own.
      if (frame_.before.empty() || !(frame_.before[s] >= 0 && frame_.before[s] <= 1)) return std::nullopt;
      kept = nearest_least(depth_before(s));
    } else if (std::isfinite(model.clear)) {
      kept = greater ? Range{0, 0} : Range{model.clear, model.clear};
    }
    std::vector<std::uint32_t> covering;
    for (std::uint32_t i = counts.last[s]; i != Counts::kNone; i = counts.links[i].before) {
      covering.push_back(counts.links[i].which);
    }
    Seen seen;
    for (; !covering.empty(); covering.pop_back()) {
      const std::uint32_t which = covering.back();
      const Draw& draw = frame_.draws[places_[which].draw];
      const bool first = kept.low == kInfinity;
      if (!first || covering.size() > 1) {
        const Range depth = nearest_least(kept_range(s, which, nullptr));
        if (!first && depth.low > kept.high) continue;
        if (!first && !(depth.high < kept.low)) return std::nullopt;
        if (draw.depth_write) kept = depth;
      }
      // M5's order is that of identifiers.
      const bool same_draw = seen.visible != kNoTriangle && places_[seen.visible].draw == places_[which].draw;
      if (!draw.depth_write && !draw.identifiers.empty() && same_draw) return std::nullopt;
      seen.visible = which;
      if (draw.depth_write) seen.kept = which;
    }
    return seen;
  }

  Range depth_before(std::size_t s) const {
    const double step = format_step(terms_.model);
    return {frame_.before[s] - step, frame_.before[s] + step};
  }

  // What is granted to the depth that a triangle leaves.
  Range kept_range(std::size_t s, std::uint32_t which, double* value) const {
    const auto [d, t] = places_[which];
    const Draw& draw = frame_.draws[d];
    double z = 0;
    const Range granted = depth_range(models_[d], frame_, Shape(draw, t), place_of(models_[d], frame_, s), &z);
    if (value) *value = z;
    if (draw.depth_mode != DepthMode::clamp && !in_depths(z)) return kAnything;
    if (draw.depth_mode != DepthMode::clamp) return granted;
    const double step = format_step(models_[d]) + 0x1p-23;
    if (value) *value = std::clamp(*value, 0.0, 1.0);
    return {std::clamp(granted.low, 0.0, 1.0) - step, std::clamp(granted.high, 0.0, 1.0) + step};
  }

  void look_at_seen(std::size_t s, const Seen& seen) {
    const bool empty = seen.visible == kNoTriangle;
    const Of of = empty ? Of{} : places_[seen.visible];
    const std::uint32_t index = empty ? kNoTriangle : identifier_of(frame_.draws[of.draw], of.triangle);
    if (!image_.index.empty() && image_.index[s] != index) {
      differs("index", s, named(index), named(image_.index[s]), 1);
      return;
    }
    if (!image_.depth.empty() && seen.kept != kNoTriangle) {
      double z = 0;
      const Range granted = kept_range(s, seen.kept, &z);
      note("depth", result_.deviations.depth, s, z, granted, image_.depth[s]);
    } else if (!image_.depth.empty() && frame_.initial_depth) {
      in_range("depth, which was there before,", s, depth_before(s), image_.depth[s], true);
    } else {
      look_at_empty_depth(s, empty ? "depth of an empty sample" : "depth, which is not written,");  // M5
    }
    // With several samples, where in the pixel a value is taken is for M1 to say and the standards to leave open.
    if (!empty && frame_.samples == 1) look_at_values(s, seen.visible);
  }

  void look_at_empty_depth(std::size_t s, const char* what) {
    const float empty = frame_.depth_test == DepthTest::greater ? -std::numeric_limits<float>::infinity()
                                                                : std::numeric_limits<float>::infinity();
    if (image_.depth.empty() || image_.depth[s] == empty || image_.depth[s] == terms_.model.clear) return;
    differs(what, s, number(empty), number(image_.depth[s]), HUGE_VAL);
  }

  void look_at_values(std::size_t s, std::uint32_t which) {
    const auto [d, t] = places_[which];
    const Draw& draw = frame_.draws[d];
    const Model& model = models_[d];
    const Shape shape(draw, t);
    const Place at = place_of(model, frame_, s);
    const std::array<double, 3> ones{1, 1, 1};
    const auto look = [&](const std::string& name, Deviation& deviation, const std::array<double, 3>& above,
                          const std::array<double, 3>& below, double largest, float actual) {
      if (!std::isfinite(largest)) return;
      const std::array<double, 2> distance = distance_of(model, frame_, shape);
      const Values values = shape.values(above, below, at.x, at.y, distance);
      const double terms = std::max(largest, shape.terms(above, below, at.x, at.y, distance));
      const double more = kGrantedRoundings * 0x1p-24 * terms * cut_roundings(model, shape) + 0x1p-126;
      note(name, deviation, s, values.value, {values.range.low - more, values.range.high + more}, actual);
    };
    for (std::size_t i = 0; i < 3 && !image_.barycentrics.empty(); ++i) {
      std::array<double, 3> unit{};
      unit[i] = 1;
      look("barycentric b" + std::to_string(i), result_.deviations.barycentrics, unit, ones, 1,
           image_.barycentrics[3 * s + i]);
    }
    for (std::size_t k = 0; k < image_.attributes.size() && k < draw.attributes.size(); ++k) {
      if (image_.attributes[k].empty()) continue;
      for (std::size_t c = 0; c < draw.attributes[k].components; ++c) {
        const Corners corners = attribute_of(which, k, c);
        look(names_[k].name, result_.deviations.attributes, corners.above, corners.below, corners.largest,
             image_.attributes[k][draw.attributes[k].components * s + c]);
      }
    }
  }

  // R13: where somebody is visible, whose values are in whose range. Without an index nobody knows who it is, and without
  // a count nobody whether it is anyone.
  void look_at_ranges(std::size_t s, const Counts& counts) {
    const bool known = counts.least[s] == counts.most[s];
    const bool hidden = frame_.initial_depth || std::isfinite(terms_.model.clear);
    std::vector<std::uint32_t> seen;
    for (std::uint32_t i = counts.last[s]; i != Counts::kNone; i = counts.links[i].before) {
      const auto [d, t] = places_[counts.links[i].which];
      if (image_.index.empty() || image_.index[s] == identifier_of(frame_.draws[d], t)) {
        seen.push_back(counts.links[i].which);
      }
    }
    if (!image_.index.empty()) {
      if (image_.index[s] == kNoTriangle) {
        if (counts.least[s] > 0 && !hidden) differs("index", s, "a triangle's", "none", 1, known);
        return;
      }
      if (seen.empty()) {
        differs("index", s, "that of a triangle that may cover it", named(image_.index[s]), 1, known);
        return;
      }
    } else if (image_.count.empty() || image_.count[s] == 0 || hidden) {
      return;
    }
    look_at_depth_range(s, seen, known);
    // With several samples, where in the pixel a value is taken is for M1 to say and the standards to leave open.
    if (frame_.samples > 1) return;
    const auto look = [&](const std::string& name, float actual, const auto& corners) {
      Range hull{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
      for (const std::uint32_t which : seen) {
        const Range range = range_of(s, which, corners(which));
        hull = {std::min(hull.low, range.low), std::max(hull.high, range.high)};
      }
      in_range(name, s, hull, actual, known);
    };
    for (std::size_t i = 0; i < 3 && !image_.barycentrics.empty(); ++i) {
      look("barycentric b" + std::to_string(i), image_.barycentrics[3 * s + i], [&](std::uint32_t) {
        Corners corners{{}, {1, 1, 1}, {0, 1}, 1};
        corners.above[i] = 1;
        return corners;
      });
    }
    for (std::size_t k = 0; k < image_.attributes.size(); ++k) {
      const std::size_t components = image_.attributes[k].size() / counts.least.size();
      for (std::size_t c = 0; c < components; ++c) {
        look(names_[k].name, image_.attributes[k][components * s + c],
             [&](std::uint32_t which) { return attribute_of(which, k, c); });
      }
    }
  }

  // What is interpolated: (sum above_i E_i) / (sum below_i E_i), of values in `vertices`.
  struct Corners {
    std::array<double, 3> above, below;
    Range vertices;
    double largest;
  };

  Corners attribute_of(std::uint32_t which, std::size_t k, std::size_t c) const {
    const auto [d, t] = places_[which];
    const Draw& draw = frame_.draws[d];
    const Shape shape(draw, t);
    const AttributeArray& array = draw.attributes[k];
    const std::size_t stride = array.stride == 0 ? array.components : array.stride;
    Corners corners{{}, {1, 1, 1}, {}, 0};
    std::array<double, 3>& u = corners.above;
    for (std::size_t i = 0; i < 3; ++i) u[i] = array.values[shape.indices()[i] * stride + c];
    if (array.interpolation == Interpolation::flat) u = {u[0], u[0], u[0]};
    const auto [low, high] = std::minmax({u[0], u[1], u[2]});
    corners.vertices = {low, high};
    corners.largest = std::max(std::abs(low), std::abs(high));
    for (std::size_t i = 0; i < 3 && array.interpolation == Interpolation::noperspective; ++i) {
      corners.below[i] = shape.vertices()[i].w;
      u[i] *= corners.below[i];
    }
    return corners;
  }

  // What is granted at a sample that the triangle may cover: what R11 grants, and what its vertices have. Beside a
  // triangle its plane is a difference of large numbers, and rounded as such.
  Range range_of(std::size_t s, std::uint32_t which, const Corners& corners) const {
    const auto [d, t] = places_[which];
    const Model& model = models_[d];
    const Shape shape(frame_.draws[d], t);
    const Place at = place_of(model, frame_, s);
    const std::array<double, 2> distance = distance_of(model, frame_, shape);
    Range range = shape.values(corners.above, corners.below, at.x, at.y, distance).range;
    double more =
        kGrantedRoundings * 0x1p-24 * shape.terms(corners.above, corners.below, at.x, at.y, distance) + 0x1p-126;
    if (shape.in_front()) {
      range.low = std::min(range.low, corners.vertices.low);
      range.high = std::max(range.high, corners.vertices.high);
    }
    if (std::isfinite(corners.largest)) more = std::max(more, kGrantedRoundings * 0x1p-24 * corners.largest);
    more *= cut_roundings(model, shape);
    return {range.low - more, range.high + more};
  }

  void look_at_depth_range(std::size_t s, const std::vector<std::uint32_t>& seen, bool known) {
    if (image_.depth.empty()) return;
    Range hull{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Draw& draw : frame_.draws) {
      if (!draw.depth_write) return;  // then the depth is not the visible triangle's
    }
    for (const std::uint32_t which : seen) {
      const auto [d, t] = places_[which];
      const Draw& draw = frame_.draws[d];
      const Shape shape(draw, t);
      std::array<double, 3> z{};
      Corners corners{{}, {}, {}, 0};
      for (std::size_t i = 0; i < 3; ++i) {
        corners.above[i] = shape.vertices()[i].z;
        corners.below[i] = shape.vertices()[i].w;
        z[i] = corners.above[i] / corners.below[i];
      }
      const auto [low, high] = std::minmax({z[0], z[1], z[2]});
      if (draw.depth_mode != DepthMode::clamp && !(in_depths(low) && in_depths(high))) return;
      corners.vertices = {low, high};
      if (shape.in_front()) corners.largest = std::max(std::abs(low), std::abs(high));
      const double step = format_step(models_[d]);
      Range range = range_of(s, which, corners);
      range = {range.low - step, range.high + step};
      if (draw.depth_mode == DepthMode::clamp) {
        const double beyond = step + 0x1p-23;
        range = {std::clamp(range.low, 0.0, 1.0) - beyond, std::clamp(range.high, 0.0, 1.0) + beyond};
      }
      hull = {std::min(hull.low, range.low), std::max(hull.high, range.high)};
    }
    in_range("depth", s, hull, image_.depth[s], known);
  }

  void in_range(const std::string& name, std::size_t s, const Range& granted, float actual, bool known) {
    if (!std::isfinite(granted.low) || !std::isfinite(granted.high)) return;
    if (actual >= granted.low && actual <= granted.high) return;
    differs(name, s, number(static_cast<float>(granted.low)) + " to " + number(static_cast<float>(granted.high)),
            number(actual), std::max(granted.low - actual, actual - granted.high), known);
  }

  // Notes the error of one value, in ULP of the largest number that is granted (next to 0 its own ULP says nothing of
  // how it was found).
  void note(const std::string& name, Deviation& deviation, std::size_t s, double expected, const Range& granted,
            float actual) {
    if (!std::isfinite(granted.low) || !std::isfinite(granted.high)) return;
    const double error = std::abs(actual - expected);
    const double allowed = std::max(granted.high - expected, expected - granted.low);
    const bool good = actual >= granted.low && actual <= granted.high;
    if (std::isfinite(error)) {
      // Numbers below 2^-32 are not judged.
      const double scale = std::max({std::abs(granted.low), std::abs(granted.high), 0x1p-32});
      deviation.ulp = std::max(deviation.ulp, error / std::ldexp(1.0, std::ilogb(scale) - 23));
      deviation.granted = std::max(deviation.granted, error / allowed);
    }
    if (!good) differs(name, s, number(static_cast<float>(expected)), number(actual), error);
  }

  struct Of {
    std::size_t draw, triangle;
  };
  const Terms& terms_;
  const Frame& frame_;
  const corpus::Image& image_;
  std::span<const corpus::SceneAttribute> names_;
  std::vector<Of> places_;
  std::vector<Model> models_;  // of each draw
  Judgement result_;
};

}  // namespace

std::uint64_t Counts::judged() const {
  std::uint64_t n = 0;
  for (std::size_t s = 0; s < least.size(); ++s) n += static_cast<std::uint64_t>(least[s] == most[s]);
  return n;
}

std::string why_open(const Terms& terms, const Frame& frame) {
  if (terms.model.x.lacks >= frame.width || terms.model.y.lacks >= frame.height) return "a viewport of no size";
  for (const Draw& draw : frame.draws) {
    if (draw.conservative != Conservative::none) return "conservative rasterization has no model";
    if (draw.primitive != Primitive::triangles) {
      if (frame.samples > 1) return "lines and points with several samples a pixel";
      if (draw.width.value_or(1) > kWidest) return "widths above 256 pixels";
    }
    for (const Vertex& v : draw.vertices) {
      if (!ordinary(v.x) || !ordinary(v.y) || !ordinary(v.z) || !ordinary(v.w))
        return "numbers beyond 2^32 or below 2^-32";
    }
    for (const AttributeArray& array : draw.attributes) {
      for (const float value : array.values) {
        if (!ordinary(value)) return "numbers beyond 2^32 or below 2^-32";
      }
    }
    const bool own_grid = terms.draws_own_grid && draw.grid;
    if (!terms.known && own_grid) return "a grid of the draw's, where no model is known";
  }
  return "";
}

Model model_of_draw(const Terms& terms, const Frame& frame, const Draw& draw) {
  Model model = terms.model;
  if (terms.known && terms.draws_own_rule) {
    model.front = model.back = oracle::owners_of(draw.fill_rule);
    if (draw.primitive != Primitive::triangles) {
      model.lines.outline.ties = model.points.outline.ties = draw.fill_rule;
    }
    model.vertices = oracle::AtVertices::as_edges;
  }
  if (terms.known && terms.draws_own_grid) {
    for (oracle::AxisModel* axis : {&model.x, &model.y}) {
      axis->bits = draw.grid ? draw.grid->bits : -1;
      if (!draw.grid) continue;
      constexpr oracle::Rounding kNames[] = {oracle::Rounding::nearest_even, oracle::Rounding::nearest_up,
                                             oracle::Rounding::truncate};
      axis->rounding = kNames[static_cast<std::size_t>(draw.grid->rounding)];
      const int offset = axis == &model.x ? draw.grid->offset_x : draw.grid->offset_y;
      axis->grid_offset = std::ldexp(offset, -draw.grid->bits - 4);
    }
  }
  if (draw.depth_mode == DepthMode::clip) {
    const std::array<double, 2> always = model.clipped.value_or(std::array{0.0, 1.0});
    model.clipped = {std::max(always[0], 0.0), std::min(always[1], 1.0)};
  }
  double farthest = std::max(frame.width, frame.height);
  for (const Vertex& v : draw.vertices) {
    if (!finite(v) || !(v.w > 0)) continue;
    farthest = std::max({farthest, std::abs(static_cast<double>(v.x) / v.w), std::abs(static_cast<double>(v.y) / v.w)});
  }
  farthest = std::min(farthest, 0x1p14);
  // Blur was found within kTurnLength pixels, and what rounds on the way rounds more of what is larger.
  model.x.blur *= std::max(1.0, farthest / kTurnLength);
  model.y.blur *= std::max(1.0, farthest / kTurnLength);
  model.x.divided_blur = divided_blur(model.x, farthest);
  model.y.divided_blur = divided_blur(model.y, farthest);
  return model;
}

Counts counts_under(const Expected& expected, const Terms& terms, const Frame& frame) {
  const std::size_t total = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height) *
                            static_cast<std::size_t>(frame.samples);
  Counts counts;
  counts.least.assign(total, 0);
  counts.most.assign(total, 0);
  counts.last.assign(total, Counts::kNone);
  std::uint32_t which = 0;
  for (const Draw& draw : frame.draws) {
    Model model = model_of_draw(terms, frame, draw);
    const Cull cull = in_default_facing(draw);
    // A rounding may decide ties on slanted edges, and on all where there is neither a grid nor a rule of C3's.
    if (terms.rounds_slanted) {
      const bool all = model.x.bits < 0 && model.y.bits < 0 && !oracle::watertight_rule(terms.model);
      const std::uint8_t open = all ? 0xFF : oracle::kSlanted;
      model.front.open |= open, model.back.open |= open;
      if (all) model.vertices = oracle::AtVertices::open;
    }
    const bool nothing = model.culled != Cull::none && cull != Cull::none && cull != model.culled;
    if (cull != Cull::none) model.culled = cull;
    const std::size_t corners = corpus::corners_of(draw.primitive);
    for (std::size_t t = 0; corners * t < draw.indices.size(); ++t, ++which) {
      const Shape shape(draw, t);
      const std::array<Vertex, 3>& v = shape.vertices();
      const bool triangle = draw.primitive == Primitive::triangles;
      if ((triangle && nothing) || !std::all_of(v.begin(), v.end(), finite) || !attributes_finite(draw, shape)) {
        continue;
      }
      const std::vector<Cover> covers =
          triangle ? expected.cover(model, frame.width, frame.height, frame.samples, v)
          : draw.primitive == Primitive::lines
              ? expected.cover_line(model, frame.width, frame.height, {v[0], v[1]}, draw.width)
              : expected.cover_point(model, frame.width, frame.height, v[0], draw.width.value_or(1));
      // R9: pieces of what roundings have lost may lie one over the other.
      const std::uint32_t pieces =
          triangle && oracle::lost_by_cutting(model, frame.width, frame.height, v) > kClearSteps ? kPieces : 1;
      for (std::size_t s = 0; s < total; ++s) {
        Cover cover = covers[s];
        if (cover == Cover::no) continue;
        const Place at = place_of(model, frame, s);
        if (draw.scissor && (at.pixel_x < draw.scissor->x0 || at.pixel_x >= draw.scissor->x1 ||
                             at.pixel_y < draw.scissor->y0 || at.pixel_y >= draw.scissor->y1)) {
          continue;
        }
        const bool hides = terms.counts_seen && std::isfinite(model.clear);
        if (model.clipped || hides) {
          const Range depth = depth_range(model, frame, shape, at, nullptr);
          const bool greater = frame.depth_test == DepthTest::greater;
          // What the clear value hides was taken for clipping, as it is with the test LESS.
          if (model.clipped && !(hides && greater)) {
            cover = clipped(cover, depth, (*model.clipped)[0], (*model.clipped)[1]);
          }
          if (hides && cover == Cover::yes && (depth.high >= 1 || (greater && depth.low <= 0))) cover = Cover::open;
        }
        if (cover == Cover::no) continue;
        counts.most[s] += cover == Cover::open ? pieces : 1;
        counts.links.push_back({which, counts.last[s]});
        counts.last[s] = static_cast<std::uint32_t>(counts.links.size() - 1);
        if (cover == Cover::yes) ++counts.least[s];
      }
    }
  }
  return counts;
}

Judgement judge_image(const Expected& expected, const Terms& terms, const Frame& frame, const corpus::Image& image,
                      const Looks& looks, std::span<const corpus::SceneAttribute> names) {
  return Look(terms, frame, image, names).run(counts_under(expected, terms, frame), looks);
}

}  // namespace surefill::judge
