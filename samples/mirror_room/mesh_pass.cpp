#include "samples/mirror_room/mesh_pass.h"

#include <cstring>

#include "host/vulkan_check.h"

namespace froth {
namespace {

#include "meshes.frag.h"  // kMeshFragments
#include "meshes.vert.h"  // kMeshVertices

// As the shaders declare it.
struct PartConstants {
  glm::mat4 clipFromNode;
  glm::vec4 clipPlane, rotation;
  float material;
};

PartConstants constantsOf(const RoomPart& part, const RoomNode& node, const MeshCamera& camera) {
  glm::dmat4 relativeFromNode(glm::mat3_cast(node.rotation) * node.scale);
  relativeFromNode[3] = glm::dvec4(node.position - camera.origin, 1);
  PartConstants constants{};
  constants.clipFromNode = camera.clipFromRelative * relativeFromNode;
  constants.clipPlane = glm::vec4(0, 0, 0, 1);
  if (camera.visible) {
    const MirrorPlane& plane = *camera.visible;
    const glm::dvec3 normal = node.scale * (glm::conjugate(node.rotation) * plane.normal);
    constexpr double kBefore = 1e-4;  // [metres] the plane itself is left out too
    constants.clipPlane = glm::dvec4(normal, glm::dot(plane.normal, node.position) + plane.offset - kBefore);
  }
  constants.rotation = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
  constants.material = static_cast<float>(part.material);
  return constants;
}

VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule module) {
  VkPipelineShaderStageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage = stage;
  info.module = module;
  info.pName = "main";
  return info;
}

// What all of the pipelines' fixed functions share.
struct FixedFunctions {
  VkVertexInputBindingDescription binding{0, sizeof(RoomVertex), VK_VERTEX_INPUT_RATE_VERTEX};
  VkVertexInputAttributeDescription attributes[2] = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(RoomVertex, position)},
                                                     {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(RoomVertex, normal)}};
  VkPipelineVertexInputStateCreateInfo vertices{};
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  VkPipelineViewportStateCreateInfo viewport{};
  VkPipelineRasterizationStateCreateInfo rasterization{};
  VkPipelineMultisampleStateCreateInfo samples{};
  VkPipelineDepthStencilStateCreateInfo depth{};
  VkPipelineColorBlendAttachmentState attachment{};
  VkPipelineColorBlendStateCreateInfo blend{};
  VkDynamicState dynamicStates[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{};

  FixedFunctions(bool hasSurface, VkCompareOp nearer) {
    vertices.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    vertices.vertexBindingDescriptionCount = 1;
    vertices.pVertexBindingDescriptions = &binding;
    vertices.vertexAttributeDescriptionCount = 2;
    vertices.pVertexAttributeDescriptions = attributes;
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
    depth.depthCompareOp = nearer;
    attachment.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = hasSurface ? 1 : 0;
    blend.pAttachments = &attachment;
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamicStates;
  }
  FixedFunctions(const FixedFunctions&) = delete;
};

}  // namespace

Result<std::unique_ptr<MeshPass>> MeshPass::create(Host& host, const Room& room) {
  std::unique_ptr<MeshPass> pass(new MeshPass(host));
  Status made = pass->uploadMeshes(room);
  if (made) made = pass->createLayout();
  if (made) made = pass->createPipeline(Kind::kSurface, pass->surfaces_);
  if (made) made = pass->createPipeline(Kind::kShadow, pass->shadows_);
  if (!made) return made.error();
  return pass;
}

MeshPass::~MeshPass() {
  vkDestroyPipeline(host_.device, surfaces_, nullptr);
  vkDestroyPipeline(host_.device, shadows_, nullptr);
  vkDestroyPipelineLayout(host_.device, layout_, nullptr);
  host_.destroyBuffer(vertices_);
  host_.destroyBuffer(indices_);
}

Status MeshPass::uploadMeshes(const Room& room) {
  const size_t vertexBytes = room.vertices.size() * sizeof(RoomVertex),
               indexBytes = room.indices.size() * sizeof(uint32_t);
  Result<HostBuffer> vertices = host_.createBuffer(vertexBytes, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  if (!vertices) return vertices.error();
  vertices_ = *vertices;
  std::memcpy(vertices_.mapped, room.vertices.data(), vertexBytes);
  Result<HostBuffer> indices = host_.createBuffer(indexBytes, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  if (!indices) return indices.error();
  indices_ = *indices;
  std::memcpy(indices_.mapped, room.indices.data(), indexBytes);
  return {};
}

Status MeshPass::createLayout() {
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(PartConstants)};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  return checkVulkan(vkCreatePipelineLayout(host_.device, &info, nullptr, &layout_), "vkCreatePipelineLayout");
}

Status MeshPass::createPipeline(Kind kind, VkPipeline& pipeline) {
  const bool hasSurface = kind == Kind::kSurface;
  const FixedFunctions functions(hasSurface, hasSurface ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS);
  const Result<VkShaderModule> vertices = createShaderModule(host_.device, kMeshVertices);
  if (!vertices) return vertices.error();
  const Result<VkShaderModule> fragments = createShaderModule(host_.device, kMeshFragments);
  if (!fragments) return fragments.error();
  const VkPipelineShaderStageCreateInfo stages[] = {stageOf(VK_SHADER_STAGE_VERTEX_BIT, *vertices),
                                                    stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, *fragments)};
  const VkFormat surfaceFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = hasSurface ? 1 : 0;
  rendering.pColorAttachmentFormats = &surfaceFormat;
  rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;
  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = &rendering;
  info.stageCount = hasSurface ? 2 : 1;
  info.pStages = stages;
  info.pVertexInputState = &functions.vertices;
  info.pInputAssemblyState = &functions.assembly;
  info.pViewportState = &functions.viewport;
  info.pRasterizationState = &functions.rasterization;
  info.pMultisampleState = &functions.samples;
  info.pDepthStencilState = &functions.depth;
  info.pColorBlendState = &functions.blend;
  info.pDynamicState = &functions.dynamic;
  info.layout = layout_;
  const Status made = checkVulkan(vkCreateGraphicsPipelines(host_.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
                                  "vkCreateGraphicsPipelines");
  vkDestroyShaderModule(host_.device, *vertices, nullptr);
  vkDestroyShaderModule(host_.device, *fragments, nullptr);
  return made;
}

void MeshPass::beginRendering(VkCommandBuffer commands, Kind kind, const MeshTarget& target) const {
  VkRenderingAttachmentInfo surface{};
  surface.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  surface.imageView = target.surface;
  surface.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  surface.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  surface.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  VkRenderingAttachmentInfo depth = surface;
  depth.imageView = target.depth;
  depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depth.clearValue.depthStencil = {kind == Kind::kSurface ? 0.0f : 1.0f, 0};
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea = {{0, 0}, target.extent};
  info.layerCount = 1;
  info.colorAttachmentCount = kind == Kind::kSurface ? 1 : 0;
  info.pColorAttachments = &surface;
  info.pDepthAttachment = &depth;
  vkCmdBeginRendering(commands, &info);
}

void MeshPass::record(VkCommandBuffer commands, Kind kind, const Room& room, const MeshCamera& camera,
                      const MeshTarget& target) const {
  beginRendering(commands, kind, target);
  const VkViewport viewport{0, 0, static_cast<float>(target.extent.width), static_cast<float>(target.extent.height),
                            0, 1};
  const VkRect2D scissor{{0, 0}, target.extent};
  const VkDeviceSize start = 0;
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scissor);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, kind == Kind::kSurface ? surfaces_ : shadows_);
  vkCmdBindVertexBuffers(commands, 0, 1, &vertices_.buffer, &start);
  vkCmdBindIndexBuffer(commands, indices_.buffer, 0, VK_INDEX_TYPE_UINT32);
  for (const RoomPart& part : room.parts) {
    const PartConstants constants = constantsOf(part, room.nodes[part.node], camera);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof(constants), &constants);
    vkCmdDrawIndexed(commands, part.indexCount, 1, part.firstIndex, 0, 0);
  }
  vkCmdEndRendering(commands);
}

}  // namespace froth
