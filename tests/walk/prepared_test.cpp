// Prepared cells (FrothAssetInfo::prepareRays) change what rays cost, and no hit.
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

std::vector<FrothGpuRay> raysThrough(const glm::dvec3& low, const glm::dvec3& high, size_t count) {
  Random random(21);
  std::vector<FrothGpuRay> rays;
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 origin(random.inBox(low, high));
    rays.push_back(gpuRay(origin, glm::vec3(glm::normalize(random.inBox(low, high) - glm::dvec3(origin)))));
  }
  return rays;
}

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

void expectSameHits(const AssetContents& contents, const std::vector<FrothGpuRay>& rays) {
  const Cast expected = castAll(contents, rays, FROTH_PREPARE_NOTHING);
  for (const FrothRayPreparation prepared : {FROTH_PREPARE_VISIBILITY, FROTH_PREPARE_RADIANCE}) {
    const Cast cast = castAll(contents, rays, prepared);
    for (size_t i = 0; i < cast.hits.size(); ++i) EXPECT_TRUE(areSame(cast.hits[i], expected.hits[i])) << prepared;
    // Rows that planes do not decide are read twice.
    const double more = static_cast<double>(cast.status.neighbours) / static_cast<double>(expected.status.neighbours);
    std::printf("neighbours tested: %.4f times as many\n", more);
    EXPECT_LT(more, 1.02);
    EXPECT_EQ(cast.status.cells, expected.status.cells);
  }
}

TEST(PreparedCells, ChangeNoHitInARandomFoamOfSeveralChunks) {
  expectSameHits(bakeScene(makeRandomFoam(200, 4, 2, 3), "exact", 64), raysThrough({-1, -1, 2}, {1, 1, 4}, 2000));
}

TEST(PreparedCells, ChangeNoHitInAGalleryWithLobesAndLattices) {
  expectSameHits(bakeDefault(synthesize("gallery", 2000)), raysThrough({-3, -3, -3}, {3, 3, 3}, 4000));
}

}  // namespace
}  // namespace froth::test
