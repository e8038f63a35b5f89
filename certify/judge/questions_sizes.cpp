// SPDX-License-Identifier: Apache-2.0
//
// Questions about sizes: of draws, in vertices, and of targets.
#include <algorithm>
#include <array>

#include "certify/judge/questions.hpp"
#include "certify/judge/text.hpp"

namespace surefill::judge {

namespace {

using corpus::Scene;

}  // namespace

// A triangle whose vertices are not the first ones.
std::string about_indices(const Questions& questions) {
  Scene scene = empty_scene(16, 16);
  const auto at = [](double x, double y) { return corner(x, y); };
  scene.draws[0].vertices = {at(9.125, 9.25), at(14.5, 9.75), at(9.5, 14.625),
                             at(1.125, 1.25), at(6.5, 2.125), at(2.25, 6.625)};
  scene.draws[0].triangles = {{{3, 4, 5}, std::nullopt}, {{5, 3, 4}, std::nullopt}};
  const auto image = questions.rival(scene);
  constexpr std::size_t kIndexed = 3 * 16 + 3, kFirst = 10 * 16 + 10;
  if (!image || image->count.empty()) return "";
  if (image->count[kIndexed] == 1 && image->count[kFirst] == 1)
    return "indices are not read: vertices are taken three by three in the order in which they come";
  return "";
}

// A draw of so many vertices.
std::string about_vertices(const Questions& questions) {
  for (const int bits : {0, 8, 10, 12, 15, 16}) {
    const int before = bits == 0 ? 0 : (1 << bits) + 50;
    Scene scene = empty_scene(16, 16);
    scene.draws[0].vertices.assign(static_cast<std::size_t>(before), corner(-8, -8));
    add_triangle(scene.draws[0], {corner(1.125, 1.25), corner(14.5, 2.125), corner(2.25, 14.625)},
                 questions.model.culled);
    const auto shown = answer(questions, scene);
    if (!shown || shown->right.count == shown->rival.count) continue;
    if (bits == 0) return "";
    return text("vertex numbers beyond %d are taken for others: they have %d bits", (1 << bits) - 1, bits);
  }
  return "";
}

namespace {

// --- sizes

// Some triangles side by side all along a target of this length, and in its last columns.
Scene strip(int length, bool upright, Cull culled) {
  Scene scene = upright ? empty_scene(6, length) : empty_scene(length, 6);
  const auto add = [&](double at, double size) {
    const auto place = [&](double along, double across) {
      return upright ? corner(across, at + along * size) : corner(at + along * size, across);
    };
    add_triangle(scene.draws[0], {place(0, 0.25), place(1, 0.25), place(0, 5.625)}, culled);
  };
  for (int at = 0; at + 8 <= length; at += 8) add(at, 8);
  // The other way round: it ends with the target.
  add(length, -std::min(length, 8));
  return scene;
}

}  // namespace

std::string about_sizes(const Questions& questions) {
  for (const bool upright : {false, true}) {
    std::vector<int> wrong, right;
    int first = 1 << 20;  // of the wrong ones, along the target
    bool lacks = true, exact = true, last = true;
    std::vector<std::array<int, 2>> begins;  // of the wrong ones: length, where it begins
    const auto note = [&](const Wrong& shown, int length) {
      int begin = length;
      for (std::size_t s = 0; s < shown.right.count.size(); ++s) {
        if (shown.right.count[s] == shown.rival.count[s]) continue;
        lacks = lacks && shown.rival.count[s] < shown.right.count[s];
        begin = std::min(begin, static_cast<int>(upright ? s / 6 : s % static_cast<std::size_t>(length)));
      }
      exact = exact && (first == 1 << 20 || begin == first);
      last = last && begin == length - 1;
      begins.push_back({length, begin});
      first = std::min(first, begin);
    };
    for (const int length :
         {3,   5,   6,   7,   8,   9,    10,   12,   14,   18,   22,   34,   66,   130,  15,   16,   17,   20,   24,
          31,  32,  33,  40,  48,  63,   64,   65,   96,   100,  127,  128,  129,  160,  200,  255,  256,  257,  300,
          511, 512, 513, 640, 800, 1000, 1024, 1025, 1280, 2047, 2048, 2049, 3000, 4096, 4097, 8192, 8200, 16384}) {
      const auto shown = answer(questions, strip(length, upright, questions.model.culled));
      if (!shown) continue;
      const bool bad = shown->right.count != shown->rival.count;
      (bad ? wrong : right).push_back(length);
      if (bad) note(*shown, length);
    }
    if (wrong.empty() || right.size() < 3) continue;
    const char *side = upright ? "high" : "wide", *lines = upright ? "row" : "column";
    const auto all = [](const std::vector<int>& of, const auto& is) { return std::all_of(of.begin(), of.end(), is); };
    if (lacks) {
      for (const int m : {2, 4, 8, 16, 32, 64}) {
        const auto odd = [m](int n) { return n % m != 0; };
        const bool rest = std::ranges::all_of(begins, [m](const auto& b) { return b[1] >= b[0] / m * m; });
        if (m > 2 && rest && all(wrong, odd) && std::none_of(right.begin(), right.end(), odd)) {
          return "on targets whose " + std::string(upright ? "height" : "width") + " is no multiple of " +
                 std::to_string(m) + " the last " + lines + "s, beyond the last whole group of " + std::to_string(m) +
                 ", are not drawn";
        }
      }
    }
    if (last && lacks) {
      for (const int m : {2, 4, 8, 16, 32, 64}) {
        const auto odd = [m](int n) { return n % m != 0; };
        if (all(wrong, odd) && std::none_of(right.begin(), right.end(), odd)) {
          return "the last " + std::string(lines) + " is not drawn of targets whose " + (upright ? "height" : "width") +
                 " is no multiple of " + std::to_string(m);
        }
      }
    }
    if (*std::max_element(right.begin(), right.end()) < *std::min_element(wrong.begin(), wrong.end())) {
      const std::string from = std::to_string(*std::max_element(right.begin(), right.end()));
      if (exact && lacks && first >= 8) {
        return "nothing is drawn beyond the first " + std::to_string(first) + " " + lines + "s of a target";
      }
      return "targets more than " + from + " pixels " + side + " are wrong" + (lacks ? ": samples are not drawn" : "");
    }
    if (*std::max_element(wrong.begin(), wrong.end()) < *std::min_element(right.begin(), right.end())) {
      return "targets under " + std::to_string(*std::min_element(right.begin(), right.end())) + " pixels " + side +
             " are wrong" + (lacks ? ": samples are not drawn" : "");
    }
    for (const int m : {2, 4, 8, 16, 32, 64}) {
      const auto odd = [m](int n) { return n % m != 0; };
      if (all(wrong, odd) && std::none_of(right.begin(), right.end(), odd)) {
        return std::string("targets whose ") + (upright ? "height" : "width") + " is no multiple of " +
               std::to_string(m) + " are wrong";
      }
    }
  }
  return "";
}

}  // namespace surefill::judge
