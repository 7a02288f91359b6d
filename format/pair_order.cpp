#include "format/pair_order.h"

#include <algorithm>
#include <cmath>

namespace froth {
namespace {

constexpr uint32_t kNoPair = 0xffffffff;

// Readers must agree on every bit of this, so it is spelled out; the build forbids fused operations.
double squaredDistance(const ChunkContents& chunk, uint32_t a, uint32_t b) {
  const double x = double{chunk.sites[b].x} - chunk.sites[a].x;
  const double y = double{chunk.sites[b].y} - chunk.sites[a].y;
  const double z = double{chunk.sites[b].z} - chunk.sites[a].z;
  return (x * x + y * y) + z * z;
}

double rankOf(const ChunkContents& chunk, uint32_t cell, uint32_t site) {
  const double radius = chunk.radii[site];
  const double rank = squaredDistance(chunk, cell, site) - radius * radius;
  return std::isnan(rank) ? 0 : rank;  // numbers that a reader will refuse, but must be able to sort
}

}  // namespace

bool isLikelyAlpha(const ChunkContents& chunk, uint32_t cell, uint32_t neighbour) {
  const double reach = double{chunk.radii[cell]} + chunk.radii[neighbour];
  return cell < chunk.liveCount && squaredDistance(chunk, cell, neighbour) < reach * reach;
}

PairOrder::PairOrder(const ChunkContents& chunk)
    : chunk_(chunk), starts_(1, 0), lastPair_(chunk.sites.size(), kNoPair), seenAt_(chunk.sites.size(), 0) {
  starts_.reserve(size_t{chunk.cellCount} + 1);
}

void PairOrder::startCell(uint32_t cell) {
  cell_ = cell;
  if (cell > 0) starts_.push_back(static_cast<uint32_t>(neighbours_.size()));
  ranking_.clear();
  for (uint32_t pair = lastPair_[cell]; pair != kNoPair; pair = sameNeighbour_[pair]) {
    const uint32_t first = starts_[owners_[pair]], last = starts_[owners_[pair] + 1];
    if (last - first > kMaxGuide) continue;
    for (uint32_t i = first; i < last; ++i) {
      const uint32_t site = neighbours_[i];
      if (site <= cell || seenAt_[site] == cell + 1) continue;
      seenAt_[site] = cell + 1;
      ranking_.emplace_back(rankOf(chunk_, cell, site), site);
    }
  }
  std::sort(ranking_.begin(), ranking_.end());
  candidates_.resize(ranking_.size());
  std::transform(ranking_.begin(), ranking_.end(), candidates_.begin(), [](const auto& entry) { return entry.second; });
}

void PairOrder::add(uint32_t neighbour) {
  sameNeighbour_.push_back(lastPair_[neighbour]);
  lastPair_[neighbour] = static_cast<uint32_t>(neighbours_.size());
  owners_.push_back(cell_);
  neighbours_.push_back(neighbour);
}

}  // namespace froth
