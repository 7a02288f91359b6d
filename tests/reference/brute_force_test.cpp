// The renderer's tree only saves time.
#include <gtest/gtest.h>

#include "foam/cech_pairs.h"
#include "reference/render/ray.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

std::vector<uint32_t> allCells(const Foam& foam) {
  std::vector<uint32_t> cells(foam.cellCount);
  for (uint32_t i = 0; i < foam.cellCount; ++i) cells[i] = i;
  return cells;
}

// The image, bit for bit, with every ray tested against every ball.
template <class Real>
void expectBruteForceGivesTheSameImage() {
  const Foam foam = randomFoam(300, 3, 2, 23);
  const View view = lookAt({0.3, -0.4, -3}, {0, 0, 0}, 64, 48, 0.6);
  const ReferenceOptions options = plainOptions(std::is_same_v<Real, float> ? Precision::kFloat : Precision::kDouble);
  const RenderedImages images = renderFoam(foam, view, options);

  std::vector<uint32_t> drawable = allCells(foam);
  std::erase_if(drawable, [&](uint32_t cell) { return foam.densities[cell] == 0; });
  // Sites of a random foam may coincide; the renderer keeps one of each, and so does this test by having
  // none.
  const CellGraph pairs = findCechPairs(foam.sites, foam.radii);
  const ViewCells<Real> cells = prepareViewCells<Real>(foam, pairs, drawable, view, options);
  const RaySettings<Real> settings{0, Real(std::log(0.5)), 10};
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const glm::vec<3, Real> direction(directionOf(view, x, y));
      std::vector<BallHit<Real>> hits;
      for (uint32_t rank = 0; rank < cells.cells.size(); ++rank) {
        BallHit<Real> hit{rank, 0, 0};
        if (foam::intersectBall(cells.cells[rank].centre, cells.cells[rank].radius, direction, hit.tNear, hit.tFar)) {
          hits.push_back(hit);
        }
      }
      const PrimaryRay<Real> primary{glm::vec<3, Real>(0), direction};
      const RayResult<Real> ray = compositeHits(cells, primary, settings, hits);
      for (int c = 0; c < 3; ++c) ASSERT_EQ(images.colour.pixel(x, y)[c], float(ray.colour[c])) << x << ", " << y;
      ASSERT_EQ(*images.distance.pixel(x, y), float(ray.distance)) << x << ", " << y;
    }
  }
}

TEST(BruteForce, GivesTheSameImageInDouble) { expectBruteForceGivesTheSameImage<double>(); }
TEST(BruteForce, GivesTheSameImageInFloat) { expectBruteForceGivesTheSameImage<float>(); }

}  // namespace
}  // namespace froth
