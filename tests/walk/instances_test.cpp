// Several instances, and rays that are out of the ordinary.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/walk/walk_stage.h"

namespace froth::test {
namespace {

FrothInstanceInfo placeAt(const glm::dvec3& position, float scale = 1, const glm::vec4& rotation = {0, 0, 0, 1}) {
  FrothInstanceInfo info{};
  for (int axis = 0; axis < 3; ++axis) info.position[axis] = position[axis];
  for (int part = 0; part < 4; ++part) info.rotation[part] = rotation[part];
  info.scale = scale;
  return info;
}

FrothCastInfo withoutCutoff() {
  FrothCastInfo info{};
  info.cutoff = -1;
  return info;
}

// The foam lies in [-1, 1]^3 + (0, 0, 3).
class GpuInstances : public testing::Test {
 protected:
  GpuInstances() : asset_(stage_.open(bakeScene(makeRandomFoam(120, 3, 1, 4), "exact", 64))) { info_.cutoff = -1; }

  void expectAsOnHost(const std::vector<FrothGpuRay>& rays) {
    const auto hits = stage_.cast(rays, FROTH_RAY_TRANSMITTANCE, info_);
    const auto expected = stage_.castOnHost(rays, withoutCutoff());
    size_t apart = 0, stopped = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(hits[i].status, 0u);
      const bool isSame =
          std::isfinite(hits[i].distance) == std::isfinite(expected[i].distance) &&
          std::abs(hits[i].transmittance - expected[i].transmittance) < 1e-4 &&
          (!std::isfinite(hits[i].distance) ||
           (std::abs(hits[i].distance - expected[i].distance) < 1e-3 && hits[i].cell == expected[i].cell));
      apart += !isSame;
      stopped += std::isfinite(hits[i].distance);
    }
    EXPECT_LE(apart, rays.size() / 500);
    EXPECT_GT(stopped, rays.size() / 10);
  }

  WalkStage stage_;
  FrothAsset asset_;
  FrothWalkInfo info_ = walkInfo();
};

TEST_F(GpuInstances, TurnedAndScaledIsMetAsOnTheHost) {
  stage_.place(asset_, placeAt({0.5, -0.2, 1}, 0.6f, {0.36f, 0.48f, 0, 0.8f}));
  expectAsOnHost(raysThrough({0.9, -2.2, 0.6}, {2.8, -0.3, 2.4}));
}

TEST_F(GpuInstances, ThatOverlapAddTheirDensities) {
  stage_.place(asset_);
  stage_.place(asset_, placeAt({0.35, -0.2, 0.9}, 0.75f));
  stage_.place(asset_, placeAt({-0.4, 0.3, 1.3}, 0.6f, {0, 0.6f, 0, 0.8f}));
  expectAsOnHost(raysThrough({-2, -2, 0}, {2, 2, 5}));
}

TEST_F(GpuInstances, InARowMayBeMoreThanOverlapAtOnce) {
  for (int i = 0; i < 9; ++i) stage_.place(asset_, placeAt({3.0 * i, 0, 0}, 0.5f));
  expectAsOnHost(raysThrough({-1, -0.6, 0.8}, {26, 0.6, 2.2}));
}

// The same cells twice: as if each were twice as dense.
TEST_F(GpuInstances, AtTheSamePlaceMixTheirColours) {
  Foam dense = makeRandomFoam(120, 3, 1, 4);
  for (float& density : dense.densities) density *= 2;
  FrothInstanceInfo placement{};
  placement.mask = 1;
  stage_.place(asset_, placement);
  stage_.place(asset_, placement);
  placement.mask = 2;
  stage_.place(stage_.open(bakeScene(dense, "exact", 64)), placement);
  const View view = lookAt({0.2, 0.3, -1}, {0, 0, 3}, 64, 48, 0.4);
  Image images[2];
  for (uint32_t mask : {1u, 2u}) {
    std::vector<FrothGpuRay> rays = cameraRays(view);
    for (FrothGpuRay& ray : rays) ray.mask = mask;
    images[mask - 1] = imageOf(stage_.cast(rays, FROTH_RAY_RADIANCE, walkInfo(eyeOf(view))), view);
  }
  EXPECT_GE(psnr(images[0], images[1]), 60);
}

TEST_F(GpuInstances, ThatCrossAreThePictureOfTheRaster) {
  stage_.place(asset_);
  stage_.place(asset_, placeAt({0.3, -0.2, 0.5}, 0.8f, {0, 0.6f, 0, 0.8f}));
  const View view = lookAt({0.2, 0.3, -1}, {0, 0, 3}, 64, 48, 0.4);
  const Image rays = imageOf(stage_.cast(cameraRays(view), FROTH_RAY_RADIANCE, walkInfo(eyeOf(view))), view);
  EXPECT_GE(psnr(rays, stage_.rasterize(view)), 60);
}

TEST_F(GpuInstances, ThatCrossAreAsBrightAsTheRasterShowsThem) {
  FrothInstanceInfo dim = placeAt({0, 0, 0}), bright = placeAt({0.3, -0.2, 0.5}, 0.8f, {0, 0.6f, 0, 0.8f});
  dim.exposure = 0.3f;
  bright.exposure = 1.7f;
  stage_.place(asset_, dim);
  stage_.place(asset_, bright);
  const View view = lookAt({0.2, 0.3, -1}, {0, 0, 3}, 64, 48, 0.4);
  const Image rays = imageOf(stage_.cast(cameraRays(view), FROTH_RAY_RADIANCE, walkInfo(eyeOf(view))), view);
  EXPECT_GE(psnr(rays, stage_.rasterize(view)), 60);
}

// What a dropped frame would have filled is filled again.
TEST_F(GpuInstances, AreMetAfterTheFirstFrameThatSawThemWasDropped) {
  stage_.place(asset_);
  const FrothWalkInfo info = walkInfo();
  uint64_t dropped = 0;
  const Status submitted = sharedHost().submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
    const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
    EXPECT_EQ(frothUpdate(stage_.context(), &frame, nullptr), FROTH_OK);
    VkDescriptorSet set = VK_NULL_HANDLE;
    EXPECT_EQ(frothRecordWalkSet(stage_.context(), commands, &info, &set), FROTH_OK);
    dropped = serial;
    return makeError(ErrorKind::kUnsupported, "not submitted");
  });
  EXPECT_FALSE(submitted);
  EXPECT_EQ(frothDropFrame(stage_.context(), dropped), FROTH_OK);
  expectAsOnHost(raysThrough({-2, -2, 0}, {2, 2, 5}));
  EXPECT_LT(stage_.status().descents, 2 * 2000u);
}

TEST_F(GpuInstances, BeyondWhatARayCanBeInAtOnceAreToldOf) {
  for (int i = 0; i < 5; ++i) stage_.place(asset_, placeAt({0.01 * i, 0, 0}));
  const auto hits = stage_.cast({gpuRay({0, 0, 0}, {0, 0, 1})}, FROTH_RAY_TRANSMITTANCE, info_);
  EXPECT_EQ(hits[0].status, uint32_t{FROTH_WALK_STREAM_LIMIT});
}

TEST_F(GpuInstances, AreMetByRaysThatShareABitOfTheirMask) {
  FrothInstanceInfo placement = placeAt({0, 0, 0});
  placement.mask = 6;
  placement.userId = 77;
  stage_.place(asset_, placement);
  std::vector<FrothGpuRay> rays(4, gpuRay({0, 0, 0}, {0, 0, 1}));
  rays[1].mask = 1;
  rays[2].mask = 3;
  rays[3].mask = 8;
  const auto hits = stage_.cast(rays, FROTH_RAY_TRANSMITTANCE, info_);
  EXPECT_LT(hits[0].transmittance, 0.5f);
  EXPECT_EQ(hits[0].userId, 77u);
  EXPECT_EQ(hits[1].transmittance, 1.0f);
  EXPECT_EQ(hits[2].transmittance, hits[0].transmittance);
  EXPECT_EQ(hits[3].transmittance, 1.0f);
}

TEST_F(GpuInstances, FarFromTheWorldsOriginAreMetAsNearIt) {
  const glm::dvec3 far(1e6, -2e6, 3e6);
  const FrothInstance instance = stage_.place(asset_);
  const auto rays = raysThrough({-2, -2, 0}, {2, 2, 5}, 500);
  const auto near = stage_.cast(rays, FROTH_RAY_TRANSMITTANCE, info_);
  stage_.move(instance, asset_, placeAt(far));
  FrothWalkInfo info = walkInfo(far);
  info.cutoff = -1;
  const auto hits = stage_.cast(rays, FROTH_RAY_TRANSMITTANCE, info);
  for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(hits[i].transmittance, near[i].transmittance);
}

TEST_F(GpuInstances, EndARayAtTheLimitOfStepsWithAStatus) {
  stage_.place(asset_);
  info_.maxSteps = 3;
  const auto rays = raysThrough({-2, -2, 0}, {2, 2, 5}, 500);
  const std::vector<FrothGpuHit> hits = stage_.cast(rays, FROTH_RAY_TRANSMITTANCE, info_);
  uint32_t limited = 0;
  for (const FrothGpuHit& hit : hits) {
    EXPECT_LE(hit.steps, 3u);
    limited += hit.status == FROTH_WALK_STEP_LIMIT;
  }
  EXPECT_GT(limited, 100u);
  EXPECT_EQ(stage_.status().stepLimits, limited);
}

// The search for the first cell counts too: a row may hold 65,535 neighbours, and maxSteps of them are hours.
TEST_F(GpuInstances, EndARayAtTheLimitOfNeighboursWithAStatus) {
  stage_.place(asset_);
  const auto rays = raysThrough({-2, -2, 0}, {2, 2, 5}, 500);
  stage_.cast(rays, FROTH_RAY_TRANSMITTANCE, info_);
  const FrothWalkStatus whole = stage_.status();
  EXPECT_EQ(whole.stepLimits, 0u);
  info_.maxNeighbours = 1;
  const std::vector<FrothGpuHit> hits = stage_.cast(rays, FROTH_RAY_TRANSMITTANCE, info_);
  uint32_t limited = 0;
  for (const FrothGpuHit& hit : hits) {
    EXPECT_LE(hit.steps, 1u);
    limited += hit.status == FROTH_WALK_STEP_LIMIT;
  }
  EXPECT_GT(limited, 100u);
  const FrothWalkStatus cut = stage_.status();
  EXPECT_EQ(cut.stepLimits, limited);
  EXPECT_LE(cut.cells + cut.descents, rays.size());  // one row each, for the search or for the walk
  EXPECT_LT(cut.neighbours, whole.neighbours / 2);
}

// The same cut-off as on the host, where it is compared with the reference: T of a cell later or earlier is another
// one.
TEST_F(GpuInstances, EndARayBehindTheCellThatFallsBelowTheCutoff) {
  stage_.place(asset_);
  const auto rays = raysThrough({-2, -2, 0}, {2, 2, 5});
  const auto whole = stage_.cast(rays, FROTH_RAY_TRANSMITTANCE, info_);
  FrothCastInfo castInfo{};
  info_.cutoff = castInfo.cutoff = 0.3f;
  const auto expected = stage_.castOnHost(rays, castInfo);
  for (const FrothRayKind kind : {FROTH_RAY_TRANSMITTANCE, FROTH_RAY_RADIANCE}) {
    const auto cut = stage_.cast(rays, kind, info_);
    size_t apart = 0, ended = 0, shorter = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      apart += std::abs(cut[i].transmittance - expected[i].transmittance) > 1e-4;
      EXPECT_LE(cut[i].steps, whole[i].steps);
      ended += cut[i].transmittance > whole[i].transmittance + 1e-4f;
      shorter += cut[i].steps < whole[i].steps;
    }
    EXPECT_LE(apart, rays.size() / 500);
    EXPECT_GT(ended, rays.size() / 20);
    EXPECT_GE(shorter, ended);
  }
}

TEST_F(GpuInstances, AreLeftAloneByRaysOfNonsense) {
  stage_.place(asset_);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  std::vector<FrothGpuRay> rays;
  for (const float value : {nan, inf, -inf, 1e30f, -1e30f, 1e-40f, 0.0f}) {
    rays.push_back(gpuRay({value, 0, 0}, {0, 0, 1}));
    rays.push_back(gpuRay({0, 0, 0}, {value, value, value}));
    rays.push_back(gpuRay({0, 0, 3}, {0, 0, 1}, value, 0));
    rays.push_back(gpuRay({0, 0, 3}, {0, 0, 1}, 0, value));
    rays.push_back(gpuRay({0, 0, 0}, {0, 0, 1}));
    rays.back().apex = value;
  }
  for (const FrothRayKind kind : {FROTH_RAY_TRANSMITTANCE, FROTH_RAY_CLOSEST, FROTH_RAY_RADIANCE}) {
    for (const FrothGpuHit& hit : stage_.cast(rays, kind, info_)) EXPECT_LE(hit.steps, 65536u);
  }
}

}  // namespace
}  // namespace froth::test
