// Rays of the runtime's queries against the reference in double.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "foam/checkpoint/checkpoint.h"
#include "measure/stability/cases/case_parts.h"
#include "tests/query/query_fixture.h"
#include "tests/query/reference_rays.h"
#include "tests/surroundings.h"

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
    const glm::dvec3 direction = glm::normalize(target - origin);
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

// Of the grid's four columns that meet in the ray, or the two, it shows one: that of smallest x, then y.
TEST_F(Cast, ARayInAPlaneGoesThroughTheCellsOfTheFirstSites) {
  std::vector<CaseCell> cells;
  for (int z = 0; z < 4; ++z) {
    for (const float x : {0.25f, -0.25f}) {
      for (const float y : {0.25f, -0.25f}) {
        cells.push_back({{x, y, 0.5f * static_cast<float>(z)}, 0.375f, x + 2 * y + 1, kFaceToViewer, 5, 0});
      }
    }
  }
  const Foam foam = foamOfCells(cells);
  const AssetContents contents = bakeScene(foam, "exact", 1000);
  createInstance(openReady(contents));
  auto info = makeStruct<FrothCastInfo>();
  info.cutoff = -1;
  const ReferenceRays reference(foam);
  for (const double y : {0.0, 0.125}) {
    const double tEnd = 10;
    const ReferenceHit expected = reference.cast({0, y, -2}, {0, 0, 1}, tEnd, 0.5, 0);
    const FrothRayHit hit = cast({makeRay({0, y, -2}, {0, 0, 1}, 0, tEnd)}, info).front();
    EXPECT_NEAR(hit.transmittance, expected.transmittance, 1e-6) << y;
    // (-0.25, -0.25) has the density 0.25, (-0.25, 0.25) 1.25. Each layer shows the plane z's chord of one ball.
    const double aside = 0.0625 + (y == 0 ? 0.0625 : 0.015625), half = std::min(std::sqrt(0.140625 - aside), 0.25);
    const double length = 6 * half + 2 * std::sqrt(0.140625 - aside);
    EXPECT_NEAR(hit.transmittance, std::exp(-(y == 0 ? 0.25 : 1.25) * length), 1e-6) << y;
  }
}

class CastManyRays : public Cast {
 protected:
  void expectAgreement(const AssetContents& contents, size_t count) {
    ASSERT_GT(contents.chunks.size(), 2u);
    const FrothAsset asset = openReady(contents);
    createInstance(asset);
    const Result<Foam> foam = foamFromAsset(contents);
    ASSERT_TRUE(foam) << foam.error().message;
    auto info = makeStruct<FrothCastInfo>();
    info.cutoff = -1;
    const std::vector<FrothRay> rays = randomRays(extentOf(statusOf(asset)), rayCount(count), 1);
    const Agreement agreement = compare(rays, cast(rays, info), ReferenceRays(*foam));
    EXPECT_GT(agreement.hits, rays.size() / 4);
    EXPECT_LE(agreement.meanTransmittance, 1e-7);
    EXPECT_LE(agreement.disagreeing, rays.size() / 100000);
  }
};

TEST_F(CastManyRays, ThroughASyntheticFoamAgreeWithTheReferenceInDouble) {
  expectAgreement(bakeScene(synthesize("gallery", 5000), "default", 500), 20000);
}

TEST_F(CastManyRays, ThroughATrainedFoamAgreeWithTheReferenceInDouble) {
  const std::filesystem::path path = dataFolder() / "foams/miku_plush/model.pt";
  if (!std::filesystem::exists(path)) FROTH_SKIP() << "no foams/miku_plush; set FROTH_DATA";
  const Result<Foam> foam = importCheckpoint(path);
  ASSERT_TRUE(foam) << foam.error().message;
  expectAgreement(bakeScene(*foam, "exact", 8192), 5000);
}

class CastRandom : public Cast {
 protected:
  void SetUp() override {
    contents_ = bakeScene(synthesize("random", 0), "exact", 64);
    asset_ = openReady(contents_);
    foam_ = *foamFromAsset(contents_);
    extent_ = extentOf(statusOf(asset_));
  }

  FrothCastInfo withoutCutoff() const {
    auto info = makeStruct<FrothCastInfo>();
    info.cutoff = -1;
    return info;
  }

  void expectAgreement(const std::vector<FrothRay>& rays) {
    const Agreement agreement = compare(rays, cast(rays, withoutCutoff()), ReferenceRays(foam_));
    EXPECT_EQ(agreement.disagreeing, 0u);
  }

  AssetContents contents_;
  FrothAsset asset_{};
  Foam foam_;
  Extent extent_;
};

// Lattice directions too: their rays run along radical planes of nothing, but their components are zero.
TEST_F(CastRandom, FromSitesAgreesWithTheReference) {
  createInstance(asset_);
  Random random(2);
  std::vector<FrothRay> rays;
  for (size_t cell = 0; cell < foam_.cellCount; ++cell) {
    const glm::dvec3 axes[] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, random.direction()};
    for (const glm::dvec3& direction : axes) rays.push_back(makeRay(glm::dvec3(foam_.sites[cell]), direction));
  }
  expectAgreement(rays);
}

// The reference's numbers are relative to the origin, so far away it loses what a walk, which begins at the foam,
// keeps.
TEST_F(CastRandom, FromFarAwayEqualsTheRayFromNearby) {
  createInstance(asset_);
  Random random(3);
  std::vector<FrothRay> near, far;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 target = random.inBox(extent_.low, extent_.high);
    const glm::dvec3 direction = random.direction();
    near.push_back(makeRay(target - 20.0 * direction, direction));
    far.push_back(makeRay(target - 1e6 * direction, direction));
  }
  const std::vector<FrothRayHit> nearHits = cast(near, withoutCutoff()), farHits = cast(far, withoutCutoff());
  for (size_t i = 0; i < near.size(); ++i) {
    EXPECT_NEAR(nearHits[i].transmittance, farHits[i].transmittance, 1e-6);
    if (!std::isfinite(nearHits[i].distance)) continue;
    EXPECT_NEAR(nearHits[i].distance + 1e6 - 20, farHits[i].distance, 1e-6);
  }
}

TEST_F(CastRandom, StopsAtTheCellThatItNames) {
  const FrothInstance instance = createInstance(asset_);
  const std::vector<FrothRay> rays = randomRays(extent_, 1000, 4);
  for (const FrothRayHit& hit : cast(rays)) {
    if (!std::isfinite(hit.distance)) continue;
    const FrothLocation location = locate(instance, {hit.position[0], hit.position[1], hit.position[2]});
    EXPECT_EQ(location.cell, hit.cell);
    EXPECT_EQ(location.chunk, hit.chunk);
    EXPECT_EQ(hit.instance.generation, instance.generation);
    const glm::dvec3 normal = faceFrame<double>(contents_.chunks[hit.chunk].orientations[hit.cell]).normal;
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(double{hit.normal[axis]}, normal[axis], 1e-6);
  }
}

// A ray cut in two: the second part starts at tMin. Where a cut lies in a cell with a displaced face, both parts may
// see another height than the whole does; so the foam has none.
TEST_F(CastRandom, InTwoPartsMultipliesToTheWhole) {
  for (ChunkContents& chunk : contents_.chunks) chunk.detailHeights.clear();
  createInstance(openReady(contents_));
  const std::vector<FrothRay> whole = randomRays(extent_, 1000, 5);
  std::vector<FrothRay> first = whole, second = whole;
  for (size_t i = 0; i < whole.size(); ++i) {
    first[i].tMax = second[i].tMin = 1;
    if (whole[i].tMax > 0 && whole[i].tMax < 1) first[i].tMax = whole[i].tMax;
  }
  const auto a = cast(first, withoutCutoff()), b = cast(second, withoutCutoff()), all = cast(whole, withoutCutoff());
  for (size_t i = 0; i < whole.size(); ++i) {
    EXPECT_NEAR(a[i].transmittance * b[i].transmittance, all[i].transmittance, 1e-6);
  }
}

TEST_F(CastRandom, WithAnIntervalThatIsEmptyMeetsNothing) {
  createInstance(asset_);
  FrothRay ray = makeRay(0.5 * (extent_.low + extent_.high), {1, 0, 0}, 2, 1);
  EXPECT_EQ(cast({ray})[0].transmittance, 1.0f);
  EXPECT_EQ(cast({ray})[0].distance, kInfinity);
}

// Two foams that cross: densities add, so transmittances multiply, and the quantile falls where the product does.
TEST_F(CastRandom, ThroughTwoFoamsAddsTheirDensities) {
  const glm::dvec3 offset(0.35, -0.2, 0.15);
  const float scale = 0.75f;
  createInstance(asset_);
  placeAt(asset_, offset, {0, 0, 0, 1}, scale);
  const ReferenceRays reference(foam_);
  const auto both = [&](const glm::dvec3& origin, const glm::dvec3& direction, double tEnd) {
    return reference.cast(origin, direction, tEnd, 0.5, 0).transmittance *
           reference.cast((origin - offset) / double{scale}, direction, tEnd / double{scale}, 0.5, 0).transmittance;
  };
  std::vector<FrothRay> rays = randomRays(extent_, 300, 6);
  for (FrothRay& ray : rays) ray.tMax = 0;
  const std::vector<FrothRayHit> hits = cast(rays, withoutCutoff());
  int found = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 origin(rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]);
    const glm::dvec3 direction(rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]);
    EXPECT_NEAR(hits[i].transmittance, both(origin, direction, kInfinity), 1e-6);
    if (!std::isfinite(hits[i].distance)) continue;
    ++found;
    EXPECT_NEAR(both(origin, direction, hits[i].distance), 0.5, 1e-6);
  }
  EXPECT_GT(found, 50);
}

// The walk ends behind the cell in which T falls below the cut-off: not before, not a cell later.
TEST_F(CastRandom, WithACutoffEndBehindTheCellThatFallsBelowIt) {
  createInstance(asset_);
  std::vector<FrothRay> rays = randomRays(extent_, 1000, 8);
  for (FrothRay& ray : rays) ray.tMax = 0;
  auto info = makeStruct<FrothCastInfo>();
  info.cutoff = 0.3f;
  const std::vector<FrothRayHit> cut = cast(rays, info), whole = cast(rays, withoutCutoff());
  const ReferenceRays reference(foam_);
  size_t ended = 0, shorter = 0, apart = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 origin(rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]);
    const glm::dvec3 direction(rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]);
    const double expected = reference.cast(origin, direction, kInfinity, 0.5, 0.3).transmittance;
    apart += std::abs(cut[i].transmittance - expected) > 1e-6;
    EXPECT_LE(cut[i].steps, whole[i].steps);
    if (whole[i].transmittance >= info.cutoff) {
      EXPECT_EQ(cut[i].transmittance, whole[i].transmittance);
      EXPECT_EQ(cut[i].steps, whole[i].steps);
      continue;
    }
    EXPECT_LT(cut[i].transmittance, info.cutoff);
    ended += cut[i].transmittance > whole[i].transmittance;
    shorter += cut[i].steps < whole[i].steps;
  }
  EXPECT_LE(apart, 2u) << "but where T is the cut-off to the last digit";
  EXPECT_GT(ended, 100u);
  EXPECT_GE(shorter, ended);
}

TEST_F(CastRandom, WithClosestOnlyFindsTheSameDistance) {
  createInstance(asset_);
  const std::vector<FrothRay> rays = randomRays(extent_, 1000, 7);
  auto info = makeStruct<FrothCastInfo>();
  info.closestOnly = 1;
  const std::vector<FrothRayHit> closest = cast(rays, info), all = cast(rays);
  uint64_t closestSteps = 0, allSteps = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(closest[i].distance, all[i].distance);
    EXPECT_EQ(closest[i].cell, all[i].cell);
    closestSteps += closest[i].steps;
    allSteps += all[i].steps;
  }
  EXPECT_LT(closestSteps, allSteps);
}

TEST_F(CastRandom, OnTwoThreadsGivesTheBitsOfOne) {
  createInstance(asset_);
  placeAt(asset_, {0.3, 0, 0});
  const std::vector<FrothRay> rays = randomRays(extent_, 4000, 8);
  const std::vector<FrothRayHit> expected = cast(rays);
  std::vector<FrothRayHit> found[2];
  const auto work = [&](std::vector<FrothRayHit>& hits) {
    hits.resize(rays.size());
    for (size_t i = 0; i < rays.size(); i += 100) frothCastRays(context_, nullptr, &rays[i], &hits[i], 100);
    auto contact = makeStruct<FrothContact>();
    auto sphere = makeStruct<FrothSphere>();
    sphere.radius = 0.5;
    for (int i = 0; i < 100; ++i) frothOverlapSphere(context_, &sphere, &contact);
  };
  std::thread other(work, std::ref(found[1]));
  work(found[0]);
  other.join();
  for (const std::vector<FrothRayHit>& hits : found) {
    EXPECT_EQ(std::memcmp(hits.data(), expected.data(), expected.size() * sizeof(FrothRayHit)), 0);
  }
}

}  // namespace
}  // namespace froth::test
