// SPDX-License-Identifier: Apache-2.0
//
// The shaders of certify/drivers/shaders as glslangValidator compiled them.
#ifndef SUREFILL_CERTIFY_DRIVERS_SPIRV_HPP
#define SUREFILL_CERTIFY_DRIVERS_SPIRV_HPP

#include <cstddef>
#include <cstdint>

namespace surefill::drivers {

namespace spirv {
#include "certify/drivers/count.inc"
#include "certify/drivers/samples_float.inc"
#include "certify/drivers/samples_uint.inc"
#include "certify/drivers/scene_0.inc"
#include "certify/drivers/scene_1.inc"
#include "certify/drivers/scene_2.inc"
#include "certify/drivers/scene_3.inc"
#include "certify/drivers/scene_4.inc"
#include "certify/drivers/unindexed_0.inc"
#include "certify/drivers/unindexed_1.inc"
#include "certify/drivers/unindexed_2.inc"
#include "certify/drivers/unindexed_3.inc"
#include "certify/drivers/unindexed_4.inc"
#include "certify/drivers/visible_0.inc"
#include "certify/drivers/visible_1.inc"
#include "certify/drivers/visible_2.inc"
#include "certify/drivers/visible_3.inc"
#include "certify/drivers/visible_4.inc"
}  // namespace spirv

struct Spirv {
  const std::uint32_t* code;
  std::size_t words;

  template <std::size_t kWords>
  constexpr Spirv(const std::uint32_t (&all)[kWords]) : code(all), words(kWords) {}
};

// By the number of attributes.
inline constexpr Spirv kSceneVertexSpirv[] = {spirv::scene_0, spirv::scene_1, spirv::scene_2, spirv::scene_3,
                                              spirv::scene_4};
inline constexpr Spirv kVisibleFragmentSpirv[] = {spirv::visible_0, spirv::visible_1, spirv::visible_2,
                                                  spirv::visible_3, spirv::visible_4};
inline constexpr Spirv kUnindexedFragmentSpirv[] = {spirv::unindexed_0, spirv::unindexed_1, spirv::unindexed_2,
                                                    spirv::unindexed_3, spirv::unindexed_4};
inline constexpr Spirv kCountFragmentSpirv = spirv::count;
// Of floats, of whole numbers.
inline constexpr Spirv kSamplesComputeSpirv[] = {spirv::samples_float, spirv::samples_uint};

}  // namespace surefill::drivers

#endif  // SUREFILL_CERTIFY_DRIVERS_SPIRV_HPP
