// What the tests of queries share: assets on a null context, random rays.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/glm.hpp>

#include "baker/bake/bake.h"
#include "baker/synth/synth.h"
#include "foam/foam.h"
#include "format/write/asset_writer.h"
#include "tests/runtime/runtime_fixture.h"

namespace froth::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  glm::dvec3 inBox(const glm::dvec3& low, const glm::dvec3& high) {
    const double x = uniform(low.x, high.x), y = uniform(low.y, high.y), z = uniform(low.z, high.z);
    return {x, y, z};
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 p = inBox(glm::dvec3(-1), glm::dvec3(1));
      if (glm::dot(p, p) < 1 && glm::dot(p, p) > 0.01) return glm::normalize(p);
    }
  }

 private:
  std::mt19937_64 engine_;
};

inline FrothRay makeRay(const glm::dvec3& origin, const glm::dvec3& direction, double tMin = 0, double tMax = 0) {
  return {{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, tMin, tMax};
}

inline AssetContents bakeScene(const Foam& foam, const std::string& preset, uint32_t chunkCells, bool walkGraph = true,
                               bool steiner = true) {
  BakeOptions options;
  options.knobs = *presetKnobs(preset);
  options.knobs.compressColours = false;  // queries see none
  options.preset = preset;
  options.chunkCells = chunkCells;
  options.walkGraph = walkGraph;
  options.steiner = steiner;
  options.measure = false;
  Result<BakeResult> baked = bakeFoam(foam, options);
  EXPECT_TRUE(baked) << baked.error().message;
  return std::move(baked->contents);
}

inline Foam synthesize(const std::string& name, uint32_t cells) {
  Result<Foam> foam = synthesizeFoam({.name = name, .cellCount = cells});
  EXPECT_TRUE(foam) << foam.error().message;
  return *foam;
}

// By brute force over all cells of a foam.
inline double powerOfCell(const Foam& foam, size_t cell, const glm::dvec3& point) {
  const glm::dvec3 difference = point - glm::dvec3(foam.sites[cell]);
  return glm::dot(difference, difference) - double{foam.radii[cell]} * double{foam.radii[cell]};
}

inline double leastPower(const Foam& foam, const glm::dvec3& point) {
  double least = kInfinity;
  for (size_t cell = 0; cell < foam.cellCount; ++cell) least = std::min(least, powerOfCell(foam, cell, point));
  return least;
}

class QueryTest : public RuntimeTest {
 protected:
  // Without a context yet: makes a null one.
  FrothAsset openForQueries(const AssetContents& contents, uint32_t keep = 1) {
    if (!context_) createContext();
    Result<std::vector<uint8_t>> bytes = encodeAsset(contents);
    EXPECT_TRUE(bytes) << bytes.error().message;
    const std::vector<uint8_t>& kept = bytes_.emplace_back(std::move(*bytes));
    auto info = makeStruct<FrothAssetInfo>();
    info.data = kept.data();
    info.dataSize = kept.size();
    info.keepForQueries = keep;
    FrothAsset asset{};
    EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK) << lastText();
    return asset;
  }

  FrothAsset openReady(const AssetContents& contents) {
    const FrothAsset asset = openForQueries(contents);
    while (statusOf(asset).state == FROTH_ASSET_OPENING && !HasFailure()) {
      EXPECT_EQ(update(++serial_), FROTH_OK) << lastText();
    }
    EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY) << lastText();
    return asset;
  }

  FrothInstance placeAt(FrothAsset asset, const glm::dvec3& position, const glm::vec4& rotation = {0, 0, 0, 1},
                        float scale = 1) {
    auto info = makeStruct<FrothInstanceInfo>();
    info.asset = asset;
    info.scale = scale;
    for (int axis = 0; axis < 3; ++axis) info.position[axis] = position[axis];
    for (int part = 0; part < 4; ++part) info.rotation[part] = rotation[part];
    FrothInstance instance{};
    EXPECT_EQ(frothCreateInstance(context_, &info, &instance), FROTH_OK) << lastText();
    return instance;
  }

  std::vector<FrothRayHit> cast(const std::vector<FrothRay>& rays, FrothCastInfo info = makeStruct<FrothCastInfo>(),
                                FrothResult expected = FROTH_OK) {
    std::vector<FrothRayHit> hits(rays.size());
    EXPECT_EQ(frothCastRays(context_, &info, rays.data(), hits.data(), static_cast<uint32_t>(rays.size())), expected)
        << lastText();
    return hits;
  }

  FrothLocation locate(FrothInstance instance, const glm::dvec3& point) {
    auto location = makeStruct<FrothLocation>();
    EXPECT_EQ(frothLocate(context_, instance, &point.x, &location), FROTH_OK) << lastText();
    return location;
  }

  FrothContact overlap(const glm::dvec3& centre, double radius, float opacity = 0) {
    auto sphere = makeStruct<FrothSphere>();
    for (int axis = 0; axis < 3; ++axis) sphere.centre[axis] = centre[axis];
    sphere.radius = radius;
    sphere.opacity = opacity;
    auto contact = makeStruct<FrothContact>();
    EXPECT_EQ(frothOverlapSphere(context_, &sphere, &contact), FROTH_OK) << lastText();
    return contact;
  }

  uint64_t serial_ = 0;

 private:
  std::list<std::vector<uint8_t>> bytes_;
};

}  // namespace froth::test
