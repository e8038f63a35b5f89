// SPDX-License-Identifier: Apache-2.0
#include "bench/city.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace surefill::bench {
namespace {

constexpr float kLot = 20;       // metres
constexpr float kNear = 0.25f;   // metres
constexpr int kLotsAStreet = 3;  // every third line of lots is a street

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

void add_house(City& city, const Bounds& b) {
  constexpr std::uint32_t kFaces[36] = {0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7, 0, 2, 4, 2, 6, 4,
                                        1, 5, 3, 3, 5, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6};
  const auto first = static_cast<std::uint32_t>(city.positions.size());
  for (unsigned i = 0; i < 8; ++i) {
    city.positions.push_back({(i & 1) != 0 ? b.high[0] : b.low[0], (i & 2) != 0 ? b.high[1] : b.low[1],
                              (i & 4) != 0 ? b.high[2] : b.low[2]});
  }
  for (const std::uint32_t i : kFaces) city.indices.push_back(first + i);
}

}  // namespace

City make_city(std::size_t triangles, std::size_t objects) {
  City city;
  std::mt19937_64 random(1);
  const std::size_t houses = triangles / 12;
  const int lots = kLotsAStreet * static_cast<int>(std::ceil(std::sqrt(static_cast<double>(houses) / 4))) + 1;
  city.extent = static_cast<float>(lots) * kLot;
  for (int j = 0; j < lots; ++j) {
    for (int i = 0; i < lots; ++i) {
      if (i % kLotsAStreet == 0 || j % kLotsAStreet == 0 || city.indices.size() / 36 >= houses) continue;
      const auto inset = [&] { return static_cast<float>(uniform(random, 0, 1) < 0.5 ? 0 : uniform(random, 0, 3)); };
      const float x = static_cast<float>(i) * kLot, z = static_cast<float>(j) * kLot;
      const auto height = static_cast<float>(uniform(random, 8, 60));
      add_house(city, {{x + inset(), 0, z + inset()}, {x + kLot - inset(), height, z + kLot - inset()}});
    }
  }
  while (city.objects.size() < objects) {
    // Along a street, or anywhere.
    double place[2] = {uniform(random, 0, city.extent), uniform(random, 0, city.extent)};
    if (uniform(random, 0, 1) < 0.8) {
      const double street = std::floor(uniform(random, 0, lots) / kLotsAStreet) * kLotsAStreet * kLot;
      place[random() & 1] = street + uniform(random, 0, kLot);
    }
    Bounds b;
    b.low = {static_cast<float>(place[0]), static_cast<float>(uniform(random, 0, 1) < 0.1 ? uniform(random, 5, 40) : 0),
             static_cast<float>(place[1])};
    for (std::size_t k = 0; k < 3; ++k) b.high[k] = b.low[k] + static_cast<float>(uniform(random, 0.5, 4));
    city.objects.push_back(b);
  }
  return city;
}

Matrix street_view(const City& city, int number) {
  std::mt19937_64 random(static_cast<std::uint64_t>(number) + 100);
  const double streets = std::floor(city.extent / (kLotsAStreet * kLot));
  const double eye[3] = {std::floor(uniform(random, 0, streets)) * kLotsAStreet * kLot + uniform(random, 4, 16), 1.7,
                         uniform(random, 0.2, 0.8) * city.extent};
  const double heading = uniform(random, 0, 2 * std::numbers::pi), pitch = uniform(random, -0.1, 0.15);
  const double ch = std::cos(heading), sh = std::sin(heading), cp = std::cos(pitch), sp = std::sin(pitch);
  const double forward[3] = {sh * cp, sp, ch * cp}, right[3] = {ch, 0, -sh};
  const double up[3] = {-sh * sp, cp, -ch * sp};
  const double focal = std::sqrt(3.0), aspect = 16.0 / 9;
  Matrix m{};
  const auto dot = [&](const double(&axis)[3]) { return axis[0] * eye[0] + axis[1] * eye[1] + axis[2] * eye[2]; };
  for (std::size_t k = 0; k < 3; ++k) {
    m[4 * k] = static_cast<float>(right[k] * focal / aspect);
    m[4 * k + 1] = static_cast<float>(up[k] * focal);
    m[4 * k + 3] = static_cast<float>(forward[k]);
  }
  m[12] = static_cast<float>(-dot(right) * focal / aspect);
  m[13] = static_cast<float>(-dot(up) * focal);
  m[14] = kNear;
  m[15] = static_cast<float>(-dot(forward));
  return m;
}

ClipVertex transformed(const Matrix& m, const Point& p) {
  return {p[0] * m[0] + p[1] * m[4] + p[2] * m[8] + m[12], p[0] * m[1] + p[1] * m[5] + p[2] * m[9] + m[13],
          p[0] * m[2] + p[1] * m[6] + p[2] * m[10] + m[14], p[0] * m[3] + p[1] * m[7] + p[2] * m[11] + m[15]};
}

}  // namespace surefill::bench
