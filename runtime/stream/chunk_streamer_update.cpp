// What an update of a ChunkStreamer does after the selection: the cut, what is needed for the wanted one, and room.
#include <algorithm>

#include "runtime/stream/chunk_streamer.h"
#include "runtime/stream/cuts.h"

namespace froth {

bool ChunkStreamer::isFloorResident(uint32_t number) const {
  return std::ranges::all_of(assets_[number].graph->floor(), [&](uint32_t chunk) {
    return residency_.state({number, chunk}) == ChunkState::kResident;
  });
}

void ChunkStreamer::updateCut(uint32_t number) {
  Asset& asset = assets_[number];
  if (!asset.isPlaced) {
    if (asset.isShown) {
      asset.isShown = false;  // so that coarse chunks do not appear in place of what goes
      asset.next.clear();
      showChanges(number);
      for (const uint32_t chunk : asset.graph->floor()) showOrHide(number, chunk);
    }
    if (asset.isLeaving) evictAllOf(number);
    return;
  }
  if (!asset.isShown) {
    if (!isFloorResident(number)) return;
    asset.isShown = true;
    for (const uint32_t chunk : asset.graph->floor()) showOrHide(number, chunk);
  }
  refine(number, !mustShed_ && !asset.isDirect);
  showChanges(number);
}

void ChunkStreamer::evictAllOf(uint32_t number) {
  for (uint32_t chunk = 0; chunk < assets_[number].graph->chunkCount(); ++chunk) {
    const ChunkId id{number, chunk};
    if (residency_.holdsBytes(id) && residency_.state(id) != ChunkState::kEvicting) evict(id);
  }
}

// Finds the cut that is drawn next.
void ChunkStreamer::refine(uint32_t number, bool keepsUnwanted) {
  Asset& asset = assets_[number];
  const GroupSet& wanted = demands_[number].wanted;
  const std::span<const ChunkState> states = residency_.states(number);
  const auto isResident = [&](uint32_t chunk) { return states[chunk] == ChunkState::kResident; };

  asset.next.clear();
  for (const uint32_t group : wanted.members()) asset.next.add(group);
  if (keepsUnwanted) {
    for (const uint32_t group : asset.refined.members()) asset.next.add(group);
  }
  shrinkToWhole(*asset.graph, isResident, asset.next, scratch_);
  if (asset.isDirect && asset.next.members().size() < wanted.members().size()) asset.next.clear();
  if (!keepsUnwanted) return;
  for (const uint32_t group : asset.next.members()) {
    if (!wanted.contains(group)) asset.next.drop(group);
  }
  asset.next.compact();
  growToWhole(*asset.graph, isResident, asset.next);
}

// Makes `next` the cut that is drawn.
void ChunkStreamer::showChanges(uint32_t number) {
  Asset& asset = assets_[number];
  scratch_.clear();
  for (const uint32_t group : asset.refined.members()) {
    if (!asset.next.contains(group)) scratch_.push_back(group);
  }
  for (const uint32_t group : asset.next.members()) {
    if (!asset.refined.contains(group)) scratch_.push_back(group);
  }
  std::swap(asset.refined, asset.next);
  for (const uint32_t group : scratch_) {
    for (const uint32_t chunk : asset.graph->fineOf(group)) showOrHide(number, chunk);
    for (const uint32_t chunk : asset.graph->coarseOf(group)) showOrHide(number, chunk);
  }
  scratch_.clear();
}

void ChunkStreamer::showOrHide(uint32_t number, uint32_t chunk) {
  const Asset& asset = assets_[number];
  const ChunkId id{number, chunk};
  const bool isDrawn = asset.isShown && isDrawnIn(asset.refined, asset.graph->chunk(chunk));
  if (isDrawn == residency_.isDrawn(id)) return;
  residency_.setDrawn(id, isDrawn, frame_);
  (isDrawn ? actions_.shown : actions_.hidden).push_back(id);
}

void ChunkStreamer::listNeeds() {
  needs_.clear();
  oldestRequest_ = 0;
  floorHits_ = 0;
  for (uint32_t number = 0; number < assets_.size(); ++number) {
    Asset& asset = assets_[number];
    const GroupSet& wanted = demands_[number].wanted;
    asset.isSettled = asset.isShown && asset.refined.members().size() == wanted.members().size() &&
                      std::ranges::all_of(wanted.members(), [&](uint32_t g) { return asset.refined.contains(g); });
    if (asset.isSettled) asset.isDirect = false;
    if (!asset.isPlaced || asset.isShown) continue;
    for (const uint32_t chunk : asset.graph->floor()) addNeed({number, chunk}, NeedKind::kFloor);
  }
  for (const GroupId id : selection_.bought()) {
    if (!assets_[id.asset].isSettled && demands_[id.asset].wanted.contains(id.group)) needGroup(id);
  }
}

void ChunkStreamer::needGroup(GroupId id) {
  const Asset& asset = assets_[id.asset];
  const LevelGraph& graph = *asset.graph;
  const bool isRefined = asset.refined.contains(id.group);
  for (const uint32_t chunk : graph.fineOf(id.group)) {
    const bool isWanted = isDrawnIn(demands_[id.asset].wanted, graph.chunk(chunk));
    if (!isRefined && (isWanted || !asset.isDirect)) addNeed({id.asset, chunk}, NeedKind::kFiner);
    if (isRefined && isWanted && !isDrawnIn(asset.refined, graph.chunk(chunk))) {
      addNeed({id.asset, chunk}, NeedKind::kCoarser);
    }
  }
  if (isRefined || !asset.isShown) return;
  for (const uint32_t chunk : graph.coarseOf(id.group)) {
    if (graph.chunk(chunk).in == kNoGroup) ++floorHits_;
  }
}

void ChunkStreamer::addNeed(ChunkId id, NeedKind kind) {
  const ChunkState state = residency_.state(id);
  if (state == ChunkState::kFailed) return;
  const uint32_t age = residency_.noteNeed(id, frame_);
  if (state != ChunkState::kResident) oldestRequest_ = std::max(oldestRequest_, age);
  needs_.push_back({id, kind});
}

bool ChunkStreamer::isToRead(ChunkId id) const {
  const ChunkState state = residency_.state(id);
  return state == ChunkState::kAbsent || (state == ChunkState::kRetry && residency_.isDue(id, frame_));
}

// Floors come first, then chunks by how much their group is wanted. Where not all of them fit, coarser chunks come
// before finer ones: they make room.
void ChunkStreamer::orderNeeds() {
  uint64_t bytes = residency_.usedBytes();
  for (const Need& need : needs_) {
    if (isToRead(need.id)) bytes += residency_.bytesOf(need.id);
  }
  ordered_.clear();
  if (bytes <= budget_) {
    ordered_.insert(ordered_.end(), needs_.begin(), needs_.end());
    return;
  }
  for (const NeedKind kind : {NeedKind::kFloor, NeedKind::kCoarser, NeedKind::kFiner}) {
    for (const Need& need : needs_) {
      if (need.kind == kind) ordered_.push_back(need);
    }
  }
}

// Reads begin in order until one does not fit; the others wait for it, so that they do not take its room again and
// again.
void ChunkStreamer::readAndMakeRoom(uint32_t readRoom) {
  uint64_t used = residency_.usedBytes(), blockedBytes = 0;
  size_t firstBlocked = ordered_.size();
  uint32_t reads = 0;
  for (size_t i = 0; i < ordered_.size() && reads < readRoom; ++i) {
    const ChunkId id = ordered_[i].id;
    if (!isToRead(id)) continue;
    ++reads;
    const uint64_t bytes = residency_.bytesOf(id);
    if (firstBlocked == ordered_.size() && used + bytes <= budget_) {
      if (residency_.state(id) == ChunkState::kRetry) ++retries_;
      residency_.beginRead(id, frame_);
      actions_.reads.push_back(id);
      used += bytes;
    } else {
      firstBlocked = std::min(firstBlocked, i);
      blockedBytes += bytes;
    }
  }
  const bool waitsForAge = evictSpare(blockedBytes);
  const bool isChanging =
      waitsForAge || residency_.totals(ChunkState::kEvicting).chunks > 0 || residency_.chunksOnTheWay() > 0;
  if (isChanging) return;
  resolveStandstill(firstBlocked, firstBlocked < ordered_.size() ? residency_.bytesOf(ordered_[firstBlocked].id) : 0);
}

// What must yet be evicted before so many bytes more fit.
uint64_t ChunkStreamer::shortageFor(uint64_t bytes) const {
  const uint64_t wanted = residency_.usedBytes() - residency_.totals(ChunkState::kEvicting).bytes + bytes;
  return wanted - std::min(wanted, budget_);
}

// Evicts what is spare and not needed until so many bytes more fit. Returns whether chunks must age for that.
bool ChunkStreamer::evictSpare(uint64_t bytes) {
  for (ChunkId id = residency_.firstSpare(); id != Residency::kNone && shortageFor(bytes) > 0;) {
    if (frame_ - residency_.spareSince(id) < options_.keepFrames) return true;
    const ChunkId spare = id;
    id = residency_.nextSpare(id);
    if (!residency_.isNeeded(spare, frame_)) evict(spare);
  }
  return false;
}

void ChunkStreamer::evict(ChunkId id) {
  residency_.evict(id);
  actions_.evictions.push_back(id);
  ++evictions_;
}

// Nothing is on its way, nothing can be evicted, and yet the first blocked need has no room. Gives up, for the next
// update, what is dispensable: chunks that are needed less; if there are none, drawn groups that are not wanted; if
// there are none, all steps on the way to the wanted cut.
void ChunkStreamer::resolveStandstill(size_t firstBlocked, uint64_t bytes) {
  if (shortageFor(bytes) == 0) return;
  bool hasEvicted = false;
  for (size_t i = ordered_.size(); i-- > firstBlocked + 1 && shortageFor(bytes) > 0;) {
    const auto [id, kind] = ordered_[i];
    if (kind == NeedKind::kFloor || residency_.state(id) != ChunkState::kResident) continue;
    evict(id);
    hasEvicted = true;
  }
  if (hasEvicted) return;
  for (uint32_t number = 0; number < assets_.size(); ++number) {
    const auto isWanted = [&](uint32_t group) { return demands_[number].wanted.contains(group); };
    mustShed_ = mustShed_ || !std::ranges::all_of(assets_[number].refined.members(), isWanted);
  }
  if (mustShed_) return;
  for (Asset& asset : assets_) asset.isDirect = asset.isShown && !asset.isSettled;
}

}  // namespace froth
