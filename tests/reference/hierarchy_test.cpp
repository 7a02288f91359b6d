// The hierarchy only saves time: it never hides a ball that a ray meets.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "foam/cech_pairs.h"
#include "reference/render/ball_hierarchy.h"
#include "reference/render/ray.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

std::vector<uint32_t> allCells(const Foam& foam) {
  std::vector<uint32_t> cells(foam.cellCount);
  for (uint32_t i = 0; i < foam.cellCount; ++i) cells[i] = i;
  return cells;
}

template <class Real>
bool meetsBall(const Foam& foam, uint32_t cell, const glm::dvec3& origin, const glm::dvec3& direction) {
  Real tNear, tFar;
  return foam::intersectBall(glm::vec<3, Real>(glm::dvec3(foam.sites[cell]) - origin), Real(foam.radii[cell]),
                             glm::vec<3, Real>(direction), tNear, tFar);
}

std::multiset<uint32_t> visited(const BallHierarchy& hierarchy, const glm::dvec3& origin,
                                const glm::dvec3& direction) {
  std::multiset<uint32_t> cells;
  hierarchy.visitAlongRay(origin, direction, [&](uint32_t cell) { cells.insert(cell); });
  return cells;
}

TEST(Hierarchy, VisitsEveryBallOnARayOnceAndMostOthersNever) {
  Foam foam = randomFoam(1000, 1, 1, 17);
  for (float& radius : foam.radii) radius *= 0.2f;
  const BallHierarchy hierarchy(foam.sites, foam.radii, allCells(foam));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  size_t met = 0, visits = 0;
  for (int i = 0; i < 2000; ++i) {
    // Far, near and inside; every third ray runs along an axis.
    const double scale = i % 2 ? 0.8 : 1000;
    const glm::dvec3 origin = scale * glm::dvec3(uniform(random), uniform(random), uniform(random));
    const glm::dvec3 target(uniform(random), uniform(random), uniform(random));
    glm::dvec3 direction = glm::normalize(target - origin);
    if (i % 3 == 0) {
      direction = glm::dvec3(0);
      direction[i % 9 / 3] = i % 4 < 2 ? 1 : -1;
    }
    const std::multiset<uint32_t> cells = visited(hierarchy, origin, direction);
    visits += cells.size();
    for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
      ASSERT_LE(cells.count(cell), 1u);
      if (!meetsBall<double>(foam, cell, origin, direction) &&
          !meetsBall<float>(foam, cell, origin, direction))
        continue;
      ASSERT_EQ(cells.count(cell), 1u) << "cell " << cell << ", ray " << i;
      ++met;
    }
  }
  EXPECT_GT(met, 5000u);
  EXPECT_LT(visits, 2000u * foam.cellCount / 20);
}

TEST(Hierarchy, HoldsAnyNumberOfCellsAndCoincidentOnes) {
  const std::vector<glm::vec3> sites(100, glm::vec3(1, 2, 3));
  const std::vector<float> radii(100, 0.5f);
  for (uint32_t count : {0u, 1u, 2u, 3u, 5u, 100u}) {
    std::vector<uint32_t> cells(count);
    for (uint32_t i = 0; i < count; ++i) cells[i] = 99 - i;
    const BallHierarchy hierarchy(sites, radii, cells);
    EXPECT_EQ(visited(hierarchy, {1, 2, 0}, {0, 0, 1}).size(), count);
    EXPECT_EQ(visited(hierarchy, {1, 2, 0}, {0, 0, -1}).size(), 0u);
  }
}

// The image, bit for bit, with every ray tested against every ball.
template <class Real>
void expectBruteForceGivesTheSameImage() {
  const Foam foam = randomFoam(300, 3, 2, 23);
  const View view = lookAt({0.3, -0.4, -3}, {0, 0, 0}, 64, 48, 0.6);
  const ReferenceOptions options =
      plainOptions(std::is_same_v<Real, float> ? Precision::kFloat : Precision::kDouble);
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
        if (foam::intersectBall(cells.cells[rank].centre, cells.cells[rank].radius, direction, hit.tNear,
                                hit.tFar)) {
          hits.push_back(hit);
        }
      }
      const PrimaryRay<Real> primary{glm::vec<3, Real>(0), direction};
      const RayResult<Real> ray = compositeHits(cells, primary, settings, hits);
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(images.colour.pixel(x, y)[c], float(ray.colour[c])) << x << ", " << y;
      ASSERT_EQ(*images.depth.pixel(x, y), float(ray.depth)) << x << ", " << y;
    }
  }
}

TEST(Hierarchy, BruteForceGivesTheSameImageInDouble) {
  expectBruteForceGivesTheSameImage<double>();
}
TEST(Hierarchy, BruteForceGivesTheSameImageInFloat) {
  expectBruteForceGivesTheSameImage<float>();
}

}  // namespace
}  // namespace froth
