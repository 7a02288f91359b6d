// No number that a file may hold makes a formula leave the floats: lengths of 1e-18 to 1e18, any other value at random
// over all exponents. What reaches a pixel is finite.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "shaders/foam/appearance.h"
#include "shaders/foam/cell.h"
#include "shaders/foam/clip_face.h"
#include "shaders/foam/compositing.h"

namespace froth {
namespace {

using glm::vec3;

class Extremes : public ::testing::Test {
 protected:
  // Log-uniform.
  float size(double least, double most) {
    return static_cast<float>(
        std::exp(std::uniform_real_distribution<double>(std::log(least), std::log(most))(random_)));
  }
  // Of either sign, or 0.
  float any(double most) {
    const int kind = std::uniform_int_distribution<int>(0, 9)(random_);
    return kind == 0 ? 0.0f : (kind % 2 == 0 ? 1.0f : -1.0f) * size(1e-36, most);
  }
  vec3 anyVector(double most) { return {any(most), any(most), any(most)}; }
  // One component in four is exactly 0.
  vec3 direction() {
    for (;;) {
      vec3 v(0);
      for (int axis = 0; axis < 3; ++axis) {
        if (std::uniform_int_distribution<int>(0, 3)(random_) > 0) {
          v[axis] = std::uniform_real_distribution<float>(-1, 1)(random_);
        }
      }
      if (glm::length(v) > 0.01f) return glm::normalize(v);
    }
  }
  std::mt19937_64 random_{3};
};

constexpr double kMost = 3.4e38;

TEST_F(Extremes, ADetailSitesColourLiesBetweenZeroAndTheLargestHalf) {
  for (int i = 0; i < 20000; ++i) {
    const vec3 base = anyVector(kMost), seen = foam::directionToDetail(anyVector(kMost), direction());
    float largest = -3.402823466e38f, weightSum = 0;
    vec3 colourSum(0);
    for (int lobe = 0; lobe < 4; ++lobe) {
      foam::addLobe(foam::lobeExponent(anyVector(kMost), seen), anyVector(kMost), largest, weightSum, colourSum);
    }
    const vec3 colour = foam::lobeColour(base, weightSum, colourSum);
    for (int c = 0; c < 3; ++c) ASSERT_TRUE(colour[c] >= 0 && colour[c] <= 65504) << i << ": " << colour[c];
  }
}

TEST_F(Extremes, ADetailSitesWeightLiesBetweenZeroAndOne) {
  for (int i = 0; i < 20000; ++i) {
    const float sharpness = i % 8 == 0 ? 0 : size(1e-36, kMost);
    const float weight = foam::detailWeight(foam::faceQuery(anyVector(kMost)), {any(1e9), any(1e9)}, sharpness);
    ASSERT_TRUE(weight >= 0 && weight <= 1) << i << ": " << weight;
  }
}

// As a cell is shaded: base face, query, height, displaced face, colour, opacity.
TEST_F(Extremes, WhatARayGainsInACellIsFinite) {
  int gained = 0;
  for (int i = 0; i < 20000; ++i) {
    const float radius = size(1e-18, 1e18), sharpness = i % 8 == 0 ? 0 : size(1e-9, kMost),
                density = size(1e-38, kMost);
    const vec3 ray = direction(), normal = direction(), tangent = direction(), bitangent = direction();
    const vec3 centre = radius * size(1e-6, 1e6) < 1e18f ? radius * size(1e-6, 1e2) * direction() : vec3(0);
    const float facing = glm::dot(normal, ray) / radius;
    float tNear = 0, tFar = 0;
    if (!foam::intersectBall(centre, radius, ray, tNear, tFar)) continue;
    const vec3 scaled = normal / radius;
    const auto queryAt = [&](float t) {
      return foam::faceQuery(foam::inFaceFrame(t * ray - centre, tangent, bitangent, normal, 1 / radius));
    };
    const auto blend = [&](const vec3& query, float value) {
      const float weight = foam::detailWeight(query, {any(1e9), any(1e9)}, sharpness) +
                           foam::detailWeight(query, {query.x, query.y}, sharpness);
      return weight * value / foam::flooredWeightSum(weight);
    };
    const float tBase = foam::intersectFace(centre, scaled, facing, 0.0f);
    const float height = blend(queryAt(facing >= 0 ? tNear : std::max(tNear, tBase)), any(1e30));
    ASSERT_TRUE(std::isfinite(height)) << i;
    const float tFace = foam::intersectFace(centre, scaled, facing, height);
    ASSERT_TRUE(std::isfinite(tFace)) << i;
    if (facing >= 0) {
      tFar = std::min(tFar, tFace);
    } else {
      tNear = std::max(tNear, tFace);
    }
    if (!(tFar > tNear)) continue;
    ++gained;
    const float opacity = foam::opacity(density * (tFar - tNear));
    ASSERT_TRUE(opacity >= 0 && opacity <= 1) << i;
    const float shown = opacity * blend(queryAt(tNear), 65504);
    ASSERT_TRUE(shown >= 0 && shown <= 65504 * 1.001f) << i << ": " << shown;
  }
  EXPECT_GT(gained, 5000);
}

}  // namespace
}  // namespace froth
