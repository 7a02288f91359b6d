#include "tests/walk/engine_pipeline.h"

#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

void check(VkResult result, const char* call) { EXPECT_EQ(result, VK_SUCCESS) << call; }

VkShaderModule createModule(std::span<const uint32_t> spirv) {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = spirv.size_bytes();
  info.pCode = spirv.data();
  VkShaderModule made = VK_NULL_HANDLE;
  check(vkCreateShaderModule(sharedHost().device, &info, nullptr, &made), "vkCreateShaderModule");
  return made;
}

VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule shader) {
  VkPipelineShaderStageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage = stage;
  info.module = shader;
  info.pName = "main";
  return info;
}

}  // namespace

EnginePipeline::EnginePipeline(FrothContext* context, VkShaderStageFlags stages, uint32_t constantBytes)
    : stages_(stages), constantBytes_(constantBytes) {
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
  EXPECT_EQ(frothGetWalkSetLayout(context, &setLayout), FROTH_OK);
  const VkPushConstantRange range{stages, 0, constantBytes};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &setLayout;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(sharedHost().device, &info, nullptr, &layout_), "vkCreatePipelineLayout");
}

EnginePipeline::~EnginePipeline() {
  const VkDevice device = sharedHost().device;
  vkDestroyPipeline(device, pipeline_, nullptr);
  vkDestroyPipelineLayout(device, layout_, nullptr);
  vkDestroyFramebuffer(device, framebuffer_, nullptr);
  vkDestroyRenderPass(device, renderPass_, nullptr);
  if (picture_.image) sharedHost().destroyImage(picture_);
}

EnginePipeline::EnginePipeline(FrothContext* context, std::span<const uint32_t> computeSpirv, uint32_t constantBytes,
                               FrothRayPreparation prepared)
    : EnginePipeline(context, VK_SHADER_STAGE_COMPUTE_BIT, constantBytes) {
  const VkShaderModule shader = createModule(computeSpirv);
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage = stageOf(VK_SHADER_STAGE_COMPUTE_BIT, shader);
  const VkSpecializationMapEntry entry{0, 0, sizeof(prepared)};
  const VkSpecializationInfo specialization{1, &entry, sizeof(prepared), &prepared};
  info.stage.pSpecializationInfo = &specialization;
  info.layout = layout_;
  const VkDevice device = sharedHost().device;
  check(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_), "vkCreateComputePipelines");
  vkDestroyShaderModule(device, shader, nullptr);
}

EnginePipeline::EnginePipeline(FrothContext* context, std::span<const uint32_t> vertexSpirv,
                               std::span<const uint32_t> fragmentSpirv, uint32_t constantBytes, VkExtent2D extent)
    : EnginePipeline(context, VK_SHADER_STAGE_FRAGMENT_BIT, constantBytes) {
  createPicture(extent);
  createRenderPass();
  createGraphicsPipeline(vertexSpirv, fragmentSpirv);
}

void EnginePipeline::createPicture(VkExtent2D extent) {
  Host& host = sharedHost();
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  check(vkCreateImage(host.device, &info, nullptr, &picture_.image), "vkCreateImage");
  VkMemoryRequirements requirements{};
  vkGetImageMemoryRequirements(host.device, picture_.image, &requirements);
  VkMemoryAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocation.allocationSize = requirements.size;
  while ((requirements.memoryTypeBits >> allocation.memoryTypeIndex & 1) == 0) ++allocation.memoryTypeIndex;
  check(vkAllocateMemory(host.device, &allocation, nullptr, &picture_.memory), "vkAllocateMemory");
  check(vkBindImageMemory(host.device, picture_.image, picture_.memory, 0), "vkBindImageMemory");
  VkImageViewCreateInfo viewInfo{};
  viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  viewInfo.image = picture_.image;
  viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
  viewInfo.format = info.format;
  viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  check(vkCreateImageView(host.device, &viewInfo, nullptr, &picture_.view), "vkCreateImageView");
  picture_.format = info.format;
  picture_.extent = extent;
}

void EnginePipeline::createRenderPass() {
  VkAttachmentDescription attachment{};
  attachment.format = picture_.format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  const VkDevice device = sharedHost().device;
  check(vkCreateRenderPass(device, &info, nullptr, &renderPass_), "vkCreateRenderPass");
  VkFramebufferCreateInfo frameInfo{};
  frameInfo.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
  frameInfo.renderPass = renderPass_;
  frameInfo.attachmentCount = 1;
  frameInfo.pAttachments = &picture_.view;
  frameInfo.width = picture_.extent.width;
  frameInfo.height = picture_.extent.height;
  frameInfo.layers = 1;
  check(vkCreateFramebuffer(device, &frameInfo, nullptr, &framebuffer_), "vkCreateFramebuffer");
}

void EnginePipeline::createGraphicsPipeline(std::span<const uint32_t> vertexSpirv,
                                            std::span<const uint32_t> fragmentSpirv) {
  const VkShaderModule vertex = createModule(vertexSpirv), fragment = createModule(fragmentSpirv);
  const VkPipelineShaderStageCreateInfo stages[] = {stageOf(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                                                    stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
  VkPipelineVertexInputStateCreateInfo input{};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkExtent2D extent = picture_.extent;
  const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
  const VkRect2D scissor{{0, 0}, extent};
  VkPipelineViewportStateCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  view.viewportCount = view.scissorCount = 1;
  view.pViewports = &viewport;
  view.pScissors = &scissor;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineColorBlendAttachmentState all{};
  all.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1;
  blend.pAttachments = &all;
  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &view;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pColorBlendState = &blend;
  info.layout = layout_;
  info.renderPass = renderPass_;
  const VkDevice device = sharedHost().device;
  check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_), "vkCreateGraphicsPipelines");
  for (const VkShaderModule shader : {vertex, fragment}) vkDestroyShaderModule(device, shader, nullptr);
}

void EnginePipeline::bind(VkCommandBuffer commands, VkDescriptorSet set, const void* constants) const {
  const VkPipelineBindPoint point = renderPass_ ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE;
  vkCmdBindPipeline(commands, point, pipeline_);
  vkCmdBindDescriptorSets(commands, point, layout_, 0, 1, &set, 0, nullptr);
  vkCmdPushConstants(commands, layout_, stages_, 0, constantBytes_, constants);
}

void EnginePipeline::draw(VkCommandBuffer commands, VkDescriptorSet set, const void* constants) const {
  VkRenderPassBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  info.renderPass = renderPass_;
  info.framebuffer = framebuffer_;
  info.renderArea = {{0, 0}, picture_.extent};
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  bind(commands, set, constants);
  vkCmdDraw(commands, 3, 1, 0, 0);
  vkCmdEndRenderPass(commands);
}

}  // namespace froth::test
