// Rays of the runtime's queries against the reference in double.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "tests/query/query_fixture.h"
#include "tests/query/reference_rays.h"

namespace froth::test {
namespace {

class Cast : public QueryTest {};

struct Extent {
  glm::dvec3 low, high;
};

Extent extentOf(const FrothAssetStatus& status) {
  return {{status.boundsMin[0], status.boundsMin[1], status.boundsMin[2]},
          {status.boundsMax[0], status.boundsMax[1], status.boundsMax[2]}};
}

// From in and around the foam, in all directions.
std::vector<FrothRay> randomRays(const Extent& extent, size_t count, uint64_t seed) {
  Random random(seed);
  const glm::dvec3 margin = 0.3 * (extent.high - extent.low);
  std::vector<FrothRay> rays;
  for (size_t i = 0; i < count; ++i) {
    const glm::dvec3 origin = random.inBox(extent.low - margin, extent.high + margin);
    const glm::dvec3 target = random.inBox(extent.low, extent.high);
    const glm::dvec3 direction = glm::length(target - origin) > 1e-6 ? glm::normalize(target - origin) : random.direction();
    const double tMax = i % 4 == 0 ? random.uniform(0, 1) * glm::length(extent.high - extent.low) : 0;
    rays.push_back(makeRay(origin, direction, 0, tMax));
  }
  return rays;
}

struct Agreement {
  double meanTransmittance = 0, maxTransmittance = 0;
  double meanDistance = 0, maxDistance = 0;  // of rays that both stop
  size_t hits = 0, disagreeing = 0;          // disagreeing: by more than kTolerance, or only one stops
  static constexpr double kTolerance = 1e-6;
};

// Without a cut-off: all of a ray counts. Two threads.
Agreement compare(const std::vector<FrothRay>& rays, const std::vector<FrothRayHit>& hits,
                  const ReferenceRays& reference) {
  std::vector<ReferenceHit> expected(rays.size());
  const auto castPart = [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const FrothRay& ray = rays[i];
      expected[i] = reference.cast({ray.origin[0], ray.origin[1], ray.origin[2]},
                                   glm::normalize(glm::dvec3(ray.direction[0], ray.direction[1], ray.direction[2])),
                                   ray.tMax == 0 ? kInfinity : ray.tMax, 0.5, 0);
    }
  };
  std::thread other(castPart, rays.size() / 2, rays.size());
  castPart(0, rays.size() / 2);
  other.join();
  Agreement result;
  for (size_t i = 0; i < rays.size(); ++i) {
    const double difference = std::abs(hits[i].transmittance - expected[i].transmittance);
    result.meanTransmittance += difference / static_cast<double>(rays.size());
    result.maxTransmittance = std::max(result.maxTransmittance, difference);
    const bool isHit = std::isfinite(hits[i].distance), isExpected = expected[i].distance >= 0;
    double apart = isHit == isExpected ? 0 : kInfinity;
    if (isHit && isExpected) {
      apart = std::abs(hits[i].distance - expected[i].distance);
      result.meanDistance += apart;
      result.maxDistance = std::max(result.maxDistance, apart);
      ++result.hits;
    }
    if (std::max(difference, apart) <= Agreement::kTolerance) continue;
    ++result.disagreeing;
    if (result.disagreeing > 5) continue;
    std::printf("ray %zu: transmittance %.9g, reference %.9g; distance %.9g, reference %.9g\n", i,
                double{hits[i].transmittance}, expected[i].transmittance, hits[i].distance, expected[i].distance);
  }
  if (result.hits > 0) result.meanDistance /= static_cast<double>(result.hits);
  std::printf("%zu rays, %zu hits: transmittance mean %.3g max %.3g; distance mean %.3g max %.3g; %zu disagree\n",
              rays.size(), result.hits, result.meanTransmittance, result.maxTransmittance, result.meanDistance,
              result.maxDistance, result.disagreeing);
  return result;
}

// FROTH_QUERY_RAYS sets how many rays the random tests cast.
size_t rayCount(size_t standard) {
  const char* count = std::getenv("FROTH_QUERY_RAYS");
  return count ? std::strtoull(count, nullptr, 10) : standard;
}

TEST_F(Cast, OfRandomRaysAgreesWithTheReferenceInDouble) {
  const AssetContents contents = bakeScene(synthesize("gallery", 20000), "default", 2000);
  ASSERT_GT(contents.chunks.size(), 4u);
  const FrothAsset asset = openReady(contents);
  createInstance(asset);
  const Result<Foam> foam = foamFromAsset(contents);
  ASSERT_TRUE(foam) << foam.error().message;
  auto info = makeStruct<FrothCastInfo>();
  info.cutoff = -1;
  const std::vector<FrothRay> rays = randomRays(extentOf(statusOf(asset)), rayCount(20000), 1);
  const Agreement agreement = compare(rays, cast(rays, info), ReferenceRays(*foam));
  EXPECT_GT(agreement.hits, rays.size() / 4);
  EXPECT_LE(agreement.meanTransmittance, 1e-7);
  EXPECT_LE(agreement.disagreeing, rays.size() / 10000);
}

}  // namespace
}  // namespace froth::test
