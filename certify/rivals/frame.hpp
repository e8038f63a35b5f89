// SPDX-License-Identifier: Apache-2.0
//
// A frame of the engine's public types as an adapter sees it (certify/adapter.h), and what such a frame asks of a
// rival.
#ifndef SUREFILL_CERTIFY_ADAPTERS_FRAME_HPP
#define SUREFILL_CERTIFY_ADAPTERS_FRAME_HPP

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "certify/adapter.h"
#include "certify/adapter2.h"
#include "certify/rivals/wire.hpp"
#include "surefill/surefill.hpp"

namespace surefill::adapters {

// The model's place in every draw: its fill rule, unless the rival takes rules from the draws, and its grid likewise. A
// model that is not known leaves the draws as they are.
std::vector<Draw> under_model(std::span<const Draw> draws, const surefill_adapter_info& info);

// What is no feature of a header, and claimed by the primitives of version 2: bits after the features.
inline constexpr std::uint32_t kLines = 1u << 21, kPoints = 1u << 22;
inline constexpr int kFeatureBits = 23;

// The features that a frame needs, as bits of the adapter, and kLines and kPoints; and what they are called.
std::uint32_t needed_features(const Target& target, std::span<const Draw> draws);
const char* feature_name(int bit);

// Why this rival is not asked to draw this frame (a feature that it lacks, a limit), as a short sentence; empty if it
// is. `draws` are under its model.
std::string what_is_lacking(const Target& target, std::span<const Draw> draws, const surefill_adapter_info& info);

// What the clip form of a frame depends on.
struct ClipForm {
  std::uint32_t depth_range = SUREFILL_ADAPTER_ZERO_TO_ONE;
  std::uint32_t max_width = 0, max_height = 0;  // of the rival's targets; 0: no limit
  bool wide = true;                             // no viewport is an ordinary one
};
ClipForm clip_form(const surefill_adapter_info& info, bool wide);

// Parts of a target of this size, as programs have viewports: all of it, and others at odd places. A draw has one of these where all of
// its vertices lie in it and no float32 is rounded on the way from clip space, whoever computes it; else a wide one (frame.cpp).
std::array<Viewport, 3> ordinary_viewports(int width, int height);

// The frame in the adapter's form. The target's buffers are where the answer goes, directly. Target and draws are
// valid, and outlive this object.
class AdapterFrame {
 public:
  AdapterFrame(const Target& target, std::span<const Draw> draws, const ClipForm& form = {});
  AdapterFrame(const AdapterFrame&) = delete;
  AdapterFrame& operator=(const AdapterFrame&) = delete;

  surefill_adapter_scene& scene() { return scene_; }
  const surefill_adapter_scene& scene() const { return scene_; }
  const surefill_adapter_image& image() const { return image_; }
  const Primitives& primitives() const { return primitives_; }
  // As viewports are whose y is counted from the bottom row.
  void turn_viewports();

 private:
  struct Storage {
    std::vector<float> pixel, clip;
    std::vector<std::uint32_t> identifiers;
    std::vector<std::vector<float>> values;
    std::vector<surefill_adapter_attribute> attributes;
  };
  std::vector<Storage> storage_;
  std::vector<surefill_adapter_draw> draws_;
  Primitives primitives_;
  std::vector<float*> attribute_images_;
  surefill_adapter_scene scene_{};
  surefill_adapter_image image_{};
};

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_FRAME_HPP
