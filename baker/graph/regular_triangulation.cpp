// The regular triangulation of the whole: CGAL's, with exact predicates.
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "baker/graph/local_triangulation.h"
#include "foam/morton_order.h"

namespace froth {
Status checkFinite(std::span<const glm::vec3> sites, std::span<const float> radii) {
  for (size_t i = 0; i < sites.size(); ++i) {
    const glm::vec3& p = sites[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return makeError(ErrorKind::kBadInput, "cell %zu: site (%g, %g, %g) is not finite; repair the foam", i,
                       double{p.x}, double{p.y}, double{p.z});
    }
    if (!std::isfinite(radii[i]) || !(radii[i] > 0)) {
      return makeError(ErrorKind::kBadInput, "cell %zu: radius %g is not a positive number; repair the foam", i,
                       double{radii[i]});
    }
  }
  return {};
}

// Along a Morton curve.
Result<std::vector<uint32_t>> listDistinct(std::span<const glm::vec3> sites, std::span<const float> radii,
                                           const Progress& progress) {
  const auto isAsked = [&](uint64_t part) { return !report(progress, "sort sites", part, 3); };
  if (isAsked(0)) return stoppedOnRequest("triangulation");
  const std::vector<uint32_t> order = mortonOrder(sites);
  if (isAsked(1)) return stoppedOnRequest("triangulation");
  std::vector<uint32_t> sorted = order;
  tbb::parallel_sort(sorted.begin(), sorted.end(), [&](uint32_t a, uint32_t b) {
    const glm::vec3 &p = sites[a], &q = sites[b];
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    if (p.z != q.z) return p.z < q.z;
    if (radii[a] != radii[b]) return radii[a] > radii[b];
    return a < b;
  });
  if (isAsked(2)) return stoppedOnRequest("triangulation");
  std::vector<bool> isDropped(sites.size());
  for (size_t k = 1; k < sorted.size(); ++k) {
    if (sites[sorted[k]] == sites[sorted[k - 1]]) isDropped[sorted[k]] = true;
  }
  sorted.clear();
  for (const uint32_t cell : order) {
    if (!isDropped[cell]) sorted.push_back(cell);
  }
  return sorted;
}

RegularTriangulation assembleRows(const PlacedSites& sites, std::vector<RowBlock>&& blocks) {
  const size_t cellCount = sites.sites.size();
  RegularTriangulation result;
  result.duplicates = cellCount - sites.order.size();
  result.isHidden.assign(cellCount, 1);
  CellGraph& graph = result.graph;
  graph.offsets.assign(cellCount + 1, 0);
  for (const RowBlock& block : blocks) {
    for (size_t k = 0; k < block.cells.size(); ++k) {
      result.isHidden[block.cells[k]] = 0;
      graph.offsets[block.cells[k] + 1] = block.degrees[k];
    }
  }
  std::partial_sum(graph.offsets.begin(), graph.offsets.end(), graph.offsets.begin());
  graph.neighbours.resize(graph.offsets.back());
  for (RowBlock& block : blocks) {
    auto row = block.neighbours.begin();
    for (size_t k = 0; k < block.cells.size(); ++k) {
      const auto rowEnd = row + block.degrees[k];
      std::sort(row, rowEnd);
      std::copy(row, rowEnd, graph.neighbours.begin() + graph.offsets[block.cells[k]]);
      row = rowEnd;
    }
    block = {};
  }
  return result;
}

Result<RegularTriangulation> triangulateRegular(std::span<const glm::vec3> sites, std::span<const float> radii,
                                                const Progress& progress) {
  if (Status status = checkFinite(sites, radii); !status) return status.error();
  const Result<std::vector<uint32_t>> order = listDistinct(sites, radii, progress);
  if (!order) return order.error();
  const PlacedSites placed{sites, radii, *order};

  std::vector<uint32_t> places(placed.order.size());
  std::iota(places.begin(), places.end(), 0u);
  InsertionProgress insertion(progress, "triangulate", places.size());
  std::vector<RowBlock> blocks(1);
  {
    LocalTriangulation triangulation(placed);
    if (!triangulation.insert(places, insertion)) return stoppedOnRequest("triangulation");
    blocks[0] = triangulation.collectRows(0, static_cast<uint32_t>(order->size()), insertion);
  }
  if (!insertion.add(0)) return stoppedOnRequest("triangulation");
  return assembleRows(placed, std::move(blocks));
}

}  // namespace froth
