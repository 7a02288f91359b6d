// No ray gains opacity outside a cell's solid ball: rays through cells, evaluated in float as the shaders do.
#include "baker/bake/solid_balls.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "foam/foam.h"
#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"
#include "shaders/foam/clip_face.h"
#include "shaders/foam/rays.h"
#include "shaders/foam/solid_ball.h"
#include "tests/bake/random_foam.h"

namespace froth {
namespace {

constexpr float kSharpness = 10;

ChunkContents bakeChunk(const Foam& foam, bool walkGraph = true) {
  BakeOptions options;
  options.steiner = false;
  options.walkGraph = walkGraph;
  Result<BakeResult> result = bakeFoam(foam, options);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(result->contents.chunks.at(0));
}

glm::vec4 codeOf(uint32_t bytes) { return {bytes & 0xff, bytes >> 8 & 0xff, bytes >> 16 & 0xff, bytes >> 24}; }

// One cell as rays through one eye meet it; all in float, in the order of the shaders.
class CellRays {
 public:
  CellRays(const ChunkContents& chunk, uint32_t details, uint32_t cell, const glm::vec3& centre)
      : chunk_(chunk),
        details_(details),
        cell_(cell),
        centre_(centre),
        radius_(chunk.radii[cell]),
        frame_(faceFrame<float>(chunk.orientations[cell])) {
    const uint32_t row = chunk.neighbourOffsets[cell];
    for (uint32_t i = row; i < row + chunk.alphaCounts[cell]; ++i) {
      const uint32_t neighbour = chunk.neighbours[i];
      const glm::vec3 toNeighbour = chunk.sites[neighbour] - chunk.sites[cell];
      const glm::vec3 other = (chunk.sites[neighbour] - chunk.sites[cell]) + centre;
      const float clearance = foam::sharedClearance(centre, other, toNeighbour, radius_, chunk.radii[neighbour]);
      const bool isFar = clearance > 0 || (clearance == 0 && foam::comesFirst(toNeighbour));
      (isFar ? far_ : near_).push_back(foam::eyePlane(toNeighbour, clearance, isFar));
    }
  }

  bool gainsOpacity(const glm::vec3& direction, float& tNear, float& tFar) const {
    if (!foam::intersectBall(centre_, radius_, direction, tNear, tFar)) return false;
    float inverseFar = 1 / tFar, inverseNear = INFINITY;
    for (const glm::vec3& plane : far_) inverseFar = std::max(inverseFar, glm::dot(plane, direction));
    for (const glm::vec3& plane : near_) inverseNear = std::min(inverseNear, glm::dot(plane, direction));
    if (!(inverseNear > 0)) return false;
    tFar = 1 / inverseFar;
    tNear = std::max(tNear, 1 / inverseNear);
    if (!(tFar > tNear)) return false;
    const float facing = glm::dot(frame_.normal, direction);
    const float tBase = foam::intersectFace(centre_, frame_.normal, facing, 0.0f);
    const float height = radius_ * heightAt((facing >= 0 ? tNear : std::max(tNear, tBase)) * direction - centre_);
    const float tFace = foam::intersectFace(centre_, frame_.normal, facing, height);
    if (facing >= 0) {
      tFar = std::min(tFar, tFace);
    } else {
      tNear = std::max(tNear, tFace);
    }
    return tFar > tNear;
  }

 private:
  float heightAt(const glm::vec3& local) const {
    if (chunk_.detailHeights.empty()) return 0;
    const glm::vec3 query =
        foam::faceQuery(foam::inFaceFrame(local, frame_.tangent, frame_.bitangent, frame_.normal, 1 / radius_));
    float sum = 0, weightSum = 0;
    for (uint32_t k = cell_ * details_; k < (cell_ + 1) * details_; ++k) {
      const float weight = foam::detailWeight(query, chunk_.detailSites[k], kSharpness);
      sum += weight * chunk_.detailHeights[k];
      weightSum += weight;
    }
    return sum / foam::flooredWeightSum(weightSum);
  }

  const ChunkContents& chunk_;
  uint32_t details_, cell_;
  glm::vec3 centre_;
  float radius_;
  FaceFrame<float> frame_;
  std::vector<glm::vec3> far_, near_;
};

struct Faults {
  uint32_t raysWithGain = 0;
  uint32_t raysThatMiss = 0;   // though they gain opacity
  uint32_t pointsOutside = 0;  // of the gaining intervals, seen from near by
};

// Rays from eyes around the cell, `distance` radii away, to points all over its ball.
Faults traceCell(const ChunkContents& chunk, uint32_t details, uint32_t cell, double distance, int rays,
                 BallSetMaker& random) {
  Faults faults;
  const double radius = chunk.radii[cell];
  for (int eye = 0; eye < 8; ++eye) {
    const glm::vec3 centre(glm::normalize(random.pointInCube(-1, 1) + glm::dvec3(1e-9)) * distance * radius);
    const CellRays cellRays(chunk, details, cell, centre);
    const glm::vec4 ball = foam::decodeSolidBall(centre, chunk.radii[cell], codeOf(chunk.solidBalls[cell]));
    const glm::vec3 solidCentre(ball);
    for (int i = 0; i < rays / 8; ++i) {
      const glm::vec3 direction(glm::normalize(glm::dvec3(centre) + random.pointInCube(-1, 1) * radius));
      float tNear, tFar;
      if (!cellRays.gainsOpacity(direction, tNear, tFar)) continue;
      ++faults.raysWithGain;
      faults.raysThatMiss += !foam::rayMeetsBall(solidCentre, foam::guardedRadius(solidCentre, ball.w), direction);
      for (const float t : {tNear, tFar}) {
        faults.pointsOutside += glm::distance(glm::dvec3(t * direction), glm::dvec3(solidCentre)) > ball.w * 1.0001;
      }
    }
  }
  return faults;
}

void add(Faults& sum, const Faults& more) {
  sum.raysWithGain += more.raysWithGain;
  sum.raysThatMiss += more.raysThatMiss;
  sum.pointsOutside += more.pointsOutside;
}

void expectAllInside(const ChunkContents& chunk, uint32_t details, uint32_t stride = 1) {
  BallSetMaker random(3);
  ASSERT_EQ(chunk.solidBalls.size(), chunk.liveCount);
  Faults near, far;
  for (uint32_t cell = 0; cell < chunk.liveCount; cell += stride) {
    add(near, traceCell(chunk, details, cell, 3, 400, random));
    add(far, traceCell(chunk, details, cell, std::pow(1000, random.uniform(0.4, 1)), 200, random));
  }
  EXPECT_GT(near.raysWithGain, 0u);
  EXPECT_EQ(near.raysThatMiss, 0u);
  EXPECT_EQ(near.pointsOutside, 0u);
  EXPECT_EQ(far.raysThatMiss, 0u);
}

Foam withBalls(const BallSet& balls, uint64_t seed) {
  Foam foam = makeRandomFoam(balls.size(), 4, 1, seed);
  foam.sites = balls.sites;
  foam.radii = balls.radii;
  return foam;
}

TEST(SolidBalls, HoldEveryPointWhereARayGainsOpacity) {
  expectAllInside(bakeChunk(makeMixedFoam()), 2);
  Foam tall = makeRandomFoam(300, 8, 1, 21);
  for (float& height : tall.detailHeights) height *= 8;
  expectAllInside(bakeChunk(tall), 8);
  Foam sunken = makeRandomFoam(300, 3, 1, 22);
  for (float& height : sunken.detailHeights) height = -0.3f - std::abs(height);
  expectAllInside(bakeChunk(sunken, false), 3);
  Foam flat = makeRandomFoam(300, 1, 1, 23);
  flat.detailHeights.assign(flat.detailHeights.size(), 0.0f);
  expectAllInside(bakeChunk(flat), 1);
}

TEST(SolidBalls, HoldEveryPointOfDegenerateFoams) {
  BallSetMaker random(8);
  for (const BallSet& balls : {random.stiff(400), random.grid(6, 0.7f), random.coplanar(200), random.collinear(60),
                               random.withNearDuplicates(200), random.foamLike(200, 1000)}) {
    SCOPED_TRACE(balls.name);
    expectAllInside(bakeChunk(withBalls(balls, 4)), 4);
  }
}

// What a reader of layer 0 alone draws.
TEST(SolidBalls, HoldEveryPointOfTheCoarserScene) {
  ChunkContents chunk = bakeChunk(makeRandomFoam(300, 4, 1, 24));
  chunk.detailSites.assign(chunk.liveCount, glm::vec2(0));
  chunk.detailHeights = chunk.cellHeights;
  expectAllInside(chunk, 1);
}

TEST(SolidBalls, ThatWereTooSmallOrOffWouldBeFound) {
  ChunkContents chunk = bakeChunk(makeRandomFoam(200, 2, 1, 25));
  for (uint32_t& bytes : chunk.solidBalls) bytes -= 4u << 24;
  BallSetMaker random(3);
  uint32_t found = 0;
  for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
    found += traceCell(chunk, 2, cell, 3, 2000, random).pointsOutside > 0;
  }
  EXPECT_GT(found, 0.9 * chunk.liveCount);
}

TEST(SolidBalls, AreTighterThanTheCellsOwnWhereCellsAreCut) {
  const ChunkContents chunk = bakeChunk(makeRandomFoam(2000, 2, 1, 26));
  double area = 0;
  for (const uint32_t bytes : chunk.solidBalls) area += std::pow((bytes >> 24) / 64.0, 2);
  EXPECT_LT(area / chunk.liveCount, 0.95);
}

TEST(SolidBalls, OfLoneCellsAreTheirOwn) {
  Foam foam = makeRandomFoam(2, 1, 1, 27);
  foam.sites = {{0, 0, 0}, {10, 0, 0}};
  EXPECT_EQ(bakeChunk(foam).solidBalls, (std::vector<uint32_t>{kWholeBall, kWholeBall}));
}

}  // namespace
}  // namespace froth
