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

class GpuRays : public testing::TestWithParam<FrothRayPreparation> {
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
    stage.place(stage.open(contents, GetParam()));
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

TEST_P(GpuRays, ThroughARandomFoamAgreeWithTheQueries) {
  expectAgreement(bakeScene(makeRandomFoam(200, 4, 2, 3), "exact", 64), 5000);
}

// Chunk origins are so large that a float holds the foam's box to 0.06 and to 64 units.
TEST_P(GpuRays, ThroughChunksFarFromTheOriginAgreeWithTheQueries) {
  const AssetContents contents = bakeScene(makeRandomFoam(200, 4, 2, 3), "default", 64);
  ASSERT_GE(contents.chunks.size(), 3u);
  expectAgreement(contents, 2000, {0x1p20, -0x1p20, 0x1p19});  // 1e6
  expectAgreement(contents, 2000, {-0x1p30, 0x1p29, 0x1p30});  // 1e9
}

TEST_P(GpuRays, ThroughASyntheticFoamAgreeWithTheQueries) {
  static const AssetContents contents = bakeScene(synthesize("gallery", 5000), "default", 500);
  expectAgreement(contents, 10000);
}

INSTANTIATE_TEST_SUITE_P(Prepared, GpuRays, preparations(), nameOfPreparation);

// What denoisers take for hit distances.
class HitDistances : public testing::Test {
 protected:
  HitDistances() {
    asset_ = stage_.open(bakeScene(makeRandomFoam(200, 4, 2, 3), "exact", 64));  // in [-1, 1]^3 + (0, 0, 3)
    instance_ = stage_.place(asset_);
    rays_ = randomRays({-1, -1, 2}, {1, 1, 4}, 1000, 5);
    for (FrothGpuRay& ray : rays_) ray.tMax = 0;
  }

  std::vector<float> cast(const std::vector<FrothGpuRay>& rays, FrothRayKind kind = FROTH_RAY_CLOSEST) {
    std::vector<float> distances;
    for (const FrothGpuHit& hit : stage_.cast(rays, kind)) distances.push_back(hit.distance);
    return distances;
  }

  // All but a few: where a face is grazed, the last place of a float decides.
  void expectDistances(const std::vector<float>& found, double factor, double shift) {
    const std::vector<float> base = cast(rays_);
    size_t stopped = 0, differing = 0;
    for (size_t i = 0; i < base.size(); ++i) {
      const double expected = factor * base[i] + shift;
      stopped += std::isfinite(base[i]);
      differing += std::isfinite(found[i]) != std::isfinite(base[i]) ||
                   (std::isfinite(found[i]) && !(std::abs(found[i] - expected) <= 1e-4 * expected));
    }
    EXPECT_GT(stopped, base.size() / 4);
    EXPECT_LT(stopped, base.size());
    EXPECT_LE(differing, base.size() / 200);
  }

  WalkStage stage_;
  FrothAsset asset_{};
  FrothInstance instance_{};
  std::vector<FrothGpuRay> rays_;
};

TEST_F(HitDistances, AreInWorldUnitsWhateverTheLengthOfTheDirection) {
  std::vector<FrothGpuRay> longer = rays_;
  for (FrothGpuRay& ray : longer) {
    for (float& part : ray.direction) part *= 5;
  }
  expectDistances(cast(longer), 1, 0);
}

// A mirror's ray is the part of the mirrored camera's that begins at the mirror.
TEST_F(HitDistances, CountFromTheOriginAndNotFromWhereTheRayBegins) {
  constexpr float kBack = 0.75f;
  std::vector<FrothGpuRay> earlier = rays_;
  for (FrothGpuRay& ray : earlier) {
    for (int axis = 0; axis < 3; ++axis) ray.origin[axis] -= kBack * ray.direction[axis];
    ray.tMin = kBack;
  }
  expectDistances(cast(earlier), 1, kBack);
}

TEST_F(HitDistances, GrowWithTheInstance) {
  FrothInstanceInfo placement{};
  placement.scale = 2;
  stage_.move(instance_, asset_, placement);
  std::vector<FrothGpuRay> larger = rays_;
  for (FrothGpuRay& ray : larger) {
    for (float& part : ray.origin) part *= 2;
  }
  const std::vector<float> found = cast(larger);
  stage_.move(instance_, asset_, {});
  expectDistances(found, 2, 0);
}

TEST_F(HitDistances, AreTheSameOfAllKindsAndInfiniteOfAMiss) {
  for (const FrothRayKind kind : {FROTH_RAY_TRANSMITTANCE, FROTH_RAY_RADIANCE}) {
    expectDistances(cast(rays_, kind), 1, 0);
  }
  const std::vector<FrothGpuRay> away = {gpuRay({0, 0, 0}, {0, 0, -1}), gpuRay({0, 5, 3}, {1, 0, 0})};
  for (const FrothRayKind kind : {FROTH_RAY_TRANSMITTANCE, FROTH_RAY_CLOSEST, FROTH_RAY_RADIANCE}) {
    for (const float distance : cast(away, kind)) EXPECT_EQ(distance, kInfinity);
  }
}

}  // namespace
}  // namespace froth::test
