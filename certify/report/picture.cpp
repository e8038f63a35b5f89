// SPDX-License-Identifier: Apache-2.0
#include "certify/report/picture.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "certify/run/files.hpp"

namespace surefill::certify {

namespace {

using Colour = std::array<double, 3>;  // 0..1, as shown (sRGB)

constexpr Colour kBackground{0.13, 0.14, 0.16};

Colour mix(const Colour& a, const Colour& b, double weight) {
  Colour result{};
  for (std::size_t k = 0; k < 3; ++k) result[k] = a[k] + (b[k] - a[k]) * weight;
  return result;
}

// A colour of full lightness range for a number: neighbours differ clearly.
Colour hashed(std::uint32_t number) {
  std::uint32_t h = number * 0x9E3779B1u;
  h ^= h >> 15;
  h *= 0x85EBCA77u;
  h ^= h >> 13;
  const double hue = (h & 0xFFFFu) / 65536.0 * 6;
  const double lightness = 0.45 + ((h >> 16) & 0xFFu) / 255.0 * 0.5;
  const double saturation = 0.35 + ((h >> 24) & 0xFFu) / 255.0 * 0.4;
  Colour colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double phase = std::fmod(hue + 6 - 2 * static_cast<double>(k), 6.0);
    const double ramp = std::clamp(std::fabs(phase - 3) - 1, 0.0, 1.0);
    colour[k] = lightness * (1 - saturation + saturation * ramp);
  }
  return colour;
}

// Black body: 0 is dark violet, 1 is nearly white.
Colour heat(double value) {
  static constexpr Colour kStops[] = {{0.16, 0.20, 0.45}, {0.20, 0.52, 0.71}, {0.36, 0.76, 0.58},
                                      {0.95, 0.82, 0.35}, {0.93, 0.46, 0.25}, {1.00, 0.96, 0.92}};
  const double at = std::clamp(value, 0.0, 1.0) * (std::size(kStops) - 1);
  const std::size_t stop = std::min(static_cast<std::size_t>(at), std::size(kStops) - 2);
  return mix(kStops[stop], kStops[stop + 1], at - static_cast<double>(stop));
}

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

// Maps one sample to a colour; holds what has to be known of the whole image.
class Palette {
 public:
  Palette(const corpus::Image& image, Show show) : image_(image), show_(show) {
    if (show == Show::depth) {
      for (const float depth : image.depth) {
        if (!std::isfinite(depth)) continue;
        low_ = std::min(low_, double{depth});
        high_ = std::max(high_, double{depth});
      }
    }
    if (show == Show::count) {
      for (const std::uint32_t count : image.count) largest_ = std::max(largest_, count);
    }
  }

  Colour operator()(std::size_t sample) const {
    switch (show_) {
      case Show::count:
        if (image_.count[sample] == 0) return kBackground;
        return heat(largest_ > 1 ? (image_.count[sample] - 1.0) / (largest_ - 1.0) : 0.0);
      case Show::depth: {
        const float depth = image_.depth[sample];
        if (!std::isfinite(depth)) return kBackground;
        const double far = high_ > low_ ? (depth - low_) / (high_ - low_) : 0.0;
        return mix({0.98, 0.97, 0.94}, {0.24, 0.26, 0.34}, far);
      }
      case Show::wireframe:
        if (empty(sample)) return kBackground;
        return image_.index[sample] < kFirstEdge ? Colour{0.98, 0.97, 0.94} : Colour{0.13, 0.2, 0.36};
      case Show::index:
        return empty(sample) ? kBackground : hashed(image_.index[sample]);
      case Show::barycentrics:
        if (empty(sample)) return kBackground;
        return {image_.barycentrics[3 * sample], image_.barycentrics[3 * sample + 1],
                image_.barycentrics[3 * sample + 2]};
      case Show::normals: {
        if (empty(sample)) return kBackground;
        Colour colour{};
        double size = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          colour[k] = image_.attributes[0][3 * sample + k];
          size += colour[k] * colour[k];
        }
        for (double& component : colour) component = size > 0 ? component / std::sqrt(size) / 2 + 0.5 : 0.5;
        return colour;
      }
    }
    return kBackground;
  }

 private:
  bool empty(std::size_t sample) const { return image_.index[sample] == kNoTriangle; }

  const corpus::Image& image_;
  Show show_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
  std::uint32_t largest_ = 0;
};

}  // namespace

std::optional<Show> show_by_name(const std::string& name) {
  if (name == "depth") return Show::depth;
  if (name == "index") return Show::index;
  if (name == "barycentrics") return Show::barycentrics;
  if (name == "normals") return Show::normals;
  if (name == "count") return Show::count;
  if (name == "wireframe") return Show::wireframe;
  return std::nullopt;
}

corpus::Outputs outputs_for(Show show) {
  corpus::Outputs outputs;
  outputs.count = show == Show::count;
  outputs.index = show == Show::wireframe || show == Show::index || show == Show::barycentrics || show == Show::normals;
  outputs.depth = show == Show::depth;
  outputs.barycentrics = show == Show::barycentrics;
  outputs.attributes = show == Show::normals;
  return outputs;
}

corpus::Scene with_edges(corpus::Scene scene) {
  std::uint32_t first = kFirstEdge;
  const std::size_t draws = scene.draws.size();
  for (std::size_t d = 0; d < draws; ++d) {
    if (scene.draws[d].primitive != Primitive::triangles) continue;
    corpus::SceneDraw edges = scene.draws[d];
    corpus::SceneDraw& faces = scene.draws[d];
    faces.grid.reset(), faces.conservative = Conservative::none, faces.depth_bias = DepthBias{0, 1};
    for (corpus::SceneTriangle& face : faces.triangles) face.identifier.reset();
    std::set<std::array<std::uint32_t, 2>> pairs;
    for (const corpus::SceneTriangle& face : faces.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] = std::minmax(face.vertices[i], face.vertices[(i + 1) % 3]);
        pairs.insert({low, high});
      }
    }
    edges.state() = {};
    edges.scissor = faces.scissor, edges.depth_mode = faces.depth_mode;
    edges.primitive = Primitive::lines;
    edges.first_index = first, first += static_cast<std::uint32_t>(pairs.size());
    edges.triangles.clear();
    for (const auto& [low, high] : pairs) edges.triangles.push_back({{low, high, high}, std::nullopt});
    scene.draws.push_back(std::move(edges));
  }
  if (scene.samples != 1 && scene.initial_depth.size() > 1) scene.initial_depth.clear();
  scene.samples = 1, scene.sample_locations.clear(), scene.layers = 1, scene.more = {};
  return scene;
}

Picture picture_of(const corpus::Image& image, Show show) {
  const Palette palette(image, show);
  Picture picture{image.width, image.height, {}};
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const std::size_t samples = static_cast<std::size_t>(image.samples);
  picture.rgb.reserve(3 * pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    Colour sum{};
    for (std::size_t n = 0; n < samples; ++n) {
      const Colour colour = palette(pixel * samples + n);
      for (std::size_t k = 0; k < 3; ++k) sum[k] += colour[k];
    }
    for (const double component : sum) picture.rgb.push_back(byte_of(component / static_cast<double>(samples)));
  }
  return picture;
}

void write_png(const Picture& picture, const std::string& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(picture.width);
  header.height = static_cast<png_uint_32>(picture.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  if (png_image_write_to_memory(&header, nullptr, &size, 0, picture.rgb.data(), 0, nullptr) == 0) {
    throw FileError(path + ": " + header.message);
  }
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, picture.rgb.data(), 0, nullptr) == 0) {
    throw FileError(path + ": " + header.message);
  }
  bytes.resize(size);
  write_file(path, bytes);
}

}  // namespace surefill::certify
