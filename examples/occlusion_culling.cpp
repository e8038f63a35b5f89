// SPDX-License-Identifier: Apache-2.0
//
// Occlusion culling with a small buffer that never lies: the houses of a city are drawn into 240 x 135 pixels, every crate and
// every house is asked for, and the picture has 3840 x 2160. Then the proof: with everything drawn, nothing that was hidden
// owns one pixel of it. And the trap: a house is an occluder, too, and its own face may hide it; above all in a buffer of one
// image, where a house whose face is parallel to the screen has no pixel that is farther.
//
//     occlusion_culling [PICTURE.ppm]    the picture's quarter: crates are orange; below it the small buffer, where it hides
#include <algorithm>
#include <cstdio>
#include <vector>

#include "surefill/occlusion.hpp"

namespace {

constexpr int kWidth = 3840, kHeight = 2160, kSmaller = 16;  // a power of two: so both show exactly the same view [T7]

struct Point {
  float x, y, z;
};

struct Box {
  Point low, high;
};

// A camera 9 m above a street that looks along +z; depth is reversed, near / distance, so larger is nearer.
surefill::ClipVertex in_clip_space(const Point& p) {
  const float z = p.z - 5;
  return {(p.x - 42) * 0.97f, (p.y - 9) * 1.73f, 0.25f, z};
}

// Vertices in pixels of a target of this size.
std::vector<surefill::Vertex> project(const std::vector<Point>& points, int width, int height) {
  std::vector<surefill::ClipVertex> clip;
  for (const Point& p : points) clip.push_back(in_clip_space(p));
  surefill::Viewport viewport;
  viewport.width = static_cast<float>(width), viewport.height = static_cast<float>(height);
  std::vector<surefill::Vertex> vertices(points.size());
  surefill::to_pixel(viewport, clip, vertices);  // it refuses only what is not finite
  return vertices;
}

// Boxes as a mesh: eight points and twelve triangles each.
struct Mesh {
  std::vector<Point> points;
  std::vector<std::uint32_t> indices;

  explicit Mesh(const std::vector<Box>& boxes) {
    constexpr std::uint32_t kFaces[36] = {0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7, 0, 2, 4, 2, 6, 4,
                                          1, 5, 3, 3, 5, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6};
    for (const Box& b : boxes) {
      for (const std::uint32_t i : kFaces) indices.push_back(static_cast<std::uint32_t>(points.size()) + i);
      for (unsigned i = 0; i < 8; ++i) {
        points.push_back(
            {(i & 1) != 0 ? b.high.x : b.low.x, (i & 2) != 0 ? b.high.y : b.low.y, (i & 4) != 0 ? b.high.z : b.low.z});
      }
    }
  }
};

// Streets 12 m wide between blocks of four houses, crates in all of them.
void build_city(std::vector<Box>& houses, std::vector<Box>& crates) {
  std::uint32_t state = 7;
  const auto next = [&](int range) {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(static_cast<int>(state >> 16) % range);
  };
  for (int j = 0; j < 12; ++j) {
    for (int i = 0; i < 12; ++i) {
      const float x = static_cast<float>(i * 18 + i / 2 * 12 - 48), z = static_cast<float>(j * 18 + j / 2 * 12 + 12);
      houses.push_back({{x, 0, z}, {x + 18, 6 + next(20), z + 18}});
    }
  }
  houses.push_back({{36, 0, 160}, {48, 20, 170}});  // a tower across the street, with its face to the camera
  while (crates.size() < 5000) {
    const Point p{next(680) / 2 - 60, 0, 20 + next(600) / 2};
    const Box crate{p, {p.x + 0.5f + next(3) / 2, 0.5f + next(3) / 2, p.z + 0.5f + next(3) / 2}};
    const bool free = std::none_of(houses.begin(), houses.end(), [&](const Box& h) {
      return crate.low.x < h.high.x && crate.high.x > h.low.x && crate.low.z < h.high.z && crate.high.z > h.low.z;
    });
    if (free) crates.push_back(crate);
  }
}

// One answer for each box.
template <typename Buffer>
surefill::Status ask(const Buffer& buffer, const std::vector<Box>& boxes, std::vector<surefill::Occlusion>& answers) {
  const Mesh mesh(boxes);
  const std::vector<surefill::Vertex> corners = project(mesh.points, buffer.width(), buffer.height());
  std::vector<surefill::OcclusionBox> asked(boxes.size());
  for (std::size_t i = 0; i < corners.size(); ++i) asked[i / 8].corners[i % 8] = corners[i];
  answers.resize(boxes.size());
  return buffer.query(asked, answers);
}

std::size_t hidden_of(const std::vector<surefill::Occlusion>& answers) {
  return static_cast<std::size_t>(std::count(answers.begin(), answers.end(), surefill::Occlusion::hidden));
}

// The state in which houses are drawn, to the small buffer and to the picture alike.
surefill::DrawState house_state() {
  surefill::DrawState state;
  state.front_face = surefill::FrontFace::counter_clockwise, state.cull = surefill::Cull::back;
  state.depth_mode = surefill::DepthMode::clip;
  return state;
}

// Every fourth pixel each way, and the small buffer as large.
bool write_picture(const char* path, const std::vector<std::uint32_t>& index, const std::vector<float>& depth,
                   const surefill::SafeOcclusionBuffer& buffer, std::size_t house_triangles) {
  std::FILE* const file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  std::fprintf(file, "P6\n%d %d\n255\n", kWidth / 4, kHeight / 2);
  const auto put = [&](double r, double g, double b) {
    for (const double c : {r, g, b}) std::fputc(static_cast<int>(std::clamp(c, 0.0, 255.0)), file);
  };
  const auto shade = [](float z) { return 40 + 200 * std::min(1.0, 8.0 * static_cast<double>(z)); };
  for (std::size_t y = 0; y < kHeight; y += 4) {
    for (std::size_t x = 0; x < kWidth; x += 4) {
      const std::size_t i = y * kWidth + x;
      if (index[i] == surefill::kNoTriangle) {
        put(200, 225, 255);
      } else if (index[i] >= house_triangles) {
        put(255, 140, 0);
      } else {
        const double light = shade(depth[i]) * (0.7 + 0.15 * static_cast<double>(index[i] % 12 / 4));
        put(light, light, light);
      }
    }
  }
  for (std::size_t y = 0; y < kHeight; y += 4) {
    for (std::size_t x = 0; x < kWidth; x += 4) {
      const float z = buffer.depth()[y / kSmaller * (kWidth / kSmaller) + x / kSmaller];
      if (z < 0) {
        put(120, 0, 0);  // -infinity: hides nothing
      } else {
        put(shade(z), shade(z), shade(z));
      }
    }
  }
  return std::fclose(file) == 0;
}

int fail(surefill::Status status) {
  std::fprintf(stderr, "occlusion_culling: %s\n", surefill::status_text(status));
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Box> houses, crates;
  build_city(houses, crates);
  const Mesh house_mesh(houses);

  // Once: the mesh. Positions lie in an array of floats, as they do in a Point.
  surefill::OccluderMesh prepared;
  if (const auto status = prepared.prepare({&house_mesh.points[0].x, 3 * house_mesh.points.size()}, house_mesh.indices);
      status != surefill::Status::ok) {
    return fail(status);
  }

  // Each frame: the occluders, and then what is asked.
  surefill::SafeOcclusionBuffer buffer;
  if (const auto status = buffer.resize(kWidth / kSmaller, kHeight / kSmaller, surefill::DepthTest::greater);
      status != surefill::Status::ok) {
    return fail(status);
  }
  const std::vector<surefill::Vertex> small = project(house_mesh.points, buffer.width(), buffer.height());
  surefill::Occluder occluder;
  occluder.state() = house_state();
  occluder.mesh = &prepared, occluder.vertices = small;
  if (const auto status = buffer.draw({&occluder, 1}); status != surefill::Status::ok) return fail(status);

  std::vector<surefill::Occlusion> of_crates, of_houses;
  buffer.equal_is_visible(true);  // houses hide and are asked for
  if (const auto status = ask(buffer, houses, of_houses); status != surefill::Status::ok) return fail(status);
  if (const auto status = ask(buffer, crates, of_crates); status != surefill::Status::ok) return fail(status);

  // The proof: everything in one picture, houses first. Triangle 12 i belongs to box i.
  const Mesh crate_mesh(crates);
  const std::vector<surefill::Vertex> house_vertices = project(house_mesh.points, kWidth, kHeight);
  const std::vector<surefill::Vertex> crate_vertices = project(crate_mesh.points, kWidth, kHeight);
  surefill::Draw draws[2];
  draws[0].state() = draws[1].state() = house_state();
  draws[0].vertices = house_vertices, draws[0].indices = house_mesh.indices;
  draws[1].vertices = crate_vertices, draws[1].indices = crate_mesh.indices;
  draws[1].first_index = static_cast<std::uint32_t>(12 * houses.size());
  std::vector<std::uint32_t> index(std::size_t{kWidth} * kHeight);
  std::vector<float> depth(index.size());
  surefill::Target target;
  target.width = kWidth, target.height = kHeight, target.index = index, target.depth = depth;
  target.depth_test = surefill::DepthTest::greater;
  if (const auto status = surefill::render(target, draws); status != surefill::Status::ok) return fail(status);

  // The trap, in a buffer of the picture itself that is used without care.
  surefill::OcclusionBuffer careless;
  std::vector<surefill::Occlusion> of_houses_careless;
  auto status = careless.resize(kWidth, kHeight, surefill::DepthTest::greater);
  if (status == surefill::Status::ok) status = careless.draw({draws, 1});
  if (status == surefill::Status::ok) status = ask(careless, houses, of_houses_careless);
  if (status != surefill::Status::ok) return fail(status);

  std::vector<std::size_t> pixels(houses.size() + crates.size());
  for (const std::uint32_t triangle : index) {
    if (triangle != surefill::kNoTriangle) ++pixels[triangle / 12];
  }
  std::size_t lost = 0, lost_houses = 0, seen = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const bool house = i < houses.size();
    const surefill::Occlusion answer = house ? of_houses[i] : of_crates[i - houses.size()];
    if (answer != surefill::Occlusion::visible) lost += pixels[i];
    if (house && of_houses_careless[i] != surefill::Occlusion::visible) lost_houses += pixels[i] != 0;
    seen += !house && pixels[i] != 0;
  }
  std::printf("%zu crates: a buffer of %d x %d hides %zu; %zu own a pixel of %d x %d\n", crates.size(), buffer.width(),
              buffer.height(), hidden_of(of_crates), seen, kWidth, kHeight);
  std::printf("%zu houses: it hides %zu\n", houses.size(), hidden_of(of_houses));
  std::printf("pixels of what was called hidden or outside: %zu\n", lost);
  std::printf("houses in view that hide themselves where equal depth hides: %zu\n", lost_houses);
  if (argc > 1 && !write_picture(argv[1], index, depth, buffer, 12 * houses.size())) {
    std::fprintf(stderr, "occlusion_culling: %s cannot be written\n", argv[1]);
    return 1;
  }
  return lost == 0 ? 0 : 1;
}
