#include "baker/bake/chunk_arrays.h"

#include <algorithm>
#include <tuple>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "shaders/foam/cell.h"

namespace froth {
namespace {

// One neighbour of a row; sorts into the order in which the row is stored.
struct RowEntry {
  bool isOther;     // not in the alpha-complex, or the row's cell is not live
  double distance;  // of the radical plane from the site, negative beyond it [scene units]
  uint32_t place;   // of the neighbour in the chunk

  bool operator<(const RowEntry& other) const {
    return std::tie(isOther, distance, place) < std::tie(other.isOther, other.distance, other.place);
  }
};

double planeDistance(const Foam& foam, uint32_t cell, uint32_t neighbour) {
  const glm::dvec3 toNeighbour = glm::dvec3(foam.sites[neighbour]) - glm::dvec3(foam.sites[cell]);
  return foam::radicalOffset(toNeighbour, double{foam.radii[cell]}, double{foam.radii[neighbour]}) /
         glm::length(toNeighbour);
}

std::span<const uint32_t> rowOf(const CellGraph& graph, uint32_t cell) {
  return std::span(graph.neighbours)
      .subspan(graph.offsets[cell], graph.offsets[cell + 1] - graph.offsets[cell]);
}

// The values of the listed cells, `perCell` each.
template <class T>
std::vector<T> gather(const std::vector<T>& values, std::span<const uint32_t> cells, size_t perCell) {
  std::vector<T> gathered;
  gathered.reserve(cells.size() * perCell);
  for (const uint32_t cell : cells) {
    const auto first = values.begin() + static_cast<ptrdiff_t>(cell * perCell);
    gathered.insert(gathered.end(), first, first + static_cast<ptrdiff_t>(perCell));
  }
  return gathered;
}

}  // namespace

void fillGraphRows(const Foam& foam, const CellGraph& walkGraph, const CellGraph& alphaGraph,
                   std::span<const uint32_t> order, ChunkContents& chunk) {
  std::vector<uint32_t> placeOf(foam.cellCount, 0);
  chunk.neighbourOffsets.assign(1, 0);
  chunk.neighbourOffsets.reserve(order.size() + 1);
  for (uint32_t place = 0; place < order.size(); ++place) {
    placeOf[order[place]] = place;
    const size_t degree = rowOf(walkGraph, order[place]).size();
    chunk.neighbourOffsets.push_back(chunk.neighbourOffsets.back() + static_cast<uint32_t>(degree));
  }
  chunk.neighbours.resize(chunk.neighbourOffsets.back());
  chunk.alphaCounts.resize(chunk.liveCount);

  tbb::parallel_for(
      tbb::blocked_range<uint32_t>(0, chunk.cellCount), [&](const tbb::blocked_range<uint32_t>& range) {
        std::vector<RowEntry> row;
        for (uint32_t place = range.begin(); place < range.end(); ++place) {
          const uint32_t cell = order[place];
          const bool isLive = place < chunk.liveCount;
          const std::span<const uint32_t> alphaRow = rowOf(alphaGraph, cell);
          row.clear();
          for (const uint32_t neighbour : rowOf(walkGraph, cell)) {
            const bool isAlpha = isLive && std::binary_search(alphaRow.begin(), alphaRow.end(), neighbour);
            row.push_back({!isAlpha, planeDistance(foam, cell, neighbour), placeOf[neighbour]});
          }
          std::sort(row.begin(), row.end());
          std::transform(row.begin(), row.end(), chunk.neighbours.begin() + chunk.neighbourOffsets[place],
                         [](const RowEntry& entry) { return entry.place; });
          if (isLive) chunk.alphaCounts[place] = static_cast<uint32_t>(alphaRow.size());
        }
      });
}

void fillAttributes(const Foam& foam, std::span<const uint32_t> order, ChunkContents& chunk) {
  chunk.sites = gather(foam.sites, order, 1);
  chunk.radii = gather(foam.radii, order, 1);

  const std::span<const uint32_t> live = order.first(chunk.liveCount);
  const size_t details = foam.detailCount, lobes = details * foam.lobeCount;
  chunk.densities = gather(foam.densities, live, 1);
  chunk.orientations = gather(foam.orientations, live, 1);
  chunk.detailSites = gather(foam.detailSites, live, details);
  chunk.detailHeights = gather(foam.detailHeights, live, details);
  const auto isZero = [](float height) { return height == 0; };
  if (std::all_of(chunk.detailHeights.begin(), chunk.detailHeights.end(), isZero)) chunk.detailHeights = {};
  chunk.lobeAxes = gather(foam.lobeAxes, live, lobes);
  chunk.lobeColours = gather(foam.lobeColours, live, lobes);
}

}  // namespace froth
