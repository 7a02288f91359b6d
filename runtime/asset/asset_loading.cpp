// How an asset comes out of its file: reads and jobs, in which order, and what becomes of their results.
#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

#include "runtime/asset/asset.h"

namespace froth {
namespace {

// Decoded and not staged: no job begins beyond it [bytes].
constexpr uint64_t kMostQueuedBytes = 16u << 20;

FrothStoredCamera toApi(const StoredCamera& camera) {
  FrothStoredCamera result{};
  std::copy(camera.worldFromCamera.begin(), camera.worldFromCamera.end(), result.worldFromCamera);
  result.tanHalfFovY = camera.tanHalfFovY;
  return result;
}

FrothAssetStatus describeManifest(const AssetContents& manifest) {
  FrothAssetStatus description{};
  for (size_t i = 0; i < manifest.chunks.size(); ++i) {
    if (!manifest.levels.empty() && manifest.levels[i].level > 0) continue;
    description.cellCount += manifest.chunks[i].cellCount;
    description.liveCount += manifest.chunks[i].liveCount;
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

// Null: the opener wants more.
Result<std::shared_ptr<const AssetReader>> takeHead(AssetOpener& opener, const ByteSource& bytes) {
  std::vector<uint8_t> storage;
  const Result<std::span<const uint8_t>> wanted = bytes.view(*opener.wanted(), storage);
  if (!wanted) {
    return wanted.error();
  }
  if (const Status status = opener.take(*wanted); !status) {
    return status.error();
  }
  return opener.wanted() ? nullptr : std::make_shared<const AssetReader>(opener.finish());
}

}  // namespace

void Asset::load(JobRunner& jobs, ReadTable& reads, LoadLimit& limit, const Preparation& prepare,
                 const Messages& messages) {
  if (hasFailed() || (isDecoded_ && !isLoading())) {
    return;
  }
  waitsForMemory_ = false;
  try {
    Status status = takeResults(prepare);
    while (status && startNext(jobs, reads, limit)) {
      status = takeResults(prepare);
    }
    if (!status) {
      fail(status.error(), messages);
    }
  } catch (const std::bad_alloc&) {
    fail(FROTH_ERROR_MEMORY, "host memory is exhausted while the asset is loaded", messages);
  }
}

void Asset::stop() {
  const bool waits = source_.kind == SourceKind::kMemory;  // a job holds a file open, and bytes that were read for it
  headFetch_.drop();
  fetches_.clear();
  opening_.drop(waits);
  opener_.reset();
  isPrepared_ = false;
  for (Decoding& decoding : decoding_) {
    decoding.job.drop(waits);
  }
  decoding_.clear();
  toRead_.clear();
  unplaced_.reset();
  finishing_.drop(false);
  reader_.reset();
}

Status Asset::takeResults(const Preparation& prepare) {
  if (opening_.hasEnded()) {
    Result<std::shared_ptr<const AssetReader>> reader = opening_.take();
    if (!reader) {
      return reader.error();
    }
    if (*reader) {
      takeReader(std::move(*reader));
    }
  }
  if (reader_ && !isPrepared_) {
    const std::optional<Status> prepared = prepare(gpu_.shape());
    if (prepared && !*prepared) {
      return *prepared;
    }
    isPrepared_ = prepared.has_value();
  }
  if (const Status status = takeChunks(); !status) {
    return status;
  }
  if (finishing_.hasEnded()) {
    Result<std::shared_ptr<QueryFoam>> foam = finishing_.take();
    if (!foam) {
      return foam.error();
    }
    queryFoam_ = std::move(*foam);
  }
  const bool isWhole = reader_ && isPrepared_ && !isLoading() && !isQueryFoamWanted();
  return isWhole && !isDecoded_ && !waitsForMemory_ ? finish() : Status();
}

Status Asset::takeChunks() {
  while (!waitsForMemory_ && (unplaced_ || (!decoding_.empty() && decoding_.front().job.hasEnded()))) {
    if (!unplaced_) {
      const uint32_t number = decoding_.front().chunk;
      Result<LoadedChunk> chunk = decoding_.front().job.take();
      decoding_.pop_front();
      if (!chunk) {
        if (const Status status = refuseChunk(number, chunk.error()); !status) return status;
        continue;
      }
      unplaced_ = std::move(*chunk);
    }
    const Status status = placeChunk(*unplaced_);
    waitsForMemory_ = isPending(status);
    if (waitsForMemory_) {
      break;
    }
    const uint32_t number = unplaced_->gpu.number;
    unplaced_.reset();
    if (status) continue;
    if (const Status refused = refuseChunk(number, status.error()); !refused) return refused;
  }
  return {};
}

// False: there is nothing to be started, or no room for it.
bool Asset::startNext(JobRunner& jobs, ReadTable& reads, LoadLimit& limit) {
  if (isDecoded_ && !isLoading()) {
    return false;
  }
  if (source_.kind == SourceKind::kReader && startReading(reads, limit)) {
    return true;
  }
  if (!jobs.hasRoom() || limit.isReached() || queuedBytes() > kMostQueuedBytes) {
    return false;
  }
  if (!reader_) {
    return startOpening(jobs, limit);
  }
  if (!toRead_.empty()) {
    return startDecoding(jobs, limit);
  }
  if (isLoading() || !isQueryFoamWanted() || finishing_.isUnderWay()) {
    return false;
  }
  limit.count(0);
  startFinishing(jobs);
  return true;
}

// Reads ahead of the jobs as far as there is room. A reader that answers at once takes the frame's time: when that is
// over, only what decoding waits for is read.
bool Asset::startReading(ReadTable& reads, const LoadLimit& limit) {
  if (!reader_) {
    if (opening_.isUnderWay() || headFetch_.isUnderWay()) {
      return false;
    }
    if (!opener_) {
      opener_ = std::make_shared<AssetOpener>(source_.name, source_.reader.size, source_.lastLayer);
    }
    const std::span<const ByteRange> wanted(&*opener_->wanted(), 1);
    if (!reads.hasRoom(wanted)) {
      return false;
    }
    headFetch_.start(reads, source_.reader, wanted);
    return true;
  }
  if (fetches_.size() >= toRead_.size() || (limit.isLate() && !fetches_.empty())) {
    return false;
  }
  const uint32_t chunk = toRead_[fetches_.size()];
  const std::vector<ByteRange> ranges = reader_->rangesOf(chunk);
  if (!reads.hasRoom(ranges)) {
    return false;
  }
  fetches_.emplace_back().start(reads, source_.reader, ranges);
  return true;
}

bool Asset::startOpening(JobRunner& jobs, LoadLimit& limit) {
  const bool isRead = source_.kind == SourceKind::kReader;
  if (opening_.isUnderWay() || (isRead && !headFetch_.hasEnded())) {
    return false;
  }
  limit.count(0);
  if (isRead) {
    opening_.start(jobs, [opener = opener_, bytes = headFetch_.take(source_.name)] {
      return bytes ? takeHead(*opener, **bytes) : bytes.error();
    });
    return true;
  }
  opening_.start(jobs, [source = source_]() -> Result<std::shared_ptr<const AssetReader>> {
    Result<AssetReader> reader = openReader(source);
    if (!reader) {
      return reader.error();
    }
    return std::make_shared<const AssetReader>(std::move(*reader));
  });
  return true;
}

bool Asset::startDecoding(JobRunner& jobs, LoadLimit& limit) {
  using Bytes = Result<std::shared_ptr<const ByteSource>>;
  Bytes bytes = reader_->source();
  if (source_.kind == SourceKind::kReader) {
    if (fetches_.empty() || !fetches_.front().hasEnded()) {
      return false;
    }
    bytes = fetches_.front().take(source_.name);
    fetches_.pop_front();
  }
  const uint32_t chunk = toRead_.front();
  toRead_.pop_front();
  limit.count(chunkWork_[chunk]);
  const ChunkUses uses{device_ != nullptr, isQueryChunkWanted()};
  Decoding& decoding = decoding_.emplace_back();
  decoding.chunk = chunk;
  decoding.job.start(jobs, [reader = reader_, bytes, chunk, name = source_.name, uses] {
    return bytes ? loadChunk(*reader, **bytes, chunk, name, uses) : bytes.error();
  });
  return true;
}

void Asset::startFinishing(JobRunner& jobs) {
  finishing_.start(jobs, [foam = std::move(queryFoam_), name = source_.name]() -> Result<std::shared_ptr<QueryFoam>> {
    if (const Status status = foam->checkGhosts(name); !status) {
      return status.error();
    }
    foam->finish();
    return foam;
  });
}

void Asset::takeReader(std::shared_ptr<const AssetReader> reader) {
  const AssetContents& manifest = reader->manifest();
  description_ = describeManifest(manifest);
  gpu_ = describeShape(manifest);
  flightPath_.clear();
  std::transform(manifest.flightPath.begin(), manifest.flightPath.end(), std::back_inserter(flightPath_), toApi);
  takeSizes(*reader);
  takeLevels(*reader);
  describeChunks(*reader);
  if (isQueryFoamWanted()) {
    queryFoam_ = std::make_shared<QueryFoam>(manifest);
  }
  gpu_.hasHeights = shapeOf(*reader, source_.lastLayer).hasHeights;
  reader_ = std::move(reader);
  opener_.reset();
}

void Asset::takeSizes(const AssetReader& reader) {
  chunkWork_.assign(description_.chunkCount, 0);
  workDone_ = workToCome_ = 0;
  layerWork_ = {};
  for (const SectionRecord& section : reader.sections()) {
    if (section.chunk >= description_.chunkCount) continue;
    chunkWork_[section.chunk] += section.rawSize;
    workToCome_ += section.rawSize;
    if (!sectionName(section.type)) continue;  // of a later version
    layerWork_[static_cast<size_t>(sectionLayer(static_cast<SectionType>(section.type)))] += section.rawSize;
  }
  layers_ = description_.layers = layersHeld(static_cast<uint32_t>(source_.lastLayer) + 1);
  if (openedLayers_ == 0) openedLayers_ = layers_;
}

Status Asset::finish() {
  Status status = placeBorders();
  if (status) {
    status = placeEntries();
  }
  waitsForMemory_ = isPending(status);
  if (waitsForMemory_) {
    return {};
  }
  if (!hasLevels() || !status) {
    reader_.reset();
  }
  if (!status) {
    return status;
  }
  if (hasLevels()) {
    slots_.measurePlan(gpu_);
    drawPlan(0, false);  // no frame draws it before its copies are recorded
  }
  isDecoded_ = true;
  figures_[layers_ - 1] = {heldBytes(), gpu_.detailCount};
  return {};
}

}  // namespace froth
