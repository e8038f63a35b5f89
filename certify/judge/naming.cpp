// SPDX-License-Identifier: Apache-2.0
#include "certify/judge/naming.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace surefill::judge {

namespace {

using corpus::Image;

// The outputs of one sample, equal or not; what an image lacks is equal.
bool same_sample(const Image& a, const Image& b, std::size_t s, double within) {
  const auto same = [s](const auto& x, const auto& y) { return x.empty() || y.empty() || x[s] == y[s]; };
  const auto same_floats = [&](const std::vector<float>& x, const std::vector<float>& y, std::size_t n) {
    for (std::size_t i = n * s; i < n * (s + 1) && !x.empty() && !y.empty(); ++i) {
      if (!alike_within(x[i], y[i], within)) return false;
    }
    return true;
  };
  if (!same(a.count, b.count)) return false;
  if (!same(a.index, b.index) || !same_floats(a.depth, b.depth, 1) || !same_floats(a.barycentrics, b.barycentrics, 3)) {
    return false;
  }
  const std::size_t total = a.count.size();
  for (std::size_t k = 0; k < std::min(a.attributes.size(), b.attributes.size()); ++k) {
    if (!same_floats(a.attributes[k], b.attributes[k], total == 0 ? 1 : a.attributes[k].size() / total)) return false;
  }
  return true;
}

}  // namespace

bool alike_within(float a, float b, double within) {
  const auto bits = [](float value) { return value != value ? 0x7FC00000u : std::bit_cast<std::uint32_t>(value); };
  if (bits(a) == bits(b)) return true;
  if (within == 0 || !std::isfinite(a) || !std::isfinite(b)) return false;
  return std::abs(double{a} - b) <= within * std::max({1.0, std::abs(double{a}), std::abs(double{b})});
}

std::vector<Name> name_fault(std::span<const Fault> faults, std::span<const Wrong> wrong, double within, double least) {
  std::vector<Name> names;
  for (const Fault& fault : faults) {
    // Each scene has one vote, so that a large one does not outvote the others.
    double sum = 0;
    Name name{&fault, 0, 0};
    std::size_t scenes = 0;
    for (const Wrong& shown : wrong) {
      corpus::Outputs outputs{!shown.rival.count.empty(), !shown.rival.index.empty(), !shown.rival.depth.empty(),
                              !shown.rival.barycentrics.empty(), !shown.rival.attributes.empty()};
      corpus::Frame frame(shown.scene, outputs);
      if (fault.render(frame.target(), frame.draws()) != Status::ok) continue;
      std::uint64_t either = 0, alike = 0;
      const std::size_t total = shown.rival.count.size();
      for (std::size_t s = 0; s < total; ++s) {
        if (!shown.open.empty() && shown.open[s]) continue;
        const bool rival = !same_sample(shown.rival, shown.right, s, within);
        const bool theirs = !same_sample(frame.image(), shown.right, s, within);
        if (!rival && !theirs) continue;
        ++either;
        if (same_sample(frame.image(), shown.rival, s, within)) ++alike;
      }
      if (either == 0) continue;
      sum += static_cast<double>(alike) / static_cast<double>(either);
      name.samples += alike;
      ++scenes;
    }
    if (scenes == 0) continue;
    name.agreement = sum / static_cast<double>(scenes);
    if (name.agreement >= least) names.push_back(name);
  }
  std::stable_sort(names.begin(), names.end(), [](const Name& a, const Name& b) { return a.agreement > b.agreement; });
  return names;
}

void drop_refuted(std::vector<Name>& names, std::span<const corpus::Scene> fine, double within) {
  constexpr std::size_t kMost = 12;
  fine = fine.first(std::min(fine.size(), kMost));
  std::erase_if(names, [&](const Name& name) {
    std::size_t shown = 0;
    for (const corpus::Scene& scene : fine) {
      const corpus::Outputs outputs{true, true, true, true, true};
      corpus::Frame right(scene, outputs), theirs(scene, outputs);
      if (render(right.target(), right.draws()) != Status::ok) continue;
      if (name.fault->render(theirs.target(), theirs.draws()) != Status::ok) continue;
      const std::size_t total = right.image().count.size();
      for (std::size_t s = 0; s < total; ++s) {
        if (same_sample(right.image(), theirs.image(), s, within)) continue;
        ++shown;
        break;
      }
    }
    return 4 * shown > fine.size();
  });
}

}  // namespace surefill::judge
