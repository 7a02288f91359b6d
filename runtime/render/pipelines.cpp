#include "runtime/render/pipelines.h"

#include <span>

#include "runtime/render/composite.h"
#include "runtime/render/depth_export.h"
#include "runtime/render/output_images.h"
#include "runtime/render/pipeline_state.h"
#include "shaders/gpu/layout.h"
#include "spirv/aim_rays.h"
#include "spirv/aim_rays_by_image.h"
#include "spirv/choose_cells.h"
#include "spirv/clear_rgba16f.h"
#include "spirv/clear_rgba32f.h"
#include "spirv/compact_cells.h"
#include "spirv/count_tiles.h"
#include "spirv/cull_cells.h"
#include "spirv/emit_pairs.h"
#include "spirv/expand_cells.h"
#include "spirv/fade_rgba16f.h"
#include "spirv/fade_rgba32f.h"
#include "spirv/locate.h"
#include "spirv/nearest_balls.h"
#include "spirv/order_tiles.h"
#include "spirv/publish_borders.h"
#include "spirv/raster_long_tiles_rgba16f.h"
#include "spirv/raster_long_tiles_rgba32f.h"
#include "spirv/raster_merged_rgba16f.h"
#include "spirv/raster_merged_rgba32f.h"
#include "spirv/raster_ordered_rgba16f.h"
#include "spirv/raster_ordered_rgba32f.h"
#include "spirv/raster_tiles_rgba16f.h"
#include "spirv/raster_tiles_rgba32f.h"
#include "spirv/shade_details.h"
#include "spirv/share_tiles.h"
#include "spirv/sort_scatter.h"
#include "spirv/sort_scatter_many.h"
#include "spirv/walk_merged_rgba16f.h"
#include "spirv/walk_merged_rgba32f.h"
#include "spirv/walk_rgba16f.h"
#include "spirv/walk_rgba32f.h"
#include "spirv/widen_cones.h"
#include "spirv/write_ids.h"
#include "spirv/write_motion.h"
#include "spirv/write_reactive.h"

namespace froth {
namespace {

constexpr uint32_t kPushConstantBytes = 128;
static_assert(sizeof(gpu::SortConstants) <= kPushConstantBytes &&
              sizeof(gpu::PassConstants) + sizeof(gpu::PartConstants) <= kPushConstantBytes);

// FROTH_COMMON_PASSES, lenses.
constexpr uint32_t kAnyLens = 1 << gpu::kLensClassPinhole;
constexpr uint32_t kMapped = 1 << gpu::kLensClassMapped;
constexpr uint32_t kEyeOrNone = kAnyLens | 1 << gpu::kLensClassOrthographic;  // whether rays share an eye matters
constexpr uint32_t kEachLens = kEyeOrNone | kMapped;

struct PassCode {
  const char* name;
  std::span<const uint32_t> spirv;
  uint32_t lensClasses;
  bool isFull = false;
};

#define FROTH_CODE(shader, lenses, isFull) {#shader, shader##_spirv, lenses, isFull},
#define FROTH_CODE_ONE(name, shader, lenses) FROTH_CODE(shader, lenses, false)
#define FROTH_CODE_COLOURS(name, shader, lenses) \
  FROTH_CODE(shader##_rgba16f, lenses, false) FROTH_CODE(shader##_rgba32f, lenses, false)
#define FROTH_CODE_FORMS(name, shader, lenses) \
  FROTH_CODE_COLOURS(name, shader, lenses)     \
  FROTH_CODE(shader##_rgba16f, lenses, true) FROTH_CODE(shader##_rgba32f, lenses, true)

const std::array<PassCode, kPassCount> kPassCodes = {
    {FROTH_COMMON_PASSES(FROTH_CODE_ONE, FROTH_CODE_COLOURS, FROTH_CODE_FORMS)
         FROTH_MERGED_PASSES(FROTH_CODE_ONE, FROTH_CODE_COLOURS, FROTH_CODE_FORMS)
             FROTH_SHAPED_PASSES(FROTH_CODE_ONE, FROTH_CODE_COLOURS, FROTH_CODE_FORMS)}};

struct Specialization {
  VkBool32 checkIndices;
  uint32_t detailCount, lobeCount;
  VkBool32 hasHeights;
  VkBool32 countWork;
  VkBool32 isFull;
  uint32_t lensClass;
  VkBool32 floatColours;
  VkBool32 keepsQuarters;
};

constexpr std::array<VkSpecializationMapEntry, 9> kSpecializationEntries = {{
    {gpu::kConstantCheckIndices, offsetof(Specialization, checkIndices), sizeof(VkBool32)},
    {gpu::kConstantDetailCount, offsetof(Specialization, detailCount), sizeof(uint32_t)},
    {gpu::kConstantLobeCount, offsetof(Specialization, lobeCount), sizeof(uint32_t)},
    {gpu::kConstantHasHeights, offsetof(Specialization, hasHeights), sizeof(VkBool32)},
    {gpu::kConstantCountWork, offsetof(Specialization, countWork), sizeof(VkBool32)},
    {gpu::kConstantIsFull, offsetof(Specialization, isFull), sizeof(VkBool32)},
    {gpu::kConstantLensClass, offsetof(Specialization, lensClass), sizeof(uint32_t)},
    {gpu::kConstantFloatColours, offsetof(Specialization, floatColours), sizeof(VkBool32)},
    {gpu::kConstantKeepsQuarters, offsetof(Specialization, keepsQuarters), sizeof(VkBool32)},
}};

Result<VkPipeline> createPipeline(RenderPipelines::State& state, const PassCode& code, const Specialization& values) {
  VkSpecializationInfo specialization{};
  specialization.mapEntryCount = static_cast<uint32_t>(kSpecializationEntries.size());
  specialization.pMapEntries = kSpecializationEntries.data();
  specialization.dataSize = sizeof(values);
  specialization.pData = &values;
  return createComputePipeline(state.device, state.cache, code.name, code.spirv, &specialization, state.layout);
}

bool hasOwnPipeline(uint32_t pass, uint32_t lensClass) { return (kPassCodes[pass].lensClasses >> lensClass & 1) != 0; }

// Makes passes [first, last) of all classes of lenses into `pipelines`.
Status createPasses(RenderPipelines::State& state, const AssetShape& shape, uint32_t first, uint32_t last,
                    LensPipelines& pipelines) {
  Specialization values{.checkIndices = state.options.checkIndices,
                        .detailCount = shape.detailCount,
                        .lobeCount = shape.lobeCount,
                        .hasHeights = shape.hasHeights,
                        .countWork = state.options.countWork,
                        .isFull = false,
                        .lensClass = gpu::kLensClassPinhole,
                        .floatColours = state.options.floatColours,
                        .keepsQuarters = false};
  for (values.lensClass = 0; values.lensClass < gpu::kLensClassCount; ++values.lensClass) {
    if (!state.hasLensClass(values.lensClass)) continue;
    for (uint32_t pass = first; pass < last; ++pass) {
      VkPipeline& made = pipelines[values.lensClass][pass];
      if (!hasOwnPipeline(pass, values.lensClass)) {
        made = pipelines[gpu::kLensClassPinhole][pass];
        continue;
      }
      values.isFull = kPassCodes[pass].isFull;
      values.keepsQuarters = values.isFull && state.options.keepsQuarters;
      Result<VkPipeline> pipeline = createPipeline(state, kPassCodes[pass], values);
      if (!pipeline) return pipeline.error();
      made = *pipeline;
    }
  }
  return {};
}

void destroyPasses(RenderPipelines::State& state, uint32_t first, uint32_t last, LensPipelines& pipelines) {
  for (uint32_t lensClass = 0; lensClass < gpu::kLensClassCount; ++lensClass) {
    for (uint32_t pass = first; pass < last; ++pass) {
      if (hasOwnPipeline(pass, lensClass)) {
        state.device.table.vkDestroyPipeline(state.device.device, pipelines[lensClass][pass], nullptr);
      }
    }
  }
}

Status createLayout(RenderPipelines::State& state) {
  constexpr const char* kName = "passes of a view";
  const Result<VkDescriptorSetLayout> setLayout = createSetLayout(state.device, kName, outputBindings());
  if (!setLayout) return setLayout.error();
  state.setLayout = *setLayout;
  const Result<VkPipelineLayout> layout =
      createPipelineLayout(state.device, kName, state.setLayout, kPushConstantBytes);
  if (!layout) return layout.error();
  state.layout = *layout;
  return {};
}

// The passes over hits, whose images have formats that not every device can write.
Status createHitPasses(RenderPipelines::State& state) {
  if (!state.options.hasExtendedFormats) return {};
  const auto create = [&](const char* name, std::span<const uint32_t> spirv,
                          std::unique_ptr<ImagePass>& pass) -> Status {
    Result<std::unique_ptr<ImagePass>> made = ImagePass::create(
        state.device, state.cache, {name, spirv, {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}, sizeof(VkDeviceAddress)});
    if (!made) return made.error();
    pass = std::move(*made);
    return {};
  };
  Status status = create("write_ids", write_ids_spirv, state.writeIds);
  if (status) status = create("write_motion", write_motion_spirv, state.writeMotion);
  if (!status || !state.options.keepsQuarters) return status;
  return create("write_reactive", write_reactive_spirv, state.writeReactive);
}

}  // namespace

SetBindings outputBindings() {
  SetBindings bindings;
  for (const FrameImage& image : boundImages()) bindings.types.push_back(descriptorTypeOf(image));
  return bindings;
}

bool RenderPipelines::State::hasLensClass(uint32_t lensClass) const {
  return lensClass == gpu::kLensClassPinhole || (options.lensClasses >> (lensClass - 1) & 1) != 0;
}

const PassPipelines* RenderPipelines::State::find(const AssetShape& shape, uint32_t lensClass) {
  if (!hasLensClass(lensClass)) return nullptr;
  const std::lock_guard lock(mutex);
  const auto found = byShape.find(shape);
  return found == byShape.end() ? nullptr : &found->second[lensClass];
}

RenderPipelines::RenderPipelines(Device& device, VkPipelineCache cache, ShaderOptions options)
    : state_(new State{.device = device, .cache = cache, .options = options}) {}

RenderPipelines::~RenderPipelines() {
  const DeviceTable& vk = state_->device.table;
  const VkDevice device = state_->device.device;
  for (auto& [shape, pipelines] : state_->byShape) destroyPasses(*state_, kFirstShapedPass, kPassCount, pipelines);
  destroyPasses(*state_, 0, kFirstMergedPass, state_->common);
  destroyPasses(*state_, kFirstMergedPass, kFirstShapedPass, state_->merged);
  vk.vkDestroyPipelineLayout(device, state_->layout, nullptr);
  vk.vkDestroyDescriptorSetLayout(device, state_->setLayout, nullptr);
}

Result<std::unique_ptr<RenderPipelines>> RenderPipelines::create(Device& device, VkPipelineCache cache,
                                                                 ShaderOptions options) {
  std::unique_ptr<RenderPipelines> pipelines(new RenderPipelines(device, cache, options));
  State& state = *pipelines->state_;
  if (const Status status = createLayout(state); !status) return status.error();
  if (const Status status = createPasses(state, {}, 0, kFirstMergedPass, state.common); !status) return status.error();
  if (const Status status = createHitPasses(state); !status) return status.error();
  if (options.compositeFormat != VK_FORMAT_UNDEFINED) {
    Result<std::unique_ptr<ImagePass>> made = createCompositePass(device, cache, options.compositeFormat);
    if (!made) return made.error();
    state.composite = std::move(*made);
  }
  if (options.depthExportFormat != VK_FORMAT_UNDEFINED) {
    Result<std::unique_ptr<DepthExport>> made = DepthExport::create(device, cache, options.depthExportFormat);
    if (!made) return made.error();
    state.depthExport = std::move(*made);
  }
  return pipelines;
}

Status RenderPipelines::prepareFor(const AssetShape& shape) {
  const std::lock_guard making(state_->making);
  if (state_->find(shape, gpu::kLensClassPinhole)) return {};
  std::map<AssetShape, LensPipelines> made;  // takes its memory now: what follows cannot lose a pipeline
  LensPipelines& pipelines = made[shape] = state_->common;
  const Status status = createPasses(*state_, shape, kFirstShapedPass, kPassCount, pipelines);
  if (!status) {
    destroyPasses(*state_, kFirstShapedPass, kPassCount, pipelines);
    return status;
  }
  const std::lock_guard lock(state_->mutex);
  state_->byShape.merge(made);
  return {};
}

bool RenderPipelines::hasShape(const AssetShape& shape) const {
  return state_->find(shape, gpu::kLensClassPinhole) != nullptr;
}

bool RenderPipelines::canMerge() const { return state_->canMerge; }

Status RenderPipelines::prepareMerging() {
  const std::lock_guard making(state_->making);
  if (state_->canMerge) return {};
  const Status status = createPasses(*state_, {}, kFirstMergedPass, kFirstShapedPass, state_->merged);
  if (!status) {
    destroyPasses(*state_, kFirstMergedPass, kFirstShapedPass, state_->merged);
    state_->merged = {};
    return status;
  }
  state_->canMerge = true;
  return {};
}

}  // namespace froth
