#include "runtime/query/sphere_overlap.h"

#include <algorithm>

#include "shaders/foam/cell.h"

namespace froth {

bool SphereOverlap::CellSet::insert(CellAddress cell) {
  if (2 * count_ >= places_.size()) {
    std::pmr::vector<uint64_t> old(std::max<size_t>(128, 2 * places_.size()), 0, places_.get_allocator());
    old.swap(places_);
    count_ = 0;
    for (const uint64_t key : old) {
      if (key != 0) insert({static_cast<uint32_t>(key >> 32) - 1, static_cast<uint32_t>(key)});
    }
  }
  const uint64_t key = (uint64_t{cell.chunk} + 1) << 32 | cell.cell;
  constexpr uint64_t kGolden = 0x9e3779b97f4a7c15;  // Fibonacci hashing
  size_t place = static_cast<size_t>(key * kGolden >> 32) & (places_.size() - 1);
  while (places_[place] != 0) {
    if (places_[place] == key) return false;
    place = (place + 1) & (places_.size() - 1);
  }
  places_[place] = key;
  ++count_;
  return true;
}

// Power cells are visited by their distance, from the one that holds the centre outwards, as far as there is no nearer
// contact. A ball meets a connected set of power cells, and two of them next to each other share a face that meets it:
// none is left out.
std::optional<SolidContact> SphereOverlap::findNearest(double reach) {
  reach_ = reach;
  push(0, foam_.locate(centre_));
  while (!candidates_.empty()) {
    std::pop_heap(candidates_.begin(), candidates_.end(),
                  [](const Candidate& a, const Candidate& b) { return a.distance > b.distance; });
    const Candidate candidate = candidates_.back();
    candidates_.pop_back();
    if (candidate.distance > reach_) break;
    visit(candidate.cell);
  }
  return nearest_;
}

void SphereOverlap::push(double distance, CellAddress cell) {
  if (!known_.insert(cell)) return;
  candidates_.push_back({distance, cell});
  std::push_heap(candidates_.begin(), candidates_.end(),
                 [](const Candidate& a, const Candidate& b) { return a.distance > b.distance; });
}

void SphereOverlap::visit(CellAddress cell) {
  const QueryChunk& chunk = foam_.chunk(cell.chunk);
  const glm::dvec3 site = chunk.siteOf(cell.cell);
  const double radius = chunk.radiusOf(cell.cell);
  const glm::dvec3 local = centre_ - chunk.origin - site;
  const uint32_t begin = chunk.neighbourOffsets[cell.cell], end = chunk.neighbourOffsets[cell.cell + 1];
  halfSpaces_.clear();
  for (uint32_t i = begin; i < end; ++i) {
    const uint32_t other = chunk.neighbourAt(i);
    const glm::dvec3 toNeighbour = chunk.siteOf(other) - site;
    const double length = glm::length(toNeighbour);
    const double offset = foam::radicalOffset(toNeighbour, radius, chunk.radiusOf(other)) / length;
    const glm::dvec3 normal = toNeighbour / length;
    if (glm::dot(normal, local) - offset > reach_) return;  // the whole power cell is out of reach
    halfSpaces_.push_back({normal, offset / radius});
  }
  if (isSolid(chunk, cell.cell)) meetBody(cell, chunk, local);
  for (uint32_t i = begin; i < end; ++i) {
    const HalfSpace& plane = halfSpaces_[i - begin];
    const double distance = radius * plane.offset - glm::dot(plane.normal, local);
    if (distance <= reach_) push(std::max(distance, 0.0), foam_.cellOfSite(cell, chunk.neighbourAt(i)));
  }
}

bool SphereOverlap::isSolid(const QueryChunk& chunk, uint32_t cell) const {
  return chunk.densityOf(cell) * 2 * chunk.radiusOf(cell) >= opticalDepth_;
}

// Adds the face to halfSpaces_ and takes it off again.
void SphereOverlap::meetBody(CellAddress cell, const QueryChunk& chunk, const glm::dvec3& local) {
  const double radius = chunk.radiusOf(cell.cell);
  if (glm::length(local) - radius > reach_) return;
  const glm::dvec3 normal = chunk.faceFrameOf(cell.cell)[0];
  const double height = foam_.meanHeightOf(chunk, cell.cell);
  const glm::dvec3 point = local / radius;
  const double below = radius * (height - glm::dot(normal, point));
  if (-below > reach_) return;
  halfSpaces_.push_back({normal, height});
  const auto found = findNearestPointInBall(halfSpaces_, point);
  halfSpaces_.pop_back();
  if (!found) return;
  const double distance = radius * glm::length(point - *found);
  if (!(distance <= reach_)) return;  // NaN too: a file may hold two cells at one site
  const glm::dvec3 fromAsset = centre_ - local;
  const bool isInside = distance <= 1e-12 * radius;
  if (isInside) {
    nearest_ = {-below, centre_ + below * normal, normal, cell};
  } else {
    nearest_ = {distance, fromAsset + radius * *found, (point - *found) / glm::length(point - *found), cell};
  }
  reach_ = distance;
}

}  // namespace froth
