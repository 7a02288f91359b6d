#include "runtime/render/view_buffers.h"

#include <cstring>
#include <initializer_list>
#include <utility>

#include "shaders/gpu/layout.h"

namespace froth {
namespace {

static_assert(sizeof(gpu::FrameBlock) <= kBlockStride && sizeof(gpu::Counters) <= kBlockStride);

VkDeviceSize strideOf(const ViewCapacity& capacity) {
  return kBlockStride + VkDeviceSize{capacity.chunks} * sizeof(gpu::ChunkEntry);
}

VkDeviceSize sizeOf(ViewBuffer id, const ViewCapacity& capacity) {
  const VkDeviceSize cells = capacity.cells;
  const VkDeviceSize pairs = capacity.pairs;
  switch (id) {
    case ViewBuffer::kFrames:
      return kRecordingsPerFrame * strideOf(capacity);
    case ViewBuffer::kStaging:
      return capacity.frames * kRecordingsPerFrame * strideOf(capacity);
    case ViewBuffer::kReadback:
      return capacity.frames * kRecordingsPerFrame * kBlockStride;
    case ViewBuffer::kCounters:
      return kRecordingsPerFrame * kBlockStride;
    case ViewBuffer::kGroupSums:
      return 8 * VkDeviceSize{capacity.groups};
    case ViewBuffer::kVisibility:
      return 8 * gpu::kMaskWords * VkDeviceSize{capacity.groups};
    case ViewBuffer::kVisibleCells:
      return 16 * cells;
    case ViewBuffer::kRecords:
      return sizeof(gpu::CellRecord) * cells;
    case ViewBuffer::kPlanes:
      return 16 * capacity.planes;
    case ViewBuffer::kDetails:
      return sizeof(gpu::DetailRecord) * capacity.details;
    case ViewBuffer::kCellKeys:
    case ViewBuffer::kCellKeysSwap:
    case ViewBuffer::kOrder:
    case ViewBuffer::kOrderSwap:
    case ViewBuffer::kSlotTiles:
    case ViewBuffer::kTileCounts:
      return 4 * cells;
    case ViewBuffer::kPairTiles:
    case ViewBuffer::kPairTilesSwap:
    case ViewBuffer::kPairCells:
    case ViewBuffer::kPairCellsSwap:
      return 4 * pairs;
    case ViewBuffer::kTileLists:
      return sizeof(gpu::uvec4) * capacity.tiles;
    case ViewBuffer::kTallies:
      return layOutTallies(capacity, fewestSortRounds(capacity)).end;
    case ViewBuffer::kWalkStart:
      return 8 * VkDeviceSize{capacity.walkStarts};
    case ViewBuffer::kRays:
      return 16 * capacity.rays;
    case ViewBuffer::kCones:  // of sub-tiles, tiles, and at most as many blocks
      return capacity.rays > 0 ? 16 * (gpu::kSubTilesPerTile + 2) * VkDeviceSize{capacity.tiles} : 0;
    case ViewBuffer::kHits:
      return gpu::kHitWords * sizeof(uint32_t) * capacity.hits;
  }
  return 0;
}

BufferKind kindOf(ViewBuffer id) {
  if (id == ViewBuffer::kStaging) return BufferKind::kStaging;
  return id == ViewBuffer::kReadback ? BufferKind::kReadback : BufferKind::kDevice;
}

const char* nameOf(ViewBuffer id) {
  constexpr std::array<const char*, kViewBufferCount> kNames = {"view: frames",          "view: staging",
                                                                "view: read-back",       "view: counters",
                                                                "view: group sums",      "view: visibility",
                                                                "view: visible cells",   "view: cell keys",
                                                                "view: cell keys, swap", "view: order",
                                                                "view: order, swap",     "view: records",
                                                                "view: planes",          "view: details",
                                                                "view: slot tiles",      "view: tile counts",
                                                                "view: pair tiles",      "view: pair tiles, swap",
                                                                "view: pair cells",      "view: pair cells, swap",
                                                                "view: tallies",         "view: tile lists",
                                                                "view: walk start",      "view: rays",
                                                                "view: cones",           "view: hits"};
  return kNames[static_cast<uint32_t>(id)];
}

MemoryUse useOf(ViewBuffer id) { return kindOf(id) == BufferKind::kDevice ? MemoryUse::kViews : MemoryUse::kViewsHost; }

}  // namespace

ViewBuffers::~ViewBuffers() {
  freeRetired(UINT64_MAX);
  for (GpuBuffer& buffer : buffers_) device_.destroyBuffer(buffer);
}

Status ViewBuffers::grow(const ViewCapacity& wanted, uint64_t lastSerial) {
  const ViewCapacity grown = largest(capacity_, wanted);
  retired_.reserve(retired_.size() + kViewBufferCount);
  std::array<GpuBuffer, kViewBufferCount> larger{};
  for (uint32_t i = 0; i < kViewBufferCount; ++i) {
    const auto id = static_cast<ViewBuffer>(i);
    if (buffers_[i].size >= sizeOf(id, grown)) continue;
    Result<GpuBuffer> buffer = device_.createBuffer(useOf(id), kindOf(id), sizeOf(id, grown), nameOf(id));
    if (!buffer) {
      for (GpuBuffer& made : larger) device_.destroyBuffer(made);
      return buffer.error();
    }
    larger[i] = *buffer;
  }
  for (uint32_t i = 0; i < kViewBufferCount; ++i) {
    if (larger[i].size == 0) continue;
    if (buffers_[i].size != 0 && lastSerial != 0) {
      retired_.emplace_back(lastSerial, buffers_[i]);
    } else {
      device_.destroyBuffer(buffers_[i]);
    }
    buffers_[i] = larger[i];
  }
  capacity_ = grown;
  return {};
}

void ViewBuffers::freeRetired(uint64_t completedSerial) {
  std::erase_if(retired_, [&](std::pair<uint64_t, GpuBuffer>& retired) {
    if (retired.first > completedSerial) return false;
    device_.destroyBuffer(retired.second);
    return true;
  });
}

Status ViewBuffers::trim(uint64_t lastSerial, uint64_t completedSerial) {
  retired_.reserve(1);
  for (uint32_t i = 0; i < kViewBufferCount && retired_.empty(); ++i) {
    const auto id = static_cast<ViewBuffer>(i);
    const VkDeviceSize size = sizeOf(id, capacity_);
    if (buffers_[i].size <= size) continue;
    Result<GpuBuffer> smaller = device_.createBuffer(useOf(id), kindOf(id), size, nameOf(id), true);
    if (!smaller) return smaller.error();
    retired_.emplace_back(lastSerial, std::exchange(buffers_[i], *smaller));
    freeRetired(completedSerial);
  }
  return {};
}

bool ViewBuffers::isTrimmed() const {
  if (!retired_.empty()) return false;
  for (uint32_t i = 0; i < kViewBufferCount; ++i) {
    if (buffers_[i].size > sizeOf(static_cast<ViewBuffer>(i), capacity_)) return false;
  }
  return true;
}

VkDeviceSize bytesOf(const ViewCapacity& capacity) {
  VkDeviceSize bytes = 0;
  for (uint32_t i = 0; i < kViewBufferCount; ++i) {
    const auto id = static_cast<ViewBuffer>(i);
    bytes += kindOf(id) == BufferKind::kDevice ? sizeOf(id, capacity) : 0;
  }
  return bytes;
}

VkDeviceSize ViewBuffers::deviceBytes() const {
  VkDeviceSize bytes = 0;
  for (const GpuBuffer& buffer : buffers_) bytes += buffer.kind == BufferKind::kDevice ? buffer.size : 0;
  for (const auto& [serial, buffer] : retired_) bytes += buffer.kind == BufferKind::kDevice ? buffer.size : 0;
  return bytes;
}

void ViewBuffers::addMemory(FrothViewStatus& status) const {
  status.deviceBytes += deviceBytes();
  const auto add = [&](const char* name, std::initializer_list<ViewBuffer> ids) {
    uint32_t place = 0;
    while (place < status.memoryCount && std::strcmp(status.memory[place].name, name) != 0) ++place;
    if (place == status.memoryCount) status.memory[status.memoryCount++] = {name, 0};
    for (const ViewBuffer id : ids) status.memory[place].bytes += (*this)[id].size;
  };
  using enum ViewBuffer;
  add("frames", {kFrames, kCounters, kWalkStart});
  add("visibility of all cells", {kGroupSums, kVisibility});
  add("visible cells", {kVisibleCells, kCellKeys, kCellKeysSwap, kOrder, kOrderSwap, kSlotTiles, kTileCounts});
  add("records", {kRecords});
  add("planes", {kPlanes});
  add("detail sites", {kDetails});
  if (capacity_.rays > 0) add("rays", {kRays, kCones});
  if (capacity_.hits > 0) add("hits", {kHits});
  add("pairs", {kPairTiles, kPairTilesSwap, kPairCells, kPairCellsSwap, kTallies, kTileLists});
}

uint32_t ViewBuffers::sortRounds() const {
  const uint32_t rounds = sortRoundsOf(expectedCells_);
  const bool hasRoom = layOutTallies(capacity_, rounds).end <= (*this)[ViewBuffer::kTallies].size;
  return hasRoom ? rounds : gpu::kManyKeysRounds;
}

VkDeviceSize ViewBuffers::recordingStride() const { return strideOf(capacity_); }

}  // namespace froth
