#include "baker/cells/cell_order.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/morton_code.h"
#include "foam/morton_order.h"
#include "format/position_order.h"
#include "format/section_codec.h"

namespace froth {
namespace {

// Lattice indices from the lowest corner of the cells' box.
std::vector<LatticePoint> latticePoints(std::span<const uint32_t> run, const BakeCells& cells, double step) {
  glm::dvec3 low(cells.sites[run[0]]);
  for (const uint32_t cell : run) low = glm::min(low, glm::dvec3(cells.sites[cell]));
  std::vector<LatticePoint> points;
  points.reserve(run.size());
  for (const uint32_t cell : run) {
    const glm::dvec3 place = (glm::dvec3(cells.sites[cell]) - low) / step;
    points.push_back({static_cast<int32_t>(place.x), static_cast<int32_t>(place.y), static_cast<int32_t>(place.z)});
  }
  return points;
}

bool fitsCodecs(std::span<const LatticePoint> points) {
  constexpr int32_t kEnd = 1 << kMaxPositionBits;
  return std::all_of(points.begin(), points.end(),
                     [](const LatticePoint& point) { return point[0] < kEnd && point[1] < kEnd && point[2] < kEnd; });
}

uint64_t codeOf(const LatticePoint& point) {
  return mortonCode(
      {static_cast<uint32_t>(point[0]), static_cast<uint32_t>(point[1]), static_cast<uint32_t>(point[2])});
}

std::vector<uint32_t> latticeMortonOrder(std::span<const LatticePoint> points) {
  std::vector<std::pair<uint64_t, uint32_t>> keys;
  keys.reserve(points.size());
  for (uint32_t i = 0; i < points.size(); ++i) keys.emplace_back(codeOf(points[i]), i);
  std::sort(keys.begin(), keys.end());
  std::vector<uint32_t> order;
  for (const auto& [code, index] : keys) order.push_back(index);
  return order;
}

// order[i]: which of the cells comes i-th.
void permute(std::span<uint32_t> run, std::span<const uint32_t> order) {
  const std::vector<uint32_t> before(run.begin(), run.end());
  std::transform(order.begin(), order.end(), run.begin(), [&](uint32_t index) { return before[index]; });
}

// False: the run cannot have a position codec, or has no lattice.
bool sortAlongCurve(std::span<uint32_t> run, const BakeCells& cells, double positionStep) {
  std::sort(run.begin(), run.end());  // places on the curve that fall together are told apart by index
  if (run.empty()) return positionStep > 0;
  if (positionStep > 0) {
    const std::vector<LatticePoint> points = latticePoints(run, cells, positionStep);
    if (fitsCodecs(points)) {
      permute(run, latticeMortonOrder(points));
      return true;
    }
  }
  std::vector<glm::vec3> sites;
  sites.reserve(run.size());
  for (const uint32_t cell : run) sites.push_back(cells.sites[cell]);
  permute(run, mortonOrder(sites));
  return false;
}

}  // namespace

void orderCells(std::span<uint32_t> live, std::span<uint32_t> others, const BakeCells& cells, double positionStep) {
  const bool liveFits = sortAlongCurve(live, cells, positionStep);
  const bool othersFit = sortAlongCurve(others, cells, positionStep);
  if (!liveFits || live.empty()) return;
  const Result<PositionOrder> choice = choosePositionOrder(latticePoints(live, cells, positionStep));
  if (!choice || !choice->isDraco) return;
  permute(live, choice->order);
  if (!othersFit || others.empty()) return;
  if (const auto order = dracoOrder(latticePoints(others, cells, positionStep))) permute(others, *order);
}

}  // namespace froth
