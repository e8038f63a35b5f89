// SPDX-License-Identifier: Apache-2.0
//
// RenderHelp (github.com/skywind3000/RenderHelp, 4e71027, MIT) under test. It drops triangles with a vertex beside the screen, as
// its comments say; those are declined.
//     c++ -std=c++17 -O2 -w -shared -fPIC -I. -IRENDERHELP -o render_help.so examples/rivals/outside/render_help.cpp
#include <RenderHelp.h>

#include "examples/rivals/outside/plugin.hpp"

namespace {

class Renderer : public RenderHelp {
 public:
  using RenderHelp::RenderHelp;
  bool is_drawn(int x, int y) const { return _frame_buffer->GetPixel(x, y) != _color_bg; }
};

void draw_alone(const outside::Corner corners[3], int width, int height, std::uint32_t* count) {
  Renderer renderer(width, height);
  renderer.SetVertexShader([&](int i, ShaderContext&) {
    return Vec4f{static_cast<float>(2 * corners[i].x / width - 1), static_cast<float>(1 - 2 * corners[i].y / height),
                 0.5f, 1.0f};
  });
  renderer.SetPixelShader([](ShaderContext&) { return Vec4f{1, 1, 1, 1}; });
  renderer.DrawPrimitive();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) count[y * width + x] += renderer.is_drawn(x, y);
}

}  // namespace

SUREFILL_PLUGIN("RenderHelp", "4e71027", draw_alone, false)
