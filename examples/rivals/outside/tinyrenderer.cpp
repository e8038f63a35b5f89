// SPDX-License-Identifier: Apache-2.0
//
// tinyrenderer (github.com/ssloy/tinyrenderer, 87bc715, zlib licence) under test: its function `rasterize`. It draws
// counter-clockwise triangles alone (y is up there).
//     c++ -std=c++20 -O2 -w -shared -fPIC -I. -ITINYRENDERER -o tinyrenderer.so examples/rivals/outside/tinyrenderer.cpp
//         TINYRENDERER/our_gl.cpp TINYRENDERER/tgaimage.cpp
#include <our_gl.h>

#include "examples/rivals/outside/plugin.hpp"

namespace {

struct White : IShader {
  std::pair<bool, TGAColor> fragment(const vec3) const override { return {false, {255, 255, 255, 255}}; }
};

void draw_alone(const outside::Corner corners[3], int width, int height, std::uint32_t* count) {
  init_viewport(0, 0, width, height);
  init_zbuffer(width, height);
  TGAImage image(width, height, TGAImage::RGB);
  Triangle clip;
  for (int i = 0; i < 3; ++i) clip[i] = {2 * corners[i].x / width - 1, 1 - 2 * corners[i].y / height, 0.5, 1};
  rasterize(clip, White{}, image);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) count[y * width + x] += image.get(x, height - 1 - y)[0] != 0;
}

}  // namespace

SUREFILL_PLUGIN("tinyrenderer", "87bc715", draw_alone, true)
