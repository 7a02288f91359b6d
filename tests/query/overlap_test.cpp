// Spheres against the solid, by projection onto every cell's body.
#include <algorithm>
#include <cmath>
#include <optional>

#include "foam/cech_pairs.h"
#include "foam/cell_graph.h"
#include "shaders/foam/cell.h"
#include "tests/query/query_fixture.h"

namespace froth::test {
namespace {

struct HalfSpaceOfCell {
  glm::dvec3 normal;
  double offset;
};

// The solid of froth.h (FrothSphere), cell by cell. Nearest points by Dykstra's alternating projections onto the ball
// and the half-spaces: slow, and nothing like the library's way.
class BruteSolid {
 public:
  explicit BruteSolid(const Foam& foam) : foam_(foam), pairs_(findCechPairs(foam.sites, foam.radii)) {}

  // Distance of the nearest point, at most `reach`, and of which cell; negative: how far the centre is below the face
  // of its cell.
  std::pair<double, uint32_t> findNearest(const glm::dvec3& centre, double reach, double opacity) const {
    std::pair<double, uint32_t> best{kInfinity, 0};
    for (uint32_t cell = 0; cell < foam_.cellCount; ++cell) {
      const double radius = foam_.radii[cell];
      if (1 - std::exp(-2 * radius * foam_.densities[cell]) < opacity) continue;
      const glm::dvec3 local = centre - glm::dvec3(foam_.sites[cell]);
      if (glm::length(local) - radius > std::min(best.first, reach)) continue;
      const std::vector<HalfSpaceOfCell> planes = planesOf(cell);
      const std::optional<glm::dvec3> nearest = project(planes, radius, local);
      if (!nearest) continue;
      double distance = glm::length(local - *nearest);
      if (distance < 1e-9) distance = glm::dot(planes.back().normal, local) - planes.back().offset;
      if (distance < best.first) best = {distance, cell};
    }
    return best;
  }

 private:
  // The face is the last.
  std::vector<HalfSpaceOfCell> planesOf(uint32_t cell) const {
    std::vector<HalfSpaceOfCell> planes;
    for (const uint32_t other : neighboursOf(pairs_, cell)) {
      const glm::dvec3 toNeighbour = glm::dvec3(foam_.sites[other]) - glm::dvec3(foam_.sites[cell]);
      const double length = glm::length(toNeighbour);
      const double offset = foam::radicalOffset(toNeighbour, double{foam_.radii[cell]}, double{foam_.radii[other]});
      planes.push_back({toNeighbour / length, offset / length});
    }
    double height = 0;
    for (uint32_t k = 0; k < foam_.detailCount; ++k) {
      height +=
          double{foam_.radii[cell]} * foam_.detailHeights[size_t{cell} * foam_.detailCount + k] / foam_.detailCount;
    }
    planes.push_back({faceFrame<double>(foam_.orientations[cell]).normal, height});
    return planes;
  }

  static std::optional<glm::dvec3> project(const std::vector<HalfSpaceOfCell>& planes, double radius,
                                           const glm::dvec3& point) {
    std::vector<glm::dvec3> corrections(planes.size() + 1, glm::dvec3(0));
    glm::dvec3 x = point;
    for (int round = 0; round < 20000; ++round) {
      const glm::dvec3 before = x;
      for (size_t i = 0; i <= planes.size(); ++i) {
        const glm::dvec3 y = x + corrections[i];
        if (i == planes.size()) {
          x = glm::length(y) > radius ? y * (radius / glm::length(y)) : y;
        } else {
          x = y - std::max(glm::dot(planes[i].normal, y) - planes[i].offset, 0.0) * planes[i].normal;
        }
        corrections[i] = y - x;
      }
      if (glm::length(x - before) < 1e-13 * radius) break;
    }
    double outside = glm::length(x) - radius;
    for (const HalfSpaceOfCell& plane : planes) outside = std::max(outside, glm::dot(plane.normal, x) - plane.offset);
    return outside < 1e-6 * radius ? std::optional(x) : std::nullopt;
  }

  const Foam& foam_;
  CellGraph pairs_;
};

class Overlap : public QueryTest {};

TEST_F(Overlap, FindsTheNearestPointOfAllCells) {
  const AssetContents contents = bakeScene(synthesize("random", 0), "exact", 64);
  const Foam foam = *foamFromAsset(contents);
  const FrothAsset asset = openReady(contents);
  createInstance(asset);
  const FrothAssetStatus status = statusOf(asset);
  const BruteSolid solid(foam);
  Random random(1);
  int touching = 0, inside = 0;
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 low(status.boundsMin[0], status.boundsMin[1], status.boundsMin[2]);
    const glm::dvec3 high(status.boundsMax[0], status.boundsMax[1], status.boundsMax[2]);
    const glm::dvec3 centre = random.inBox(low, high);
    const double radius = random.uniform(0, 0.3);
    const float opacity = i % 2 == 0 ? 0.5f : 0.99f;
    const FrothContact contact = overlap(centre, radius, opacity);
    const auto [distance, cell] = solid.findNearest(centre, radius, double{opacity});
    ASSERT_EQ(contact.isTouching != 0, distance <= radius) << i << ": " << distance << " of " << radius;
    if (!contact.isTouching) continue;
    ++touching;
    inside += distance < 0;
    EXPECT_NEAR(contact.depth, radius - distance, 1e-6) << i;
    // From the contact along the normal lies the centre.
    for (int axis = 0; axis < 3; ++axis) {
      const double towards = contact.position[axis] + (radius - contact.depth) * double{contact.normal[axis]};
      EXPECT_NEAR(towards, centre[axis], 1e-6);
    }
  }
  EXPECT_GT(touching, 100);
  EXPECT_GT(inside, 10);
  EXPECT_GT(touching - inside, 50);
}

// A ball that is pushed along the contact's normal by its depth leaves the cell that it touched.
TEST_F(Overlap, PushedOutASphereTouchesTheCellNoMore) {
  const FrothAsset asset = openReady(bakeScene(synthesize("one", 0), "exact", 64));
  createInstance(asset);
  const FrothAssetStatus status = statusOf(asset);
  Random random(2);
  int touching = 0;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 low(status.boundsMin[0], status.boundsMin[1], status.boundsMin[2]);
    const glm::dvec3 high(status.boundsMax[0], status.boundsMax[1], status.boundsMax[2]);
    glm::dvec3 centre = random.inBox(low, high);
    const double radius = 0.05 * glm::length(high - low);
    const FrothContact contact = overlap(centre, radius);
    if (!contact.isTouching) continue;
    ++touching;
    for (int axis = 0; axis < 3; ++axis) centre[axis] += (contact.depth + 1e-6) * double{contact.normal[axis]};
    EXPECT_EQ(overlap(centre, radius).isTouching, 0u);
  }
  EXPECT_GT(touching, 20);
}

TEST_F(Overlap, OfALargeSphereFindsTheSameSurfaceAsASmallOne) {
  const FrothAsset asset = openReady(bakeScene(synthesize("gallery", 5000), "default", 700));
  createInstance(asset);
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 centre = random.inBox(glm::dvec3(-1, -1, 0.5), glm::dvec3(1, 1, 1.5));
    const FrothContact large = overlap(centre, 100);
    ASSERT_TRUE(large.isTouching);
    const double distance = 100 - large.depth;
    if (distance < 0) continue;
    const FrothContact small = overlap(centre, distance + 1e-6);
    EXPECT_EQ(small.cell, large.cell);
    EXPECT_EQ(small.chunk, large.chunk);
    EXPECT_EQ(overlap(centre, distance - 1e-6).isTouching, 0u);
  }
}

TEST_F(Overlap, WithSeveralInstancesFindsTheDeepestContact) {
  const AssetContents contents = bakeScene(synthesize("one", 0), "exact", 64);
  const FrothAsset asset = openReady(contents);
  const FrothInstance near = placeAt(asset, {0, 0, 0});
  const FrothAssetStatus status = statusOf(asset);
  const glm::dvec3 middle =
      0.5 * glm::dvec3(status.boundsMin[0] + status.boundsMax[0], status.boundsMin[1] + status.boundsMax[1],
                       status.boundsMin[2] + status.boundsMax[2]);
  const FrothContact alone = overlap(middle + glm::dvec3(0, 0, 10), 20);
  ASSERT_TRUE(alone.isTouching);
  const FrothInstance nearer = placeAt(asset, {0, 0, 3}, {0, 0, 0, 1}, 0.5f);
  const FrothContact both = overlap(middle + glm::dvec3(0, 0, 10), 20);
  EXPECT_EQ(alone.instance.index, near.index);
  EXPECT_EQ(both.instance.index, nearer.index);
  EXPECT_GT(both.depth, alone.depth);
}

}  // namespace
}  // namespace froth::test
