#include "runtime/render/view_renderer.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "runtime/device/handles.h"
#include "runtime/render/camera_rays.h"
#include "runtime/render/composite.h"
#include "runtime/render/fade.h"
#include "runtime/render/hit_passes.h"
#include "runtime/render/part_order.h"
#include "runtime/render/placed_box.h"
#include "runtime/render/space_growth.h"
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
  status.pairs += counters.pairs;
  status.longestList = std::max(status.longestList, counters.longestList);
  status.indexViolations += counters.violations;
  addWork(counters, status.work);
  if (counters.cellsWanted > counters.visibleCells) status.bits |= FROTH_VIEW_CELL_OVERFLOW;
  if (counters.pairs > counters.pairsKept) status.bits |= FROTH_VIEW_PAIR_OVERFLOW;
  if (counters.stepLimit != 0) status.bits |= FROTH_VIEW_STEP_LIMIT;
  if (counters.isCut != 0) status.bits |= FROTH_VIEW_ENTRY_LIMIT;
}

void readRecording(ViewState& view, uint32_t number) {
  uint32_t visibleCells = 0, shownCells = 0;  // of all parts
  for (const auto& space : view.spaces) {
    if (space->serials[number] != view.status.serial) continue;
    const gpu::Counters& counters = readCounters(*space, number);
    addCounters(counters, view.status);
    visibleCells += counters.cellsWanted;
    shownCells += counters.visibleCells;
    space->demand = largest(space->demand, demandOf(counters));
  }
  if (visibleCells > view.status.visibleCells) {
    view.status.visibleCells = visibleCells;
    view.status.shownCells = shownCells;
  }
  if (view.timer) view.timer->read(number, view.status);
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
  for (const auto& space : view.spaces) space->demand = {};
  const auto firstNumber = static_cast<uint32_t>(newest - view.slots.data()) * view.leastCapacity.recordings;
  for (uint32_t number = firstNumber; number < firstNumber + newest->recordings; ++number) readRecording(view, number);
}

// The first error counts, but for what is only ordered.
void keepFirst(const Status& status, Status& result) {
  if (result || (isPending(result) && !status)) result = status;
}

Status nameInstance(const RenderInstance& instance, const Status& status) {
  if (status || isPending(status)) return status;
  const Error& error = status.error();
  return makeError(error.kind, "instance {%u, %u}, userId %u: %s", instance.handle.index, instance.handle.generation,
                   instance.userId, error.message.c_str());
}

InstanceSpace* findSpace(const ViewState& view, FrothInstance instance) {
  for (const auto& space : view.spaces) {
    if (space->isTaken && isSame(space->instance, instance)) return space.get();
  }
  return nullptr;
}

// The instance's own of the last frame; else one that nobody has; else a new one.
InstanceSpace& takeSpace(ViewState& view, FrothInstance instance) {
  InstanceSpace* space = findSpace(view, instance);
  for (size_t i = 0; i < view.spaces.size() && !space; ++i) {
    if (!view.spaces[i]->isTaken) space = view.spaces[i].get();
  }
  if (!space) {
    const auto recordings = static_cast<uint32_t>(view.slots.size()) * view.leastCapacity.recordings;
    space = view.spaces.emplace_back(std::make_unique<InstanceSpace>(view.device, recordings)).get();
  }
  space->instance = instance;
  space->isTaken = true;
  return *space;
}

// Spaces whose instances are gone are there for others; what is then left over is freed.
void giveUpSpaces(ViewState& view, uint64_t completedSerial, std::span<const RenderInstance> instances) {
  for (const auto& space : view.spaces) {
    const auto isIts = [&](const RenderInstance& instance) { return findSpace(view, instance.handle) == space.get(); };
    space->isTaken = space->isTaken && std::any_of(instances.begin(), instances.end(), isIts);
  }
  const auto isLeftOver = [&](const std::unique_ptr<InstanceSpace>& space) {
    return !space->isTaken && space->lastSerial <= completedSerial;
  };
  const size_t most = std::max<size_t>(instances.size(), 1);
  for (size_t i = view.spaces.size(); i-- > 1 && view.spaces.size() > most;) {
    if (isLeftOver(view.spaces[i])) view.spaces.erase(view.spaces.begin() + static_cast<ptrdiff_t>(i));
  }
}

void describeMemory(ViewState& view) {
  view.status.deviceBytes = view.status.memoryCount = 0;
  for (const auto& space : view.spaces) space->buffers.addMemory(view.status);
}

struct Drawable {
  InstanceSpace* space;
  const PassPipelines* passes;
};

// What can be drawn of the instances and may be in view, as parts of the recording, front to back where their boxes do
// not meet.
uint32_t addParts(const Recording& recording, RenderPipelines::State& pipelines,
                  std::span<const RenderInstance> instances) {
  uint32_t bits = 0, count = 0;
  std::array<Drawable, gpu::kMostInstances> drawables;
  std::array<const RenderInstance*, gpu::kMostInstances> drawn;
  std::array<PlacedBox, gpu::kMostInstances> boxes;
  const FrothCamera& camera = recording.info.camera;
  const RayPyramid rays(camera, computeCameraRays(camera, RenderInstance{}));
  const glm::dvec3 eye(camera.eye[0], camera.eye[1], camera.eye[2]);
  for (const RenderInstance& instance : instances) {
    InstanceSpace* space = findSpace(recording.view, instance.handle);
    const PassPipelines* passes = pipelines.find(instance.asset->shape(), lensClassOf(camera));
    const bool isFirst = count == 0;
    if (!space || !passes || !space->buffers.areMade() || !coversAsset(*instance.asset, space->buffers.capacity()) ||
        !(isFirst || pipelines.canMerge)) {
      bits |= FROTH_VIEW_NOT_READY;
    } else if (recording.method == RenderMethod::kWalk && !instance.asset->hasWalkGraph) {
      bits |= FROTH_VIEW_NO_WALK_GRAPH;
    } else {
      boxes[count] = boxOf(instance, eye);
      if (rays.mayMeet(boxes[count])) {
        drawables[count] = {space, passes};
        drawn[count++] = &instance;
      }
      if (mayLack(*instance.asset, space->demand, space->buffers.capacity())) bits |= FROTH_VIEW_MAY_LACK_CELLS;
    }
  }
  const PartOrder order = orderParts(camera, std::span(boxes).first(count));
  for (uint32_t place = 0; place < count; ++place) {
    const uint32_t instance = order.boxes[place];
    addPart(recording, *drawables[instance].space, drawn[instance], *drawables[instance].passes, order.overlaps[place]);
  }
  return bits;
}

Status createSets(Device& device, const char* name, const SetBindings& bindings, uint32_t count,
                  std::unique_ptr<DescriptorSets>& sets) {
  Result<std::unique_ptr<DescriptorSets>> made = DescriptorSets::create(device, name, bindings, count);
  if (!made) return made.error();
  sets = std::move(*made);
  return {};
}

}  // namespace

ViewCapacity leastCapacity(const ViewOptions& options) {
  const VkExtent2D extent = options.maxExtent;
  ViewCapacity capacity;
  capacity.frames = options.framesInFlight;
  if (options.fades) capacity.recordings = kFadingRecordingsPerFrame;
  capacity.tiles = tilesAlong(extent.width) * tilesAlong(extent.height);
  if (options.lensClasses & FROTH_LENS_CLASS_MAPPED) capacity.rays = uint64_t{extent.width} * extent.height;
  return capacity;
}

ViewCapacity firstCapacity(const ViewOptions& options) {
  ViewCapacity capacity = leastCapacity(options);
  const uint64_t pixels = uint64_t{options.maxExtent.width} * options.maxExtent.height;
  if (options.keepsHits) capacity.hits = pixels;
  if (options.keepsReactive) capacity.quarters = pixels;
  if (options.fades) capacity.fades = pixels;
  return capacity;
}

ViewRenderer::ViewRenderer() = default;
ViewRenderer::~ViewRenderer() = default;

Result<std::unique_ptr<ViewRenderer>> ViewRenderer::create(Device& device, const ViewOptions& options) {
  const uint32_t recordings = options.framesInFlight * leastCapacity(options).recordings;
  Result<std::unique_ptr<OutputImages>> images = OutputImages::create(device, recordings);
  if (!images) return images.error();
  std::unique_ptr<PassTimer> timer;
  std::unique_ptr<DescriptorSets> hitSets, compositeSets, exportSets;
  Status sets;
  if (options.keepsHits) {
    sets = createSets(device, "hits of a view", {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}, kHitImages * recordings, hitSets);
  }
  if (sets && options.composites) {
    sets = createSets(device, "composite", compositeBindings(), kMostEyes * options.framesInFlight, compositeSets);
  }
  if (sets && options.exportsDepth) {
    sets = createSets(device, "export_depth", DepthExport::bindings(), kMostEyes * options.framesInFlight, exportSets);
  }
  if (!sets) return sets.error();
  if (options.measurePasses) {
    Result<std::unique_ptr<PassTimer>> made = PassTimer::create(device, recordings);
    if (!made) return made.error();
    timer = std::move(*made);
  }
  std::unique_ptr<ViewRenderer> renderer(new ViewRenderer);
  renderer->state_.reset(new ViewState{.device = device,
                                       .spaces = {},
                                       .images = std::move(*images),
                                       .hitSets = std::move(hitSets),
                                       .compositeSets = std::move(compositeSets),
                                       .exportSets = std::move(exportSets),
                                       .timer = std::move(timer),
                                       .breadcrumbs = options.breadcrumbs,
                                       .slots = std::vector<FrameSlot>(options.framesInFlight)});
  ViewState& view = *renderer->state_;
  view.leastCapacity = leastCapacity(options);
  view.reservedCells = options.reservedCells;
  view.parts.reserve(gpu::kMostInstances);
  view.spaces.push_back(std::make_unique<InstanceSpace>(device, recordings));
  ViewBuffers& buffers = view.spaces.front()->buffers;
  const ViewCapacity first = firstCapacity(options);
  ViewCapacity whole = first;
  if (options.firstAsset) coverAsset(*options.firstAsset, view.reservedCells, whole);
  const uint64_t budgetRefusals = device.budgetRefusals;
  Status status = buffers.grow(whole, 0);
  if (!status && device.budgetRefusals != budgetRefusals) status = buffers.grow(first, 0);
  if (!status) return status.error();
  return renderer;
}

void ViewRenderer::startLike(const ViewRenderer& other) {
  const double area = static_cast<double>(state_->leastCapacity.tiles) / other.state_->leastCapacity.tiles;
  for (const auto& space : other.state_->spaces) {
    if (!space->isTaken) continue;
    ViewDemand& demand = takeSpace(*state_, space->instance).demand;
    demand = space->demand;
    demand.pairs = static_cast<uint64_t>(static_cast<double>(demand.pairs) * std::max(area, 1.0));
  }
}

Status ViewRenderer::prepare(uint64_t completedSerial, std::span<const RenderInstance> instances) {
  ViewState& view = *state_;
  readBack(view, completedSerial);
  if (view.slots[view.slot].recordings != 0) {  // frames can be dropped in any order, so any slot may be free
    const auto free = std::find_if(view.slots.begin(), view.slots.end(),
                                   [&](const FrameSlot& slot) { return slot.serial <= completedSerial; });
    *free = {};
    view.slot = static_cast<uint32_t>(free - view.slots.begin());
  }

  giveUpSpaces(view, completedSerial, instances);
  Status result;
  for (const RenderInstance& instance : instances) {
    const Status status = prepareSpace(view, takeSpace(view, instance.handle), completedSerial, instance.asset);
    keepFirst(nameInstance(instance, status), result);
  }
  for (const auto& space : view.spaces) {
    if (space->isTaken) continue;
    keepFirst(prepareSpace(view, *space, completedSerial, nullptr), result);
  }
  describeMemory(view);
  return result;
}

bool ViewRenderer::coversNext(const RenderInstance& instance) const {
  const InstanceSpace* space = findSpace(*state_, instance.handle);
  if (!space || !coversAsset(*instance.asset, space->buffers.capacity())) return true;
  const bool isEnded = (space->refusal && space->buffers.isTrimmed()) || state_->device.excessBytes() > 0;
  return isEnded ? coversNextChunks(*instance.asset, space->buffers.capacity())
                 : froth::coversNext(*instance.asset, state_->reservedCells, space->demand, space->buffers.capacity());
}

bool ViewRenderer::covers(const RenderInstance& instance) const {
  const InstanceSpace* space = findSpace(*state_, instance.handle);
  return space && space->buffers.areMade() && coversAsset(*instance.asset, space->buffers.capacity());
}

CutRoom ViewRenderer::roomForCuts(FrothInstance instance, const GpuAsset& asset) const {
  const InstanceSpace* space = findSpace(*state_, instance);
  const ViewCapacity& capacity = space ? space->buffers.capacity() : state_->leastCapacity;
  return {bytesWithoutCells(asset, capacity), bytesPerCell(asset.detailCount), state_->reservedCells,
          space ? space->buffers.deviceBytes() : 0};
}

VkDeviceSize ViewRenderer::heldBytes() const {
  VkDeviceSize bytes = 0;
  for (const auto& space : state_->spaces) bytes += space->buffers.deviceBytes();
  return bytes;
}

VkDeviceSize ViewRenderer::missingBytes(const RenderInstance& instance, uint32_t detailCount) const {
  const InstanceSpace* space = findSpace(*state_, instance.handle);
  if (!space) return 0;
  const ViewCapacity& held = space->buffers.capacity();
  const ViewCapacity wanted = largest(held, neededBy(*instance.asset, space->demand, detailCount));
  return wanted == held ? 0 : bytesOf(wanted);
}

VkDeviceSize ViewRenderer::shrinkableBytes() const {
  VkDeviceSize bytes = 0;
  for (const auto& space : state_->spaces) {
    const ViewCapacity& capacity = space->buffers.capacity();
    bytes += bytesOf(capacity) - bytesOf(lessened(capacity, 0));
  }
  return bytes;
}

void ViewRenderer::shrink(double factor) {
  for (const auto& space : state_->spaces) space->buffers.lessen(lessened(space->buffers.capacity(), factor));
}

bool ViewRenderer::isShrinking() const {
  return !std::all_of(state_->spaces.begin(), state_->spaces.end(),
                      [](const auto& space) { return space->buffers.isTrimmed(); });
}

uint32_t ViewRenderer::record(RenderMethod method, VkCommandBuffer commandBuffer, RenderPipelines& pipelines,
                              std::span<const RenderInstance> instances, const FrothRenderInfo& info, uint64_t serial,
                              float fadeWeight) {
  ViewState& view = *state_;
  const Recording recording = beginRecording(view, pipelines.state(), commandBuffer, method, info, serial);
  const uint32_t bits = addParts(recording, pipelines.state(), instances);
  const bool isClear = view.parts.empty();
  if (isClear) addPart(recording, *view.spaces.front(), nullptr, pipelines.state().common[gpu::kLensClassPinhole]);
  startPasses(recording);
  if (isClear) {
    recording.run("clear", [&] { recordPixels(recording, isWideColour(info) ? Pass::kClear32 : Pass::kClear16); });
  } else if (method == RenderMethod::kRaster) {
    recordRasterPasses(recording);
  } else {
    recordWalkPasses(recording);
  }
  if (fadeWeight < 1) recordFade(recording, fadeWeight);  // before hits, which bind images of their own
  recordHitPasses(recording);
  endRecording(recording);
  return bits;
}

void ViewRenderer::composite(VkCommandBuffer commandBuffer, RenderPipelines& pipelines, const FrothCompositeInfo& info,
                             const VkRect2D& region) {
  recordPass(state_->breadcrumbs, commandBuffer, {"frothRecordComposite", "composite", info.eye, state_->lastSerial},
             [&] {
               recordComposite(state_->device.table, commandBuffer, *pipelines.state().composite,
                               *state_->compositeSets, kMostEyes * state_->slot + info.eye, info, region);
             });
}

void ViewRenderer::exportDepth(VkCommandBuffer commandBuffer, RenderPipelines& pipelines,
                               const FrothDepthExportInfo& info, const VkRect2D& region, bool isReversed) {
  const VkDescriptorImageInfo image{VK_NULL_HANDLE, info.depth.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkDescriptorSet set = state_->exportSets->update(kMostEyes * state_->slot + info.eye, {&image, 1});
  recordPass(state_->breadcrumbs, commandBuffer,
             {"frothRecordDepthExport", "export_depth", info.eye, state_->lastSerial},
             [&] { pipelines.state().depthExport->record(commandBuffer, set, info, region, isReversed); });
}

void ViewRenderer::dropFrame(uint64_t serial) {
  for (FrameSlot& slot : state_->slots) {
    if (slot.serial == serial) slot = {};
  }
  if (state_->breadcrumbs) state_->breadcrumbs->dropFrame(serial);
  // it may be that frame that would have found the start
  for (const auto& space : state_->spaces) space->walkAsset = nullptr;
}

const FrothViewStatus& ViewRenderer::status() const { return state_->status; }

}  // namespace froth
