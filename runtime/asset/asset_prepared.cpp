// Cells of an asset that are prepared for rays: which chunks have room for them, and who fills it.
#include <algorithm>
#include <vector>

#include "runtime/asset/asset.h"

namespace froth {
namespace {

// Blocks may leave this part of what is asked for unused; where chunks come and go, as much as in level_budget.cpp.
constexpr VkDeviceSize kPreparedSpare = 16;
constexpr double kPreparedUsed = 0.7;

}  // namespace

uint32_t Asset::preparedForm() const {
  const bool isWalked = gpu_.hasWalkGraph && device_ && description_.liveCount > 0;
  return isWalked ? preparedForWalks_ : gpu::kPreparedNothing;
}

VkDeviceSize Asset::preparedBytesOf(const GpuChunk& chunk) const {
  return preparedBytes(gpu_, preparedForm(), {chunk.liveCount, chunk.neighbourCount, chunk.lobeQuadTotal()});
}

VkDeviceSize Asset::preparedBytesWanted() const {
  const VkDeviceSize drawn = preparedBytes(gpu_, preparedForm());
  if (!hasLevels()) return drawn + drawn / kPreparedSpare;
  VkDeviceSize drawnChunks = 0, allChunks = 0;
  for (uint32_t chunk = 0; chunk < chunkCount(); ++chunk) {
    allChunks += chunkBytes(chunk);
    if (slots_.isDrawn(chunk)) drawnChunks += chunkBytes(chunk);
  }
  const double share = static_cast<double>(allChunks) / static_cast<double>(std::max<VkDeviceSize>(drawnChunks, 1));
  return static_cast<VkDeviceSize>(static_cast<double>(drawn) * share / kPreparedUsed);
}

void Asset::beginPreparing() { prepared_ = std::make_shared<PreparedCells>(*device_, chunkCount()); }

Status Asset::placePrepared() {
  std::vector<const GpuChunk*> lacking;
  VkDeviceSize toCome = 0;
  const auto find = [&](const GpuChunk& chunk) {
    const VkDeviceSize size = preparedBytesOf(chunk);
    if (size == 0 || prepared_->has(chunk.number)) return;
    lacking.push_back(&chunk);
    toCome += size;
  };
  if (hasLevels()) {
    slots_.forEachTaken([&](const ChunkSlot& slot) {
      if (slots_.stateOf(slot.gpu.number) != SlotState::kLeaving) find(slot.gpu);
    });
  } else {
    std::ranges::for_each(gpu_.chunks, find);
  }
  for (const GpuChunk* const chunk : lacking) {
    const VkDeviceSize size = preparedBytesOf(*chunk);
    toCome -= size;
    if (const Status status = prepared_->place(chunk->number, size, toCome); !status) return status;
  }
  awaitsPrepared_ = false;
  return {};
}

std::shared_ptr<PreparedCells> Asset::releasePrepared() {
  for (GpuChunk& chunk : gpu_.chunks) chunk.prepared = 0;
  gpu_.prepared = gpu_.preparing = gpu::kPreparedNothing;
  awaitsPrepared_ = false;
  return std::move(prepared_);
}

std::span<const uint32_t> Asset::fillPrepared(uint64_t serial, uint64_t& bytesLeft) {
  toFill_.clear();
  if (!prepared_) return toFill_;
  toFill_.reserve(gpu_.chunks.size());
  bool isWhole = true;
  for (uint32_t slot = 0; slot < gpu_.chunks.size(); ++slot) {
    GpuChunk& chunk = gpu_.chunks[slot];
    const VkDeviceSize size = preparedBytesOf(chunk);
    if (size == 0) continue;
    chunk.prepared = prepared_->addressOf(chunk.number);
    if (prepared_->filledBy(chunk.number) != 0) continue;
    const bool isNow = prepared_->has(chunk.number) && bytesLeft > 0;
    isWhole = isWhole && isNow;
    if (!isNow) continue;
    bytesLeft -= std::min<uint64_t>(bytesLeft, size);
    prepared_->fill(chunk.number, serial);
    toFill_.push_back(slot);
  }
  gpu_.preparing = preparedForm();
  gpu_.prepared = isWhole ? gpu_.preparing : gpu::kPreparedNothing;
  return toFill_;
}

}  // namespace froth
