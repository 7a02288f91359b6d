#include "runtime/stream/selection.h"

#include <algorithm>

namespace froth {

bool sees(const StreamEye& eye, const GroupBounds& bounds) {
  const glm::dvec3 low = bounds.low - eye.position, high = bounds.high - eye.position;
  return std::ranges::all_of(eye.sight, [&](const SightPlane& plane) {
    const glm::dvec3& n = plane.normal;
    const double farthest =
        n.x * (n.x > 0 ? high.x : low.x) + n.y * (n.y > 0 ? high.y : low.y) + n.z * (n.z > 0 ? high.z : low.z);
    return farthest + plane.offset >= 0;
  });
}

Wish wishFor(const LevelGraph::Group& group, std::span<const StreamEye> eyes) {
  constexpr double kLeastPixel = 1e-100;  // keeps keys finite, so that errors order the groups that an eye is inside of
  Wish wish;
  for (const StreamEye& eye : eyes) {
    const double distance = std::max(0.0, distanceTo(group.bounds, eye.position) - eye.radius);
    const double pixel = std::max({eye.pixelSize, eye.pixelAngle * distance, kLeastPixel});
    const double key = group.error * eye.detail / pixel;
    wish.key = std::max(wish.key, key);
    if (!(key >= 1 && key > wish.rank)) continue;
    wish.rank = std::max(wish.rank, sees(eye, group.bounds) ? key : key * kUnseenPart);
  }
  return wish;
}

bool Selection::Offer::operator<(const Offer& other) const {
  if (rank != other.rank) return rank < other.rank;
  return id.asset != other.id.asset ? id.asset > other.id.asset : id.group > other.id.group;
}

void Selection::reserve(size_t groupCount) {
  heap_.reserve(groupCount);
  bought_.reserve(groupCount);
}

void Selection::select(std::span<AssetDemand> assets, CutLimits limits) {
  heap_.clear();
  bought_.clear();
  for (uint32_t a = 0; a < assets.size(); ++a) {
    if (assets[a].graph == nullptr) continue;
    assets[a].wanted.clear();
    for (const uint32_t group : assets[a].graph->lowest()) {
      offer(assets[a], {a, group});
    }
  }
  while (!heap_.empty()) {
    const Offer best = heap_.front();
    AssetDemand& asset = assets[best.id.asset];
    const LevelGraph::Group& group = asset.graph->group(best.id.group);
    const uint64_t viewPrice = group.cellPrice * asset.viewBytesPerCell;
    if (group.bytePrice > limits.bytes || group.cellPrice > limits.cells || viewPrice > limits.viewBytes) return;
    limits.bytes -= group.bytePrice;
    limits.cells -= group.cellPrice;
    limits.viewBytes -= viewPrice;
    std::pop_heap(heap_.begin(), heap_.end());
    heap_.pop_back();
    asset.wanted.add(best.id.group);
    bought_.push_back(best.id);
    offerFiner(asset, best.id);
  }
}

void Selection::offer(const AssetDemand& asset, GroupId id) {
  const Wish wish = wishFor(asset.graph->group(id.group), asset.eyes);
  if (!(wish.key >= 1)) return;
  heap_.push_back({wish.rank, id});
  std::push_heap(heap_.begin(), heap_.end());
}

// A group is on offer as soon as all that are coarser are bought, so what is bought is a cut even where rounding lifts
// its rank above theirs.
void Selection::offerFiner(const AssetDemand& asset, GroupId bought) {
  for (const uint32_t finer : asset.graph->finerThan(bought.group)) {
    const bool isReady = std::ranges::all_of(asset.graph->coarserThan(finer),
                                             [&](uint32_t group) { return asset.wanted.contains(group); });
    if (isReady) offer(asset, {bought.asset, finer});
  }
}

}  // namespace froth
