// SPDX-License-Identifier: Apache-2.0
//
// PortableGL (github.com/rswinkle/PortableGL, 911292f, MIT) under test: OpenGL 3 in one header.
//     c++ -std=c++17 -O2 -w -shared -fPIC -I. -IPORTABLEGL -o portable_gl.so examples/rivals/outside/portable_gl.cpp
#define PORTABLEGL_IMPLEMENTATION
#include <portablegl.h>

#include "examples/rivals/outside/plugin.hpp"

namespace {

void vertex_shader(float*, vec4* attributes, Shader_Builtins* builtins, void*) {
  builtins->gl_Position = attributes[0];
}
void fragment_shader(float*, Shader_Builtins* builtins, void*) {
  builtins->gl_FragColor = {1, 1, 1, 1};
}

void draw_alone(const outside::Corner corners[3], int width, int height, std::uint32_t* count) {
  glContext context;
  pix_t* pixels = nullptr;
  if (!init_glContext(&context, &pixels, width, height)) return;
  set_glContext(&context);
  float positions[12];
  for (int i = 0; i < 3; ++i) {
    positions[4 * i] = static_cast<float>(2 * corners[i].x / width - 1);
    positions[4 * i + 1] = static_cast<float>(1 - 2 * corners[i].y / height);
    positions[4 * i + 2] = 0;
    positions[4 * i + 3] = 1;
  }
  GLuint array, buffer;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, sizeof positions, positions, GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glUseProgram(pglCreateProgram(vertex_shader, fragment_shader, 0, nullptr, GL_FALSE));
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  for (int i = 0; i < width * height; ++i) count[i] += pixels[i] != 0;  // row 0 is the top one
  free_glContext(&context);
}

}  // namespace

SUREFILL_PLUGIN("PortableGL", "911292f", draw_alone, true)
