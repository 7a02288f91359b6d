#include "runtime/stream/chunk_streamer.h"

#include <algorithm>

#include "runtime/stream/cuts.h"

namespace froth {

namespace {

using Bytes = unsigned long long;

// Part of the budget that the wanted cut leaves free, so that several groups can change their form at once.
constexpr uint64_t kTransitShare = 8;

}  // namespace

Status ChunkStreamer::setBudget(uint64_t bytes) {
  if (bytes < floorBytes_) {
    return makeError(ErrorKind::kMemory,
                     "stream budget: %llu bytes are less than the %llu of the floors of placed assets; allow %llu or "
                     "remove instances",
                     Bytes{bytes}, Bytes{floorBytes_}, Bytes{floorBytes_});
  }
  budget_ = bytes;
  return {};
}

uint32_t ChunkStreamer::addAsset(LevelGraph graph) {
  uint32_t number = 0;
  while (hasAsset(number)) ++number;
  if (number == assets_.size()) {
    assets_.emplace_back();
    demands_.emplace_back();
  }
  Asset& asset = assets_[number];
  asset = {};
  asset.refined = GroupSet(graph.groupCount());
  asset.next = GroupSet(graph.groupCount());
  demands_[number].wanted = GroupSet(graph.groupCount());
  demands_[number].eyes.clear();
  demands_[number].viewBytesPerCell = 0;
  asset.graph = std::make_unique<const LevelGraph>(std::move(graph));
  residency_.addAsset(number, *asset.graph);
  reserveForAll();
  return number;
}

void ChunkStreamer::reserveForAll() {
  size_t chunks = 0, groups = 0;
  for (const Asset& asset : assets_) {
    if (asset.graph == nullptr) continue;
    chunks += asset.graph->chunkCount();
    groups += asset.graph->groupCount();
  }
  selection_.reserve(groups);
  scratch_.reserve(groups);
  needs_.reserve(chunks);
  ordered_.reserve(chunks);
  for (std::vector<ChunkId>* list : {&actions_.reads, &actions_.evictions, &actions_.shown, &actions_.hidden}) {
    list->reserve(chunks);
  }
}

Status ChunkStreamer::placeAsset(uint32_t number) {
  Asset& asset = assets_[number];
  if (asset.isPlaced) return {};
  const uint64_t bytes = asset.graph->floorBytes();
  if (bytes > budget_ - floorBytes_) {
    return makeError(
        ErrorKind::kMemory,
        "stream budget: the asset's floor takes %llu bytes and those of other placed assets %llu, which is "
        "more than the %llu of the budget; allow %llu or remove instances",
        Bytes{bytes}, Bytes{floorBytes_}, Bytes{budget_}, Bytes{floorBytes_ + bytes});
  }
  floorBytes_ += bytes;
  asset.isPlaced = true;
  for (const uint32_t chunk : asset.graph->floor()) residency_.setPinned({number, chunk}, true, frame_ + 1);
  return {};
}

void ChunkStreamer::unplaceAsset(uint32_t number) {
  Asset& asset = assets_[number];
  if (!asset.isPlaced) return;
  floorBytes_ -= asset.graph->floorBytes();
  asset.isPlaced = asset.isDirect = false;
  for (const uint32_t chunk : asset.graph->floor()) residency_.setPinned({number, chunk}, false, frame_ + 1);
}

void ChunkStreamer::removeAsset(uint32_t number) {
  unplaceAsset(number);
  assets_[number].isLeaving = true;
}

void ChunkStreamer::setEyes(uint32_t asset, std::span<const StreamEye> eyes) {
  demands_[asset].eyes.assign(eyes.begin(), eyes.end());
}

void ChunkStreamer::advance(ChunkId id, ChunkState to) { residency_.advance(id, to, frame_ + 1); }

void ChunkStreamer::fail(ChunkId id, bool mayPass) {
  const uint32_t attempts = residency_.failedAttempts(id);
  if (mayPass && attempts < kMostRetries) {
    residency_.retryLater(id, frame_ + (options_.retryFrames << (2 * attempts)));
    return;
  }
  residency_.failForGood(id);
  ++failures_;
  Asset& asset = assets_[id.asset];
  ++asset.failedChunks;
  if (asset.graph->chunk(id.chunk).in == kNoGroup) ++asset.failedFloorChunks;
}

void ChunkStreamer::completeEviction(ChunkId id) { residency_.completeEviction(id); }

const StreamActions& ChunkStreamer::update(uint32_t readRoom) {
  ++frame_;
  for (std::vector<ChunkId>* list : {&actions_.reads, &actions_.evictions, &actions_.shown, &actions_.hidden}) {
    list->clear();
  }
  forgetLeft();
  selectGroups();
  for (uint32_t asset = 0; asset < assets_.size(); ++asset) {
    if (assets_[asset].graph != nullptr) updateCut(asset);
  }
  mustShed_ = false;
  listNeeds();
  orderNeeds();
  readAndMakeRoom(readRoom);
  return actions_;
}

void ChunkStreamer::forgetLeft() {
  for (uint32_t number = 0; number < assets_.size(); ++number) {
    Asset& asset = assets_[number];
    if (asset.graph == nullptr || !asset.isLeaving || residency_.bytesOfAsset(number) > 0) continue;
    residency_.removeAsset(number);
    demands_[number].graph = nullptr;
    asset = {};
  }
}

void ChunkStreamer::selectGroups() {
  uint64_t cells = 0, viewBytes = 0, mostCoarseBytes = 0;
  for (uint32_t number = 0; number < assets_.size(); ++number) {
    const Asset& asset = assets_[number];
    const bool takesPart = asset.isPlaced && asset.failedFloorChunks == 0;
    demands_[number].graph = takesPart ? asset.graph.get() : nullptr;
    demands_[number].wanted.clear();
    if (!takesPart) continue;
    cells += asset.graph->floorCells();
    viewBytes += asset.graph->floorCells() * demands_[number].viewBytesPerCell;
    mostCoarseBytes = std::max(mostCoarseBytes, asset.graph->mostCoarseBytes());
  }
  const uint64_t taken = floorBytes_ + std::max(mostCoarseBytes, budget_ / kTransitShare);
  const auto left = [](uint64_t budget, uint64_t spent) { return budget - std::min(budget, spent); };
  selection_.select(demands_, {left(budget_, taken), left(cellBudget_, cells), left(viewBudget_, viewBytes)});
  for (uint32_t number = 0; number < assets_.size(); ++number) {
    if (demands_[number].graph == nullptr || assets_[number].failedChunks == 0) continue;
    const std::span<const ChunkState> states = residency_.states(number);
    const auto mayCome = [&](uint32_t chunk) { return states[chunk] != ChunkState::kFailed; };
    shrinkToWhole(*assets_[number].graph, mayCome, demands_[number].wanted, scratch_);
  }
}

bool ChunkStreamer::isSettled() const {
  return std::ranges::all_of(assets_, [](const Asset& asset) { return !asset.isPlaced || asset.isSettled; });
}

StreamStatistics ChunkStreamer::statistics() const {
  StreamStatistics statistics;
  for (size_t i = 0; i < kChunkStates; ++i) statistics.states[i] = residency_.totals(static_cast<ChunkState>(i));
  statistics.usedBytes = residency_.usedBytes();
  statistics.excessBytes = statistics.usedBytes - std::min(statistics.usedBytes, budget_);
  statistics.oldestRequest = oldestRequest_;
  statistics.floorHits = floorHits_;
  statistics.evictions = evictions_;
  statistics.retries = retries_;
  statistics.failures = failures_;
  return statistics;
}

}  // namespace froth
