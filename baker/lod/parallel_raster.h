// A foam alone, seen along parallel rays from outside: many directions, small images. A raster, because every cell is
// small in them: cells from front to back, each over the rays that its ball meets. The same mathematics as the
// reference renderer, in float.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/lod/detail_sharpness.h"
#include "foam/cell_graph.h"
#include "foam/foam.h"
#include "reference/render/ray.h"
#include "reference/render/view_cells.h"

namespace froth {

// A square of parallel rays around a centre.
struct RayGrid {
  glm::vec3 right{1, 0, 0}, down{0, 1, 0}, forward{0, 0, 1};  // unit, orthogonal; rays go along `forward`
  uint32_t size = 0;                                          // rays per side
  float spacing = 0;                                          // [scene units]
  float start = 0;                                            // of the rays along `forward` [scene units]
};

// A ball around the balls of the foam's cells that show: the middle of their box, and the least radius from there.
struct FoamBall {
  glm::dvec3 centre{0};  // [scene units]
  double radius = 0;     // [scene units]; 0: none shows
};
FoamBall boundVisibleCells(const Foam& foam);

// `count` grids that hold the ball, centred on it: along the directions from eyes, spread over them, with rays that
// start beside their eye; without eyes from all sides, turned by the seed, with rays that start outside.
std::vector<RayGrid> makeGrids(const FoamBall& ball, std::span<const glm::vec3> eyes, uint32_t count, uint32_t size,
                               uint64_t seed);

// What one grid of rays shows.
struct ParallelImage {
  std::vector<glm::vec3> colours;        // [size * size] display-coded over black
  std::vector<float> logTransmittances;  // [size * size]
};

class ParallelRaster {
 public:
  // Keeps a reference to the foam; grids are centred on `centre`.
  ParallelRaster(const Foam& foam, const glm::dvec3& centre);

  // Calls visit(ray, cell, weight, shares) for each cell that shows in a ray, front to back along each ray: weight = T
  // alpha, shares [K] of its detail sites. May be called from several threads at once.
  template <class Visit>
  ParallelImage draw(const RayGrid& grid, const Visit& visit) const;
  ParallelImage draw(const RayGrid& grid) const {
    return draw(grid, [](uint32_t, uint32_t, float, const float*) {});
  }

 private:
  // A ray ends where less than this is left (log): that of the runtime, 1e-3.
  static constexpr float kLogCutoff = -6.9f;

  std::vector<uint32_t> sortAlong(const glm::vec3& forward) const;
  void shade(uint32_t rank, const glm::vec3& forward, ViewDetail<float>* details) const;

  const Foam& foam_;
  ViewCells<float> cells_;         // positions relative to the centre; colours are those of no direction
  std::vector<uint32_t> sources_;  // [rank] the foam's cell
};

template <class Visit>
ParallelImage ParallelRaster::draw(const RayGrid& grid, const Visit& visit) const {
  const uint32_t K = foam_.detailCount;
  const auto size = static_cast<int>(grid.size);
  const float half = 0.5f * static_cast<float>(size) - 0.5f;
  ParallelImage image{std::vector<glm::vec3>(size_t{grid.size} * grid.size, glm::vec3(0)),
                      std::vector<float>(size_t{grid.size} * grid.size, 0.0f)};
  std::vector<ViewDetail<float>> details(K);
  std::vector<float> shares(K);
  for (const uint32_t rank : sortAlong(grid.forward)) {
    const ViewCell<float>& cell = cells_.cells[rank];
    const float x = glm::dot(cell.centre, grid.right) / grid.spacing + half;
    const float y = glm::dot(cell.centre, grid.down) / grid.spacing + half, reach = cell.radius / grid.spacing;
    const int left = std::max(static_cast<int>(std::ceil(x - reach)), 0);
    const int right = std::min(static_cast<int>(std::floor(x + reach)), size - 1);
    const int top = std::max(static_cast<int>(std::ceil(y - reach)), 0);
    const int bottom = std::min(static_cast<int>(std::floor(y + reach)), size - 1);
    bool isShaded = false;
    for (int row = top; row <= bottom; ++row) {
      for (int column = left; column <= right; ++column) {
        const auto ray = static_cast<uint32_t>(row * size + column);
        float& logTransmittance = image.logTransmittances[ray];
        if (logTransmittance < kLogCutoff) continue;
        const glm::vec3 offset = ((float(column) - half) * grid.spacing) * grid.right +
                                 ((float(row) - half) * grid.spacing) * grid.down + grid.start * grid.forward;
        const PrimaryRay<float> primary{offset, grid.forward};
        BallHit<float> hit{rank, 0, 0};
        if (!foam::intersectBall(cell.centre - offset, cell.radius, grid.forward, hit.tNear, hit.tFar)) continue;
        if (!clipByNeighbours(cells_.planesOf(cell), primary, hit)) continue;
        if (!isShaded) shade(rank, grid.forward, details.data());
        isShaded = true;
        const CellInterval<float> interval = shadeCell(cell, std::span<const ViewDetail<float>>(details), primary,
                                                       static_cast<float>(kTrainedSharpness), hit);
        if (!(interval.tNear < interval.tFar)) continue;
        const float depth = cell.density * (interval.tFar - interval.tNear);
        const float weight = std::exp(logTransmittance) * foam::opacity(depth);
        image.colours[ray] += weight * interval.colour;
        logTransmittance -= depth;
        float sum = 0;
        for (uint32_t k = 0; k < K; ++k) {
          sum += shares[k] =
              foam::detailWeight(interval.query, details[k].place, static_cast<float>(kTrainedSharpness));
        }
        for (float& share : shares) share /= foam::flooredWeightSum(sum);
        visit(ray, sources_[rank], weight, shares.data());
      }
    }
  }
  return image;
}

}  // namespace froth
