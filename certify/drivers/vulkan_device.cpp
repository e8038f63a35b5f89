// SPDX-License-Identifier: Apache-2.0
#include "certify/drivers/vulkan_device.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

namespace surefill::drivers {

namespace {

std::string said_by_validation;

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
  if (said_by_validation.empty()) said_by_validation = data->pMessage;
  return VK_FALSE;
}

}  // namespace

void check(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  throw DriverError(std::string("Vulkan: ") + what + " returned " + std::to_string(result));
}

VulkanDevice::VulkanDevice(bool validation, const std::string& name) {
  try {
    make_instance(validation);
    choose_device(name);
    make_device();
  } catch (...) {
    destroy();
    throw;
  }
}

VulkanDevice::~VulkanDevice() {
  destroy();
}

void VulkanDevice::destroy() {
  if (device_ != VK_NULL_HANDLE) {
    vkDestroyFence(device_, fence_, nullptr);
    vkDestroyCommandPool(device_, command_pool_, nullptr);
    vkDestroyDevice(device_, nullptr);
  }
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy_messenger(instance_, messenger_, nullptr);
  }
  if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

std::string VulkanDevice::validation_message() {
  return std::exchange(said_by_validation, "");
}

void VulkanDevice::make_instance(bool validation) {
  auto application = make<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  application.pApplicationName = "surefill";
  application.apiVersion = VK_API_VERSION_1_3;
  auto create = make<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  create.pApplicationInfo = &application;
  const char* layer = "VK_LAYER_KHRONOS_validation";
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  if (validation) {
    create.enabledLayerCount = create.enabledExtensionCount = 1;
    create.ppEnabledLayerNames = &layer;
    create.ppEnabledExtensionNames = &extension;
  }
  const VkResult result = vkCreateInstance(&create, nullptr, &instance_);
  if (result == VK_ERROR_LAYER_NOT_PRESENT) throw NotJudged("the Khronos validation layer is not installed");
  if (result != VK_SUCCESS) throw NotJudged("there is no Vulkan driver");
  if (!validation) return;
  auto messages = make<VkDebugUtilsMessengerCreateInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
  messages.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messages.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  messages.pfnUserCallback = on_message;
  const auto create_messenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
  check(create_messenger(instance_, &messages, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
}

void VulkanDevice::choose_device(const std::string& name) {
  std::uint32_t count = 0;
  vkEnumeratePhysicalDevices(instance_, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  vkEnumeratePhysicalDevices(instance_, &count, devices.data());
  std::string names;
  for (const VkPhysicalDevice device : devices) {
    vkGetPhysicalDeviceProperties(device, &properties_);
    names += (names.empty() ? "" : ", ") + std::string(properties_.deviceName);
    if (std::string(properties_.deviceName).find(name) == std::string::npos) continue;
    if (properties_.apiVersion < VK_API_VERSION_1_3) {
      throw NotJudged(std::string(properties_.deviceName) + " has no Vulkan 1.3");
    }
    physical_ = device;
    return;
  }
  throw NotJudged("there is no Vulkan device \"" + name + "\"; there are: " + (names.empty() ? "none" : names));
}

void VulkanDevice::make_device() {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  std::uint32_t family = 0;
  while (family < count && (families[family].queueFlags & kNeeded) != kNeeded) ++family;
  if (family == count) throw NotJudged("the device has no queue for graphics and compute");

  auto has13 = make<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  auto has = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  has.pNext = &has13;
  vkGetPhysicalDeviceFeatures2(physical_, &has);
  VkFormatProperties count_format{};
  vkGetPhysicalDeviceFormatProperties(physical_, kCountFormat, &count_format);
  if (!has13.dynamicRendering || !has13.synchronization2 || !has.features.depthClamp ||
      !(count_format.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT)) {
    throw NotJudged("the device lacks depth clamping or blending of 32-bit floats");
  }
  auto use13 = make<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  use13.dynamicRendering = use13.synchronization2 = VK_TRUE;
  auto use = make<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  use.pNext = &use13;
  use.features.depthClamp = VK_TRUE;
  use.features.independentBlend = has.features.independentBlend;
  use.features.wideLines = has.features.wideLines;
  use.features.largePoints = has.features.largePoints;
  wide_lines_ = has.features.wideLines == VK_TRUE;
  large_points_ = has.features.largePoints == VK_TRUE;
  const float priority = 1;
  auto queue = make<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queue.queueFamilyIndex = family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  auto create = make<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  create.pNext = &use;
  create.queueCreateInfoCount = 1;
  create.pQueueCreateInfos = &queue;
  check(vkCreateDevice(physical_, &create, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, family, 0, &queue_);
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);

  auto pool = make<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = family;
  check(vkCreateCommandPool(device_, &pool, nullptr, &command_pool_), "vkCreateCommandPool");
  auto allocate = make<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  allocate.commandPool = command_pool_;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(device_, &allocate, &commands_), "vkAllocateCommandBuffers");
  const auto fence = make<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
  check(vkCreateFence(device_, &fence, nullptr, &fence_), "vkCreateFence");
}

VkDeviceMemory VulkanDevice::allocate(const VkMemoryRequirements& needed, VkMemoryPropertyFlags flags) {
  for (std::uint32_t type = 0; type < memory_.memoryTypeCount; ++type) {
    if (!(needed.memoryTypeBits >> type & 1u)) continue;
    if ((memory_.memoryTypes[type].propertyFlags & flags) != flags) continue;
    auto allocate = make<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocate.allocationSize = needed.size;
    allocate.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    if (vkAllocateMemory(device_, &allocate, nullptr, &memory) != VK_SUCCESS) break;
    return memory;
  }
  throw NotJudged("the device has too little memory for this target");
}

void VulkanDevice::free_buffer(Buffer& buffer) {
  if (buffer.buffer == VK_NULL_HANDLE) return;
  vkDestroyBuffer(device_, buffer.buffer, nullptr);
  vkFreeMemory(device_, buffer.memory, nullptr);
  buffer = {};
}

void VulkanDevice::grow(Buffer& buffer, VkDeviceSize size, VkBufferUsageFlags usage) {
  if (buffer.size >= size && buffer.size > 0) return;
  free_buffer(buffer);
  auto create = make<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  create.size = std::bit_ceil(std::max<VkDeviceSize>(size, 4096));
  create.usage = usage;
  check(vkCreateBuffer(device_, &create, nullptr, &buffer.buffer), "vkCreateBuffer");
  VkMemoryRequirements needed{};
  vkGetBufferMemoryRequirements(device_, buffer.buffer, &needed);
  buffer.memory = allocate(needed, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  check(vkBindBufferMemory(device_, buffer.buffer, buffer.memory, 0), "vkBindBufferMemory");
  check(vkMapMemory(device_, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.data), "vkMapMemory");
  buffer.size = create.size;
}

Image VulkanDevice::make_image(VkFormat format, std::uint32_t width, std::uint32_t height,
                               VkSampleCountFlagBits samples) {
  Image image;
  image.format = format;
  auto create = make<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  create.imageType = VK_IMAGE_TYPE_2D;
  create.format = format;
  create.extent = {width, height, 1};
  create.mipLevels = create.arrayLayers = 1;
  create.samples = samples;
  create.usage = image.depth() ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  create.usage |= samples == VK_SAMPLE_COUNT_1_BIT ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : VK_IMAGE_USAGE_SAMPLED_BIT;
  if (vkCreateImage(device_, &create, nullptr, &image.image) != VK_SUCCESS) {
    throw NotJudged("the device has no images of this size");
  }
  VkMemoryRequirements needed{};
  vkGetImageMemoryRequirements(device_, image.image, &needed);
  try {
    image.memory = allocate(needed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  } catch (...) {
    vkDestroyImage(device_, image.image, nullptr);
    throw;
  }
  check(vkBindImageMemory(device_, image.image, image.memory, 0), "vkBindImageMemory");
  auto view = make<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  view.image = image.image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {image.aspect(), 0, 1, 0, 1};
  check(vkCreateImageView(device_, &view, nullptr, &image.view), "vkCreateImageView");
  return image;
}

void VulkanDevice::free_image(const Image& image) {
  vkDestroyImageView(device_, image.view, nullptr);
  vkDestroyImage(device_, image.image, nullptr);
  vkFreeMemory(device_, image.memory, nullptr);
}

void VulkanDevice::begin() {
  check(vkResetCommandBuffer(commands_, 0), "vkResetCommandBuffer");
  auto start = make<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  start.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands_, &start), "vkBeginCommandBuffer");
}

void VulkanDevice::submit() {
  check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
  auto work = make<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
  work.commandBufferCount = 1;
  work.pCommandBuffers = &commands_;
  check(vkQueueSubmit(queue_, 1, &work, fence_), "vkQueueSubmit");
  check(vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device_, 1, &fence_), "vkResetFences");
}

}  // namespace surefill::drivers
