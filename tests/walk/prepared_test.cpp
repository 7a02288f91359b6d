// Prepared cells (FrothAssetInfo::prepareRays) change what rays cost, and no hit but for last digits: each form is
// compiled by itself, and a GPU may fuse other products in each.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/walk/walk_stage.h"

namespace froth::test {
namespace {

constexpr FrothRayKind kKinds[] = {FROTH_RAY_TRANSMITTANCE, FROTH_RAY_CLOSEST, FROTH_RAY_RADIANCE};

// With lattices, and lobes beside the table of axes.
AssetContents bakeDefault(const Foam& foam) {
  BakeOptions options;
  options.knobs = *presetKnobs("default");
  options.preset = "default";
  options.chunkCells = 500;
  options.measure = false;
  Result<BakeResult> baked = bakeFoam(foam, options);
  EXPECT_TRUE(baked) << baked.error().message;
  return std::move(baked->contents);
}

struct Cast {
  std::vector<std::vector<FrothGpuHit>> hits;  // by kind, each twice
  FrothWalkStatus status{};                    // of transmittance
};

Cast castAll(const AssetContents& contents, const std::vector<FrothGpuRay>& rays, FrothRayPreparation prepared) {
  WalkStage stage;
  stage.place(stage.open(contents, prepared));
  Cast cast;
  for (const FrothRayKind kind : kKinds) {
    for (int time = 0; time < 2; ++time) cast.hits.push_back(stage.cast(rays, kind));
    if (kind == FROTH_RAY_TRANSMITTANCE) cast.status = stage.status();
  }
  EXPECT_EQ(stage.status().indexViolations, 0u);
  return cast;
}

bool areSame(const std::vector<FrothGpuHit>& a, const std::vector<FrothGpuHit>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(FrothGpuHit)) == 0;
}

bool areNear(float a, float b, float difference) { return a == b || std::abs(a - b) <= difference; }

bool isNear(const FrothGpuHit& hit, const FrothGpuHit& expected) {
  bool isNear = hit.status == expected.status && hit.chunk == expected.chunk && hit.cell == expected.cell &&
                areNear(hit.transmittance, expected.transmittance, 5e-5f) &&
                areNear(hit.distance, expected.distance, 1e-5f * std::max(1.0f, expected.distance));
  for (int i = 0; i < 3; ++i) {
    isNear = isNear && areNear(hit.normal[i], expected.normal[i], 1e-5f);
    isNear = isNear && areNear(hit.colour[i], expected.colour[i], 1e-4f);
  }
  return isNear;
}

void expectNearHits(const std::vector<FrothGpuHit>& hits, const std::vector<FrothGpuHit>& expected) {
  ASSERT_EQ(hits.size(), expected.size());
  for (size_t i = 0; i < hits.size(); ++i) {
    const FrothGpuHit &hit = hits[i], &other = expected[i];
    EXPECT_TRUE(isNear(hit, other)) << "ray " << i << ": T " << hit.transmittance << " for " << other.transmittance
                                    << ", distance " << hit.distance << " for " << other.distance << ", cell "
                                    << hit.chunk << "/" << hit.cell << " for " << other.chunk << "/" << other.cell
                                    << ", red " << hit.colour[0] << " for " << other.colour[0];
  }
}

void expectSameHits(const AssetContents& contents, const std::vector<FrothGpuRay>& rays) {
  const Cast expected = castAll(contents, rays, FROTH_PREPARE_NOTHING);
  for (const FrothRayPreparation prepared : {FROTH_PREPARE_VISIBILITY, FROTH_PREPARE_RADIANCE}) {
    const Cast cast = castAll(contents, rays, prepared);
    for (size_t i = 0; i < cast.hits.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "prepared " << prepared << ", cast " << i);
      expectNearHits(cast.hits[i], expected.hits[i]);
      EXPECT_TRUE(areSame(cast.hits[i], cast.hits[i ^ 1]));
    }
    // Rows that planes do not decide are read twice.
    const double more = static_cast<double>(cast.status.neighbours) / static_cast<double>(expected.status.neighbours);
    std::printf("neighbours tested: %.4f times as many\n", more);
    EXPECT_LT(more, 1.02);
    EXPECT_NEAR(static_cast<double>(cast.status.cells), static_cast<double>(expected.status.cells),
                1e-4 * static_cast<double>(expected.status.cells));
  }
}

TEST(PreparedCells, ChangeNoHitInARandomFoamOfSeveralChunks) {
  expectSameHits(bakeScene(makeRandomFoam(200, 4, 2, 3), "exact", 64), raysThrough({-1, -1, 2}, {1, 1, 4}, 2000, 21));
}

// Rays take as prepared what all instances have.
TEST(PreparedCells, ChangeNoHitBesideInstancesOfWhichLessIsPrepared) {
  const AssetContents contents = bakeScene(makeRandomFoam(120, 4, 2, 5), "exact", 64);
  const std::vector<FrothGpuRay> rays = raysThrough({-1, -1, 2}, {2, 1, 4}, 1000, 21);
  const auto castThrough = [&](FrothRayPreparation first, FrothRayPreparation second) {
    WalkStage stage;
    stage.place(stage.open(contents, first));
    FrothInstanceInfo beside{};
    beside.position[0] = 0.8;
    stage.place(stage.open(contents, second), beside);
    std::vector<FrothGpuHit> hits = stage.cast(rays, FROTH_RAY_RADIANCE);
    EXPECT_EQ(stage.status().indexViolations, 0u);
    return hits;
  };
  const std::vector<FrothGpuHit> expected = castThrough(FROTH_PREPARE_NOTHING, FROTH_PREPARE_NOTHING);
  expectNearHits(castThrough(FROTH_PREPARE_RADIANCE, FROTH_PREPARE_NOTHING), expected);
  expectNearHits(castThrough(FROTH_PREPARE_VISIBILITY, FROTH_PREPARE_RADIANCE), expected);
}

TEST(PreparedCells, ChangeNoHitInAGalleryWithLobesAndLattices) {
  expectSameHits(bakeDefault(synthesize("gallery", 5000)), raysThrough({-3, -3, -3}, {3, 3, 3}, 4000, 21));
}

}  // namespace
}  // namespace froth::test
