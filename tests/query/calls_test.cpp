// The calls of queries: what they refuse, and what they answer where there is little to see.
#include <cmath>
#include <limits>

#include "tests/query/query_fixture.h"

namespace froth::test {
namespace {

using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class Calls : public QueryTest {
 protected:
  static AssetContents scene(bool walkGraph = true) {
    return bakeScene(synthesize("random", 0), "exact", 64, walkGraph);
  }

  void expectRefused(const FrothRay& ray, const char* text) {
    const std::vector<FrothRay> rays{makeRay({0, 0, 0}, {1, 0, 0}), ray};
    cast(rays, makeStruct<FrothCastInfo>(), FROTH_ERROR_ARGUMENT);
    EXPECT_THAT(lastText(), HasSubstr("rays[1]"));
    EXPECT_THAT(lastText(), HasSubstr(text));
  }
};

TEST_F(Calls, RefuseRaysThatAreNoneAndNameThem) {
  createInstance(openReady(scene()));
  expectRefused(makeRay({0, 0, 0}, {kNaN, 0, 0}), "direction");
  expectRefused(makeRay({0, 0, 0}, {0, 0, 0}), "direction");
  expectRefused(makeRay({0, kInfinity, 0}, {1, 0, 0}), "origin");
  expectRefused(makeRay({0, 0, 0}, {1, 0, 0}, -1), "tMin");
  expectRefused(makeRay({0, 0, 0}, {1, 0, 0}, kInfinity), "tMin");
  expectRefused(makeRay({0, 0, 0}, {1, 0, 0}, 0, kNaN), "tMax");
}

TEST_F(Calls, RefuseNullPointersAndNumbersOutOfRange) {
  const FrothInstance instance = createInstance(openReady(scene()));
  const FrothRay ray = makeRay({0, 0, 0}, {1, 0, 0});
  FrothRayHit hit{};
  EXPECT_EQ(frothCastRays(nullptr, nullptr, &ray, &hit, 1), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothCastRays(context_, nullptr, nullptr, &hit, 1), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothCastRays(context_, nullptr, &ray, nullptr, 1), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothCastRays(context_, nullptr, nullptr, nullptr, 0), FROTH_OK);
  auto info = makeStruct<FrothCastInfo>();
  info.quantile = 1;
  cast({ray}, info, FROTH_ERROR_ARGUMENT);
  info.quantile = 0;
  info.cutoff = 1;
  cast({ray}, info, FROTH_ERROR_ARGUMENT);
  auto location = makeStruct<FrothLocation>();
  const double point[3] = {0, 0, kNaN};
  EXPECT_EQ(frothLocate(context_, instance, nullptr, &location), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothLocate(context_, instance, point, &location), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothLocate(context_, {99, 1}, ray.origin, &location), FROTH_ERROR_HANDLE);
  auto sphere = makeStruct<FrothSphere>();
  auto contact = makeStruct<FrothContact>();
  EXPECT_EQ(frothOverlapSphere(context_, nullptr, &contact), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothOverlapSphere(context_, &sphere, nullptr), FROTH_ERROR_ARGUMENT);
  sphere.radius = -1;
  EXPECT_EQ(frothOverlapSphere(context_, &sphere, &contact), FROTH_ERROR_ARGUMENT);
  sphere.radius = 1;
  sphere.opacity = 1;
  EXPECT_EQ(frothOverlapSphere(context_, &sphere, &contact), FROTH_ERROR_ARGUMENT);
}

void expectNothingMet(const FrothRayHit& hit) {
  EXPECT_EQ(hit.transmittance, 1.0f);
  EXPECT_EQ(hit.distance, kInfinity);
  EXPECT_EQ(hit.instance.generation, 0u);
}

TEST_F(Calls, MeetNothingInAWorldWithoutInstances) {
  createContext();
  expectNothingMet(cast({makeRay({0, 0, 0}, {1, 0, 0})})[0]);
  EXPECT_EQ(overlap({0, 0, 0}, 10).isTouching, 0u);
}

TEST_F(Calls, LeaveOutAssetsThatDoNotKeepTheirDataForQueries) {
  const FrothAsset asset = openForQueries(scene(), 0);
  while (statusOf(asset).state == FROTH_ASSET_OPENING) ASSERT_EQ(update(++serial_), FROTH_OK);
  EXPECT_EQ(statusOf(asset).hostBytes, 0u);
  const FrothInstance instance = createInstance(asset);
  expectNothingMet(cast({makeRay({0, 0, -3}, {0, 0, 1})})[0]);
  auto location = makeStruct<FrothLocation>();
  const double point[3] = {0, 0, 0};
  EXPECT_EQ(frothLocate(context_, instance, point, &location), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("keepForQueries"));
}

TEST_F(Calls, TellOfAnAssetThatIsNotReady) {
  const FrothAsset asset = openForQueries(scene());
  const FrothInstance instance = createInstance(asset);
  const FrothRayHit hit = cast({makeRay({0, 0, -3}, {0, 0, 1})}, makeStruct<FrothCastInfo>(), FROTH_INCOMPLETE)[0];
  EXPECT_EQ(hit.bits, uint32_t{FROTH_QUERY_NOT_READY});
  expectNothingMet(hit);
  auto location = makeStruct<FrothLocation>();
  const double point[3] = {0, 0, 0};
  EXPECT_EQ(frothLocate(context_, instance, point, &location), FROTH_ERROR_STATE);
}

TEST_F(Calls, GoOnAnsweringWhileTheDeviceIsLost) {
  createInstance(openReady(scene()));
  const FrothRay ray = makeRay({0, 0, -3}, {0, 0, 1});
  const FrothRayHit before = cast({ray})[0];
  ASSERT_LT(before.transmittance, 1);
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  EXPECT_EQ(cast({ray})[0].transmittance, before.transmittance);
}

TEST_F(Calls, TellOfAnAssetWithoutAWalkGraph) {
  const FrothAsset asset = openReady(scene(false));
  const FrothInstance instance = createInstance(asset);
  EXPECT_EQ(statusOf(asset).hostBytes, 0u);
  const FrothRayHit hit = cast({makeRay({0, 0, -3}, {0, 0, 1})}, makeStruct<FrothCastInfo>(), FROTH_INCOMPLETE)[0];
  EXPECT_EQ(hit.bits, uint32_t{FROTH_QUERY_NO_WALK_GRAPH});
  auto location = makeStruct<FrothLocation>();
  const double point[3] = {0, 0, 0};
  EXPECT_EQ(frothLocate(context_, instance, point, &location), FROTH_ERROR_UNSUPPORTED);
  auto sphere = makeStruct<FrothSphere>();
  sphere.radius = 10;
  auto contact = makeStruct<FrothContact>();
  EXPECT_EQ(frothOverlapSphere(context_, &sphere, &contact), FROTH_INCOMPLETE);
  EXPECT_EQ(contact.bits, uint32_t{FROTH_QUERY_NO_WALK_GRAPH});
}

TEST_F(Calls, TellOfRaysThatEndAtTheStepLimit) {
  createInstance(openReady(scene()));
  auto info = makeStruct<FrothCastInfo>();
  info.maxSteps = 1;
  const FrothRayHit hit = cast({makeRay({0, 0, -3}, {0, 0, 1})}, info, FROTH_INCOMPLETE)[0];
  EXPECT_EQ(hit.bits, uint32_t{FROTH_QUERY_STEP_LIMIT});
  EXPECT_EQ(hit.steps, 1u);
}

TEST_F(Calls, TellOfRaysThatEndAtTheNeighbourLimit) {
  createInstance(openReady(scene()));
  const FrothRay ray = makeRay({0, 0, -3}, {0, 0, 1});
  ASSERT_GT(cast({ray})[0].steps, 1u);
  auto info = makeStruct<FrothCastInfo>();
  info.maxNeighbours = 1;
  const FrothRayHit hit = cast({ray}, info, FROTH_INCOMPLETE)[0];
  EXPECT_EQ(hit.bits, uint32_t{FROTH_QUERY_STEP_LIMIT});
  EXPECT_EQ(hit.steps, 1u);
}

TEST_F(Calls, SeeAClosedAssetNoMore) {
  const FrothAsset asset = openReady(scene());
  const FrothInstance instance = createInstance(asset);
  const FrothRay ray = makeRay({0, 0, -3}, {0, 0, 1});
  EXPECT_LT(cast({ray})[0].transmittance, 1);
  ASSERT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
  ASSERT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  expectNothingMet(cast({ray})[0]);
  auto location = makeStruct<FrothLocation>();
  EXPECT_EQ(frothLocate(context_, instance, ray.origin, &location), FROTH_ERROR_HANDLE);
}

TEST_F(Calls, MeetNothingInAFoamWithoutLiveCells) {
  AssetContents contents = makeSampleAsset({.cellsPerChunk = 6, .lobeCount = 0, .hasHeights = false});
  ChunkContents& chunk = contents.chunks[0];
  chunk.liveCount = 0;
  chunk.alphaCounts.clear();
  chunk.densities.clear();
  chunk.orientations.clear();
  chunk.detailSites.clear();
  chunk.lobeAxes.clear();
  chunk.lobeColours.clear();
  const FrothInstance instance = createInstance(openReady(contents));
  const glm::dvec3 origin(chunk.origin[0], chunk.origin[1], chunk.origin[2]);
  expectNothingMet(cast({makeRay(origin, {1, 0, 0})})[0]);
  EXPECT_EQ(overlap(origin, 100).isTouching, 0u);
  EXPECT_EQ(locate(instance, origin).isLive, 0u);
}

TEST_F(Calls, CountTheHostMemoryThatTheyKeep) {
  const AssetContents contents = scene();
  uint64_t cells = 0;
  for (const ChunkContents& chunk : contents.chunks) cells += chunk.cellCount;
  const FrothAsset asset = openReady(contents);
  EXPECT_GT(statusOf(asset).hostBytes, 100 * cells);
  EXPECT_LT(statusOf(asset).hostBytes, 1000 * cells);
}

class CallsOnADevice : public RuntimeGpuTest {};

TEST_F(CallsOnADevice, AnswerOnceTheAssetIsLoaded) {
  createContext(host_->contextInfo());
  const Result<std::vector<uint8_t>> bytes = encodeAsset(bakeScene(synthesize("random", 0), "exact", 64));
  ASSERT_TRUE(bytes) << bytes.error().message;
  auto info = makeStruct<FrothAssetInfo>();
  info.data = bytes->data();
  info.dataSize = bytes->size();
  info.keepForQueries = 1;
  FrothAsset asset{};
  ASSERT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK) << lastText();
  createInstance(asset);
  while (statusOf(asset).state == FROTH_ASSET_OPENING && !HasFailure()) runFrame();
  ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_READY) << lastText();
  const FrothRay ray = makeRay({0, 0, -3}, {0, 0, 1});
  FrothRayHit hit{};
  ASSERT_EQ(frothCastRays(context_, nullptr, &ray, &hit, 1), FROTH_OK) << lastText();
  EXPECT_LT(hit.transmittance, 1);
  EXPECT_GT(statusOf(asset).hostBytes, 0u);
}

}  // namespace
}  // namespace froth::test
