#include "runtime/render/view_renderer.h"

#include <algorithm>

#include "runtime/render/camera_rays.h"
#include "runtime/render/hit_passes.h"
#include "runtime/render/view_state.h"

namespace froth {
namespace {

void addWork(const gpu::Counters& counters, FrothWork& work) {
  const auto add = [&](uint32_t kind, uint64_t& sum) {
    sum += uint64_t{counters.work[2 * kind + 1]} << 32 | counters.work[2 * kind];
  };
  add(gpu::kWorkEntries, work.entries);
  add(gpu::kWorkEntriesKept, work.entriesKept);
  add(gpu::kWorkBallHits, work.ballHits);
  add(gpu::kWorkPlanes, work.planes);
  add(gpu::kWorkHeights, work.heights);
  add(gpu::kWorkColours, work.colours);
  add(gpu::kWorkSteps, work.steps);
  add(gpu::kWorkNeighbours, work.neighbours);
}

void addCounters(const gpu::Counters& counters, FrothViewStatus& status) {
  status.visibleCells = std::max(status.visibleCells, counters.cellsWanted);
  status.pairs += counters.pairs;
  status.indexViolations += counters.violations;
  addWork(counters, status.work);
  if (counters.cellsWanted > counters.visibleCells) status.bits |= FROTH_VIEW_CELL_OVERFLOW;
  if (counters.pairs > counters.pairsKept) status.bits |= FROTH_VIEW_PAIR_OVERFLOW;
  if (counters.stepLimit != 0) status.bits |= FROTH_VIEW_STEP_LIMIT;
}

// Takes over counts and times of the newest frame that is complete.
void readBack(ViewState& view, uint64_t completedSerial) {
  const auto isNewer = [&](const FrameSlot& a, uint64_t serial) {
    return a.serial <= completedSerial && a.serial > serial;
  };
  const FrameSlot* newest = nullptr;
  for (const FrameSlot& slot : view.slots) {
    if (isNewer(slot, newest ? newest->serial : view.status.serial)) newest = &slot;
  }
  if (!newest) return;
  view.status = {};
  view.status.structSize = sizeof(FrothViewStatus);
  view.status.serial = newest->serial;
  view.demand = {};
  const auto firstNumber = static_cast<uint32_t>(newest - view.slots.data()) * kRecordingsPerFrame;
  for (uint32_t number = firstNumber; number < firstNumber + newest->recordings; ++number) {
    const gpu::Counters& counters = readCounters(view, number);
    addCounters(counters, view.status);
    view.demand = largest(view.demand, demandOf(counters));
    if (view.timer) view.timer->read(number, view.status);
  }
}

Status growBuffers(ViewState& view, const GpuAsset* asset, const ViewCapacity& wanted) {
  if (wanted == view.buffers.capacity()) return {};
  const VkDeviceSize heldBytes = view.device.ledger.deviceBytes();
  const VkDeviceSize budget = view.device.budget;
  const auto& refusal = view.refusal;
  if (refusal && refusal->asset == asset && refusal->budget == budget && heldBytes >= refusal->deviceBytes) {
    return refusal->error;
  }
  view.refusal.reset();
  const uint64_t budgetRefusals = view.device.budgetRefusals;
  const Status status = view.buffers.grow(wanted, view.lastSerial);
  if (view.device.budgetRefusals != budgetRefusals) view.refusal = {asset, budget, heldBytes, status.error()};
  return status;
}

}  // namespace

ViewRenderer::ViewRenderer() = default;
ViewRenderer::~ViewRenderer() = default;

Result<std::unique_ptr<ViewRenderer>> ViewRenderer::create(Device& device, const ViewOptions& options) {
  const uint32_t recordings = options.framesInFlight * kRecordingsPerFrame;
  Result<std::unique_ptr<OutputImages>> images = OutputImages::create(device, recordings);
  if (!images) return images.error();
  std::unique_ptr<PassTimer> timer;
  std::unique_ptr<ImageSets> hitSets;
  if (options.keepsHits) {
    Result<std::unique_ptr<ImageSets>> made =
        ImageSets::create(device, {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}, 2 * recordings);
    if (!made) return made.error();
    hitSets = std::move(*made);
  }
  if (options.measurePasses) {
    Result<std::unique_ptr<PassTimer>> made = PassTimer::create(device, recordings);
    if (!made) return made.error();
    timer = std::move(*made);
  }
  std::unique_ptr<ViewRenderer> renderer(new ViewRenderer);
  renderer->state_.reset(new ViewState{.device = device,
                                       .buffers = ViewBuffers(device),
                                       .images = std::move(*images),
                                       .hitSets = std::move(hitSets),
                                       .timer = std::move(timer),
                                       .slots = std::vector<FrameSlot>(options.framesInFlight)});
  ViewCapacity capacity;
  const VkExtent2D extent = options.maxExtent;
  const uint64_t pixels = uint64_t{extent.width} * extent.height;
  capacity.frames = options.framesInFlight;
  capacity.tiles = tilesAlong(extent.width) * tilesAlong(extent.height);
  if (options.lensClasses & FROTH_LENS_CLASS_ORTHOGRAPHIC) capacity.walkStarts = capacity.tiles;
  if (options.lensClasses & FROTH_LENS_CLASS_MAPPED) capacity.rays = pixels;
  if (options.keepsHits) capacity.hits = pixels;
  if (const Status status = renderer->state_->buffers.grow(capacity, 0); !status) return status.error();
  return renderer;
}

Status ViewRenderer::prepare(uint64_t completedSerial, const GpuAsset* asset) {
  ViewState& view = *state_;
  readBack(view, completedSerial);
  view.buffers.freeRetired(completedSerial);
  if (view.slots[view.slot].recordings != 0) {  // frames can be dropped in any order, so any slot may be free
    const auto free = std::find_if(view.slots.begin(), view.slots.end(),
                                   [&](const FrameSlot& slot) { return slot.serial <= completedSerial; });
    *free = {};
    view.slot = static_cast<uint32_t>(free - view.slots.begin());
  }

  if (const Status status = view.buffers.trim(view.lastSerial, completedSerial); !status) return status;
  ViewCapacity wanted = view.buffers.capacity();
  const bool isHeldBack = view.device.excessBytes() > 0;  // what views give up now they would take again
  if (asset && !(isHeldBack && coversAsset(*asset, wanted))) {
    coverAsset(*asset, wanted);
    coverDemand(*asset, view.demand, wanted);
  }
  const VkBuffer oldWalkStart = view.buffers[ViewBuffer::kWalkStart].buffer;
  const Status status = growBuffers(view, asset, wanted);
  const bool isWalkStartKept = view.buffers[ViewBuffer::kWalkStart].buffer == oldWalkStart;
  if (!isWalkStartKept || view.walkAsset != asset) view.walkAsset = nullptr;
  view.buffers.describeMemory(view.status);
  return status;
}

VkDeviceSize ViewRenderer::shrinkableBytes() const {
  const ViewCapacity& capacity = state_->buffers.capacity();
  return bytesOf(capacity) - bytesOf(lessened(capacity, 0));
}

void ViewRenderer::shrink(double factor) {
  state_->buffers.lessen(lessened(state_->buffers.capacity(), factor));
}

bool ViewRenderer::isShrinking() const {
  return !state_->buffers.isTrimmed();
}

uint32_t ViewRenderer::recordRaster(VkCommandBuffer commandBuffer, RenderPipelines& pipelines,
                                    const RenderInstance& instance, const FrothRenderInfo& info,
                                    uint64_t serial) {
  const PassPipelines* passes = pipelines.state().find(shapeOf(*instance.asset), lensClassOf(info.camera));
  if (!passes || !coversAsset(*instance.asset, state_->buffers.capacity())) {
    recordClear(commandBuffer, pipelines, info, serial);
    return FROTH_VIEW_NOT_READY;
  }
  const Recording recording =
      beginRecording(*state_, commandBuffer, RecordingKind::kRaster, info, serial, &instance);
  recordRasterPasses(recording, bindRecording(recording, pipelines.state(), *passes), *instance.asset);
  recordHitPasses(recording, pipelines.state());
  endRecording(recording);
  return 0;
}

uint32_t ViewRenderer::recordWalk(VkCommandBuffer commandBuffer, RenderPipelines& pipelines,
                                  const RenderInstance& instance, const FrothRenderInfo& info,
                                  uint64_t serial) {
  const PassPipelines* passes = pipelines.state().find(shapeOf(*instance.asset), lensClassOf(info.camera));
  const bool isReady = passes && coversAsset(*instance.asset, state_->buffers.capacity());
  if (!isReady || !instance.asset->hasWalkGraph) {
    recordClear(commandBuffer, pipelines, info, serial);
    return isReady ? FROTH_VIEW_NO_WALK_GRAPH : FROTH_VIEW_NOT_READY;
  }
  const Recording recording =
      beginRecording(*state_, commandBuffer, RecordingKind::kWalk, info, serial, &instance);
  recordWalkPasses(recording, bindRecording(recording, pipelines.state(), *passes), *instance.asset);
  recordHitPasses(recording, pipelines.state());
  endRecording(recording);
  return 0;
}

void ViewRenderer::recordClear(VkCommandBuffer commandBuffer, RenderPipelines& pipelines,
                               const FrothRenderInfo& info, uint64_t serial) {
  const Recording recording =
      beginRecording(*state_, commandBuffer, RecordingKind::kClear, info, serial, nullptr);
  const PassRecorder recorder = bindRecording(recording, pipelines.state(), pipelines.state().common[gpu::kLensClassPinhole]);
  recordPixels(recording, recorder, isWideColour(info) ? Pass::kClear32 : Pass::kClear16);
  recording.mark("clear");
  recordHitPasses(recording, pipelines.state());
  endRecording(recording);
}

void ViewRenderer::dropFrame(uint64_t serial) {
  for (FrameSlot& slot : state_->slots) {
    if (slot.serial == serial) slot = {};
  }
  state_->walkAsset = nullptr;  // it may be that frame that would have found the start
}

const FrothViewStatus& ViewRenderer::status() const {
  return state_->status;
}

}  // namespace froth
