#include "runtime/render/view_buffers.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <span>
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
      return capacity.recordings * strideOf(capacity);
    case ViewBuffer::kStaging:
      return capacity.frames * capacity.recordings * strideOf(capacity);
    case ViewBuffer::kReadback:
      return capacity.frames * capacity.recordings * kBlockStride;
    case ViewBuffer::kCounters:
      return capacity.recordings * kBlockStride;
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
      return 8 * VkDeviceSize{capacity.tiles};
    case ViewBuffer::kRays:
      return 16 * capacity.rays;
    case ViewBuffer::kCones:  // of sub-tiles, tiles, and at most as many blocks
      return capacity.rays > 0 ? 16 * (gpu::kSubTilesPerTile + 2) * VkDeviceSize{capacity.tiles} : 0;
    case ViewBuffer::kHits:
      return gpu::kHitWords * sizeof(uint32_t) * capacity.hits;
    case ViewBuffer::kQuarters:
      return sizeof(gpu::uvec4) * capacity.quarters;
    case ViewBuffer::kFade:
      return sizeof(gpu::uvec2) * capacity.fades;
  }
  return 0;
}

BufferKind kindOf(ViewBuffer id) {
  if (id == ViewBuffer::kStaging) return BufferKind::kStaging;
  return id == ViewBuffer::kReadback ? BufferKind::kReadback : BufferKind::kDevice;
}

constexpr std::array<const char*, kViewBufferCount> kNames = {"view: frames",
                                                              "view: counters",
                                                              "view: group sums",
                                                              "view: visibility",
                                                              "view: tile lists",
                                                              "view: walk start",
                                                              "view: rays",
                                                              "view: cones",
                                                              "view: hits",
                                                              "view: quarters",
                                                              "view: fade",
                                                              "view: tallies",
                                                              "view: visible cells",
                                                              "view: cell keys",
                                                              "view: cell keys, swap",
                                                              "view: order",
                                                              "view: order, swap",
                                                              "view: slot tiles",
                                                              "view: tile counts",
                                                              "view: records",
                                                              "view: details",
                                                              "view: planes",
                                                              "view: pair tiles",
                                                              "view: pair tiles, swap",
                                                              "view: pair cells",
                                                              "view: pair cells, swap",
                                                              "view: staging",
                                                              "view: read-back"};

struct Group {
  const char* name;
  ViewBuffer first, last;
};
constexpr Group kGroups[] = {{"view: frames", ViewBuffer::kFrames, ViewBuffer::kWalkStart},
                             {"view: pixels", ViewBuffer::kRays, ViewBuffer::kFade},
                             {"view: tallies", ViewBuffer::kTallies, ViewBuffer::kTallies},
                             {"view: visible cells", ViewBuffer::kVisibleCells, ViewBuffer::kDetails},
                             {"view: planes", ViewBuffer::kPlanes, ViewBuffer::kPlanes},
                             {"view: pairs", ViewBuffer::kPairTiles, ViewBuffer::kPairCellsSwap},
                             {"view: staging", ViewBuffer::kStaging, ViewBuffer::kStaging},
                             {"view: read-back", ViewBuffer::kReadback, ViewBuffer::kReadback}};

// Whether a buffer of the group is of such a size, seen beside what the capacity asks for.
template <class Compare>
bool hasAny(const Group& group, std::span<const GpuBuffer> buffers, const ViewCapacity& capacity, Compare compare) {
  for (auto i = static_cast<uint32_t>(group.first); i <= static_cast<uint32_t>(group.last); ++i) {
    if (compare(buffers[i].size, sizeOf(static_cast<ViewBuffer>(i), capacity))) return true;
  }
  return false;
}

// The group's own of `made`.
Status makeGroup(Device& device, const Group& group, const ViewCapacity& capacity, std::span<GpuBuffer> made,
                 bool mayExceedBudget = false) {
  const auto first = static_cast<uint32_t>(group.first), count = static_cast<uint32_t>(group.last) - first + 1;
  std::array<BufferWish, kViewBufferCount> wishes;
  for (uint32_t i = 0; i < count; ++i) {
    wishes[i] = {sizeOf(static_cast<ViewBuffer>(first + i), capacity), kNames[first + i]};
  }
  const BufferKind kind = kindOf(group.first);
  const MemoryUse use = kind == BufferKind::kDevice ? MemoryUse::kViews : MemoryUse::kViewsHost;
  return device.createBuffers(use, kind, group.name, std::span(wishes).first(count), made.subspan(first, count),
                              mayExceedBudget);
}

}  // namespace

ViewBuffers::~ViewBuffers() {
  freeRetired(UINT64_MAX);
  for (GpuBuffer& buffer : buffers_) device_.destroyBuffer(buffer);
}

Status ViewBuffers::grow(const ViewCapacity& wanted, uint64_t lastSerial) {
  const ViewCapacity grown = largest(capacity_, wanted);
  retired_.reserve(retired_.size() + kViewBufferCount);
  const uint64_t newestOrder = device_.newestOrder();
  Buffers larger{};
  Status status;
  for (const Group& group : kGroups) {
    if (!hasAny(group, buffers_, grown, std::less())) continue;
    const Status made = makeGroup(device_, group, grown, larger);
    if (!made) status = made;
    if (!made && !isOrdered(made)) break;  // what the others ordered would only take room
  }
  if (!status) {
    if (!isOrdered(status)) device_.cancelOrdersBehind(newestOrder);
    for (GpuBuffer& made : larger) device_.destroyBuffer(made);
    return status;
  }
  replaceBy(larger, lastSerial);
  capacity_ = grown;
  return {};
}

// Takes over the groups that were made. retired_ has room for what they replace.
void ViewBuffers::replaceBy(const Buffers& made, uint64_t lastSerial) {
  for (uint32_t i = 0; i < kViewBufferCount; ++i) {
    if (made[i].size == 0) continue;
    if (buffers_[i].size != 0 && lastSerial != 0) {
      retired_.emplace_back(lastSerial, buffers_[i]);
    } else {
      device_.destroyBuffer(buffers_[i]);
    }
    buffers_[i] = made[i];
  }
}

void ViewBuffers::freeRetired(uint64_t completedSerial) {
  std::erase_if(retired_, [&](std::pair<uint64_t, GpuBuffer>& retired) {
    if (retired.first > completedSerial) return false;
    device_.destroyBuffer(retired.second);
    return true;
  });
}

Status ViewBuffers::trim(uint64_t lastSerial, uint64_t completedSerial) {
  retired_.reserve(kViewBufferCount);
  for (const Group& group : kGroups) {
    if (!retired_.empty()) break;
    if (!hasAny(group, buffers_, capacity_, std::greater())) continue;
    Buffers smaller{};
    if (const Status status = makeGroup(device_, group, capacity_, smaller, true); !status) return status;
    replaceBy(smaller, lastSerial);
    freeRetired(completedSerial);
  }
  return {};
}

bool ViewBuffers::isTrimmed() const {
  return retired_.empty() && std::ranges::none_of(kGroups, [&](const Group& group) {
           return hasAny(group, buffers_, capacity_, std::greater());
         });
}

VkDeviceSize bytesOf(const ViewCapacity& capacity) {
  VkDeviceSize bytes = 0;
  for (uint32_t i = 0; i < kViewBufferCount; ++i) {
    const auto id = static_cast<ViewBuffer>(i);
    bytes += kindOf(id) == BufferKind::kDevice ? sizeOf(id, capacity) : 0;
  }
  return bytes;
}

VkDeviceSize hostBytesOf(const ViewCapacity& capacity) {
  return sizeOf(ViewBuffer::kStaging, capacity) + sizeOf(ViewBuffer::kReadback, capacity);
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
  if (capacity_.hits > 0) add("hits", {kHits, kQuarters});
  if (capacity_.fades > 0) add("fade", {kFade});
  add("pairs", {kPairTiles, kPairTilesSwap, kPairCells, kPairCellsSwap, kTallies, kTileLists});
}

uint32_t ViewBuffers::sortRounds() const {
  const uint32_t rounds = sortRoundsOf(expectedCells_);
  const bool hasRoom = layOutTallies(capacity_, rounds).end <= (*this)[ViewBuffer::kTallies].size;
  return hasRoom ? rounds : gpu::kManyKeysRounds;
}

VkDeviceSize ViewBuffers::recordingStride() const { return strideOf(capacity_); }

}  // namespace froth
