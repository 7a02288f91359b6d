// Rays on the GPU against the queries on the CPU, which walk in double.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/walk/walk_stage.h"

namespace froth::test {
namespace {

struct Agreement {
  double meanTransmittance = 0, maxTransmittance = 0;
  size_t hits = 0, apart = 0, otherCells = 0;  // apart: by more than 1e-3 in T, or in distance
};

std::vector<FrothGpuRay> randomRays(const glm::dvec3& low, const glm::dvec3& high, size_t count, uint64_t seed) {
  Random random(seed);
  const glm::dvec3 margin = 0.3 * (high - low);
  std::vector<FrothGpuRay> rays;
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 origin(random.inBox(low - margin, high + margin));
    const glm::dvec3 target = random.inBox(low, high);
    const double tMax = i % 4 == 0 ? random.uniform(0, 1) * glm::length(high - low) : 0;
    rays.push_back(gpuRay(origin, glm::vec3(glm::normalize(target - glm::dvec3(origin))), 0, static_cast<float>(tMax)));
  }
  return rays;
}

Agreement compare(const std::vector<FrothGpuHit>& hits, const std::vector<FrothRayHit>& expected, double tolerance) {
  Agreement result;
  for (size_t i = 0; i < hits.size(); ++i) {
    const double difference = std::abs(double{hits[i].transmittance} - double{expected[i].transmittance});
    result.meanTransmittance += difference / static_cast<double>(hits.size());
    result.maxTransmittance = std::max(result.maxTransmittance, difference);
    const bool isHit = std::isfinite(hits[i].distance), isExpected = std::isfinite(expected[i].distance);
    const bool isFar = isHit != isExpected || (isHit && std::abs(hits[i].distance - expected[i].distance) > tolerance);
    result.apart += isFar || !(difference <= tolerance);
    result.hits += isHit && isExpected;
    const bool isSameCell = hits[i].cell == expected[i].cell && hits[i].chunk == expected[i].chunk;
    result.otherCells += isHit && isExpected && !isSameCell;
  }
  std::printf("%zu rays, %zu hits: transmittance mean %.3g max %.3g; %zu apart, %zu stop in another cell\n",
              hits.size(), result.hits, result.meanTransmittance, result.maxTransmittance, result.apart,
              result.otherCells);
  return result;
}

FrothCastInfo withoutCutoff() {
  FrothCastInfo info{};
  info.cutoff = -1;
  return info;
}

void print(const FrothWalkStatus& status) {
  const auto per = [&](uint64_t count) { return static_cast<double>(count) / static_cast<double>(status.rays); };
  std::printf("per ray: %.1f descents, %.1f cells, %.1f neighbours, %.1f cells met, %.1f detail sites\n",
              per(status.descents), per(status.cells), per(status.neighbours), per(status.cellsMet),
              per(status.detailSites));
}

class GpuRays : public testing::Test {
 protected:
  // With the foam moved by `shift`, chunks and all, and an eye that goes with it.
  void expectAgreement(AssetContents contents, size_t count, const glm::dvec3& shift = glm::dvec3(0)) {
    glm::dvec3 low(kInfinity), high(-kInfinity);
    for (ChunkContents& chunk : contents.chunks) {
      const glm::dvec3 origin(chunk.origin[0], chunk.origin[1], chunk.origin[2]);
      for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
        low = glm::min(low, origin + glm::dvec3(chunk.sites[cell]) - double{chunk.radii[cell]});
        high = glm::max(high, origin + glm::dvec3(chunk.sites[cell]) + double{chunk.radii[cell]});
      }
      for (int axis = 0; axis < 3; ++axis) chunk.origin[static_cast<size_t>(axis)] += shift[axis];
    }
    WalkStage stage;
    stage.place(stage.open(contents));
    // the asset is seen from the world's origin first
    stage.frame(walkInfo(), [](VkCommandBuffer, VkDescriptorSet) {});
    const std::vector<FrothGpuRay> rays = randomRays(low, high, count, 1);
    FrothWalkInfo info = walkInfo(shift);
    info.cutoff = -1;
    const Agreement agreement =
        compare(stage.cast(rays, FROTH_RAY_TRANSMITTANCE, info), stage.castOnHost(rays, withoutCutoff(), shift), 1e-3);
    print(stage.status());
    EXPECT_GT(agreement.hits, count / 4);
    EXPECT_LE(agreement.meanTransmittance, 1e-5);
    EXPECT_LE(agreement.apart, count / 500);
    EXPECT_LE(agreement.otherCells, count / 500);
  }
};

TEST_F(GpuRays, ThroughARandomFoamAgreeWithTheQueries) {
  expectAgreement(bakeScene(makeRandomFoam(200, 4, 2, 3), "exact", 64), 5000);
}

// Chunk origins are so large that a float holds the foam's box to 0.06 and to 64 units.
TEST_F(GpuRays, ThroughChunksFarFromTheOriginAgreeWithTheQueries) {
  const AssetContents contents = bakeScene(makeRandomFoam(200, 4, 2, 3), "default", 64);
  ASSERT_GE(contents.chunks.size(), 3u);
  expectAgreement(contents, 2000, {0x1p20, -0x1p20, 0x1p19});  // 1e6
  expectAgreement(contents, 2000, {-0x1p30, 0x1p29, 0x1p30});  // 1e9
}

TEST_F(GpuRays, ThroughASyntheticFoamAgreeWithTheQueries) {
  expectAgreement(bakeScene(synthesize("gallery", 5000), "default", 500), 10000);
}

}  // namespace
}  // namespace froth::test
