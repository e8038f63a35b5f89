// SPDX-License-Identifier: Apache-2.0
//
// The adapter for OpenGL drivers: a core profile without a window (EGL, surfaceless), 3.3 and later. Arguments:
//   driver=NAME     Mesa's software drivers: llvmpipe, softpipe (the same as the environment variable GALLIUM_DRIVER)
//   device=NUMBER   an EGL device instead of Mesa's surfaceless platform, such as the first GPU: device=0
//   clip=classic    origin at the lower left and clip depth -1 to 1; otherwise glClipControl where there is one
//   viewport=target  the viewport of programs, at whose border drivers clip; otherwise it holds all vertices
//   claim=non-finite  NaN and infinities are drawn and judged, which no standard promises
//   fault=STATE     leaves a state wrong on purpose, for tests of the self-check: scissor, viewport, multisample,
//                   cull, blend, depth-range, polygon-offset, color-mask, front-face, depth-test
#define EGL_EGLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>

#include "certify/drivers/driver.hpp"
#include "certify/drivers/shaders.hpp"

namespace surefill::drivers {

namespace {

const char* name_of(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    default:
      return "an error";
  }
}

void check(const char* what) {
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    throw DriverError(std::string("OpenGL: ") + name_of(error) + " after " + what);
  }
}

GLint integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

std::string text(GLenum name) {
  const auto* value = reinterpret_cast<const char*>(glGetString(name));
  return value ? value : "";
}

bool has_extension(const char* name) {
  for (GLint n = 0; n < integer(GL_NUM_EXTENSIONS); ++n) {
    const auto* extension = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(n)));
    if (extension && std::strcmp(extension, name) == 0) return true;
  }
  return false;
}

GLuint compile(GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const char* lines = source.c_str();
  glShaderSource(shader, 1, &lines, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    char log[512] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw DriverError(std::string("OpenGL: a shader does not compile: ") + log);
  }
  return shader;
}

GLuint link(std::initializer_list<GLuint> shaders) {
  const GLuint program = glCreateProgram();
  for (const GLuint shader : shaders) glAttachShader(program, shader);
  glLinkProgram(program);
  for (const GLuint shader : shaders) glDeleteShader(shader);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good) {
    char log[512] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    throw DriverError(std::string("OpenGL: a program does not link: ") + log);
  }
  return program;
}

struct Format {
  GLint internal;
  GLenum format, type;
  std::uint32_t components;
};
constexpr Format kCountFormat{GL_R32F, GL_RED, GL_FLOAT, 1};
constexpr Format kIndexFormat{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 1};
constexpr Format kValueFormat{GL_RGBA32F, GL_RGBA, GL_FLOAT, 4};
constexpr Format kDepthFormat{GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 1};

// A texture to draw to.
class Texture {
 public:
  Texture(const Format& format, GLsizei width, GLsizei height, GLsizei samples)
      : format_(format), target_(samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D) {
    glGenTextures(1, &name_);
    glBindTexture(target_, name_);
    if (samples > 1) {
      glTexImage2DMultisample(target_, samples, static_cast<GLenum>(format.internal), width, height, GL_TRUE);
    } else {
      glTexImage2D(target_, 0, format.internal, width, height, 0, format.format, format.type, nullptr);
      glTexParameteri(target_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
      glTexParameteri(target_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
  }
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;
  ~Texture() { glDeleteTextures(1, &name_); }

  const Format& format() const { return format_; }
  GLuint name() const { return name_; }
  GLenum target() const { return target_; }

 private:
  Format format_;
  GLenum target_;
  GLuint name_ = 0;
};

class Framebuffer {
 public:
  Framebuffer() { glGenFramebuffers(1, &name_); }
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;
  ~Framebuffer() { glDeleteFramebuffers(1, &name_); }

  void add(GLenum place, const Format& format, GLsizei width, GLsizei height, GLsizei samples) {
    glBindFramebuffer(GL_FRAMEBUFFER, name_);
    const auto& texture = textures_[place] = std::make_unique<Texture>(format, width, height, samples);
    glFramebufferTexture2D(GL_FRAMEBUFFER, place, texture->target(), texture->name(), 0);
  }
  // Binds it; fragment output n goes to GL_COLOR_ATTACHMENT0 + n where there is one.
  void bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, name_);
    std::vector<GLenum> places;
    for (GLenum n = 0; n < 2 + kMaxAttributes; ++n) {
      places.push_back(textures_.count(GL_COLOR_ATTACHMENT0 + n) ? GL_COLOR_ATTACHMENT0 + n : GL_NONE);
    }
    glDrawBuffers(static_cast<GLsizei>(places.size()), places.data());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw NotJudged("the driver has no framebuffer of the formats that the outputs need");
    }
  }
  const Texture& at(GLenum place) const { return *textures_.at(place); }
  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
  std::map<GLenum, std::unique_ptr<Texture>> textures_;
};

class OpenGl : public Driver {
 public:
  explicit OpenGl(const Arguments& arguments) : fault_(argument(arguments, "fault")) {
    const std::string device = argument(arguments, "device"), driver = argument(arguments, "driver");
    if (!driver.empty()) {
      ::setenv("GALLIUM_DRIVER", driver.c_str(), 1);
      ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    }
    // Each thread of certify has a process of its own.
    ::setenv("LP_NUM_THREADS", "0", 0);
    open_display(device);
    make_context();
    if (!driver.empty() && text(GL_RENDERER).find(driver) == std::string::npos) {
      throw NotJudged("there is no driver \"" + driver + "\": this is " + text(GL_RENDERER));
    }
    describe(arguments);
    glGenVertexArrays(1, &vertex_array_);
    glBindVertexArray(vertex_array_);
    glGenBuffers(1, &vertex_buffer_);
    glGenBuffers(1, &word_buffer_);
    count_program_ = link({compile(GL_VERTEX_SHADER, source(kSceneVertexShader, "#define ATTRIBUTES 0\n")),
                           compile(GL_FRAGMENT_SHADER, source(kCountFragmentShader, ""))});
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
    check("opening");
  }

  ~OpenGl() override {
    // The context takes all names with it.
    framebuffers_.clear();
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
  }

  surefill_adapter_info info() const override { return info_; }
  std::uint32_t primitives() const override { return 1u << SUREFILL_ADAPTER2_LINES | 1u << SUREFILL_ADAPTER2_POINTS; }

  void draw(const surefill_adapter_scene& scene, const Primitives& primitives,
            const surefill_adapter_image& image) override {
    check_primitives(scene, primitives);
    const bool attributes = image.attributes && scene.attribute_count > 0;
    const VertexStream stream = vertex_stream(scene, primitives, attributes);
    set_vertices(stream, attributes ? scene.attribute_count : 0);
    if (image.count) draw_count(scene, image, stream);
    if (asks_for_visible(image)) draw_visible(scene, image, stream, attributes);
    check("drawing");
  }

 private:
  void open_display(const std::string& device) {
    if (device.empty()) {
      display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    } else {
      const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
      EGLDeviceEXT devices[16];
      EGLint count = 0;
      if (query) query(16, devices, &count);
      const int number = std::atoi(device.c_str());
      if (number < 0 || number >= count) {
        throw NotJudged("there is no EGL device " + device + "; there are " + std::to_string(count));
      }
      display_ = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[number], nullptr);
    }
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) {
      throw NotJudged("there is no EGL display that needs no window");
    }
  }

  void make_context() {
    eglBindAPI(EGL_OPENGL_API);
    for (const int version : {46, 45, 43, 33}) {
      const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                               version / 10,
                               EGL_CONTEXT_MINOR_VERSION,
                               version % 10,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
      context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
      if (context_ == EGL_NO_CONTEXT) continue;
      version_ = version;
      if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
        throw NotJudged("the EGL display has no context without a surface");
      }
      return;
    }
    throw NotJudged("there is no OpenGL core profile of version 3.3");
  }

  void describe(const Arguments& arguments) {
    const std::string clip = argument(arguments, "clip"), claim = argument(arguments, "claim");
    if (!clip.empty() && clip != "classic") throw NotJudged("argument clip=" + clip + ": there is clip=classic");
    if (!claim.empty() && claim != "non-finite") throw NotJudged("argument claim=" + claim + ": there is non-finite");
    upper_left_ = clip.empty() && (version_ >= 45 || has_extension("GL_ARB_clip_control"));
    std::string renderer = text(GL_RENDERER), version = text(GL_VERSION);
    set_text(info_.name, renderer);
    info_.model.grid_bits = static_cast<std::uint32_t>(std::min(integer(GL_SUBPIXEL_BITS), 12));
    set_text(info_.version, version + ", GL_SUBPIXEL_BITS " + std::to_string(integer(GL_SUBPIXEL_BITS)));
    info_.outputs = SUREFILL_ADAPTER_COUNT | SUREFILL_ADAPTER_INDEX | SUREFILL_ADAPTER_DEPTH |
                    SUREFILL_ADAPTER_BARYCENTRICS | SUREFILL_ADAPTER_ATTRIBUTES;
    info_.features = SUREFILL_ADAPTER_BEHIND | SUREFILL_ADAPTER_DRAWS | SUREFILL_ADAPTER_CULL |
                     SUREFILL_ADAPTER_SCISSOR | SUREFILL_ADAPTER_DEPTH_CLIP | SUREFILL_ADAPTER_DEPTH_CLAMP |
                     SUREFILL_ADAPTER_DEPTH_GREATER | SUREFILL_ADAPTER_IDENTIFIERS | SUREFILL_ADAPTER_NOPERSPECTIVE |
                     SUREFILL_ADAPTER_FLAT;
    if (!claim.empty()) info_.features |= SUREFILL_ADAPTER_NON_FINITE;
    glGetFloatv(GL_ALIASED_LINE_WIDTH_RANGE, line_widths_.data());
    glGetFloatv(GL_POINT_SIZE_RANGE, point_sizes_.data());
    // Some contexts refuse wide lines, whatever they report.
    glLineWidth(line_widths_[1]);
    if (glGetError() != GL_NO_ERROR) line_widths_ = {1, 1};
    if (line_widths_[1] > 1 && point_sizes_[1] > 1) {
      info_.features |= static_cast<std::uint32_t>(SUREFILL_ADAPTER2_WIDTHS);
    }
    info_.form = SUREFILL_ADAPTER_FORM_CLIP;
    info_.model.kind = SUREFILL_ADAPTER_MODEL_UNKNOWN;
    info_.model.profile = SUREFILL_ADAPTER_PROFILE_OPENGL;
    info_.model.y = upper_left_ ? SUREFILL_ADAPTER_Y_DOWN : SUREFILL_ADAPTER_Y_UP;
    info_.model.depth_range = upper_left_ ? SUREFILL_ADAPTER_ZERO_TO_ONE : SUREFILL_ADAPTER_MINUS_ONE_TO_ONE;
    GLint viewport[2] = {0, 0};
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    const GLint most = std::min({integer(GL_MAX_TEXTURE_SIZE), viewport[0], viewport[1]});
    // The viewport is a power of two.
    info_.max_width = info_.max_height = std::bit_floor(static_cast<std::uint32_t>(most));
    info_.max_attributes = kMaxAttributes;
    info_.max_components = 4;
    // Samples are read back by a compute shader.
    if (version_ < 43) return;
    const GLint most_samples = std::min({integer(GL_MAX_COLOR_TEXTURE_SAMPLES), integer(GL_MAX_INTEGER_SAMPLES),
                                         integer(GL_MAX_DEPTH_TEXTURE_SAMPLES)});
    for (std::uint32_t samples = 2; samples <= 16; samples *= 2) {
      if (static_cast<GLint>(samples) <= most_samples && standard_places(samples)) sample_counts_.push_back(samples);
    }
    if (!sample_counts_.empty()) info_.features |= SUREFILL_ADAPTER_SAMPLES;
  }

  // Are the samples of the driver at the places of S4? Where the first row is the bottom one, y goes up.
  bool standard_places(std::uint32_t samples) {
    Framebuffer framebuffer;
    framebuffer.add(GL_COLOR_ATTACHMENT0, kIndexFormat, 1, 1, static_cast<GLsizei>(samples));
    framebuffer.bind();
    for (std::uint32_t n = 0; n < samples; ++n) {
      GLfloat place[2] = {0, 0};
      glGetMultisamplefv(GL_SAMPLE_POSITION, n, place);
      if (glGetError() != GL_NO_ERROR) return false;
      const std::array<int, 2> standard = standard_sample(samples, n);
      const GLfloat y = upper_left_ ? place[1] : 1 - place[1];
      if (place[0] != static_cast<float>(standard[0]) / 16 || y != static_cast<float>(standard[1]) / 16) return false;
    }
    return true;
  }

  std::string source(const char* shader, const std::string& definitions) const {
    return "#version 330 core\n" + definitions + shader;
  }

  // The program that shows what is visible, with so many attributes.
  GLuint visible_program(std::uint32_t attributes) {
    GLuint& program = visible_programs_[attributes];
    if (program == 0) {
      const std::string definitions = "#define ATTRIBUTES " + std::to_string(attributes) + "\n";
      program = link({compile(GL_VERTEX_SHADER, source(kSceneVertexShader, definitions)),
                      compile(GL_FRAGMENT_SHADER, source(kVisibleFragmentShader, definitions))});
    }
    return program;
  }

  GLuint samples_program(bool whole_numbers) {
    GLuint& program = samples_programs_[whole_numbers ? 1 : 0];
    if (program == 0) {
      const std::string definitions = whole_numbers ? "#define WHOLE_NUMBERS\n" : "";
      program = link({compile(GL_COMPUTE_SHADER, "#version 430 core\n" + definitions + kSamplesComputeShader)});
    }
    return program;
  }

  void set_vertices(const VertexStream& stream, std::uint32_t attributes) {
    const auto stride = static_cast<GLsizei>(stream.stride * 4);
    const auto at = [](std::size_t word) { return reinterpret_cast<const void*>(word * 4); };
    glBindVertexArray(vertex_array_);
    glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(stream.words.size() * 4), stream.words.data(),
                 GL_STREAM_DRAW);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, stride, at(0));
    glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, stride, at(4));
    glVertexAttribIPointer(2, 1, GL_UNSIGNED_INT, stride, at(5));
    for (GLuint n = 0; n < 3; ++n) glEnableVertexAttribArray(n);
    for (GLuint k = 0; k < kMaxAttributes; ++k) {
      if (k < attributes) {
        glVertexAttribPointer(3 + k, 4, GL_FLOAT, GL_FALSE, stride, at(6 + 4 * std::size_t{k}));
        glEnableVertexAttribArray(3 + k);
      } else {
        glDisableVertexAttribArray(3 + k);
      }
    }
  }

  // With several samples a pixel, lines are other shapes: nobody judges them.
  void check_primitives(const surefill_adapter_scene& scene, const Primitives& primitives) const {
    for (const PrimitiveOf& primitive : primitives) {
      if (primitive.kind == SUREFILL_ADAPTER2_TRIANGLES) continue;
      if (scene.samples > 1) throw NotJudged("lines and points with several samples a pixel");
      const std::array<float, 2>& range = primitive.kind == SUREFILL_ADAPTER2_LINES ? line_widths_ : point_sizes_;
      if (!(primitive.pixels() >= range[0] && primitive.pixels() <= range[1])) {
        throw NotJudged("a width beyond the driver's range");
      }
    }
  }

  // Every state on which a draw depends, whatever it was before.
  void set_state(const surefill_adapter_scene& scene, const surefill_adapter_draw& draw, const PrimitiveOf& primitive,
                 bool visible) {
    constexpr GLenum kOff[] = {GL_POLYGON_OFFSET_FILL,
                               GL_POLYGON_SMOOTH,
                               GL_LINE_SMOOTH,
                               GL_PROGRAM_POINT_SIZE,
                               GL_STENCIL_TEST,
                               GL_SAMPLE_ALPHA_TO_COVERAGE,
                               GL_SAMPLE_ALPHA_TO_ONE,
                               GL_SAMPLE_COVERAGE,
                               GL_SAMPLE_MASK,
                               GL_RASTERIZER_DISCARD,
                               GL_DITHER,
                               GL_COLOR_LOGIC_OP,
                               GL_PRIMITIVE_RESTART,
                               GL_FRAMEBUFFER_SRGB,
                               GL_SCISSOR_TEST,
                               GL_CULL_FACE};
    for (const GLenum off : kOff) {
      glDisable(off);
    }
    glEnable(GL_MULTISAMPLE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
    glLineWidth(primitive.kind == SUREFILL_ADAPTER2_LINES ? primitive.pixels() : 1);
    glPointSize(primitive.kind == SUREFILL_ADAPTER2_POINTS ? primitive.pixels() : 1);
    if (upper_left_) glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    const auto height = static_cast<GLint>(scene.height), full = static_cast<GLint>(draw.viewport_height);
    const auto left = static_cast<GLint>(draw.viewport_x), top = static_cast<GLint>(draw.viewport_y);
    // Row 0 is the top one with the origin at the upper left, else the bottom one.
    glViewport(left, upper_left_ ? top : height - top - full, static_cast<GLsizei>(draw.viewport_width), full);
    glDepthRange(0, 1);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    (draw.depth_mode == SUREFILL_ADAPTER_CLIP_DEPTH ? glDisable : glEnable)(GL_DEPTH_CLAMP);
    (visible ? glEnable : glDisable)(GL_DEPTH_TEST);
    (visible ? glDisable : glEnable)(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    glDepthFunc(scene.depth_test == SUREFILL_ADAPTER_GREATER ? GL_GEQUAL : GL_LEQUAL);
    // Facing is meant as the image shows it, with its top row first; so does OpenGL mean it with either origin.
    glFrontFace(draw.front_face == SUREFILL_ADAPTER_CLOCKWISE ? GL_CW : GL_CCW);
    if (draw.cull != SUREFILL_ADAPTER_CULL_NONE) {
      glEnable(GL_CULL_FACE);
      glCullFace(draw.cull == SUREFILL_ADAPTER_CULL_BACK ? GL_BACK : GL_FRONT);
    }
    if (draw.has_scissor) {
      const auto width = static_cast<GLint>(scene.width);
      const GLint x0 = std::clamp(draw.scissor[0], 0, width), y0 = std::clamp(draw.scissor[1], 0, height);
      const GLint x1 = std::clamp(draw.scissor[2], 0, width), y1 = std::clamp(draw.scissor[3], 0, height);
      glEnable(GL_SCISSOR_TEST);
      glScissor(x0, upper_left_ ? y0 : height - y1, std::max(x1 - x0, 0), std::max(y1 - y0, 0));
    }
    if (!fault_.empty()) leave_wrong(scene);
  }

  void leave_wrong(const surefill_adapter_scene& scene) {
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    if (fault_ == "scissor") {
      glEnable(GL_SCISSOR_TEST);
      glScissor(0, 0, static_cast<GLsizei>(scene.width) - 1, static_cast<GLsizei>(scene.height));
    } else if (fault_ == "viewport") {
      glViewport(viewport[0] + 1, viewport[1], viewport[2], viewport[3]);
    } else if (fault_ == "cull") {
      glEnable(GL_CULL_FACE);
    } else if (fault_ == "blend") {
      glDisable(GL_BLEND);
    } else if (fault_ == "depth-range") {
      glDepthRange(0, 0.5);
    } else if (fault_ == "polygon-offset") {
      glEnable(GL_POLYGON_OFFSET_FILL);
      glPolygonOffset(0, 1048576);
    } else if (fault_ == "color-mask") {
      glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
    } else if (fault_ == "front-face") {
      glFrontFace(integer(GL_FRONT_FACE) == GL_CW ? GL_CCW : GL_CW);
    } else if (fault_ == "depth-test") {
      glDisable(GL_DEPTH_TEST);
    } else if (fault_ != "multisample") {
      throw NotJudged("argument fault=" + fault_ + ": no such fault");
    }
  }

  void set_clear_state() {
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDisable(GL_RASTERIZER_DISCARD);
  }

  void check_samples(const surefill_adapter_scene& scene) const {
    if (scene.samples == 1 ||
        std::find(sample_counts_.begin(), sample_counts_.end(), scene.samples) != sample_counts_.end()) {
      return;
    }
    throw NotJudged(std::to_string(scene.samples) + " samples a pixel at the standard places");
  }

  // The framebuffer of the last scene serves the next one of its shape.
  Framebuffer& framebuffer_for(const surefill_adapter_scene& scene, bool visible, bool barycentrics,
                               std::uint32_t attributes, GLsizei samples) {
    const std::array<std::uint32_t, 5> shape{scene.width, scene.height, static_cast<std::uint32_t>(samples),
                                             barycentrics ? 1u : 0u, visible ? 1 + attributes : 0};
    const auto found = framebuffers_.find(shape);
    if (found != framebuffers_.end()) return *found->second;
    if (framebuffers_.size() >= kMostFramebuffers || scene.width * std::uint64_t{scene.height} > kLargePixels) {
      framebuffers_.clear();
    }
    auto made = std::make_unique<Framebuffer>();
    const auto width = static_cast<GLsizei>(scene.width), height = static_cast<GLsizei>(scene.height);
    made->add(GL_COLOR_ATTACHMENT0, visible ? kIndexFormat : kCountFormat, width, height, samples);
    if (visible) {
      made->add(GL_DEPTH_ATTACHMENT, kDepthFormat, width, height, samples);
      if (barycentrics) made->add(GL_COLOR_ATTACHMENT0 + 1, kValueFormat, width, height, samples);
      for (std::uint32_t k = 0; k < attributes; ++k) {
        made->add(GL_COLOR_ATTACHMENT0 + 2u + k, kValueFormat, width, height, samples);
      }
    }
    check("making a framebuffer");
    return *(framebuffers_[shape] = std::move(made));
  }

  // All samples of an attachment, in the adapter's order, with the components that the format has.
  std::vector<std::uint32_t> read(const Framebuffer& framebuffer, GLenum place, const surefill_adapter_scene& scene) {
    const Texture& texture = framebuffer.at(place);
    const Format& format = texture.format();
    std::vector<std::uint32_t> words(std::size_t{scene.width} * scene.height * scene.samples * format.components);
    const auto width = static_cast<GLsizei>(scene.width), height = static_cast<GLsizei>(scene.height);
    if (scene.samples == 1) {
      glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.name());
      if (place != GL_DEPTH_ATTACHMENT) glReadBuffer(place);
      glReadPixels(0, 0, width, height, format.format, format.type, words.data());
      return words;
    }
    const GLuint program = samples_program(format.type == GL_UNSIGNED_INT);
    glUseProgram(program);
    glUniform4i(glGetUniformLocation(program, "size"), width, height, static_cast<GLint>(scene.samples),
                static_cast<GLint>(format.components));
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture.name());
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, word_buffer_);
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(words.size() * 4), nullptr, GL_STREAM_READ);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, word_buffer_);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glDispatchCompute((scene.width + 7) / 8, (scene.height + 7) / 8, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(words.size() * 4), words.data());
    return words;
  }

  void draw_batches(const surefill_adapter_scene& scene, const VertexStream& stream, GLint interpolation,
                    bool visible) {
    for (const DrawRange& batch : stream.batches) {
      if (batch.count == 0) continue;
      constexpr GLenum kModes[] = {GL_TRIANGLES, GL_LINES, GL_POINTS};
      set_state(scene, *batch.draw, batch.primitive, visible);
      if (interpolation >= 0) glUniform4iv(interpolation, 1, batch.interpolation.data());
      glDrawArrays(kModes[batch.primitive.kind], static_cast<GLint>(batch.first), static_cast<GLsizei>(batch.count));
    }
  }

  void draw_count(const surefill_adapter_scene& scene, const surefill_adapter_image& image,
                  const VertexStream& stream) {
    check_samples(scene);
    const bool resolve = fault_ == "multisample";
    if (resolve && integer(GL_MAX_COLOR_TEXTURE_SAMPLES) < 4) throw NotJudged("fault=multisample needs four samples");
    if (resolve) framebuffers_.clear();  // so that neither of the two makes room for the other
    const auto samples = static_cast<GLsizei>(resolve ? 4 : scene.samples);
    Framebuffer& framebuffer = framebuffer_for(scene, false, false, 0, samples);
    framebuffer.bind();
    set_clear_state();
    const GLfloat zero[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, zero);
    glUseProgram(count_program_);
    draw_batches(scene, stream, -1, false);
    const Framebuffer* shown = &framebuffer;
    if (resolve) {
      Framebuffer& one = framebuffer_for(scene, false, false, 0, 1);
      one.bind();
      glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.name());
      const auto width = static_cast<GLint>(scene.width), height = static_cast<GLint>(scene.height);
      glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
      shown = &one;
    }
    const std::vector<std::uint32_t> words = read(*shown, GL_COLOR_ATTACHMENT0, scene);
    for (std::size_t s = 0; s < words.size(); ++s) {
      const auto count = std::bit_cast<float>(words[s]);
      image.count[s] = static_cast<std::uint32_t>(std::lround(4 * count));
      if (image.count[s] % 4 != 0) throw NotJudged("a count that is no whole number: multisampling is on");
      image.count[s] /= 4;
    }
  }

  void draw_visible(const surefill_adapter_scene& scene, const surefill_adapter_image& image,
                    const VertexStream& stream, bool with_attributes) {
    check_samples(scene);
    const std::uint32_t attributes = with_attributes ? scene.attribute_count : 0;
    const bool greater = scene.depth_test == SUREFILL_ADAPTER_GREATER;
    Framebuffer& framebuffer =
        framebuffer_for(scene, true, image.barycentrics != nullptr, attributes, static_cast<GLsizei>(scene.samples));
    framebuffer.bind();
    set_clear_state();
    const GLuint empty[4] = {SUREFILL_ADAPTER_EMPTY, 0, 0, 0};
    const GLfloat zero[4] = {0, 0, 0, 0}, farthest = greater ? 0.0f : 1.0f;
    glClearBufferuiv(GL_COLOR, 0, empty);
    if (image.barycentrics) glClearBufferfv(GL_COLOR, 1, zero);
    for (GLint k = 0; k < static_cast<GLint>(attributes); ++k) glClearBufferfv(GL_COLOR, 2 + k, zero);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    const GLuint program = visible_program(attributes);
    glUseProgram(program);
    draw_batches(scene, stream, glGetUniformLocation(program, "interpolation"), true);

    const std::vector<std::uint32_t> index = read(framebuffer, GL_COLOR_ATTACHMENT0, scene);
    if (image.index) std::copy(index.begin(), index.end(), image.index);
    if (image.depth) {
      const std::vector<std::uint32_t> words = read(framebuffer, GL_DEPTH_ATTACHMENT, scene);
      const float none = (greater ? -1.0f : 1.0f) * std::numeric_limits<float>::infinity();
      for (std::size_t s = 0; s < words.size(); ++s) {
        image.depth[s] = index[s] == SUREFILL_ADAPTER_EMPTY ? none : std::bit_cast<float>(words[s]);
      }
    }
    const auto copy = [](const std::vector<std::uint32_t>& words, std::uint32_t components, float* to) {
      for (std::size_t s = 0; s < words.size() / 4; ++s) {
        for (std::uint32_t c = 0; c < components; ++c) to[components * s + c] = std::bit_cast<float>(words[4 * s + c]);
      }
    };
    if (image.barycentrics) copy(read(framebuffer, GL_COLOR_ATTACHMENT0 + 1, scene), 3, image.barycentrics);
    for (std::uint32_t k = 0; k < attributes; ++k) {
      const std::uint32_t components = scene.draw_count == 0 ? 0 : scene.draws[0].attributes[k].components;
      copy(read(framebuffer, GL_COLOR_ATTACHMENT0 + 2u + k, scene), components, image.attributes[k]);
    }
  }

  static constexpr std::size_t kMostFramebuffers = 32;
  static constexpr std::uint64_t kLargePixels = 1 << 16;

  std::string fault_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  int version_ = 0;
  bool upper_left_ = false;
  std::vector<std::uint32_t> sample_counts_;
  std::array<float, 2> line_widths_{1, 1}, point_sizes_{1, 1};
  surefill_adapter_info info_{};
  GLuint vertex_array_ = 0, vertex_buffer_ = 0, word_buffer_ = 0, count_program_ = 0;
  std::array<GLuint, kMaxAttributes + 1> visible_programs_{};
  std::array<GLuint, 2> samples_programs_{};
  std::map<std::array<std::uint32_t, 5>, std::unique_ptr<Framebuffer>> framebuffers_;
};

}  // namespace

std::unique_ptr<Driver> open_driver(const Arguments& arguments) {
  check_keys(arguments, {"driver", "device", "clip", "claim", "fault"});
  return std::make_unique<OpenGl>(arguments);
}

}  // namespace surefill::drivers
