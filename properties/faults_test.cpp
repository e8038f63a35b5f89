// SPDX-License-Identifier: Apache-2.0
//
// That the properties can fail: deliberately wrong renderers, each of which the properties that name its fault must
// reject; every property rejects at least one; right renderers pass them all.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "properties/check.hpp"
#include "properties/reduce.hpp"

namespace surefill::properties {
namespace {

// The vertices of a draw, changed one by one.
class Changed {
 public:
  template <class Change>
  Changed(std::span<const Draw> draws, const Change& change)
      : vertices_(draws.size()), draws_(draws.begin(), draws.end()) {
    for (std::size_t d = 0; d < draws.size(); ++d) {
      for (const Vertex& v : draws[d].vertices) vertices_[d].push_back(change(v));
      draws_[d].vertices = vertices_[d];
    }
  }
  std::span<const Draw> draws() const { return draws_; }

 private:
  std::vector<std::vector<Vertex>> vertices_;
  std::vector<Draw> draws_;
};

template <class Change>
Status with_state(const Target& target, std::span<const Draw> draws, const Change& change) {
  std::vector<Draw> changed(draws.begin(), draws.end());
  for (Draw& draw : changed) change(draw);
  return render(target, changed);
}

template <class Change>
Status with_vertices(const Target& target, std::span<const Draw> draws, const Change& change) {
  return render(target, Changed(draws, change).draws());
}

// Each triangle as a draw of its own, with the index that it had.
std::vector<Draw> one_by_one(std::span<const Draw> draws) {
  std::vector<Draw> single;
  for (const Draw& draw : draws)
    for (std::size_t t = 0; 3 * t < draw.indices.size(); ++t) {
      Draw one = draw;
      one.indices = draw.indices.subspan(3 * t, 3);
      if (draw.identifiers.empty())
        one.first_index = draw.first_index + static_cast<std::uint32_t>(t);
      else
        one.identifiers = draw.identifiers.subspan(t, 1);
      single.push_back(one);
    }
  return single;
}

std::array<Vertex, 3> corners(const Draw& draw) {
  return {draw.vertices[draw.indices[0]], draw.vertices[draw.indices[1]], draw.vertices[draw.indices[2]]};
}

template <class Predicate>
Status without(const Target& target, std::span<const Draw> draws, const Predicate& dropped) {
  std::vector<Draw> kept = one_by_one(draws);
  std::erase_if(kept, [&](const Draw& draw) { return dropped(corners(draw)); });
  return render(target, kept);
}

// The counts, triangle by triangle, as `count_one` says; the other outputs are right.
template <class CountOne>
Status with_counts(const Target& target, std::span<const Draw> draws, const CountOne& count_one) {
  const Status status = render(target, draws);
  if (status != Status::ok || target.count.empty()) return status;
  std::fill(target.count.begin(), target.count.end(), 0u);
  std::vector<std::uint32_t> counts(target.count.size());
  for (const Draw& draw : one_by_one(draws)) {
    count_one(target, draw, counts);
    for (std::size_t s = 0; s < counts.size(); ++s) target.count[s] += counts[s];
  }
  return Status::ok;
}

void count_right(const Target& target, const Draw& draw, std::vector<std::uint32_t>& counts) {
  Target only_count;
  only_count.width = target.width;
  only_count.height = target.height;
  only_count.samples = target.samples;
  only_count.count = counts;
  (void)render(only_count, {&draw, 1});
}

FillRule opposite(FillRule rule) {
  return static_cast<FillRule>(static_cast<unsigned>(rule) ^ 3u);
}

void nudge(std::span<float> values) {
  for (float& value : values)
    if (std::isfinite(value) && value != 0) value = std::nextafter(value, 1e30f);
}

// The faults.

Status fill_rule_mirrored(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) { d.fill_rule = opposite(d.fill_rule); });
}
Status fill_rule_fixed(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) { d.fill_rule = FillRule::top_left; });
}
Status ties_by_facing(const Target& target, std::span<const Draw> draws) {
  return with_counts(target, draws, [](const Target& t, Draw draw, auto& counts) {
    if (facing(corners(draw)) < 0) draw.fill_rule = opposite(draw.fill_rule);
    count_right(t, draw, counts);
  });
}
Status edges_inclusive(const Target& target, std::span<const Draw> draws) {
  return with_counts(target, draws, [](const Target& t, Draw draw, auto& counts) {
    std::vector<std::uint32_t> other(counts.size());
    count_right(t, draw, counts);
    draw.fill_rule = opposite(draw.fill_rule);
    count_right(t, draw, other);
    for (std::size_t s = 0; s < counts.size(); ++s) counts[s] |= other[s];
  });
}
Status last_row_missing(const Target& target, std::span<const Draw> draws) {
  const Status status = render(target, draws);
  const std::size_t row = static_cast<std::size_t>(target.width) * static_cast<std::size_t>(target.samples);
  if (!target.count.empty()) std::fill(target.count.end() - static_cast<std::ptrdiff_t>(row), target.count.end(), 0u);
  return status;
}
Status one_more(const Target& target, std::span<const Draw> draws) {
  const Status status = render(target, draws);
  if (!target.count.empty()) ++target.count[0];
  return status;
}
Status depth_ulp(const Target& target, std::span<const Draw> draws) {
  const Status status = render(target, draws);
  nudge(target.depth);
  return status;
}
Status attribute_ulp(const Target& target, std::span<const Draw> draws) {
  const Status status = render(target, draws);
  for (const AttributeTarget& attribute : target.attributes) nudge(attribute.values);
  return status;
}
Status later_wins(const Target& target, std::span<const Draw> draws) {
  std::vector<Draw> single = one_by_one(draws);
  std::reverse(single.begin(), single.end());
  return render(target, single);
}
Status nan_as_zero(const Target& target, std::span<const Draw> draws) {
  return with_vertices(target, draws, [](Vertex v) {
    for (float* c : {&v.x, &v.y, &v.z, &v.w})
      if (!std::isfinite(*c)) *c = 0;
    return v;
  });
}
Status behind_covers(const Target& target, std::span<const Draw> draws) {
  return with_counts(target, draws, [](const Target& t, const Draw& draw, auto& counts) {
    std::vector<std::uint32_t> other(counts.size());
    count_right(t, draw, counts);
    const Changed negated({&draw, 1}, [](const Vertex& v) { return Vertex{-v.x, -v.y, -v.z, -v.w}; });
    count_right(t, negated.draws()[0], other);
    for (std::size_t s = 0; s < counts.size(); ++s) counts[s] |= other[s];
  });
}
Status w_not_positive_dropped(const Target& target, std::span<const Draw> draws) {
  return without(target, draws, [](const auto& t) { return t[0].w <= 0 || t[1].w <= 0 || t[2].w <= 0; });
}
Status small_dropped(const Target& target, std::span<const Draw> draws) {
  return without(target, draws, [](const auto& t) {
    const auto area = [&](float Vertex::*c) {
      const float a = t[0].*c / t[0].w, b = t[1].*c / t[1].w, d = t[2].*c / t[2].w;
      return std::max({a, b, d}) - std::min({a, b, d});
    };
    return area(&Vertex::x) * area(&Vertex::y) < 1;
  });
}
Status determinant_epsilon(const Target& target, std::span<const Draw> draws) {
  return without(target, draws, [](const auto& t) {
    const auto minor = [&](const Vertex& a, const Vertex& b) { return a.x * b.y - a.y * b.x; };
    return std::abs(t[0].w * minor(t[1], t[2]) + t[1].w * minor(t[2], t[0]) + t[2].w * minor(t[0], t[1])) < 0.01f;
  });
}
Status divided(const Target& target, std::span<const Draw> draws) {
  return with_vertices(target, draws, [](const Vertex& v) { return Vertex{v.x / v.w, v.y / v.w, v.z / v.w, 1}; });
}
Status snapped(const Target& target, std::span<const Draw> draws) {
  return with_vertices(target, draws, [](const Vertex& v) {
    const auto snap = [&](float c) { return std::nearbyint(c / v.w * 256) / 256 * v.w; };
    return Vertex{snap(v.x), snap(v.y), v.z, v.w};
  });
}
Status pixel_corner(const Target& target, std::span<const Draw> draws) {
  return with_vertices(target, draws, [](const Vertex& v) { return Vertex{v.x + v.w / 2, v.y + v.w / 2, v.z, v.w}; });
}
Status scissor_one_wider(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) {
    if (d.scissor && d.scissor->x1 < kMaxTargetSize) ++d.scissor->x1;
  });
}
Status culling_ignored(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) { d.cull = Cull::none; });
}
Status front_face_ignored(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) { d.front_face = FrontFace::clockwise; });
}
Status clip_as_clamp(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) {
    if (d.depth_mode == DepthMode::clip) d.depth_mode = DepthMode::clamp;
  });
}
Status affine(const Target& target, std::span<const Draw> draws) {
  std::vector<std::vector<AttributeArray>> arrays;
  return with_state(target, draws, [&](Draw& d) {
    std::vector<AttributeArray>& own = arrays.emplace_back(d.attributes.begin(), d.attributes.end());
    for (AttributeArray& a : own)
      if (a.interpolation == Interpolation::perspective) a.interpolation = Interpolation::noperspective;
    d.attributes = own;
  });
}
Status weights_exchanged(const Target& target, std::span<const Draw> draws) {
  const Status status = render(target, draws);
  for (std::size_t i = 0; i + 2 < target.barycentrics.size(); i += 3)
    std::swap(target.barycentrics[i], target.barycentrics[i + 1]);
  return status;
}
Status identifiers_ignored(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) { d.identifiers = {}; });
}
Status last_draw_only(const Target& target, std::span<const Draw> draws) {
  return render(target, draws.empty() ? draws : draws.last(1));
}
Status size_dependent(const Target& target, std::span<const Draw> draws) {
  if (target.width % 2 == 0) return render(target, draws);
  return with_state(target, draws, [&](Draw& d) {
    if (!d.scissor) d.scissor = Scissor{0, 0, target.width - 1, target.height};
  });
}
Status far_columns_missing(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) {
    if (!d.scissor) d.scissor = Scissor{0, 0, 2048, 2048};
  });
}
Status box_culls(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) {
    if (d.culling_box) d.indices = {};
  });
}
Status depth_write_ignored(const Target& target, std::span<const Draw> draws) {
  return with_state(target, draws, [](Draw& d) { d.depth_write = true; });
}
Status out_of_memory(const Target&, std::span<const Draw>) {
  return Status::out_of_memory;
}

// What anybody writes first: edge functions in float32 after the division, W > 0 alone, the top-left rule.
Status float_edges(const Target& target, std::span<const Draw> draws) {
  return with_counts(target, draws, [](const Target& t, const Draw& draw, std::vector<std::uint32_t>& counts) {
    std::fill(counts.begin(), counts.end(), 0u);
    std::array<Vertex, 3> v = corners(draw);
    for (Vertex& c : v) c = {c.x / c.w, c.y / c.w, c.z, c.w};
    const auto edge = [](const Vertex& a, const Vertex& b, float x, float y) {
      return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    };
    if (v[0].w <= 0 || v[1].w <= 0 || v[2].w <= 0) return;
    if (edge(v[0], v[1], v[2].x, v[2].y) < 0) std::swap(v[1], v[2]);
    for (int y = 0; y < t.height; ++y)
      for (int x = 0; x < t.width; ++x) {
        bool in = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const Vertex &a = v[i], &b = v[(i + 1) % 3];
          const float e = edge(a, b, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
          const bool top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
          in = in && (e > 0 || (e == 0 && top_left));
        }
        counts[static_cast<std::size_t>(y * t.width + x)] = in ? 1 : 0;
      }
  });
}

struct Fault {
  const char* name;
  Status (*renderer)(const Target&, std::span<const Draw>);
  std::vector<const char*> rejected_by;
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = {
      {"fill_rule_mirrored",
       fill_rule_mirrored,
       {"equality-coverage", "small-world-half-pixel", "small-world-homogeneous"}},
      {"fill_rule_fixed", fill_rule_fixed, {"equality-coverage", "mirror", "transpose", "small-world-half-pixel"}},
      {"ties_by_facing",
       ties_by_facing,
       {"partition-delaunay", "partition-adjacent", "partition-fan", "partition-quads", "partition-t-junctions",
        "partition-all-around", "octants", "small-world-octants", "degree-hull"}},
      {"edges_inclusive",
       edges_inclusive,
       {"partition-delaunay", "partition-adjacent", "partition-fan", "partition-quads", "partition-t-junctions",
        "octants", "small-world-shared-edge"}},
      {"last_row_missing", last_row_missing, {"equality-coverage", "partition-quads", "translation", "degree-spot"}},
      {"one_more", one_more, {"octants", "small-world-octants", "partition-fan"}},
      {"depth_ulp", depth_ulp, {"equality-depth", "depth-is-position", "depth-clip", "interpolation-routes"}},
      {"attribute_ulp", attribute_ulp, {"equality-attributes", "attribute-range", "interpolation-routes"}},
      {"later_wins", later_wins, {"equality-scene", "several-draws", "identifiers"}},
      {"nan_as_zero", nan_as_zero, {"equality-coverage"}},
      {"behind_covers", behind_covers, {"negation", "octants", "degree-tangle", "small-world-octants"}},
      {"w_not_positive_dropped",
       w_not_positive_dropped,
       {"octants", "partition-all-around", "degree-hull", "degree-tangle", "degree-spot", "small-world-homogeneous"}},
      {"small_dropped", small_dropped, {"equality-coverage", "partition-delaunay", "degree-spot"}},
      {"divided", divided, {"partition-all-around", "degree-hull", "equality-attributes"}},
      {"snapped", snapped, {"equality-coverage", "partition-all-around"}},
      {"pixel_corner", pixel_corner, {"equality-coverage", "depth-is-position", "mirror"}},
      {"scissor_one_wider", scissor_one_wider, {"scissor", "equality-scene"}},
      {"culling_ignored", culling_ignored, {"front-and-back", "degree-hull", "equality-scene"}},
      {"front_face_ignored", front_face_ignored, {"order", "equality-scene"}},
      {"clip_as_clamp", clip_as_clamp, {"depth-clip", "equality-depth"}},
      {"affine", affine, {"interpolation-routes", "equality-attributes"}},
      {"weights_exchanged", weights_exchanged, {"interpolation-routes", "equality-attributes", "order"}},
      {"identifiers_ignored", identifiers_ignored, {"identifiers", "equality-scene"}},
      {"last_draw_only", last_draw_only, {"several-draws", "equality-scene", "partition-adjacent"}},
      {"size_dependent", size_dependent, {"translation", "equality-coverage"}},
      {"far_columns_missing", far_columns_missing, {"equality-wide"}},
      {"box_culls", box_culls, {"culling-box"}},
      {"depth_write_ignored", depth_write_ignored, {"equality-scene"}},
      {"float_edges",
       float_edges,
       {"equality-coverage", "partition-delaunay", "partition-adjacent", "partition-all-around", "octants",
        "degree-hull", "order"}},
      {"determinant_epsilon", determinant_epsilon, {"scale", "equality-coverage", "partition-fan"}},
      {"out_of_memory", out_of_memory, {"equality-coverage", "partition-fan", "octants", "scissor"}},
  };
  return all;
}

const Property* named(std::string_view name) {
  for (const Property& property : all_properties())
    if (name == property.name) return &property;
  return nullptr;
}

// The first of the property's cases that the renderer fails, if one of the first few thousand is.
std::optional<std::uint64_t> first_failure(const Property& property, const Renderer& renderer, std::uint64_t cases) {
  const std::uint64_t step = property.exhaustive > cases ? property.exhaustive / cases : 1;
  for (std::uint64_t n = 0; n < cases; ++n) {
    const Verdict verdict = property.decide(property.make(n * step), renderer);
    if (verdict.differences == 0) continue;
    EXPECT_FALSE(verdict.finding.empty()) << property.name;
    return n * step;
  }
  return std::nullopt;
}

std::uint64_t affordable(const Property& property, std::uint64_t cases) {
  return std::string_view(property.name) == "degree-spot" ? cases / 40 : cases;
}

class FaultIsRejected : public testing::TestWithParam<Fault> {};

TEST_P(FaultIsRejected, ByThePropertiesThatNameIt) {
  for (const char* name : GetParam().rejected_by) {
    const Property* property = named(name);
    ASSERT_NE(property, nullptr) << name;
    EXPECT_TRUE(first_failure(*property, GetParam().renderer, affordable(*property, 8000))) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, FaultIsRejected, testing::ValuesIn(faults()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(Faults, EveryPropertyRejectsOne) {
  std::set<std::string_view> rejecting;
  for (const Fault& fault : faults()) rejecting.insert(fault.rejected_by.begin(), fault.rejected_by.end());
  for (const Property& property : all_properties()) EXPECT_TRUE(rejecting.contains(property.name)) << property.name;
}

TEST(Faults, AFindingReducesToOneTriangle) {
  const Property& property = *named("equality-coverage");
  const std::optional<std::uint64_t> n = first_failure(property, nan_as_zero, 2000);
  ASSERT_TRUE(n);
  const corpus::Scene reduced = reduce(property.make(*n), [&](const corpus::Scene& scene) {
    return property.decide(scene, nan_as_zero).differences != 0;
  });
  ASSERT_EQ(reduced.draws.size(), 1u);
  EXPECT_EQ(reduced.draws[0].triangles.size(), 1u) << corpus::write_scene(reduced);
}

class RightRenderers : public testing::TestWithParam<const Property*> {};

TEST_P(RightRenderers, Pass) {
  const Property& property = *GetParam();
  for (const Renderer& right : {oracle_renderer(), clipped_oracle_renderer()}) {
    const auto n = first_failure(property, right, affordable(property, 400));
    EXPECT_FALSE(n) << "case " << *n << ": " << property.decide(property.make(*n), right).finding << "\n"
                    << corpus::write_scene(property.make(*n));
  }
}

std::vector<const Property*> pointers_to_all() {
  std::vector<const Property*> all;
  for (const Property& property : all_properties()) all.push_back(&property);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Properties, RightRenderers, testing::ValuesIn(pointers_to_all()), [](const auto& tested) {
  std::string name = tested.param->name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace surefill::properties
