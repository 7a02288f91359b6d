#include "runtime/asset/chunk_slots.h"

#include <algorithm>
#include <utility>

namespace froth {
namespace {

uint32_t groupsOf(const GpuChunk& chunk) { return (chunk.cellCount + gpu::kGroupSize - 1) / gpu::kGroupSize; }

}  // namespace

void ChunkSlots::begin(uint32_t fileChunkCount) {
  *this = {};
  slotOf_.assign(fileChunkCount, kNoSlot);
  states_.assign(fileChunkCount, SlotState::kAbsent);
}

ChunkSlot& ChunkSlots::add(const GpuChunk& chunk) {
  auto free = std::find_if(slots_.begin(), slots_.end(), [](const ChunkSlot& slot) { return !slot.isTaken; });
  if (free == slots_.end()) free = slots_.emplace(slots_.end());
  *free = {};
  free->gpu = chunk;
  free->isTaken = true;
  slotOf_[chunk.number] = static_cast<uint32_t>(free - slots_.begin());
  states_[chunk.number] = SlotState::kComing;
  return *free;
}

void ChunkSlots::remove(uint32_t chunk) {
  slots_[slotOf_[chunk]] = {};
  slotOf_[chunk] = kNoSlot;
  states_[chunk] = SlotState::kAbsent;
}

bool ChunkSlots::isPlanned(uint32_t chunk) const {
  return std::find(planned_.begin(), planned_.end(), chunk) != planned_.end();
}

bool ChunkSlots::canTakePlan() const {
  return !planned_.empty() && std::all_of(planned_.begin(), planned_.end(),
                                          [&](uint32_t chunk) { return states_[chunk] == SlotState::kResident; });
}

void ChunkSlots::measurePlan(GpuAsset& asset) const {
  asset.next = {};
  for (const uint32_t chunk : planned_) {
    const GpuChunk& planned = slots_[slotOf_[chunk]].gpu;
    asset.next.chunkCount = std::max(asset.next.chunkCount, slotOf_[chunk] + 1);
    asset.next.groupCount += groupsOf(planned);
    asset.next.cellCount += planned.cellCount;
    asset.next.liveCount += planned.liveCount;
    asset.next.alphaTotal += planned.alphaTotal;
  }
}

void ChunkSlots::takePlan(uint64_t serial, GpuAsset& asset, bool keepsBefore) {
  if (keepsBefore) {
    entering_.reserve(planned_.size());
    leaving_.reserve(drawn_.size());
    for (const uint32_t chunk : planned_) {
      if (!isDrawn(chunk)) entering_.push_back(slotOf_[chunk]);
    }
  }
  for (const uint32_t chunk : drawn_) slotOf(chunk).isDrawn = false;
  for (const uint32_t chunk : planned_) slotOf(chunk).isDrawn = true;
  for (const uint32_t chunk : drawn_) {
    if (isDrawn(chunk)) continue;
    ChunkSlot& slot = slotOf(chunk);
    slot.lastSerial = serial - 1;
    slot.publishedSerial = 0;
    slot.isFading = keepsBefore;
    if (keepsBefore) leaving_.push_back(slotOf_[chunk]);
  }
  asset.liveCount = asset.cellCount = 0;
  asset.alphaTotal = asset.neighbourTotal = asset.lobeQuadTotal = 0;
  asset.chunks.assign(asset.next.chunkCount, {});
  asset.firstSlot = kNoSlot;
  for (const uint32_t chunk : planned_) {
    const uint32_t slot = slotOf_[chunk];
    asset.chunks[slot] = slots_[slot].gpu;
    asset.count(slots_[slot].gpu);
    if (slots_[slot].gpu.cellCount > 0) asset.firstSlot = std::min(asset.firstSlot, slot);
  }
  if (asset.firstSlot == kNoSlot) asset.firstSlot = 0;
  asset.next = {};
  drawn_ = std::exchange(planned_, {});
  unpublished_.reserve(drawn_.size());
}

void ChunkSlots::endFade(uint64_t serial) {
  for (const uint32_t slot : leaving_) {
    slots_[slot].isFading = false;
    slots_[slot].lastSerial = serial - 1;
  }
  leaving_.clear();
  entering_.clear();
}

ChunkSlots::Publication ChunkSlots::publish(uint64_t serial) {
  unpublished_.clear();
  for (const uint32_t chunk : drawn_) {
    ChunkSlot& slot = slotOf(chunk);
    if (slot.publishedSerial != 0) continue;
    slot.publishedSerial = serial;
    unpublished_.push_back(slotOf_[chunk]);
  }
  const bool isTableNew = tableSerial_ == 0;
  if (isTableNew) tableSerial_ = serial;
  return {unpublished_, isTableNew};
}

void ChunkSlots::dropFrame(uint64_t serial) {
  const bool isTableLost = tableSerial_ == serial;
  if (isTableLost) tableSerial_ = 0;
  forEachTaken([&](ChunkSlot& slot) {
    if (isTableLost || slot.publishedSerial == serial) slot.publishedSerial = 0;
  });
}

}  // namespace froth
