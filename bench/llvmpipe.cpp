// SPDX-License-Identifier: Apache-2.0
#include "bench/llvmpipe.hpp"

#if defined(SUREFILL_BENCH_LLVMPIPE)

#define EGL_EGLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <cstdlib>
#include <vector>

namespace surefill::bench {
namespace {

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  return shader;
}

GLuint link(const char* vertex, const char* fragment) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, vertex));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment));
  glLinkProgram(program);
  return program;
}

class OpenGl : public Llvmpipe {
 public:
  bool set_up(std::string* why) {
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) {
      *why = "there is no EGL display without a window";
      return false;
    }
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
      *why = "there is no OpenGL 4.5";
      return false;
    }
    name_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    if (name_.find("llvmpipe") == std::string::npos) {
      *why = "the driver is " + name_;
      return false;
    }
    GLuint textures[2], array;
    glGenTextures(2, textures);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT32F, kWidth, kHeight);
    glBindTexture(GL_TEXTURE_2D, textures[1]);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, kWidth, kHeight);
    glGenFramebuffers(2, framebuffers_);
    for (int color = 0; color < 2; ++color) {
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[color]);
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, textures[0], 0);
      if (color == 1) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[1], 0);
      const GLenum target = color == 1 ? GL_COLOR_ATTACHMENT0 : GL_NONE;
      glDrawBuffers(1, &target);
      if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        *why = "there is no float framebuffer";
        return false;
      }
    }
    programs_[0] = link("#version 450\nlayout(location = 0) in vec4 p; void main() { gl_Position = p; }",
                        "#version 450\nvoid main() {}");
    programs_[1] = link(
        "#version 450\nlayout(location = 0) in vec4 p; layout(location = 1) in vec4 v; out vec4 value;\n"
        "void main() { gl_Position = p; value = v; }",
        "#version 450\nin vec4 value; layout(location = 0) out vec4 color; void main() { color = value; }");
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(3, buffers_);
    glViewport(0, 0, kWidth, kHeight);
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    if (glGetError() != GL_NO_ERROR) {
      *why = "OpenGL reports an error";
      return false;
    }
    return true;
  }

  void load(const Workload& workload, std::span<const float> values) override {
    std::vector<float> clip;
    clip.reserve(4 * workload.vertices.size());
    for (const Vertex& v : workload.vertices) {
      clip.insert(clip.end(), {2 * v.x / kWidth - v.w, 2 * v.y / kHeight - v.w, v.z, v.w});
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(clip.size() * sizeof(float)), clip.data(), GL_STATIC_DRAW);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(workload.indices.size() * sizeof(std::uint32_t)),
                 workload.indices.data(), GL_STATIC_DRAW);
    count_ = static_cast<GLsizei>(workload.indices.size());
    primitive_ = workload.primitive == Primitive::triangles ? GL_TRIANGLES
                 : workload.primitive == Primitive::lines   ? GL_LINES
                                                            : GL_POINTS;
    if (values.empty()) {
      glDisableVertexAttribArray(1);
      return;
    }
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[2]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size_bytes()), values.data(), GL_STATIC_DRAW);
    glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(1);
  }

  void draw(bool color) override {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[color ? 1 : 0]);
    glUseProgram(programs_[color ? 1 : 0]);
    glClear(GL_DEPTH_BUFFER_BIT | (color ? GL_COLOR_BUFFER_BIT : 0u));
    glDrawElements(primitive_, count_, GL_UNSIGNED_INT, nullptr);
    glFinish();
  }

  std::string name() const override { return name_; }

 private:
  std::string name_;
  GLuint framebuffers_[2] = {}, programs_[2] = {}, buffers_[3] = {};
  GLsizei count_ = 0;
  GLenum primitive_ = GL_TRIANGLES;
};

}  // namespace

std::unique_ptr<Llvmpipe> Llvmpipe::open(std::string* why) {
  auto rival = std::make_unique<OpenGl>();
  if (!rival->set_up(why)) return nullptr;
  return rival;
}

}  // namespace surefill::bench

#else

namespace surefill::bench {

std::unique_ptr<Llvmpipe> Llvmpipe::open(std::string* why) {
  *why = "built without EGL and OpenGL";
  return nullptr;
}

}  // namespace surefill::bench

#endif
