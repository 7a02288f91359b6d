// Chunks of an asset with levels of detail: how they come, are drawn, and go.
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "format/to_vector.h"
#include "runtime/asset/asset.h"

namespace froth {

// Without levels all chunks are to be read; with them the floor, and nothing is exchanged for other layers.
void Asset::takeLevels(const AssetReader& reader) {
  const AssetContents& manifest = reader.manifest();
  const auto chunkCount = static_cast<uint32_t>(manifest.chunks.size());
  const auto isFloor = [](const ChunkLevel& chunk) { return chunk.in == kNoGroup; };
  floorCount_ = manifest.levels.empty()
                    ? chunkCount
                    : static_cast<uint32_t>(std::count_if(manifest.levels.begin(), manifest.levels.end(), isFloor));
  toRead_.resize(floorCount_);
  std::iota(toRead_.begin(), toRead_.end(), 0u);
  if (manifest.levels.empty()) return;
  keepLayers();
  gpu_.fileChunkCount = chunkCount;
  gpu_.borderCount = manifest.borderCount;
  slots_.begin(chunkCount);
  std::vector<uint32_t> floor(toRead_.begin(), toRead_.end());
  slots_.plan(std::move(floor));
  LoadedChunk whole;
  for (uint32_t chunk = 0; chunk < chunkCount; ++chunk) {
    if (manifest.chunks[chunk].liveCount == 0) continue;
    const Box box = placeBox(manifest.chunks[chunk].origin, reader.liveBounds(chunk));
    whole.bounds.low = glm::min(whole.bounds.low, toVector(box.min));
    whole.bounds.high = glm::max(whole.bounds.high, toVector(box.max));
    whole.gpu.liveCount += manifest.chunks[chunk].liveCount;
  }
  growBounds(whole);
  if (keepsForQueries_) levelFoam_ = std::make_shared<QueryFoam>(manifest, whole.bounds);
}

Status Asset::placeBorders() {
  if (!hasLevels() || !device_ || gpu_.borders != 0) return {};
  const Result<GpuArena::Place> place = arena_->allocate(gpu_.borderBytes(), 0, "table of borders");
  if (!place) return place.error();
  addMemory("table of borders", gpu_.borderBytes());
  gpu_.borders = place->address;
  gpu_.borderBuffer = place->buffer;
  gpu_.borderOffset = place->offset;
  return {};
}

VkDeviceSize Asset::chunkBytes(uint32_t chunk) const {
  if (chunks_[chunk].deviceBytes > 0) return chunks_[chunk].deviceBytes;
  const double share = static_cast<double>(chunkWork_[chunk]) / static_cast<double>(std::max<uint64_t>(workDone_, 1));
  return static_cast<VkDeviceSize>(share * static_cast<double>(placedBytes_));
}

VkDeviceSize Asset::tableBytes() const {
  const VkDeviceSize along = gpu_.walkEntriesAlong;
  return (gpu_.borders != 0 ? gpu_.borderBytes() : 0) + sizeof(gpu::uvec4) * along * along * along;
}

void Asset::readChunk(uint32_t chunk) {
  const SlotState state = slots_.stateOf(chunk);
  if (state != SlotState::kAbsent && state != SlotState::kFailed) return;
  toRead_.push_back(chunk);
  slots_.setState(chunk, SlotState::kComing);
}

void Asset::evictChunk(uint32_t chunk) {
  const auto queued = std::find(toRead_.begin(), toRead_.end(), chunk);
  if (isDecoded_ && queued - toRead_.begin() >= static_cast<std::ptrdiff_t>(fetches_.size()) &&
      queued != toRead_.end()) {
    toRead_.erase(queued);
    slots_.setState(chunk, SlotState::kAbsent);
    return;
  }
  const bool isFading = slots_.isFading(chunk), isDrawn = slots_.isDrawn(chunk);
  if (before_ && (isFading || isDrawn)) mustEndFade_ = true;  // what is drawn waits for that with the next plan
  const bool mayGo = chunk >= floorCount_ && !isFading && !isDrawn && !slots_.isPlanned(chunk);
  if (mayGo && slots_.stateOf(chunk) == SlotState::kResident) slots_.setState(chunk, SlotState::kLeaving);
}

// Of the floor it is the asset's error.
Status Asset::refuseChunk(uint32_t chunk, const Error& error) {
  if (!isDecoded_ || (device_ && device_->loss->isTold())) return error;
  slots_.setState(chunk, SlotState::kFailed);
  refusals_.insert_or_assign(chunk, error);
  return {};
}

Error Asset::takeRefusal(uint32_t chunk) {
  const auto refusal = refusals_.extract(chunk);
  return refusal.empty() ? Error{} : std::move(refusal.mapped());
}

bool Asset::updateChunks(uint64_t completedSerial, uint64_t completedUploadSerial, const UploadRing* ring) {
  const auto isUploaded = [&](const ChunkSlot& slot) {
    const void* const owner = slot.gpu.number < floorCount_ ? static_cast<const void*>(this) : &slot;
    const auto isWaiting = [&](const PendingArray& array) { return array.owner == owner; };
    return std::none_of(arrays_.begin(), arrays_.end(), isWaiting) &&
           (!ring || ring->isWithin(owner, completedUploadSerial));
  };
  const auto hasPlaces = [&](const ChunkSlot& slot) {
    return !prepared_ || prepared_->has(slot.gpu.number) || preparedBytesOf(slot.gpu) == 0;
  };
  slots_.forEachTaken([&](ChunkSlot& slot) {
    const uint32_t chunk = slot.gpu.number;
    const SlotState state = slots_.stateOf(chunk);
    const bool isThere = state == SlotState::kComing && hasPlaces(slot) && isUploaded(slot);
    if (isThere) slots_.setState(chunk, SlotState::kResident);
    if (state == SlotState::kLeaving && slot.lastSerial <= completedSerial) removeChunk(chunk);
  });
  if (!slots_.canTakePlan()) return false;
  slots_.measurePlan(gpu_);
  return true;
}

void Asset::removeChunk(uint32_t chunk) {
  const ChunkSlot& slot = slots_.slotOf(chunk);
  for (const auto& [name, bytes] : slot.parts) removeMemory(name, bytes);
  if (slot.size > 0) arena_->free(slot.place, slot.size);
  if (prepared_) prepared_->free(chunk);
  placedBytes_ -= slot.size;
  workDone_ -= chunkWork_[chunk];
  workToCome_ += chunkWork_[chunk];
  slots_.remove(chunk);
  if (levelFoam_) levelFoam_->removeChunk(chunk);
}

// Entries of rays are those of the chunks that are drawn.
void Asset::takePlan(uint64_t serial, bool fades) {
  drawPlan(serial, fades);
  entriesSerial = 0;
}

// For queries too. Without memory all stays as it is.
void Asset::drawPlan(uint64_t serial, bool fades) {
  QueryCut cut;
  if (levelFoam_) cut = levelFoam_->makeCut(slots_.planned());
  if (fades && !slots_.drawn().empty() && !std::ranges::equal(slots_.drawn(), slots_.planned())) {
    before_ = gpu_;
    before_->next = {};
  }
  slots_.takePlan(serial, gpu_, before_.has_value());
  if (!levelFoam_) return;
  levelFoam_->show(std::move(cut));
  queryFoam_ = levelFoam_;
}

void Asset::endFade(uint64_t serial) {
  slots_.endFade(serial);
  before_.reset();
  mustEndFade_ = false;
}

void Asset::dropFrame(uint64_t serial) {
  if (entriesSerial == serial) entriesSerial = 0;
  if (prepared_) prepared_->dropFrame(serial);
  slots_.dropFrame(serial);
}

void Asset::forgetCopies(UploadRing& ring, const std::shared_ptr<void>& targets) {
  ring.forget(this, targets);
  slots_.forEachTaken([&](const ChunkSlot& slot) { ring.forget(&slot, targets); });
}

}  // namespace froth
