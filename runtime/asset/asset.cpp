#include "runtime/asset/asset.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace froth {

Asset::Asset(AssetSource source, Device* device) : source_(std::move(source)), device_(device) {
  if (device) {
    arena_ = std::make_shared<GpuArena>(*device);
  }
}

Asset::~Asset() { stop(); }

void Asset::fail(FrothResult code, const char* text, const Messages& messages) {
  error_ = messages.fail(code, source_.name.c_str(), "%s", text);
  stop();
  arrays_.clear();
  queryFoam_.reset();
  levelFoam_.reset();
}

void Asset::fail(const Error& error, const Messages& messages) {
  if (device_ && device_->loss->isTold()) {
    return;  // not the asset's fault: frothUpdate tells, and restart() follows
  }
  // The reader's texts begin with the name, which the message has as its object.
  const std::string_view text = error.message;
  const bool hasName = text.starts_with(source_.name) && text.substr(source_.name.size()).starts_with(": ");
  fail(resultOf(error), error.message.c_str() + (hasName ? source_.name.size() + 2 : 0), messages);
}

void Asset::restart(const Messages& messages) {
  stop();
  placedBytes_ = 0;
  arrays_.clear();
  refusals_.clear();
  isDecoded_ = false;
  error_ = FROTH_OK;
  description_ = {};
  flightPath_.clear();
  chunks_.clear();
  gpu_ = {};
  before_.reset();
  mustEndFade_ = false;
  slots_ = {};
  levelFoam_.reset();
  entriesSerial = 0;
  prepared_.reset();
  isPreparingRefused_ = false;
  awaitPrepared();
  arena_ = device_ ? std::make_shared<GpuArena>(*device_) : nullptr;
  if (source_.kind == SourceKind::kMemory && !source_.bytesStay) {
    fail(FROTH_ERROR_STATE,
         "its bytes are not there any more to load it again; set FrothAssetInfo::bytesStay, or close and open it",
         messages);
  }
}

// Changes nothing while its memory is ordered.
Status Asset::placeChunk(LoadedChunk& loaded) {
  const uint32_t number = loaded.gpu.number;
  GpuArena::Place place;
  if (loaded.arrays.size > 0) {
    const std::string purpose = "chunk " + std::to_string(number);
    const Result<GpuArena::Place> given =
        arena_->allocate(loaded.arrays.size, bytesToCome(number, loaded.arrays.size), purpose.c_str());
    if (!given) {
      return given.error();
    }
    place = *given;
  }
  chunks_[number].deviceBytes = loaded.arrays.size;
  workDone_ += chunkWork_[number];
  workToCome_ -= chunkWork_[number];
  if (hasLevels()) {
    ChunkSlot& slot = slots_.add(loaded.gpu);
    slot.place = place;
    slot.size = loaded.arrays.size;
    for (const ChunkArray& array : loaded.arrays.arrays) slot.parts.emplace_back(array.purpose, array.size);
    placeArrays(loaded.arrays, place, slot.gpu, isDecoded_ ? static_cast<const void*>(&slot) : this);
    if (loaded.query) levelFoam_->setChunk(number, std::move(*loaded.query));
    return {};
  }
  growBounds(loaded);
  gpu_.add(loaded.gpu);
  if (loaded.query) {
    queryFoam_->addChunk(std::move(*loaded.query), loaded.bounds);
  }
  placeArrays(loaded.arrays, place, gpu_.chunks.back(), this);
  return {};
}

// What the arena will be asked for behind `size` bytes of the chunk at hand, by what chunks have needed so far.
VkDeviceSize Asset::bytesToCome(uint32_t chunk, VkDeviceSize size) const {
  const uint64_t atHand = chunkWork_[chunk];
  uint64_t workToCome = workToCome_ - atHand;
  if (hasLevels()) {  // nobody knows which of the others will come
    workToCome = 0;
    for (const uint32_t queued : toRead_) workToCome += chunkWork_[queued];
    for (const Decoding& decoding : decoding_) workToCome += chunkWork_[decoding.chunk];
  }
  const auto done = static_cast<double>(workDone_ + atHand), toCome = static_cast<double>(workToCome);
  const double share = done > 0 ? toCome / done : 0;
  const double chunks = std::min(static_cast<double>(placedBytes_ + size) * share, double{GpuArena::kMostShared});
  const uint64_t along = entriesAlong();
  if (hasLevels() && isDecoded_) return std::min(static_cast<VkDeviceSize>(chunks), GpuArena::kMoreWherePlacesGo);
  return static_cast<VkDeviceSize>(chunks) + sizeof(gpu::uvec4) * along * along * along;
}

void Asset::placeArrays(const ChunkArrays& arrays, const GpuArena::Place& place, GpuChunk& chunk, const void* owner) {
  placedBytes_ += arrays.size;
  for (const ChunkArray& array : arrays.arrays) {
    chunk.*array.address = place.address + array.offset;
    arrays_.push_back({owner, array.bytes, place.buffer, place.offset + array.offset, array.size, 0});
    addMemory(array.purpose, array.size);
  }
}

// 0: none.
uint32_t Asset::entriesAlong() const {
  return keepsForWalks_ && device_ && gpu_.hasWalkGraph && description_.liveCount > 0
             ? walkEntriesAlong(description_.cellCount)
             : 0;
}

Status Asset::placeEntries() {
  const VkDeviceSize along = entriesAlong();
  if (along == 0) {
    return {};
  }
  const VkDeviceSize size = sizeof(gpu::uvec4) * along * along * along;
  const Result<GpuArena::Place> place = arena_->allocate(size, 0, "entries of walks");
  if (!place) {
    return place.error();
  }
  addMemory("entries of walks", size);
  gpu_.walkEntriesAlong = static_cast<uint32_t>(along);
  gpu_.walkEntries = place->address;
  return {};
}

void Asset::addMemory(const char* name, uint64_t bytes) {
  FrothMemory* const end = description_.memory + description_.memoryCount;
  FrothMemory* const found = std::find_if(description_.memory, end,
                                          [&](const FrothMemory& part) { return std::string_view(part.name) == name; });
  if (found == end) {
    *found = {name, 0};
    ++description_.memoryCount;
  }
  found->bytes += bytes;
}

void Asset::removeMemory(const char* name, uint64_t bytes) {
  FrothMemory* const end = description_.memory + description_.memoryCount;
  std::find_if(description_.memory, end, [&](const FrothMemory& part) {
    return std::string_view(part.name) == name;
  })->bytes -= bytes;
}

void Asset::growBounds(const LoadedChunk& chunk) {
  if (chunk.gpu.liveCount == 0) {
    return;
  }
  const bool isFirst = gpu_.liveCount == 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double chunkLow = chunk.bounds.low[static_cast<int>(axis)],
                 chunkHigh = chunk.bounds.high[static_cast<int>(axis)];
    double &low = gpu_.boundsLow[axis], &high = gpu_.boundsHigh[axis];
    low = isFirst ? chunkLow : std::min(low, chunkLow);
    high = isFirst ? chunkHigh : std::max(high, chunkHigh);
    description_.boundsMin[axis] = static_cast<float>(low);
    description_.boundsMax[axis] = static_cast<float>(high);
  }
}

VkDeviceSize Asset::stage(UploadRing& ring, VkDeviceSize limit) {
  VkDeviceSize staged = 0;
  while (!arrays_.empty()) {
    PendingArray& array = arrays_.front();
    const VkDeviceSize wanted = std::min(array.size - array.staged, limit - staged);
    const VkDeviceSize taken = ring.stage(array.owner, array.target, array.offset + array.staged,
                                          static_cast<const char*>(array.bytes.get()) + array.staged, wanted);
    array.staged += taken;
    staged += taken;
    if (array.staged < array.size) {
      break;
    }
    arrays_.pop_front();
  }
  return staged;
}

uint64_t Asset::queuedBytes() const {
  uint64_t bytes = 0;
  for (const PendingArray& array : arrays_) {
    bytes += array.size - array.staged;
  }
  return bytes;
}

std::span<const GpuBuffer> Asset::buffers() const { return arena_ ? arena_->blocks() : std::span<const GpuBuffer>(); }

FrothAssetStatus Asset::describe() const {
  FrothAssetStatus description = description_;
  description.error = error_;
  description.hostBytes = queryFoam_ ? queryFoam_->bytes() : 0;
  if (levelFoam_ != queryFoam_ && levelFoam_) description.hostBytes += levelFoam_->bytes();
  description.deviceBytes = heldBytes() + preparedBytesHeld();
  description.prepared = gpu_.prepared;
  if (prepared_) description.memory[description.memoryCount++] = {"cells prepared for rays", prepared_->usedBytes()};
  if (description.deviceBytes > 0) {
    uint64_t named = 0;
    for (uint32_t i = 0; i < description.memoryCount; ++i) named += description.memory[i].bytes;
    description.memory[description.memoryCount++] = {"alignment, spare", description.deviceBytes - named};
  }
  return description;
}

}  // namespace froth
