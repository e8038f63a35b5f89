// SPDX-License-Identifier: Apache-2.0
//
// The adapter for Vulkan drivers: version 1.3, without a window. Arguments:
//   device=NAME     the first device with this text in its name (the same as the environment variable
//                   SUREFILL_VULKAN_DEVICE); without it, the first device
//   validation      the Khronos validation layer watches; what it says is a failure of the scene
//   viewport=target  the viewport of programs, at whose border drivers clip; otherwise it holds all vertices
//   claim=non-finite  NaN and infinities are drawn and judged, which no standard promises
//   fault=STATE     leaves a state wrong on purpose, for tests of the self-check: scissor, viewport, multisample,
//                   cull, blend, depth-range, front-face, depth-test; and invalid, for tests of the validation
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "certify/drivers/driver.hpp"
#include "certify/drivers/spirv.hpp"
#include "certify/drivers/vulkan_device.hpp"

namespace surefill::drivers {

namespace {

constexpr VkDeviceSize kAlignment = 256;  // of storage buffer offsets: no device asks for more

// Images to draw to, colours first, the depth last where there is one.
struct Framebuffer {
  std::vector<Image> images;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

std::string device_name(const Arguments& arguments) {
  // Each thread of certify has a process of its own; this is for lavapipe, and before it is loaded.
  ::setenv("LP_NUM_THREADS", "0", 0);
  const char* named = std::getenv("SUREFILL_VULKAN_DEVICE");
  return argument(arguments, "device", named ? named : "");
}

class Vulkan : public Driver, private VulkanDevice {
 public:
  explicit Vulkan(const Arguments& arguments)
      : VulkanDevice(arguments.count("validation") > 0, device_name(arguments)), fault_(argument(arguments, "fault")) {
    const std::string claim = argument(arguments, "claim");
    if (!claim.empty() && claim != "non-finite") throw NotJudged("argument claim=" + claim + ": there is non-finite");
    make_layouts();
    describe(!claim.empty());
  }

  ~Vulkan() override {
    vkDeviceWaitIdle(device_);
    clear_framebuffers();
    free_buffer(vertices_);
    free_buffer(words_);
    for (const auto& [key, pipeline] : pipelines_) vkDestroyPipeline(device_, pipeline, nullptr);
    for (const VkPipeline pipeline : samples_pipelines_) vkDestroyPipeline(device_, pipeline, nullptr);
    vkDestroyPipelineLayout(device_, layout_, nullptr);
    vkDestroyPipelineLayout(device_, samples_layout_, nullptr);
    vkDestroyDescriptorSetLayout(device_, set_layout_, nullptr);
    vkDestroyDescriptorPool(device_, descriptors_, nullptr);
    vkDestroySampler(device_, sampler_, nullptr);
  }

  surefill_adapter_info info() const override { return info_; }
  std::uint32_t primitives() const override { return 1u << SUREFILL_ADAPTER2_LINES | 1u << SUREFILL_ADAPTER2_POINTS; }

  void draw(const surefill_adapter_scene& scene, const Primitives& primitives,
            const surefill_adapter_image& image) override {
    check_primitives(scene, primitives);
    if (scene.samples > 1 &&
        std::find(sample_counts_.begin(), sample_counts_.end(), scene.samples) == sample_counts_.end()) {
      throw NotJudged(std::to_string(scene.samples) + " samples a pixel");
    }
    const std::uint32_t attributes = image.attributes ? scene.attribute_count : 0;
    const VertexStream stream = vertex_stream(scene, primitives, attributes > 0);
    put_vertices(stream);
    if (image.count) {
      const std::vector<std::vector<std::uint32_t>> planes = run(scene, stream, false, 0);
      for (std::size_t s = 0; s < planes[0].size(); ++s) {
        const auto quarters = static_cast<std::uint32_t>(std::lround(4 * std::bit_cast<float>(planes[0][s])));
        if (quarters % 4 != 0) throw NotJudged("a count that is no whole number: multisampling is on");
        image.count[s] = quarters / 4;
      }
    }
    if (asks_for_visible(image)) {
      const std::vector<std::vector<std::uint32_t>> planes = run(scene, stream, true, attributes);
      if (image.index) std::copy(planes[0].begin(), planes[0].end(), image.index);
      const float none =
          (scene.depth_test == SUREFILL_ADAPTER_GREATER ? -1.0f : 1.0f) * std::numeric_limits<float>::infinity();
      for (std::size_t s = 0; image.depth && s < planes[0].size(); ++s) {
        const bool empty = planes[0][s] == SUREFILL_ADAPTER_EMPTY;
        image.depth[s] = empty ? none : std::bit_cast<float>(planes.back()[s]);
      }
      const auto copy = [](const std::vector<std::uint32_t>& words, std::uint32_t components, float* to) {
        for (std::size_t s = 0; s < words.size() / 4; ++s) {
          for (std::uint32_t c = 0; c < components; ++c) {
            to[components * s + c] = std::bit_cast<float>(words[4 * s + c]);
          }
        }
      };
      if (image.barycentrics) copy(planes[1], 3, image.barycentrics);
      for (std::uint32_t k = 0; k < attributes; ++k) {
        const std::uint32_t components = scene.draw_count == 0 ? 0 : scene.draws[0].attributes[k].components;
        copy(planes[2 + std::size_t{k}], components, image.attributes[k]);
      }
    }
    const std::string said = validation_message();
    if (!said.empty()) throw Misuse("the validation layer says: " + said);
  }

 private:
  void make_layouts() {
    // The interpolation of attributes, and the size of points.
    VkPushConstantRange both[] = {{VK_SHADER_STAGE_FRAGMENT_BIT, 0, 16}, {VK_SHADER_STAGE_VERTEX_BIT, 16, 4}};
    VkPushConstantRange& modes = both[0];
    auto layout = make<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
    layout.pushConstantRangeCount = 2;
    layout.pPushConstantRanges = both;
    check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_), "vkCreatePipelineLayout");

    auto sampler = make<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    check(vkCreateSampler(device_, &sampler, nullptr, &sampler_), "vkCreateSampler");
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}};
    auto set = make<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    set.bindingCount = 2;
    set.pBindings = bindings;
    check(vkCreateDescriptorSetLayout(device_, &set, nullptr, &set_layout_), "vkCreateDescriptorSetLayout");
    constexpr std::uint32_t kSets = 3 + kMaxAttributes;
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSets},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSets}};
    auto pool = make<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool.maxSets = kSets;
    pool.poolSizeCount = 2;
    pool.pPoolSizes = sizes;
    check(vkCreateDescriptorPool(device_, &pool, nullptr, &descriptors_), "vkCreateDescriptorPool");
    modes.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    layout.pushConstantRangeCount = 1;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout_;
    check(vkCreatePipelineLayout(device_, &layout, nullptr, &samples_layout_), "vkCreatePipelineLayout");
  }

  void describe(bool non_finite) {
    set_text(info_.name, properties_.deviceName);
    auto driver = make<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto all = make<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    all.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical_, &all);
    const VkPhysicalDeviceLimits& limits = properties_.limits;
    std::string told(driver.driverInfo);
    told = told.substr(0, told.find(" ("));
    set_text(info_.version, "Vulkan, " + std::string(driver.driverName) + " " + told + ", subPixelPrecisionBits " +
                                std::to_string(limits.subPixelPrecisionBits));
    info_.outputs = SUREFILL_ADAPTER_COUNT | SUREFILL_ADAPTER_INDEX | SUREFILL_ADAPTER_DEPTH |
                    SUREFILL_ADAPTER_BARYCENTRICS | SUREFILL_ADAPTER_ATTRIBUTES;
    info_.features = SUREFILL_ADAPTER_BEHIND | SUREFILL_ADAPTER_DRAWS | SUREFILL_ADAPTER_CULL |
                     SUREFILL_ADAPTER_SCISSOR | SUREFILL_ADAPTER_DEPTH_CLIP | SUREFILL_ADAPTER_DEPTH_CLAMP |
                     SUREFILL_ADAPTER_DEPTH_GREATER | SUREFILL_ADAPTER_IDENTIFIERS | SUREFILL_ADAPTER_NOPERSPECTIVE |
                     SUREFILL_ADAPTER_FLAT;
    if (non_finite) info_.features |= SUREFILL_ADAPTER_NON_FINITE;
    if (wide_lines_ && large_points_) info_.features |= static_cast<std::uint32_t>(SUREFILL_ADAPTER2_WIDTHS);
    info_.form = SUREFILL_ADAPTER_FORM_CLIP;
    info_.model.kind = SUREFILL_ADAPTER_MODEL_UNKNOWN;
    info_.model.grid_bits = std::min(limits.subPixelPrecisionBits, 12u);
    info_.model.profile = SUREFILL_ADAPTER_PROFILE_VULKAN;
    info_.model.y = SUREFILL_ADAPTER_Y_DOWN;
    info_.model.depth_range = SUREFILL_ADAPTER_ZERO_TO_ONE;
    const std::uint32_t most =
        std::min({limits.maxImageDimension2D, limits.maxFramebufferWidth, limits.maxFramebufferHeight,
                  limits.maxViewportDimensions[0], limits.maxViewportDimensions[1]});
    // The viewport is a power of two.
    info_.max_width = info_.max_height = std::bit_floor(most);
    info_.max_attributes = std::min<std::uint32_t>(kMaxAttributes, limits.maxColorAttachments - 2);
    info_.max_components = 4;
    if (!limits.standardSampleLocations) return;
    auto limits12 = make<VkPhysicalDeviceVulkan12Properties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES);
    all.pNext = &limits12;
    vkGetPhysicalDeviceProperties2(physical_, &all);
    integer_sample_counts_ = limits12.framebufferIntegerColorSampleCounts & limits.sampledImageIntegerSampleCounts;
    const VkSampleCountFlags counts = limits.framebufferColorSampleCounts & limits.framebufferDepthSampleCounts &
                                      limits.sampledImageColorSampleCounts & limits.sampledImageDepthSampleCounts;
    for (std::uint32_t samples = 2; samples <= 16; samples *= 2) {
      if (counts & samples) sample_counts_.push_back(samples);
    }
    if (!sample_counts_.empty()) info_.features |= SUREFILL_ADAPTER_SAMPLES;
  }

  // With several samples a pixel, or widths that the device has none of, nobody judges lines and points.
  void check_primitives(const surefill_adapter_scene& scene, const Primitives& primitives) const {
    const VkPhysicalDeviceLimits& limits = properties_.limits;
    for (const PrimitiveOf& primitive : primitives) {
      if (primitive.kind == SUREFILL_ADAPTER2_TRIANGLES) continue;
      if (scene.samples > 1) throw NotJudged("lines and points with several samples a pixel");
      const bool lines = primitive.kind == SUREFILL_ADAPTER2_LINES;
      const float* range = lines ? limits.lineWidthRange : limits.pointSizeRange;
      const float width = primitive.pixels();
      const bool one = width == 1 || (lines ? wide_lines_ : large_points_);
      if (!one || !(width >= range[0] && width <= range[1])) throw NotJudged("a width beyond the device's range");
    }
  }

  // --- memory ---

  void put_vertices(const VertexStream& stream) {
    grow(vertices_, stream.words.size() * 4, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    std::copy(stream.words.begin(), stream.words.end(), static_cast<std::uint32_t*>(vertices_.data));
  }

  void clear_framebuffers() {
    for (const auto& [shape, framebuffer] : framebuffers_) {
      for (const Image& image : framebuffer.images) free_image(image);
    }
    framebuffers_.clear();
  }

  // The framebuffer of the last scene serves the next one of its shape.
  const Framebuffer& framebuffer_for(const surefill_adapter_scene& scene, bool visible, std::uint32_t attributes,
                                     std::uint32_t samples) {
    const std::array<std::uint32_t, 4> shape{scene.width, scene.height, samples, visible ? 1 + attributes : 0};
    const auto found = framebuffers_.find(shape);
    if (found != framebuffers_.end()) return found->second;
    if (framebuffers_.size() >= kMostFramebuffers || scene.width * std::uint64_t{scene.height} > kLargePixels) {
      clear_framebuffers();
    }
    Framebuffer& made = framebuffers_[shape];  // whose images are destroyed with it, however many there will be
    made.samples = static_cast<VkSampleCountFlagBits>(samples);
    const auto add = [&](VkFormat format) {
      made.images.push_back(make_image(format, scene.width, scene.height, made.samples));
    };
    try {
      if (!visible) add(kCountFormat);
      if (visible && shows_index(samples)) add(kIndexFormat);
      if (visible) {
        for (std::uint32_t n = 0; n < 1 + attributes; ++n) add(kValueFormat);
        add(kDepthFormat);
      }
    } catch (...) {
      clear_framebuffers();
      throw;
    }
    return made;
  }

  // Some drivers have no multisampled images of whole numbers to draw to. Then the identifier, plus one, is the fourth
  // component of the barycentrics.
  bool shows_index(std::uint32_t samples) const { return samples == 1 || (integer_sample_counts_ & samples) != 0; }

  // --- pipelines ---

  VkShaderModule module(const Spirv& code) {
    auto create = make<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
    create.codeSize = code.words * 4;
    create.pCode = code.code;
    VkShaderModule shader = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device_, &create, nullptr, &shader), "vkCreateShaderModule");
    return shader;
  }

  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, VkShaderModule shader) {
    auto create = make<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    create.stage = which;
    create.module = shader;
    create.pName = "main";
    return create;
  }

  VkPipeline pipeline_for(bool visible, std::uint32_t attributes, std::uint32_t stride, VkSampleCountFlagBits samples,
                          bool clamp, std::uint32_t primitive) {
    VkPipeline& pipeline = pipelines_[{visible ? 1u : 0u, attributes, stride, samples, clamp ? 1u : 0u, primitive}];
    if (pipeline != VK_NULL_HANDLE) return pipeline;
    const VkShaderModule vertex = module(kSceneVertexSpirv[attributes]);
    const VkShaderModule fragment = module(!visible               ? kCountFragmentSpirv
                                           : shows_index(samples) ? kVisibleFragmentSpirv[attributes]
                                                                  : kUnindexedFragmentSpirv[attributes]);
    const VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                                                      stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
    const VkVertexInputBindingDescription binding{0, stride * 4, VK_VERTEX_INPUT_RATE_VERTEX};
    std::vector<VkVertexInputAttributeDescription> inputs{
        {0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0}, {1, 0, VK_FORMAT_R32_UINT, 16}, {2, 0, VK_FORMAT_R32_UINT, 20}};
    for (std::uint32_t k = 0; k < attributes; ++k) {
      inputs.push_back({3 + k, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 24 + 16 * k});
    }
    auto input = make<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &binding;
    input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(inputs.size());
    input.pVertexAttributeDescriptions = inputs.data();
    auto assembly =
        make<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
    constexpr VkPrimitiveTopology kTopologies[] = {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_LINE_LIST,
                                                   VK_PRIMITIVE_TOPOLOGY_POINT_LIST};
    assembly.topology = kTopologies[primitive];
    auto viewport = make<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
    viewport.viewportCount = viewport.scissorCount = 1;
    auto raster =
        make<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
    raster.depthClampEnable = clamp ? VK_TRUE : VK_FALSE;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.lineWidth = 1;
    auto multisample =
        make<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
    multisample.rasterizationSamples = samples;
    auto depth =
        make<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
    VkPipelineColorBlendAttachmentState target{};
    target.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    target.blendEnable = !visible && fault_ != "blend" ? VK_TRUE : VK_FALSE;
    target.srcColorBlendFactor = target.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    target.srcAlphaBlendFactor = target.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    std::vector<VkFormat> formats(1, visible ? kIndexFormat : kCountFormat);
    if (visible) formats.resize(2 + attributes, kValueFormat);
    if (visible && !shows_index(samples)) formats.erase(formats.begin());
    const std::vector<VkPipelineColorBlendAttachmentState> targets(formats.size(), target);
    auto blend = make<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
    blend.attachmentCount = static_cast<std::uint32_t>(targets.size());
    blend.pAttachments = targets.data();
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT,          VK_DYNAMIC_STATE_SCISSOR,
                                     VK_DYNAMIC_STATE_CULL_MODE,         VK_DYNAMIC_STATE_FRONT_FACE,
                                     VK_DYNAMIC_STATE_DEPTH_TEST_ENABLE, VK_DYNAMIC_STATE_DEPTH_WRITE_ENABLE,
                                     VK_DYNAMIC_STATE_DEPTH_COMPARE_OP,  VK_DYNAMIC_STATE_LINE_WIDTH};
    auto dynamic = make<VkPipelineDynamicStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO);
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(std::size(states));
    dynamic.pDynamicStates = states;
    auto rendering = make<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(formats.size());
    rendering.pColorAttachmentFormats = formats.data();
    rendering.depthAttachmentFormat = visible ? kDepthFormat : VK_FORMAT_UNDEFINED;
    auto create = make<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
    create.pNext = &rendering;
    create.stageCount = 2;
    create.pStages = stages;
    create.pVertexInputState = &input;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &raster;
    create.pMultisampleState = &multisample;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &blend;
    create.pDynamicState = &dynamic;
    create.layout = layout_;
    check(vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &create, nullptr, &pipeline),
          "vkCreateGraphicsPipelines");
    vkDestroyShaderModule(device_, vertex, nullptr);
    vkDestroyShaderModule(device_, fragment, nullptr);
    return pipeline;
  }

  VkPipeline samples_pipeline(bool whole_numbers) {
    VkPipeline& pipeline = samples_pipelines_[whole_numbers ? 1 : 0];
    if (pipeline != VK_NULL_HANDLE) return pipeline;
    const VkShaderModule shader = module(kSamplesComputeSpirv[whole_numbers ? 1 : 0]);
    auto create = make<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
    create.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, shader);
    create.layout = samples_layout_;
    check(vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &create, nullptr, &pipeline),
          "vkCreateComputePipelines");
    vkDestroyShaderModule(device_, shader, nullptr);
    return pipeline;
  }

  // --- drawing ---

  void barrier(VkPipelineStageFlags2 after, VkAccessFlags2 written, VkPipelineStageFlags2 before, VkAccessFlags2 used,
               const Framebuffer* fresh = nullptr) {
    auto memory = make<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    memory.srcStageMask = after;
    memory.srcAccessMask = written;
    memory.dstStageMask = before;
    memory.dstAccessMask = used;
    std::vector<VkImageMemoryBarrier2> images;
    for (std::size_t n = 0; fresh && n < fresh->images.size(); ++n) {
      auto image = make<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
      image.srcStageMask = after;
      image.srcAccessMask = written;
      image.dstStageMask = before;
      image.dstAccessMask = used;
      image.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
      image.newLayout = VK_IMAGE_LAYOUT_GENERAL;
      image.srcQueueFamilyIndex = image.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      image.image = fresh->images[n].image;
      image.subresourceRange = {fresh->images[n].aspect(), 0, 1, 0, 1};
      images.push_back(image);
    }
    auto dependency = make<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = fresh ? 0 : 1;
    dependency.pMemoryBarriers = &memory;
    dependency.imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size());
    dependency.pImageMemoryBarriers = images.data();
    vkCmdPipelineBarrier2(commands_, &dependency);
  }

  void set_state(const surefill_adapter_scene& scene, const surefill_adapter_draw& draw, bool visible) {
    // Clip y is up, as S3 has it: the viewport is turned over.
    VkViewport viewport{
        draw.viewport_x, draw.viewport_y + draw.viewport_height, draw.viewport_width, -draw.viewport_height, 0, 1};
    VkRect2D scissor{{0, 0}, {scene.width, scene.height}};
    if (draw.has_scissor) {
      const auto width = static_cast<std::int32_t>(scene.width), height = static_cast<std::int32_t>(scene.height);
      const std::int32_t x0 = std::clamp(draw.scissor[0], 0, width), y0 = std::clamp(draw.scissor[1], 0, height);
      const std::int32_t x1 = std::clamp(draw.scissor[2], 0, width), y1 = std::clamp(draw.scissor[3], 0, height);
      scissor = {{x0, y0},
                 {static_cast<std::uint32_t>(std::max(x1 - x0, 0)), static_cast<std::uint32_t>(std::max(y1 - y0, 0))}};
    }
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
    if (draw.cull == SUREFILL_ADAPTER_CULL_BACK) cull = VK_CULL_MODE_BACK_BIT;
    if (draw.cull == SUREFILL_ADAPTER_CULL_FRONT) cull = VK_CULL_MODE_FRONT_BIT;
    bool clockwise = draw.front_face == SUREFILL_ADAPTER_CLOCKWISE, depth_test = visible;
    if (fault_ == "scissor") scissor.extent.width = scene.width - 1;
    if (fault_ == "invalid") scissor.offset.x = -1;
    if (fault_ == "viewport") viewport.x += 1;
    if (fault_ == "cull") cull = VK_CULL_MODE_BACK_BIT;
    if (fault_ == "depth-range") viewport.maxDepth = 0.5f;
    if (fault_ == "front-face") clockwise = !clockwise;
    if (fault_ == "depth-test") depth_test = false;
    vkCmdSetViewport(commands_, 0, 1, &viewport);
    vkCmdSetScissor(commands_, 0, 1, &scissor);
    vkCmdSetCullMode(commands_, cull);
    vkCmdSetFrontFace(commands_, clockwise ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
    vkCmdSetDepthTestEnable(commands_, depth_test ? VK_TRUE : VK_FALSE);
    vkCmdSetDepthWriteEnable(commands_, depth_test ? VK_TRUE : VK_FALSE);
    vkCmdSetDepthCompareOp(commands_, scene.depth_test == SUREFILL_ADAPTER_GREATER ? VK_COMPARE_OP_GREATER_OR_EQUAL
                                                                                   : VK_COMPARE_OP_LESS_OR_EQUAL);
  }

  void render(const surefill_adapter_scene& scene, const VertexStream& stream, bool visible, std::uint32_t attributes,
              const Framebuffer& framebuffer, const Framebuffer* resolved) {
    std::vector<VkRenderingAttachmentInfo> attachments;
    for (const Image& image : framebuffer.images) {
      auto attachment = make<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
      attachment.imageView = image.view;
      attachment.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
      attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
      if (image.format == kIndexFormat) attachment.clearValue.color.uint32[0] = SUREFILL_ADAPTER_EMPTY;
      if (image.depth()) {
        attachment.clearValue.depthStencil.depth = scene.depth_test == SUREFILL_ADAPTER_GREATER ? 0.0f : 1.0f;
      }
      if (resolved) {
        attachment.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
        attachment.resolveImageView = resolved->images[0].view;
        attachment.resolveImageLayout = VK_IMAGE_LAYOUT_GENERAL;
      }
      attachments.push_back(attachment);
    }
    auto rendering = make<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    rendering.renderArea = {{0, 0}, {scene.width, scene.height}};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(attachments.size()) - (visible ? 1 : 0);
    rendering.pColorAttachments = attachments.data();
    rendering.pDepthAttachment = visible ? &attachments.back() : nullptr;
    vkCmdBeginRendering(commands_, &rendering);
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(commands_, 0, 1, &vertices_.buffer, &start);
    for (const DrawRange& batch : stream.batches) {
      if (batch.count == 0) continue;
      const bool clamp = batch.draw->depth_mode != SUREFILL_ADAPTER_CLIP_DEPTH;
      vkCmdBindPipeline(
          commands_, VK_PIPELINE_BIND_POINT_GRAPHICS,
          pipeline_for(visible, attributes, stream.stride, framebuffer.samples, clamp, batch.primitive.kind));
      const bool lines = batch.primitive.kind == SUREFILL_ADAPTER2_LINES;
      const float line_width = lines ? batch.primitive.pixels() : 1, point_size = lines ? 1 : batch.primitive.pixels();
      vkCmdSetLineWidth(commands_, line_width);
      vkCmdPushConstants(commands_, layout_, VK_SHADER_STAGE_VERTEX_BIT, 16, 4, &point_size);
      set_state(scene, *batch.draw, visible);
      vkCmdPushConstants(commands_, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, 16, batch.interpolation.data());
      vkCmdDraw(commands_, batch.count, 1, batch.first, 0);
    }
    vkCmdEndRendering(commands_);
  }

  // From each image to the words, at these offsets.
  void read_back(const surefill_adapter_scene& scene, const Framebuffer& framebuffer,
                 const std::vector<VkDeviceSize>& offsets) {
    for (std::size_t n = 0; n < framebuffer.images.size(); ++n) {
      const Image& image = framebuffer.images[n];
      if (framebuffer.samples == VK_SAMPLE_COUNT_1_BIT) {
        VkBufferImageCopy copy{};
        copy.bufferOffset = offsets[n];
        copy.imageSubresource = {image.aspect(), 0, 0, 1};
        copy.imageExtent = {scene.width, scene.height, 1};
        vkCmdCopyImageToBuffer(commands_, image.image, VK_IMAGE_LAYOUT_GENERAL, words_.buffer, 1, &copy);
        continue;
      }
      auto allocate = make<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
      allocate.descriptorPool = descriptors_;
      allocate.descriptorSetCount = 1;
      allocate.pSetLayouts = &set_layout_;
      VkDescriptorSet set = VK_NULL_HANDLE;
      check(vkAllocateDescriptorSets(device_, &allocate, &set), "vkAllocateDescriptorSets");
      const VkDescriptorImageInfo from{sampler_, image.view, VK_IMAGE_LAYOUT_GENERAL};
      const VkDescriptorBufferInfo to{words_.buffer, offsets[n], offsets[n + 1] - offsets[n]};
      auto source = make<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
      source.dstSet = set;
      source.descriptorCount = 1;
      source.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
      source.pImageInfo = &from;
      VkWriteDescriptorSet target = source;
      target.dstBinding = 1;
      target.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
      target.pImageInfo = nullptr;
      target.pBufferInfo = &to;
      const VkWriteDescriptorSet writes[] = {source, target};
      vkUpdateDescriptorSets(device_, 2, writes, 0, nullptr);
      vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, samples_pipeline(image.format == kIndexFormat));
      vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, samples_layout_, 0, 1, &set, 0, nullptr);
      const std::int32_t sizes[] = {static_cast<std::int32_t>(scene.width), static_cast<std::int32_t>(scene.height),
                                    static_cast<std::int32_t>(scene.samples),
                                    static_cast<std::int32_t>(image.components())};
      vkCmdPushConstants(commands_, samples_layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof sizes, sizes);
      vkCmdDispatch(commands_, (scene.width + 7) / 8, (scene.height + 7) / 8, 1);
    }
  }

  // Draws all, and gives the words of each image: the count, or index, barycentrics, attributes and depth.
  std::vector<std::vector<std::uint32_t>> run(const surefill_adapter_scene& scene, const VertexStream& stream,
                                              bool visible, std::uint32_t attributes) {
    const bool resolve = !visible && fault_ == "multisample";
    if (resolve) clear_framebuffers();  // so that neither of the two makes room for the other
    const Framebuffer& drawn = framebuffer_for(scene, visible, attributes, resolve ? 4 : scene.samples);
    const Framebuffer& shown = resolve ? framebuffer_for(scene, visible, attributes, 1) : drawn;
    const std::size_t samples = std::size_t{scene.width} * scene.height * scene.samples;
    std::vector<VkDeviceSize> offsets{0};
    for (const Image& image : shown.images) {
      const VkDeviceSize end = offsets.back() + samples * image.components() * 4;
      offsets.push_back((end + kAlignment - 1) / kAlignment * kAlignment);
    }
    grow(words_, offsets.back(), VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);

    check(vkResetDescriptorPool(device_, descriptors_, 0), "vkResetDescriptorPool");
    begin();
    constexpr VkPipelineStageFlags2 kAll = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    constexpr VkAccessFlags2 kBoth = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier(kAll, kBoth, kAll, kBoth, &drawn);
    if (resolve) barrier(kAll, kBoth, kAll, kBoth, &shown);
    render(scene, stream, visible, attributes, drawn, resolve ? &shown : nullptr);
    barrier(kAll, VK_ACCESS_2_MEMORY_WRITE_BIT, kAll, kBoth);
    read_back(scene, shown, offsets);
    barrier(kAll, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    submit();

    std::vector<std::vector<std::uint32_t>> planes;
    for (std::size_t n = 0; n < shown.images.size(); ++n) {
      const auto* first = static_cast<const std::uint32_t*>(words_.data) + offsets[n] / 4;
      planes.emplace_back(first, first + samples * shown.images[n].components());
    }
    if (visible && !shows_index(scene.samples)) planes.insert(planes.begin(), index_of(scene, planes[0]));
    return planes;
  }

  static std::vector<std::uint32_t> index_of(const surefill_adapter_scene& scene,
                                             const std::vector<std::uint32_t>& barycentrics) {
    constexpr std::uint32_t kExact = 1u << 24;
    for (std::uint32_t d = 0; d < scene.draw_count; ++d) {
      const surefill_adapter_draw& draw = scene.draws[d];
      for (std::uint32_t t = 0; t < draw.triangle_count; ++t) {
        if (draw.identifiers[t] >= kExact) throw NotJudged("identifiers of 2^24 and more with several samples a pixel");
      }
    }
    std::vector<std::uint32_t> index(barycentrics.size() / 4);
    for (std::size_t s = 0; s < index.size(); ++s) {
      index[s] = static_cast<std::uint32_t>(std::bit_cast<float>(barycentrics[4 * s + 3])) - 1;  // none is 0xFFFFFFFF
    }
    return index;
  }

  static constexpr std::size_t kMostFramebuffers = 32;
  static constexpr std::uint64_t kLargePixels = 1 << 16;

  std::string fault_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE, samples_layout_ = VK_NULL_HANDLE;
  std::map<std::array<std::uint32_t, 6>, VkPipeline> pipelines_;
  std::array<VkPipeline, 2> samples_pipelines_{};
  std::map<std::array<std::uint32_t, 4>, Framebuffer> framebuffers_;
  Buffer vertices_, words_;
  std::vector<std::uint32_t> sample_counts_;
  VkSampleCountFlags integer_sample_counts_ = 0;
  surefill_adapter_info info_{};
};

}  // namespace

std::unique_ptr<Driver> open_driver(const Arguments& arguments) {
  check_keys(arguments, {"device", "validation", "claim", "fault"});
  const std::vector<std::string> faults{"",      "scissor",     "viewport",   "multisample", "cull",
                                        "blend", "depth-range", "front-face", "depth-test",  "invalid"};
  const std::string fault = argument(arguments, "fault");
  if (std::find(faults.begin(), faults.end(), fault) == faults.end()) {
    throw NotJudged("argument fault=" + fault + ": no such fault");
  }
  return std::make_unique<Vulkan>(arguments);
}

}  // namespace surefill::drivers
