#include "runtime/asset/asset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <string_view>

#include "runtime/asset/cell_packer.h"
#include "runtime/asset/chunk_checks.h"
#include "runtime/query/packed_elements.h"

namespace froth {
namespace {

// Of the table of entries for rays.
constexpr uint32_t kCellsPerEntry = 4, kMostEntriesAlong = 32;

FrothStoredCamera toApi(const StoredCamera& camera) {
  FrothStoredCamera result{};
  std::copy(camera.worldFromCamera.begin(), camera.worldFromCamera.end(), result.worldFromCamera);
  result.tanHalfFovY = camera.tanHalfFovY;
  return result;
}

FrothAssetStatus describeManifest(const AssetContents& manifest) {
  FrothAssetStatus description{};
  for (const ChunkContents& chunk : manifest.chunks) {
    description.cellCount += chunk.cellCount;
    description.liveCount += chunk.liveCount;
  }
  description.detailCount = manifest.detailCount;
  description.lobeCount = manifest.lobeCount;
  description.chunkCount = static_cast<uint32_t>(manifest.chunks.size());
  description.cellBits = manifest.localBits;
  description.hasWalkGraph = manifest.hasWalkGraph;
  description.nearRatio = manifest.nearRatio;
  description.nearDepth = manifest.nearDepth;
  description.hasStartView = manifest.hasStartView;
  description.startView = toApi(manifest.startView);
  description.flightPathCount = static_cast<uint32_t>(manifest.flightPath.size());
  return description;
}

GpuAsset describeShape(const AssetContents& manifest) {
  GpuAsset asset;
  asset.detailCount = manifest.detailCount;
  asset.lobeCount = manifest.lobeCount;
  asset.localBits = manifest.localBits;
  asset.hasWalkGraph = manifest.hasWalkGraph;
  asset.detailSharpness = manifest.detailSharpness;
  asset.nearRatio = manifest.nearRatio;
  asset.nearDepth = manifest.nearDepth;
  return asset;
}

// GpuChunk::siteRadius
std::vector<glm::vec4> joinSitesAndRadii(const ChunkContents& contents) {
  std::vector<glm::vec4> joined(contents.sites.size());
  for (size_t i = 0; i < joined.size(); ++i) {
    joined[i] = glm::vec4(contents.sites[i], contents.radii[i]);
  }
  return joined;
}

}  // namespace

Asset::Asset(std::string path, std::span<const uint8_t> bytes, Layer lastLayer, Device* device, bool bytesStay)
    : isFile_(!path.empty()),
      name_(isFile_ ? std::move(path) : "asset in memory"),
      bytes_(bytes),
      lastLayer_(lastLayer),
      device_(device),
      bytesStay_(bytesStay) {
  if (device) {
    arena_ = std::make_shared<GpuArena>(*device);
  }
}

void Asset::load(const Preparation& prepare, const Messages& messages, uint64_t& workLeft) {
  if (hasFailed() || isDecoded_ || !arrays_.empty()) {
    return;
  }
  try {
    Status status = reader_ ? Status() : openReader();
    while (status && workLeft > 0 && nextChunk_ < description_.chunkCount) {
      workLeft -= std::min(workLeft, std::max(chunkWork_[nextChunk_], kLeastChunkWork));
      status = loadChunk();
    }
    if (status && nextChunk_ == description_.chunkCount) {
      status = finish(prepare);
    }
    if (!status) {
      fail(status.error(), messages);
    }
  } catch (const std::bad_alloc&) {
    fail(FROTH_ERROR_MEMORY, "host memory is exhausted while the asset is decoded", messages);
  }
}

Status Asset::loadChunk() {
  workDone_ += chunkWork_[nextChunk_];
  workToCome_ -= chunkWork_[nextChunk_];
  Result<CodedChunk> coded = reader_->readCodedChunk(nextChunk_);
  if (!coded) {
    return coded.error();
  }
  const std::string place = chunkPlace(name_, nextChunk_);
  if (const Status status = checkClaims(coded->contents, reader_->liveBounds(nextChunk_), place); !status) {
    return status;
  }
  ++nextChunk_;
  return placeChunk(std::move(*coded));
}

Status Asset::finish(const Preparation& prepare) {
  if (isQueryFoamWanted()) {
    if (const Status status = queryFoam_->checkGhosts(name_); !status) {
      return status;
    }
    queryFoam_->finish();
  }
  reader_.reset();
  if (const Status status = placeEntries(); !status) {
    return status;
  }
  if (const Status status = prepare(gpu_); !status) {
    return status;
  }
  isDecoded_ = true;
  return {};
}

void Asset::fail(FrothResult code, const char* text, const Messages& messages) {
  error_ = messages.fail(code, name_.c_str(), "%s", text);
  reader_.reset();
  arrays_.clear();
  queryFoam_.reset();
}

void Asset::fail(const Error& error, const Messages& messages) {
  if (device_ && device_->loss) {
    return;  // not the asset's fault: frothUpdate tells, and restart() follows
  }
  // The reader's texts begin with the name, which the message has as its object.
  const std::string_view text = error.message;
  const bool hasName = text.starts_with(name_) && text.substr(name_.size()).starts_with(": ");
  fail(resultOf(error), error.message.c_str() + (hasName ? name_.size() + 2 : 0), messages);
}

void Asset::restart(const Messages& messages) {
  reader_.reset();
  nextChunk_ = 0;
  placedBytes_ = 0;
  arrays_.clear();
  isDecoded_ = false;
  error_ = FROTH_OK;
  description_ = {};
  flightPath_.clear();
  gpu_ = {};
  entriesSerial = 0;
  arena_ = device_ ? std::make_shared<GpuArena>(*device_) : nullptr;
  if (!isFile_ && !bytesStay_) {
    fail(FROTH_ERROR_STATE,
         "its bytes are not there any more to load it again; set FrothAssetInfo::bytesStay, or close and open it",
         messages);
  }
}

Status Asset::openReader() {
  Result<AssetReader> reader =
      isFile_ ? AssetReader::open(name_, lastLayer_) : AssetReader::openBytes(bytes_, name_, lastLayer_);
  if (!reader) {
    return reader.error();
  }
  const AssetContents& manifest = reader->manifest();
  description_ = describeManifest(manifest);
  gpu_ = describeShape(manifest);
  if (isQueryFoamWanted()) {
    queryFoam_.emplace(manifest);
  }
  std::transform(manifest.flightPath.begin(), manifest.flightPath.end(), std::back_inserter(flightPath_), toApi);
  chunkWork_.assign(description_.chunkCount, 0);
  workDone_ = workToCome_ = 0;
  for (const SectionRecord& section : reader->sections()) {
    if (section.chunk >= description_.chunkCount) continue;
    chunkWork_[section.chunk] += section.rawSize;
    workToCome_ += section.rawSize;
  }
  reader_ = std::move(*reader);
  return {};
}

Status Asset::placeChunk(CodedChunk&& coded) {
  ChunkContents& contents = coded.contents;
  growBounds(contents);
  gpu_.hasHeights |= !contents.detailHeights.empty();
  gpu_.liveCount += contents.liveCount;
  GpuChunk& chunk = gpu_.chunks.emplace_back();
  chunk.origin = contents.origin;
  chunk.cellCount = contents.cellCount;
  chunk.liveCount = contents.liveCount;
  chunk.siteCount = contents.cellCount + contents.ghostCount;
  chunk.neighbourCount = static_cast<uint32_t>(contents.neighbours.size());
  chunk.alphaTotal = std::accumulate(contents.alphaCounts.begin(), contents.alphaCounts.end(), uint64_t{0});
  gpu_.cellCount += chunk.cellCount;
  gpu_.alphaTotal += chunk.alphaTotal;
  gpu_.neighbourTotal += chunk.neighbourCount;
  if (isQueryFoamWanted()) {
    queryFoam_->addChunk(contents);
  }
  if (!device_) {
    return {};
  }
  Result<PackedCells> cells = packCells(contents, std::move(coded.codes), reader_->manifest());
  if (!cells) {
    return cells.error();
  }
  PackedElements neighbours = packElements(contents.neighbours);
  PackedElements alphaCounts = packElements(contents.alphaCounts);
  chunk.neighbourShift = neighbours.shift;
  chunk.alphaShift = alphaCounts.shift;
  chunk.cellWordCount = static_cast<uint32_t>(cells->words.size());
  chunk.code = cells->code;
  ChunkArrays arrays;
  arrays.add(joinSitesAndRadii(contents), "sites and radii", chunk.siteRadius);
  arrays.add(std::move(contents.neighbourOffsets), "neighbour offsets", chunk.neighbourOffsets);
  arrays.add(std::move(neighbours.words), "neighbours", chunk.neighbours);
  arrays.add(std::move(contents.ghostRefs), "ghost references", chunk.ghostRefs);
  arrays.add(std::move(alphaCounts.words), "alpha counts", chunk.alphaCounts);
  arrays.add(std::move(cells->starts), "cell starts", chunk.cellStarts);
  arrays.add(std::move(cells->words), "cells", chunk.cellWords);
  arrays.add(std::move(contents.solidBalls), "solid balls", chunk.solidBalls);
  return placeArrays(arrays);
}

// What the arena will be asked for behind `size` bytes of the chunk at hand, by what chunks have needed so far.
VkDeviceSize Asset::bytesToCome(VkDeviceSize size) const {
  const double share = workDone_ > 0 ? static_cast<double>(workToCome_) / static_cast<double>(workDone_) : 0;
  const double chunks = std::min(static_cast<double>(placedBytes_ + size) * share, double{GpuArena::kMostShared});
  const uint64_t along = entriesAlong();
  return static_cast<VkDeviceSize>(chunks) + sizeof(gpu::uvec4) * along * along * along;
}

Status Asset::placeArrays(const ChunkArrays& arrays) {
  if (arrays.size == 0) {
    return {};
  }
  const std::string purpose = "chunk " + std::to_string(gpu_.chunks.size() - 1);
  const Result<GpuArena::Place> place = arena_->allocate(arrays.size, bytesToCome(arrays.size), purpose.c_str());
  if (!place) {
    return place.error();
  }
  placedBytes_ += arrays.size;
  for (const ChunkArray& array : arrays.arrays) {
    *array.address = place->address + array.offset;
    arrays_.push_back({array.bytes, place->buffer, place->offset + array.offset, array.size, 0});
    addMemory(array.purpose, array.size);
  }
  return {};
}

// So many that from the nearest it is a few steps to any cell. 0: none.
uint32_t Asset::entriesAlong() const {
  if (!keepsForWalks_ || !device_ || !gpu_.hasWalkGraph || description_.liveCount == 0) {
    return 0;
  }
  const double along = std::cbrt(static_cast<double>(description_.cellCount) / kCellsPerEntry);
  return std::clamp(static_cast<uint32_t>(along), 1u, kMostEntriesAlong);
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

void Asset::growBounds(const ChunkContents& contents) {
  if (contents.liveCount == 0) {
    return;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool isFirst = gpu_.liveCount == 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    double low = isFirst ? kInfinity : gpu_.boundsLow[a], high = isFirst ? -kInfinity : gpu_.boundsHigh[a];
    for (uint32_t cell = 0; cell < contents.liveCount; ++cell) {
      const double site = contents.origin[a] + contents.sites[cell][axis];
      low = std::min(low, site - contents.radii[cell]);
      high = std::max(high, site + contents.radii[cell]);
    }
    gpu_.boundsLow[a] = low;
    gpu_.boundsHigh[a] = high;
    description_.boundsMin[axis] = static_cast<float>(low);
    description_.boundsMax[axis] = static_cast<float>(high);
  }
}

VkDeviceSize Asset::stage(UploadRing& ring, VkDeviceSize limit) {
  VkDeviceSize staged = 0;
  while (!arrays_.empty()) {
    PendingArray& array = arrays_.front();
    const VkDeviceSize wanted = std::min(array.size - array.staged, limit - staged);
    const VkDeviceSize taken = ring.stage(this, array.target, array.offset + array.staged,
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
  description.deviceBytes = arena_ ? arena_->heldBytes() : 0;
  if (description.deviceBytes > 0) {
    uint64_t named = 0;
    for (uint32_t i = 0; i < description.memoryCount; ++i) named += description.memory[i].bytes;
    description.memory[description.memoryCount++] = {"alignment, spare", description.deviceBytes - named};
  }
  return description;
}

}  // namespace froth
