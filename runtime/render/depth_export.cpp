#include "runtime/render/depth_export.h"

#include <array>

#include "runtime/render/image_barriers.h"
#include "spirv/export_depth_frag.h"
#include "spirv/export_depth_vert.h"

namespace froth {
namespace {

constexpr ImageUse kImageRead = {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
constexpr ImageUse kImageTested = {
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};

template <class Barrier>
void recordBarriers(const DeviceTable& vk, VkCommandBuffer commandBuffer, const FrothDepthExportInfo& info,
                    Barrier barrierOf) {
  const VkImageMemoryBarrier2 barriers[] = {barrierOf(info.depth, kImageRead),
                                            barrierOf(info.attachment, kImageTested)};
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.imageMemoryBarrierCount = 2;
  dependency.pImageMemoryBarriers = barriers;
  vk.vkCmdPipelineBarrier2(commandBuffer, &dependency);
}

VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule shaderModule) {
  VkPipelineShaderStageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage = stage;
  info.module = shaderModule;
  info.pName = "main";
  return info;
}

// Everything but stages and layout. What does not change is kept here.
struct FixedState {
  VkPipelineVertexInputStateCreateInfo vertices{};
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  VkPipelineViewportStateCreateInfo viewport{};
  VkPipelineRasterizationStateCreateInfo rasterization{};
  VkPipelineMultisampleStateCreateInfo samples{};
  VkPipelineDepthStencilStateCreateInfo depth{};
  VkPipelineDynamicStateCreateInfo dynamic{};
  VkPipelineRenderingCreateInfo rendering{};
  std::array<VkDynamicState, 3> dynamicStates = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                                 VK_DYNAMIC_STATE_DEPTH_COMPARE_OP};

  explicit FixedState(VkFormat format) {
    vertices.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    rasterization.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    rasterization.lineWidth = 1;
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = static_cast<uint32_t>(dynamicStates.size());
    dynamic.pDynamicStates = dynamicStates.data();
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.depthAttachmentFormat = format;
  }
};

}  // namespace

SetBindings DepthExport::bindings() { return {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}, VK_SHADER_STAGE_FRAGMENT_BIT}; }

Result<std::unique_ptr<DepthExport>> DepthExport::create(Device& device, VkPipelineCache cache, VkFormat format) {
  std::unique_ptr<DepthExport> made(new DepthExport(device));
  Status status = made->createLayout();
  if (status) status = made->createPipeline(cache, format);
  if (!status) return status.error();
  return made;
}

DepthExport::~DepthExport() {
  const DeviceTable& vk = device_.table;
  vk.vkDestroyPipeline(device_.device, pipeline_, nullptr);
  vk.vkDestroyPipelineLayout(device_.device, layout_, nullptr);
  vk.vkDestroyDescriptorSetLayout(device_.device, setLayout_, nullptr);
}

Status DepthExport::createLayout() {
  const Result<VkDescriptorSetLayout> setLayout = createSetLayout(device_, "export_depth", bindings());
  if (!setLayout) return setLayout.error();
  setLayout_ = *setLayout;
  const Result<VkPipelineLayout> layout = createPipelineLayout(device_, "export_depth", setLayout_, 0);
  if (!layout) return layout.error();
  layout_ = *layout;
  return {};
}

Status DepthExport::createPipeline(VkPipelineCache cache, VkFormat format) {
  const DeviceTable& vk = device_.table;
  const Result<VkShaderModule> vertex = device_.createShaderModule("export_depth.vert", export_depth_vert_spirv);
  if (!vertex) return vertex.error();
  const Result<VkShaderModule> fragment = device_.createShaderModule("export_depth.frag", export_depth_frag_spirv);
  if (!fragment) {
    vk.vkDestroyShaderModule(device_.device, *vertex, nullptr);
    return fragment.error();
  }
  const VkPipelineShaderStageCreateInfo stages[] = {stageOf(VK_SHADER_STAGE_VERTEX_BIT, *vertex),
                                                    stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, *fragment)};
  const FixedState state(format);
  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = &state.rendering;
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &state.vertices;
  info.pInputAssemblyState = &state.assembly;
  info.pViewportState = &state.viewport;
  info.pRasterizationState = &state.rasterization;
  info.pMultisampleState = &state.samples;
  info.pDepthStencilState = &state.depth;
  info.pDynamicState = &state.dynamic;
  info.layout = layout_;
  const VkResult result = vk.vkCreateGraphicsPipelines(device_.device, cache, 1, &info, nullptr, &pipeline_);
  for (const VkShaderModule shaderModule : {*vertex, *fragment}) {
    vk.vkDestroyShaderModule(device_.device, shaderModule, nullptr);
  }
  if (result != VK_SUCCESS) return device_.explain(result, "export_depth: vkCreateGraphicsPipelines");
  device_.nameObject(VK_OBJECT_TYPE_PIPELINE, pipeline_, "export_depth");
  return {};
}

void DepthExport::draw(VkCommandBuffer commandBuffer, VkDescriptorSet set, const FrothImage& attachment,
                       const VkRect2D& region, bool isReversed) const {
  const DeviceTable& vk = device_.table;
  VkRenderingAttachmentInfo target{};
  target.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  target.imageView = attachment.view;
  target.imageLayout = kImageTested.layout;
  target.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  target.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  VkRenderingInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  rendering.renderArea = region;
  rendering.layerCount = 1;
  rendering.pDepthAttachment = &target;
  const VkViewport viewport{
      0, 0, static_cast<float>(attachment.extent.width), static_cast<float>(attachment.extent.height), 0, 1};
  vk.vkCmdBeginRendering(commandBuffer, &rendering);
  vk.vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  vk.vkCmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set, 0, nullptr);
  vk.vkCmdSetViewport(commandBuffer, 0, 1, &viewport);
  vk.vkCmdSetScissor(commandBuffer, 0, 1, &region);
  vk.vkCmdSetDepthCompareOp(commandBuffer, isReversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS);
  vk.vkCmdDraw(commandBuffer, 3, 1, 0, 0);
  vk.vkCmdEndRendering(commandBuffer);
}

void DepthExport::record(VkCommandBuffer commandBuffer, VkDescriptorSet set, const FrothDepthExportInfo& info,
                         const VkRect2D& region, bool isReversed) const {
  device_.table.beginLabel(commandBuffer, "froth depth export");
  recordBarriers(device_.table, commandBuffer, info, entryBarrier);
  draw(commandBuffer, set, info.attachment, region, isReversed);
  recordBarriers(device_.table, commandBuffer, info, exitBarrier);
  device_.table.endLabel(commandBuffer);
}

}  // namespace froth
