#include "runtime/context/level_streaming.h"

#include <algorithm>
#include <utility>

#include "runtime/device/handles.h"

namespace froth {
namespace {

// Chunks on their way. More would be read and decoded in an order that was chosen too early.
constexpr size_t kMostComing = 8;

// What another attempt may not meet again.
bool mayPass(const Error& error) { return error.kind != ErrorKind::kBadInput && error.kind != ErrorKind::kUnsupported; }

LevelGraph makeGraph(const Asset& asset) {
  const AssetContents& manifest = asset.manifest();
  std::vector<uint64_t> bytes;
  std::vector<uint32_t> cells;
  std::vector<Box> boxes;
  for (uint32_t chunk = 0; chunk < manifest.chunks.size(); ++chunk) {
    bytes.push_back(asset.chunkBytes(chunk));
    cells.push_back(manifest.chunks[chunk].liveCount);
    boxes.push_back(asset.liveBox(chunk));
  }
  return LevelGraph({manifest.levels, manifest.groups, bytes, cells, boxes});
}

void insertSorted(std::vector<uint32_t>& chunks, uint32_t chunk) {
  chunks.insert(std::lower_bound(chunks.begin(), chunks.end(), chunk), chunk);
}

}  // namespace

const LevelStreaming::Stream* LevelStreaming::find(FrothAsset handle) const {
  const auto found =
      std::ranges::find_if(streams_, [&](const Stream& stream) { return isSame(stream.handle, handle); });
  return found == streams_.end() ? nullptr : &*found;
}

LevelStreaming::Stream* LevelStreaming::find(FrothAsset handle) {
  return const_cast<Stream*>(std::as_const(*this).find(handle));
}

LevelStreaming::Stream* LevelStreaming::streamOf(uint32_t number) {
  const auto found = std::ranges::find(streams_, number, &Stream::number);
  return found == streams_.end() ? nullptr : &*found;
}

void LevelStreaming::add(FrothAsset handle, const Asset& asset) {
  LevelGraph graph = makeGraph(asset);
  Stream& stream = streams_.emplace_back();
  stream.handle = handle;
  stream.needs = {.floorBytes = graph.floorBytes(),
                  .changeBytes = graph.mostCoarseBytes(),
                  .finestBytes = graph.finestBytes(),
                  .allBytes = graph.allBytes()};
  stream.floorCells = graph.floorCells();
  stream.finestCells = graph.finestCells();
  const uint32_t number = streamer_.addAsset(std::move(graph));
  stream.number = number;
  floorBytes_ += stream.needs.floorBytes;
  setBudget(budget_);
  [[maybe_unused]] const Status placed = streamer_.placeAsset(number);  // the budget has room for all floors
}

void LevelStreaming::remove(FrothAsset handle) {
  const auto found =
      std::ranges::find_if(streams_, [&](const Stream& stream) { return isSame(stream.handle, handle); });
  if (found == streams_.end()) return;
  for (const uint32_t chunk : found->leaving) gone_.push_back({found->number, chunk});
  floorBytes_ -= found->needs.floorBytes;
  streamer_.removeAsset(found->number);
  streams_.erase(found);
}

void LevelStreaming::report(FrothAsset handle, Asset& asset, const Messages& messages) {
  Stream& stream = *find(handle);
  reportComing(stream, asset, messages);
  stream.isDrawn = !asset.before() && std::ranges::equal(stream.drawn, asset.drawnChunks());
  std::erase_if(stream.leaving, [&](uint32_t chunk) {
    asset.evictChunk(chunk);
    const SlotState state = asset.chunkState(chunk);
    if (state != SlotState::kAbsent && state != SlotState::kFailed) return false;
    streamer_.completeEviction({stream.number, chunk});
    return true;
  });
}

void LevelStreaming::reportComing(Stream& stream, Asset& asset, const Messages& messages) {
  std::erase_if(stream.coming, [&](uint32_t chunk) {
    const ChunkId id{stream.number, chunk};
    const SlotState state = asset.chunkState(chunk);
    if (state == SlotState::kResident) streamer_.advance(id, ChunkState::kResident);
    if (state == SlotState::kFailed) {
      const Error error = asset.takeRefusal(chunk);
      streamer_.fail(id, mayPass(error));
      if (streamer_.state(id) == ChunkState::kFailed) {
        messages.warn(resultOf(error), asset.name().c_str(), "other levels stand for chunk %u: %s", chunk,
                      error.message.c_str());
      }
    }
    return state == SlotState::kResident || state == SlotState::kFailed;
  });
}

void LevelStreaming::setEyes(FrothAsset handle, std::span<const StreamEye> eyes) {
  streamer_.setEyes(find(handle)->number, eyes);
}

void LevelStreaming::setViewPrice(FrothAsset handle, uint64_t bytesPerCell, uint64_t mostBytes) {
  Stream& stream = *find(handle);
  stream.viewBytesPerCell = bytesPerCell;
  stream.needs.floorViewBytes = stream.floorCells * bytesPerCell;
  stream.needs.finestViewBytes = stream.finestCells * bytesPerCell;
  stream.needs.reservedViewBytes = std::min(mostBytes, stream.needs.finestViewBytes);
  streamer_.setViewPrice(stream.number, bytesPerCell);
}

LevelNeeds LevelStreaming::needs() const {
  LevelNeeds all;
  for (const Stream& stream : streams_) all += stream.needs;
  return all;
}

uint32_t LevelStreaming::mostCells(FrothAsset handle) const {
  const Stream& stream = *find(handle);
  const uint64_t affordable = budget_.viewBytes / std::max<uint64_t>(stream.viewBytesPerCell, 1);
  return static_cast<uint32_t>(std::min(stream.finestCells, affordable));
}

bool LevelStreaming::setBudget(const LevelShares& shares) {
  budget_ = shares;
  [[maybe_unused]] const Status set = streamer_.setBudget(std::max(shares.chunkBytes, floorBytes_));
  streamer_.setViewBudget(shares.viewBytes);
  return shares.chunkBytes >= floorBytes_;
}

uint32_t LevelStreaming::readRoom() const {
  size_t coming = 0;
  for (const Stream& stream : streams_) coming += stream.coming.size();
  return static_cast<uint32_t>(kMostComing - std::min(kMostComing, coming));
}

void LevelStreaming::decide(const FindAsset& assetOf) {
  for (const ChunkId id : std::exchange(gone_, {})) streamer_.completeEviction(id);
  const StreamActions& actions = streamer_.update(readRoom());
  for (const ChunkId id : actions.reads) {
    Stream& stream = *streamOf(id.asset);
    assetOf(stream.handle).readChunk(id.chunk);
    stream.coming.push_back(id.chunk);
  }
  for (const ChunkId id : actions.evictions) {
    Stream* const stream = streamOf(id.asset);
    if (!stream) {
      gone_.push_back(id);
      continue;
    }
    std::erase(stream->coming, id.chunk);
    stream->leaving.push_back(id.chunk);
  }
  for (const ChunkId id : actions.hidden) {
    if (Stream* const stream = streamOf(id.asset)) {
      std::erase(stream->drawn, id.chunk);
      stream->isNew = true;
    }
  }
  for (const ChunkId id : actions.shown) {
    Stream& stream = *streamOf(id.asset);
    insertSorted(stream.drawn, id.chunk);
    stream.isNew = true;
  }
  for (Stream& stream : streams_) {
    if (!std::exchange(stream.isNew, false)) continue;
    stream.isDrawn = false;
    if (!stream.drawn.empty()) assetOf(stream.handle).planChunks(stream.drawn);
  }
}

bool LevelStreaming::isSettled() const {
  return streamer_.isSettled() && std::ranges::all_of(streams_, &Stream::isDrawn);
}

uint32_t LevelStreaming::drawnChunks() const {
  size_t count = 0;
  for (const Stream& stream : streams_) count += stream.drawn.size();
  return static_cast<uint32_t>(count);
}

}  // namespace froth
