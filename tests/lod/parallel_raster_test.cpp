// The raster of parallel rays shows what the reference renderer shows.
#include "baker/lod/parallel_raster.h"

#include <gtest/gtest.h>

#include "tests/reference/scenes.h"

namespace froth {
namespace {

// The reference's view of a grid.
View viewOf(const RayGrid& grid, const FoamBall& bound) {
  View view;
  view.lens.kind = LensKind::kOrthographic;
  view.width = view.height = grid.size;
  view.fx = view.fy = 1 / grid.spacing;
  view.cx = view.cy = grid.size / 2.0;
  const glm::dvec3 eye = bound.centre - 2 * bound.radius * glm::dvec3(grid.forward);
  for (int axis = 0; axis < 3; ++axis) {
    double* const row = &view.worldFromCamera[4 * static_cast<size_t>(axis)];
    row[0] = grid.right[axis];
    row[1] = grid.down[axis];
    row[2] = grid.forward[axis];
    row[3] = eye[axis];
  }
  return view;
}

TEST(ParallelRaster, ShowsWhatTheReferenceShows) {
  const Foam foam = randomFoam(300, 4, 3, 5);
  const FoamBall bound = boundVisibleCells(foam);
  const ParallelRaster raster(foam, bound.centre);
  ReferenceOptions options = plainOptions(Precision::kFloat);
  options.cutoff = 1e-3;
  for (const RayGrid& grid : makeGrids(bound, {}, 14, 48, 7)) {
    const ParallelImage image = raster.draw(grid);
    const RenderedImages expected = renderFoam(foam, viewOf(grid, bound), options);
    double covered = 0;
    size_t different = 0;
    for (size_t ray = 0; ray < image.colours.size(); ++ray) {
      covered += double{expected.alpha.values[ray]};
      for (int c = 0; c < 3; ++c) {
        different += std::abs(image.colours[ray][c] - expected.colour.values[3 * ray + static_cast<size_t>(c)]) > 2e-3f;
      }
    }
    EXPECT_GT(covered, 300);
    EXPECT_LE(different, 9u);  // rays along an edge, which rounding gives to either side
  }
}

TEST(ParallelRaster, WeightsOfCellsAddUpToTheCoverage) {
  const Foam foam = randomFoam(100, 2, 1, 6);
  const FoamBall bound = boundVisibleCells(foam);
  const RayGrid grid = makeGrids(bound, {}, 1, 32, 1)[0];
  std::vector<float> sums(size_t{grid.size} * grid.size, 0.0f);
  const ParallelImage image =
      ParallelRaster(foam, bound.centre).draw(grid, [&](uint32_t ray, uint32_t, float weight, const float* shares) {
        EXPECT_NEAR(shares[0] + shares[1], 1, 1e-5);
        sums[ray] += weight;
      });
  for (size_t ray = 0; ray < sums.size(); ++ray) {
    EXPECT_NEAR(sums[ray], -std::expm1(image.logTransmittances[ray]), 1e-5);
  }
}

}  // namespace
}  // namespace froth
