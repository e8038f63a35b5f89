// SPDX-License-Identifier: Apache-2.0
//
// A Vulkan device with one queue, and what is allocated on it: the part of the Vulkan adapter that knows nothing of
// scenes.
#ifndef SUREFILL_CERTIFY_DRIVERS_VULKAN_DEVICE_HPP
#define SUREFILL_CERTIFY_DRIVERS_VULKAN_DEVICE_HPP

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>

#include "certify/drivers/driver.hpp"

namespace surefill::drivers {

// Throws DriverError where a call did not succeed.
void check(VkResult result, const char* what);

// A structure of this type with all else zero.
template <typename Structure>
Structure make(VkStructureType type) {
  Structure structure{};
  structure.sType = type;
  return structure;
}

inline constexpr VkFormat kCountFormat = VK_FORMAT_R32_SFLOAT;
inline constexpr VkFormat kIndexFormat = VK_FORMAT_R32_UINT;
inline constexpr VkFormat kValueFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

struct Buffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  void* data = nullptr;
};

struct Image {
  VkFormat format{};
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  bool depth() const { return format == kDepthFormat; }
  VkImageAspectFlags aspect() const { return depth() ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT; }
  std::uint32_t components() const { return format == kValueFormat ? 4 : 1; }
};

class VulkanDevice {
 public:
  VulkanDevice(const VulkanDevice&) = delete;
  VulkanDevice& operator=(const VulkanDevice&) = delete;

 protected:
  // The first device with this text in its name. Throws NotJudged where there is none that serves.
  VulkanDevice(bool validation, const std::string& name);
  ~VulkanDevice();

  // The first thing that the validation layer said since the last call; empty if it said nothing.
  static std::string validation_message();

  // Makes the buffer at least so large, mapped for the host; what was in it is lost where it grows.
  void grow(Buffer& buffer, VkDeviceSize size, VkBufferUsageFlags usage);
  void free_buffer(Buffer& buffer);
  // To draw to, and to be read: by a copy, or by a shader where it has several samples a pixel.
  Image make_image(VkFormat format, std::uint32_t width, std::uint32_t height, VkSampleCountFlagBits samples);
  void free_image(const Image& image);

  // Between the two, `commands_` is recorded; the second ends when the device has done it all.
  void begin();
  void submit();

  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties_{};
  VkDevice device_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  bool wide_lines_ = false, large_points_ = false;

 private:
  void make_instance(bool validation);
  void choose_device(const std::string& name);
  void make_device();
  void destroy();
  VkDeviceMemory allocate(const VkMemoryRequirements& needed, VkMemoryPropertyFlags flags);

  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDeviceMemoryProperties memory_{};
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool command_pool_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
};

}  // namespace surefill::drivers

#endif  // SUREFILL_CERTIFY_DRIVERS_VULKAN_DEVICE_HPP
