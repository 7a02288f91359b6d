// Open space, where empty cells touch hundreds: there a tree over balls answers rays in place of the walk. Against
// brute force over all cells.
#include <algorithm>
#include <cmath>

#include "measure/stability/cases/case_parts.h"
#include "tests/query/first_ball.h"
#include "tests/query/query_fixture.h"
#include "tests/query/reference_rays.h"

namespace froth::test {
namespace {

constexpr uint32_t kOnShell = 1200;

// Cells on a sphere of radius 10 around four that are empty, so that each of these touches hundreds.
Foam shell() {
  std::vector<CaseCell> cells = cloud(kOnShell, 1);
  for (uint32_t i = 0; i < kOnShell; ++i) {  // a Fibonacci lattice
    const float height = 1 - (2 * static_cast<float>(i) + 1) / kOnShell, angle = 2.3999632f * static_cast<float>(i);
    const float across = std::sqrt(1 - height * height);
    cells[i].site = 10.0f * glm::vec3(across * std::cos(angle), across * std::sin(angle), height);
  }
  for (int i = 0; i < 4; ++i) {
    CaseCell empty;
    empty.site = 2.0f * glm::vec3(i & 1, i >> 1 & 1, (i == 0) != (i == 3)) - 1.0f;
    empty.density = 0;
    cells.push_back(empty);
  }
  return foamOfCells(cells);
}

AssetContents bakeShell() { return bakeScene(shell(), "exact", 200, true, false); }

class OpenSpace : public QueryTest {
 protected:
  void SetUp() override {
    contents_ = bakeShell();
    ASSERT_GT(contents_.chunks.size(), 4u);
    foam_ = *foamFromAsset(contents_);
  }

  QueryFoam makeQueryFoam() const {
    QueryFoam foam(contents_);
    for (const ChunkContents& chunk : contents_.chunks) foam.addChunk(makeQueryChunk(chunk), findLiveBounds(chunk));
    foam.finish();
    return foam;
  }

  AssetContents contents_;
  Foam foam_;
};

TEST_F(OpenSpace, HasEmptyCellsWithLongRows) {
  const QueryFoam foam = makeQueryFoam();
  size_t longRows = 0;
  for (uint32_t chunk = 0; chunk < contents_.chunks.size(); ++chunk) {
    for (uint32_t cell = contents_.chunks[chunk].liveCount; cell < contents_.chunks[chunk].cellCount; ++cell) {
      longRows += foam.isRowLong(foam.chunk(chunk), cell);
    }
  }
  EXPECT_EQ(longRows, 4u);
}

TEST_F(OpenSpace, APointIsInTheCellOfLeastPower) {
  const FrothInstance instance = createInstance(openReady(contents_));
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 point = random.inBox(glm::dvec3(-12), glm::dvec3(12));
    EXPECT_NEAR(locate(instance, point).power, leastPower(foam_, point), 1e-11);
  }
}

TEST_F(OpenSpace, ARayMeetsWhatTheReferenceMeets) {
  createInstance(openReady(contents_));
  auto info = makeStruct<FrothCastInfo>();
  info.cutoff = -1;
  const ReferenceRays reference(foam_);
  Random random(2);
  std::vector<FrothRay> rays;
  for (int i = 0; i < 1500; ++i) {
    const glm::dvec3 origin = random.inBox(glm::dvec3(-12), glm::dvec3(12));
    const glm::dvec3 target(
        foam_.sites[static_cast<size_t>(random.uniform(0, 1) * static_cast<double>(foam_.cellCount))]);
    rays.push_back(makeRay(origin, glm::normalize(target - origin)));
  }
  const std::vector<FrothRayHit> hits = cast(rays, info);
  size_t stopped = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 origin(rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]);
    const glm::dvec3 direction(rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]);
    const ReferenceHit expected = reference.cast(origin, direction, kInfinity, 0.5, 0);
    EXPECT_NEAR(hits[i].transmittance, expected.transmittance, 1e-6) << i;
    ASSERT_EQ(std::isfinite(hits[i].distance), expected.distance >= 0) << i;
    if (expected.distance >= 0) {
      EXPECT_NEAR(hits[i].distance, expected.distance, 1e-6) << i;
    }
    stopped += expected.distance >= 0;
  }
  EXPECT_GT(stopped, rays.size() / 2);
}

// Along axes too, where a float of the direction is 0, and from inside of balls.
TEST_F(OpenSpace, TheFirstBallIsTheFirstOfAll) {
  const QueryFoam foam = makeQueryFoam();
  Random random(3);
  size_t found = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 site(foam_.sites[static_cast<size_t>(i) % foam_.cellCount]);
    glm::dvec3 direction = random.direction();
    if (i % 4 == 0) direction = glm::dvec3(i % 3 == 0, i % 3 == 1, i % 3 == 2);
    const glm::dvec3 origin = site - random.uniform(0, 20) * direction;
    const double from = i % 2 == 0 ? 0 : random.uniform(0, 10);
    found += expectFirstBall(foam, allChunks(contents_.chunks.size()), origin, direction, from);
  }
  EXPECT_GT(found, 2000u);
}

}  // namespace
}  // namespace froth::test
