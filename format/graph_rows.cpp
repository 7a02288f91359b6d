#include "format/graph_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace froth {

double planeDistance(const ChunkContents& chunk, uint32_t cell, uint32_t neighbour) {
  const glm::dvec3 toNeighbour = glm::dvec3(chunk.sites[neighbour]) - glm::dvec3(chunk.sites[cell]);
  const double radius = chunk.radii[cell], otherRadius = chunk.radii[neighbour];
  const double squared = glm::dot(toNeighbour, toNeighbour);
  const double distance = 0.5 * (squared + (radius - otherRadius) * (radius + otherRadius)) / std::sqrt(squared);
  return std::isnan(distance) ? 0 : distance;  // two equal sites: no plane, but still an order
}

Status DegreeCheck::add(uint32_t site, uint32_t neighbour, const std::string& place) {
  using ull = unsigned long long;
  const uint64_t most = mostSquaredDegrees(degrees_.size());
  for (const uint32_t end : {site, neighbour}) {
    squares_ += 2 * uint64_t{degrees_[end]} + 1;  // (d + 1)^2 - d^2
    if (++degrees_[end] > kMaxNeighbours) {
      return makeError(ErrorKind::kBadInput,
                       "%s: graph: site %u has more than %u neighbours; spread the cells that meet it", place.c_str(),
                       end, kMaxNeighbours);
    }
  }
  if (squares_ <= most) return {};
  return makeError(
      ErrorKind::kBadInput,
      "%s: graph: the squares of the sites' degrees add up to more than %llu; spread cells that have many neighbours",
      place.c_str(), ull{most});
}

uint32_t graphElementSize(const ChunkContents& chunk) {
  return uint64_t{chunk.cellCount} + chunk.ghostCount <= 0x8000 ? 2 : 4;  // a place is less than twice that
}

void sortGraphRows(ChunkContents& chunk, uint32_t first, uint32_t last) {
  std::vector<std::pair<double, uint32_t>> entries;  // sorts by distance, then by index
  const auto sortPart = [&](uint32_t cell, std::span<uint32_t> part) {
    entries.clear();
    for (const uint32_t neighbour : part) entries.emplace_back(planeDistance(chunk, cell, neighbour), neighbour);
    std::sort(entries.begin(), entries.end());
    std::transform(entries.begin(), entries.end(), part.begin(), [](const auto& entry) { return entry.second; });
  };
  for (uint32_t cell = first; cell < last; ++cell) {
    const uint32_t begin = chunk.neighbourOffsets[cell];
    const std::span<uint32_t> row =
        std::span(chunk.neighbours).subspan(begin, chunk.neighbourOffsets[cell + 1] - begin);
    const uint32_t alphaCount = cell < chunk.liveCount ? chunk.alphaCounts[cell] : 0;
    sortPart(cell, row.first(alphaCount));
    sortPart(cell, row.subspan(alphaCount));
  }
}

}  // namespace froth
