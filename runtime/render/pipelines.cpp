#include "runtime/render/pipelines.h"

#include <span>

#include "runtime/render/pipeline_state.h"
#include "shaders/gpu/layout.h"
#include "spirv/clear_rgba16f.h"
#include "spirv/clear_rgba32f.h"
#include "spirv/compact_cells.h"
#include "spirv/count_tiles.h"
#include "spirv/cull_cells.h"
#include "spirv/emit_pairs.h"
#include "spirv/expand_cells.h"
#include "spirv/locate.h"
#include "spirv/order_tiles.h"
#include "spirv/raster_long_tiles_rgba16f.h"
#include "spirv/raster_long_tiles_rgba32f.h"
#include "spirv/raster_tiles_rgba16f.h"
#include "spirv/raster_tiles_rgba32f.h"
#include "spirv/shade_sites.h"
#include "spirv/sort_scatter.h"
#include "spirv/sort_scatter_many.h"
#include "spirv/walk_rgba16f.h"
#include "spirv/walk_rgba32f.h"

namespace froth {
namespace {

constexpr uint32_t kPushConstantBytes = 80;
static_assert(sizeof(gpu::SortConstants) <= kPushConstantBytes &&
              sizeof(gpu::PassConstants) <= kPushConstantBytes);

struct PassCode {
  const char* name;
  std::span<const uint32_t> spirv;
  bool hasNormals = false;
};

// In the order of Pass.
const std::array<PassCode, kPassCount> kPassCodes = {{
    {"cull_cells", cull_cells_spirv},
    {"sort_scatter", sort_scatter_spirv},
    {"sort_scatter_many", sort_scatter_many_spirv},
    {"count_tiles", count_tiles_spirv},
    {"emit_pairs", emit_pairs_spirv},
    {"order_tiles", order_tiles_spirv},
    {"expand_cells", expand_cells_spirv},
    {"locate", locate_spirv},
    {"clear_rgba16f", clear_rgba16f_spirv},
    {"clear_rgba32f", clear_rgba32f_spirv},
    {"compact_cells", compact_cells_spirv},
    {"shade_sites", shade_sites_spirv},
    {"raster_long_tiles_rgba16f", raster_long_tiles_rgba16f_spirv},
    {"raster_long_tiles_rgba32f", raster_long_tiles_rgba32f_spirv},
    {"raster_long_tiles_rgba16f", raster_long_tiles_rgba16f_spirv, true},
    {"raster_long_tiles_rgba32f", raster_long_tiles_rgba32f_spirv, true},
    {"raster_tiles_rgba16f", raster_tiles_rgba16f_spirv},
    {"raster_tiles_rgba32f", raster_tiles_rgba32f_spirv},
    {"raster_tiles_rgba16f", raster_tiles_rgba16f_spirv, true},
    {"raster_tiles_rgba32f", raster_tiles_rgba32f_spirv, true},
    {"walk_rgba16f", walk_rgba16f_spirv},
    {"walk_rgba32f", walk_rgba32f_spirv},
    {"walk_rgba16f", walk_rgba16f_spirv, true},
    {"walk_rgba32f", walk_rgba32f_spirv, true},
}};

struct Specialization {
  VkBool32 checkIndices;
  uint32_t detailCount, lobeCount;
  VkBool32 hasHeights;
  VkBool32 countWork;
  VkBool32 hasNormals;
};

constexpr std::array<VkSpecializationMapEntry, 6> kSpecializationEntries = {{
    {gpu::kConstantCheckIndices, offsetof(Specialization, checkIndices), sizeof(VkBool32)},
    {gpu::kConstantDetailCount, offsetof(Specialization, detailCount), sizeof(uint32_t)},
    {gpu::kConstantLobeCount, offsetof(Specialization, lobeCount), sizeof(uint32_t)},
    {gpu::kConstantHasHeights, offsetof(Specialization, hasHeights), sizeof(VkBool32)},
    {gpu::kConstantCountWork, offsetof(Specialization, countWork), sizeof(VkBool32)},
    {gpu::kConstantHasNormals, offsetof(Specialization, hasNormals), sizeof(VkBool32)},
}};

Result<VkPipeline> createPipeline(RenderPipelines::State& state, const PassCode& code,
                                  const Specialization& values) {
  const DeviceTable& vk = state.device.table;
  VkShaderModuleCreateInfo moduleInfo{};
  moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  moduleInfo.codeSize = code.spirv.size_bytes();
  moduleInfo.pCode = code.spirv.data();
  VkShaderModule shaderModule = VK_NULL_HANDLE;
  if (const VkResult result =
          vk.vkCreateShaderModule(state.device.device, &moduleInfo, nullptr, &shaderModule);
      result != VK_SUCCESS) {
    return state.device.explain(result, "%s: vkCreateShaderModule", code.name);
  }

  VkSpecializationInfo specialization{};
  specialization.mapEntryCount = static_cast<uint32_t>(kSpecializationEntries.size());
  specialization.pMapEntries = kSpecializationEntries.data();
  specialization.dataSize = sizeof(values);
  specialization.pData = &values;
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = shaderModule;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  info.layout = state.layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      vk.vkCreateComputePipelines(state.device.device, state.cache, 1, &info, nullptr, &pipeline);
  vk.vkDestroyShaderModule(state.device.device, shaderModule, nullptr);
  if (result != VK_SUCCESS) return state.device.explain(result, "%s: vkCreateComputePipelines", code.name);
  return pipeline;
}

// Makes passes [first, last) into `pipelines`.
Status createPasses(RenderPipelines::State& state, const AssetShape& shape, uint32_t first, uint32_t last,
                    PassPipelines& pipelines) {
  Specialization values{.checkIndices = state.options.checkIndices,
                        .detailCount = shape.detailCount,
                        .lobeCount = shape.lobeCount,
                        .hasHeights = shape.hasHeights,
                        .countWork = state.options.countWork,
                        .hasNormals = false};
  for (uint32_t pass = first; pass < last; ++pass) {
    values.hasNormals = kPassCodes[pass].hasNormals;
    Result<VkPipeline> pipeline = createPipeline(state, kPassCodes[pass], values);
    if (!pipeline) return pipeline.error();
    pipelines[pass] = *pipeline;
  }
  return {};
}

Status createLayout(RenderPipelines::State& state) {
  const Result<VkDescriptorSetLayout> setLayout = createOutputSetLayout(state.device);
  if (!setLayout) return setLayout.error();
  state.setLayout = *setLayout;
  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushConstantBytes};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &state.setLayout;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  const VkResult result =
      state.device.table.vkCreatePipelineLayout(state.device.device, &info, nullptr, &state.layout);
  if (result != VK_SUCCESS) return state.device.explain(result, "vkCreatePipelineLayout");
  return {};
}

}  // namespace

AssetShape shapeOf(const GpuAsset& asset) {
  return {asset.detailCount, asset.lobeCount, asset.hasHeights};
}

Result<VkDescriptorSetLayout> createOutputSetLayout(Device& device) {
  std::array<VkDescriptorSetLayoutBinding, 3> bindings{};
  for (uint32_t i = 0; i < bindings.size(); ++i) {
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  }
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = static_cast<uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  const VkResult result = device.table.vkCreateDescriptorSetLayout(device.device, &info, nullptr, &layout);
  if (result != VK_SUCCESS) return device.explain(result, "vkCreateDescriptorSetLayout");
  return layout;
}

const PassPipelines* RenderPipelines::State::find(const AssetShape& shape) {
  const std::lock_guard lock(mutex);
  const auto found = byShape.find(shape);
  return found == byShape.end() ? nullptr : &found->second;
}

RenderPipelines::RenderPipelines(Device& device, VkPipelineCache cache, ShaderOptions options)
    : state_(new State{.device = device, .cache = cache, .options = options}) {}

RenderPipelines::~RenderPipelines() {
  const DeviceTable& vk = state_->device.table;
  const VkDevice device = state_->device.device;
  for (auto& [shape, pipelines] : state_->byShape) {
    for (uint32_t pass = kFirstShapedPass; pass < kPassCount; ++pass)
      vk.vkDestroyPipeline(device, pipelines[pass], nullptr);
  }
  for (VkPipeline pipeline : state_->common) vk.vkDestroyPipeline(device, pipeline, nullptr);
  vk.vkDestroyPipelineLayout(device, state_->layout, nullptr);
  vk.vkDestroyDescriptorSetLayout(device, state_->setLayout, nullptr);
}

Result<std::unique_ptr<RenderPipelines>> RenderPipelines::create(Device& device, VkPipelineCache cache,
                                                                 ShaderOptions options) {
  std::unique_ptr<RenderPipelines> pipelines(new RenderPipelines(device, cache, options));
  State& state = *pipelines->state_;
  if (const Status status = createLayout(state); !status) return status.error();
  if (const Status status = createPasses(state, {}, 0, kFirstShapedPass, state.common); !status)
    return status.error();
  return pipelines;
}

Status RenderPipelines::prepareFor(const GpuAsset& asset) {
  const AssetShape shape = shapeOf(asset);
  if (state_->find(shape)) return {};
  std::map<AssetShape, PassPipelines> made;  // takes its memory now: what follows cannot lose a pipeline
  PassPipelines& pipelines = made[shape] = state_->common;
  const Status status = createPasses(*state_, shape, kFirstShapedPass, kPassCount, pipelines);
  if (!status) {
    for (uint32_t pass = kFirstShapedPass; pass < kPassCount; ++pass) {
      state_->device.table.vkDestroyPipeline(state_->device.device, pipelines[pass], nullptr);
    }
    return status;
  }
  const std::lock_guard lock(state_->mutex);
  state_->byShape.merge(made);
  return {};
}

}  // namespace froth
