#include "runtime/stream/residency.h"

namespace froth {

namespace {

bool isOnTheWay(ChunkState state) { return state >= ChunkState::kReading && state <= ChunkState::kUploading; }
bool takesBytes(ChunkState state) { return state >= ChunkState::kReading && state <= ChunkState::kEvicting; }

}  // namespace

void Residency::addAsset(uint32_t asset, const LevelGraph& graph) {
  if (asset == graphs_.size()) {
    graphs_.emplace_back();
    states_.emplace_back();
    records_.emplace_back();
    assetBytes_.emplace_back();
  }
  graphs_[asset] = &graph;
  states_[asset].assign(graph.chunkCount(), ChunkState::kAbsent);
  records_[asset].assign(graph.chunkCount(), {});
  for (uint32_t i = 0; i < graph.chunkCount(); ++i) {
    ++totals_[0].chunks;
    totals_[0].bytes += graph.chunk(i).bytes;
  }
}

void Residency::removeAsset(uint32_t asset) {
  for (uint32_t i = 0; i < graphs_[asset]->chunkCount(); ++i) {
    StateTotals& total = totals_[static_cast<size_t>(states_[asset][i])];
    --total.chunks;
    total.bytes -= graphs_[asset]->chunk(i).bytes;
  }
  graphs_[asset] = nullptr;
  states_[asset].clear();
  records_[asset].clear();
}

bool Residency::holdsBytes(ChunkId id) const { return takesBytes(state(id)); }

void Residency::advance(ChunkId id, ChunkState to, uint32_t frame) {
  setState(id, to);
  if (to != ChunkState::kResident) return;
  record(id).failedAttempts = 0;
  if (isSpare(id)) {
    unlink(id);
    link(id, frame);
  }
}

void Residency::beginRead(ChunkId id, uint32_t frame) {
  setState(id, ChunkState::kReading);
  if (isSpare(id)) link(id, frame);
}

void Residency::evict(ChunkId id) {
  unlink(id);
  setState(id, ChunkState::kEvicting);
}

void Residency::completeEviction(ChunkId id) { setState(id, ChunkState::kAbsent); }

void Residency::retryLater(ChunkId id, uint32_t dueFrame) {
  if (isSpare(id)) unlink(id);
  setState(id, ChunkState::kRetry);
  ++record(id).failedAttempts;
  record(id).dueFrame = dueFrame;
}

void Residency::failForGood(ChunkId id) {
  if (isSpare(id)) unlink(id);
  setState(id, ChunkState::kFailed);
}

bool Residency::isDue(ChunkId id, uint32_t frame) const {
  return static_cast<int32_t>(frame - record(id).dueFrame) >= 0;
}

void Residency::setDrawn(ChunkId id, bool isDrawn, uint32_t frame) {
  if (isSpare(id)) unlink(id);
  record(id).isDrawn = isDrawn;
  if (isSpare(id)) link(id, frame);
}

void Residency::setPinned(ChunkId id, bool isPinned, uint32_t frame) {
  if (isSpare(id)) unlink(id);
  record(id).isPinned = isPinned;
  if (isSpare(id)) link(id, frame);
}

uint32_t Residency::noteNeed(ChunkId id, uint32_t frame) {
  Record& of = record(id);
  if (of.neededFrame != frame - 1) of.neededSince = frame;
  of.neededFrame = frame;
  return frame - of.neededSince;
}

uint64_t Residency::usedBytes() const {
  uint64_t bytes = 0;
  for (size_t i = 0; i < kChunkStates; ++i) {
    if (takesBytes(static_cast<ChunkState>(i))) bytes += totals_[i].bytes;
  }
  return bytes;
}

uint64_t Residency::chunksOnTheWay() const {
  uint64_t chunks = 0;
  for (size_t i = 0; i < kChunkStates; ++i) {
    if (isOnTheWay(static_cast<ChunkState>(i))) chunks += totals_[i].chunks;
  }
  return chunks;
}

void Residency::setState(ChunkId id, ChunkState to) {
  ChunkState& state = states_[id.asset][id.chunk];
  const uint64_t bytes = bytesOf(id);
  StateTotals& before = totals_[static_cast<size_t>(state)];
  StateTotals& after = totals_[static_cast<size_t>(to)];
  --before.chunks;
  before.bytes -= bytes;
  ++after.chunks;
  after.bytes += bytes;
  if (takesBytes(to) && !takesBytes(state)) assetBytes_[id.asset] += bytes;
  if (!takesBytes(to) && takesBytes(state)) assetBytes_[id.asset] -= bytes;
  state = to;
}

bool Residency::isSpare(ChunkId id) const {
  const Record& of = record(id);
  return !of.isDrawn && !of.isPinned && (isOnTheWay(state(id)) || state(id) == ChunkState::kResident);
}

void Residency::link(ChunkId id, uint32_t frame) {
  Record& of = record(id);
  of.spareFrame = frame;
  of.previous = last_;
  of.next = kNone;
  (last_ == kNone ? first_ : record(last_).next) = id;
  last_ = id;
}

void Residency::unlink(ChunkId id) {
  const Record& of = record(id);
  (of.previous == kNone ? first_ : record(of.previous).next) = of.next;
  (of.next == kNone ? last_ : record(of.next).previous) = of.previous;
}

}  // namespace froth
