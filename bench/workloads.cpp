// SPDX-License-Identifier: Apache-2.0
#include "bench/workloads.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "corpus/mesh.hpp"

namespace surefill::bench {
namespace {

// SplitMix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53); }
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

double place(double position, Placement placement) {
  switch (placement) {
    case Placement::free:
      return position;
    case Placement::snapped:
      return std::floor(position * 256 + 0.5) / 256;
    case Placement::aligned:
      return std::floor(position) + 0.5;
  }
  return position;
}

Vertex vertex(double x, double y, double z, double w, Placement placement) {
  if (placement != Placement::free) w = 1;
  return {static_cast<float>(place(x, placement) * w), static_cast<float>(place(y, placement) * w),
          static_cast<float>(z * w), static_cast<float>(w)};
}

// Three points in a disc of radius r have a mean area of 35 / (48 pi) r^2.
Workload random_triangles(std::size_t triangles, double area, Placement placement) {
  Random random(1);
  Workload workload;
  const double radius = std::sqrt(area * 48 * std::numbers::pi / 35);
  for (std::size_t i = 0; i < triangles; ++i) {
    const double cx = random.uniform(0, kWidth), cy = random.uniform(0, kHeight);
    for (int k = 0; k < 3; ++k) {
      const double r = radius * std::sqrt(random.uniform(0, 1)), angle = random.uniform(0, 2 * std::numbers::pi);
      workload.vertices.push_back(vertex(cx + r * std::cos(angle), cy + r * std::sin(angle), random.uniform(0, 1),
                                         random.uniform(1, 10), placement));
      workload.indices.push_back(static_cast<std::uint32_t>(3 * i) + static_cast<std::uint32_t>(k));
    }
  }
  return workload;
}

Workload height_field(std::uint32_t side, Placement placement) {
  Random random(2);
  Workload workload;
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const double u = x, v = y, last = side - 1;
      const double jitter = x != 0 && y != 0 && x + 1 < side && y + 1 < side ? 0.3 : 0;
      const double w = 1 + 0.5 * std::sin(u * 0.01) * std::cos(v * 0.013);
      workload.vertices.push_back(vertex(u / last * kWidth + random.uniform(-jitter, jitter),
                                         v / last * kHeight + random.uniform(-jitter, jitter),
                                         0.5 + 0.3 * std::sin(u * 0.02) * std::sin(v * 0.02), w, placement));
    }
  }
  for (std::uint32_t y = 0; y + 1 < side; ++y) {
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const std::uint32_t a = y * side + x, b = a + 1, c = a + side, d = c + 1;
      workload.indices.insert(workload.indices.end(), {a, b, c, b, d, c});
    }
  }
  return workload;
}

Workload slivers(std::size_t triangles, Placement placement) {
  Random random(3);
  Workload workload;
  for (std::size_t i = 0; i < triangles; ++i) {
    const double cx = random.uniform(0, kWidth), cy = random.uniform(0, kHeight);
    const double angle = random.uniform(0, 2 * std::numbers::pi), dx = std::cos(angle), dy = std::sin(angle);
    const double corners[3][2] = {{cx - 500 * dx, cy - 500 * dy},
                                  {cx + 500 * dx, cy + 500 * dy},
                                  {cx + 500 * dx - 2 * dy, cy + 500 * dy + 2 * dx}};
    for (std::uint32_t k = 0; k < 3; ++k) {
      workload.vertices.push_back(
          vertex(corners[k][0], corners[k][1], random.uniform(0, 1), random.uniform(1, 10), placement));
      workload.indices.push_back(static_cast<std::uint32_t>(3 * i) + k);
    }
  }
  return workload;
}

Workload behind_the_eye(std::size_t triangles, Placement placement) {
  Random random(4);
  Workload workload;
  for (std::size_t i = 0; i < triangles; ++i) {
    const int behind = 1 + static_cast<int>(random.next() & 1);
    const double cx = random.uniform(-500, kWidth + 500), cy = random.uniform(-500, kHeight + 500);
    for (int k = 0; k < 3; ++k) {
      const float w = static_cast<float>(k < behind ? -random.uniform(0.01, 3) : random.uniform(0.2, 3));
      Vertex v =
          vertex(cx + random.uniform(-300, 300), cy + random.uniform(-300, 300), random.uniform(0, 1), 1, placement);
      v.w = placement == Placement::free ? w : std::copysign(1.0f, w);
      workload.vertices.push_back(v);
      workload.indices.push_back(static_cast<std::uint32_t>(3 * i) + static_cast<std::uint32_t>(k));
    }
  }
  return workload;
}

}  // namespace

Workload make_workload(int number, Placement placement) {
  Workload workload;
  switch (number) {
    case 1:
      workload = random_triangles(1000000, 10, placement);
      break;
    case 2:
      workload = random_triangles(200000, 200, placement);
      break;
    case 3:
      workload = random_triangles(2000, 100000, placement);
      break;
    case 4:
      workload = height_field(1000, placement);
      break;
    case 5:
      workload = slivers(100000, placement);
      break;
    default:
      workload = behind_the_eye(20000, placement);
      break;
  }
  workload.name = "W" + std::to_string(number);
  if (placement == Placement::snapped) workload.name += " snapped";
  if (placement == Placement::aligned) workload.name += " aligned";
  return workload;
}

Workload make_small_triangles(std::size_t triangles) {
  Workload workload = random_triangles(triangles, 10, Placement::free);
  workload.name = "10 px x " + std::to_string(triangles);
  return workload;
}

Workload make_lines(std::size_t lines) {
  Random random(1);
  Workload workload;
  workload.primitive = Primitive::lines;
  for (std::size_t i = 0; i < lines; ++i) {
    const double x = random.uniform(0, kWidth), y = random.uniform(0, kHeight);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    for (const double length : {0.0, 100.0}) {
      workload.indices.push_back(static_cast<std::uint32_t>(workload.vertices.size()));
      workload.vertices.push_back(vertex(x + length * std::cos(angle), y + length * std::sin(angle),
                                         random.uniform(0, 1), random.uniform(1, 10), Placement::free));
    }
  }
  return workload;
}

Workload make_points(std::size_t points) {
  Random random(1);
  Workload workload;
  workload.primitive = Primitive::points;
  for (std::size_t i = 0; i < points; ++i) {
    workload.indices.push_back(static_cast<std::uint32_t>(i));
    workload.vertices.push_back(vertex(random.uniform(0, kWidth), random.uniform(0, kHeight), random.uniform(0, 1),
                                       random.uniform(1, 10), Placement::free));
  }
  return workload;
}

Workload make_knot(std::size_t triangles) {
  const auto around = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 20));
  const auto along = static_cast<std::uint32_t>(triangles / 2 / around);
  Workload workload;
  const auto centre = [](double t) {  // a trefoil
    return std::array{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
  };
  for (std::uint32_t i = 0; i < along; ++i) {
    const double t = 2 * std::numbers::pi * i / along;
    const auto c = centre(t), next = centre(t + 1e-3);
    const double dx = next[0] - c[0], dy = next[1] - c[1], length = std::hypot(dx, dy);
    for (std::uint32_t k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around, r = 0.6;
      const double side = r * std::cos(angle), depth = c[2] + r * std::sin(angle), w = 6 + depth;
      const double x = c[0] - dy / length * side, y = c[1] + dx / length * side;
      workload.vertices.push_back(vertex(kWidth / 2 + x / w * kHeight * 0.9, kHeight / 2 + y / w * kHeight * 0.9,
                                         (depth + 2) / 4, w, Placement::free));
    }
  }
  for (std::uint32_t i = 0; i < along; ++i) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t j = (i + 1) % along, n = (k + 1) % around;
      const std::uint32_t a = i * around + k, b = i * around + n, c = j * around + k, d = j * around + n;
      workload.indices.insert(workload.indices.end(), {a, b, c, b, d, c});
    }
  }
  return workload;
}

Workload make_spot(int height) {
  static const meshes::Mesh mesh = meshes::load_obj(SUREFILL_MESHES "/spot.obj");
  const int width = height * kWidth / kHeight;
  const corpus::Frame frame(meshes::mesh_scene(mesh, meshes::framing_camera(mesh, width, height), width, height));
  const Draw& draw = frame.draws()[0];
  Workload workload;
  workload.vertices.assign(draw.vertices.begin(), draw.vertices.end());
  workload.indices.assign(draw.indices.begin(), draw.indices.end());
  return workload;
}

}  // namespace surefill::bench
