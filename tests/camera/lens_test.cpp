// shaders/foam/lens.h against the models as they were published: those give the image of a direction, so a direction
// that is drawn and looked up again must come back.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shaders/foam/lens.h"

namespace froth {
namespace {

using glm::dvec2, glm::dvec3, glm::dvec4;

constexpr double kPi = 3.14159265358979323846;

// cv::fisheye::projectPoints, without the camera matrix.
dvec2 drawKannalaBrandt(const dvec3& direction, const dvec4& k) {
  const double r = std::hypot(direction.x, direction.y), theta = std::atan2(r, direction.z);
  const double drawn = theta + k[0] * std::pow(theta, 3) + k[1] * std::pow(theta, 5) + k[2] * std::pow(theta, 7) +
                       k[3] * std::pow(theta, 9);
  return r > 0 ? dvec2(direction.x, direction.y) * (drawn / r) : dvec2(0);
}

// cv::projectPoints, without the camera matrix; coefficients in OpenCV's order.
dvec2 drawRadialTangential(const dvec3& direction, const dvec4& first, const dvec4& second) {
  const double k1 = first[0], k2 = first[1], p1 = first[2], p2 = first[3];
  const double k3 = second[0], k4 = second[1], k5 = second[2], k6 = second[3];
  const double x = direction.x / direction.z, y = direction.y / direction.z, r2 = x * x + y * y;
  const double radial =
      (1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2) / (1 + k4 * r2 + k5 * r2 * r2 + k6 * r2 * r2 * r2);
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

// At an angle from the axis, towards `turn` on the image.
dvec3 directionAt(double theta, double turn) {
  return {std::sin(theta) * std::cos(turn), std::sin(theta) * std::sin(turn), std::cos(theta)};
}

template <class Real>
bool lookUp(int kind, const dvec2& point, const dvec4& first, const dvec4& second, dvec3& direction) {
  using Vec4 = glm::vec<4, Real>;
  const Real range = foam::lensRange(kind, Vec4(first), Vec4(second));
  glm::vec<3, Real> found;
  const bool isSeen = foam::lensRay(kind, glm::vec<2, Real>(point), Vec4(first), Vec4(second), range, found);
  direction = glm::normalize(dvec3(found));
  return isSeen;
}

template <class Real>
bool draw(int kind, const dvec3& direction, const dvec4& first, const dvec4& second, dvec2& point) {
  using Vec4 = glm::vec<4, Real>;
  const Real range = foam::lensRange(kind, Vec4(first), Vec4(second));
  glm::vec<2, Real> found;
  const bool isSeen = foam::lensPoint(kind, glm::vec<3, Real>(direction), Vec4(first), Vec4(second), range, found);
  point = dvec2(found);
  return isSeen;
}

void expectFound(int kind, const dvec3& direction, const dvec2& point, const dvec4& first, const dvec4& second) {
  dvec3 found;
  ASSERT_TRUE(lookUp<double>(kind, point, first, second, found)) << point.x << ", " << point.y;
  EXPECT_LT(glm::length(found - direction), 1e-9) << point.x << ", " << point.y;
  ASSERT_TRUE(lookUp<float>(kind, point, first, second, found)) << point.x << ", " << point.y;
  EXPECT_LT(glm::length(found - direction), 5e-6) << point.x << ", " << point.y;
  dvec2 drawn;
  ASSERT_TRUE(draw<double>(kind, 3.0 * direction, first, second, drawn)) << point.x << ", " << point.y;
  ASSERT_TRUE(lookUp<double>(kind, drawn, first, second, found))
      << "not seen where it is drawn: " << drawn.x << ", " << drawn.y;
  EXPECT_LT(glm::length(found - direction), 1e-9) << drawn.x << ", " << drawn.y;
  dvec2 drawnAsFloat;
  ASSERT_TRUE(draw<float>(kind, direction, first, second, drawnAsFloat)) << point.x << ", " << point.y;
  EXPECT_LT(glm::length(drawnAsFloat - drawn), 1e-5 * (1 + glm::length(point))) << point.x << ", " << point.y;
}

constexpr dvec4 kNone(0);

TEST(Lens, ADirectionThatAKannalaBrandtLensDrawsIsFoundAgain) {
  // A GoPro, a 190 degree lens, one without distortion.
  for (const dvec4& k : {dvec4(0.0342, 0.0096, -0.0077, 0.0012), dvec4(-0.021, 0.0088, -0.0056, 0.0008), kNone}) {
    const double range = foam::lensRange(foam::kLensKannalaBrandt, k, kNone);
    EXPECT_GT(range, 1.66);
    for (double theta = 0; theta < 0.97 * range; theta += 0.031) {
      const dvec3 direction = directionAt(theta, 7 * theta);
      expectFound(foam::kLensKannalaBrandt, direction, drawKannalaBrandt(direction, k), k, kNone);
    }
  }
}

TEST(Lens, ADirectionThatARadialTangentialLensDrawsIsFoundAgain) {
  const std::pair<dvec4, dvec4> lenses[] = {
      {dvec4(-0.28, 0.07, 0.0009, -0.0006), dvec4(0)},                    // a wide lens, k1 k2 p1 p2
      {dvec4(-0.33, 0.14, -0.0011, 0.0023), dvec4(-0.031, 0, 0, 0)},      // with k3
      {dvec4(0.9, -0.4, 0.0005, 0.0004), dvec4(0.02, 1.3, -0.1, -0.08)},  // rational
      {dvec4(0.12, 0.03, 0, 0), dvec4(0)},                                // pincushion
      {kNone, kNone},
  };
  for (const auto& [first, second] : lenses) {
    for (double angle = 0; angle < 0.65; angle += 0.023) {
      const dvec3 direction = directionAt(angle, 9 * angle);
      expectFound(foam::kLensRadialTangential, direction, drawRadialTangential(direction, first, second), first,
                  second);
    }
  }
}

TEST(Lens, AnglesOfAFisheyeAreDistancesOnTheImage) {
  for (double theta = 0; theta < 3.14; theta += 0.05) {
    const dvec3 direction = directionAt(theta, 5 * theta);
    const dvec2 point = theta * dvec2(std::cos(5 * theta), std::sin(5 * theta));
    expectFound(foam::kLensFisheye, direction, point, kNone, kNone);
  }
  dvec3 direction;
  EXPECT_FALSE(lookUp<double>(foam::kLensFisheye, {2.5, 2.5}, kNone, kNone, direction));
}

TEST(Lens, AnEquirectangularImageHoldsLongitudesAndLatitudes) {
  const std::pair<dvec2, dvec3> places[] = {
      {{0, 0}, {0, 0, 1}},          // ahead
      {{kPi / 2, 0}, {1, 0, 0}},    // to the right
      {{-kPi / 2, 0}, {-1, 0, 0}},  // to the left
      {{kPi, 0}, {0, 0, -1}},       // behind
      {{0.7, kPi / 2}, {0, 1, 0}},  // below
      {{0, -kPi / 2}, {0, -1, 0}},  // above
      {{kPi / 4, kPi / 6}, {std::sqrt(0.375), 0.5, std::sqrt(0.375)}},
  };
  for (const auto& [point, direction] : places) expectFound(foam::kLensEquirectangular, direction, point, kNone, kNone);
  dvec3 direction;
  EXPECT_FALSE(lookUp<double>(foam::kLensEquirectangular, {3.15, 0}, kNone, kNone, direction));
  EXPECT_FALSE(lookUp<double>(foam::kLensEquirectangular, {0, -1.58}, kNone, kNone, direction));
}

// r (1 - 0.3 r^2) grows up to r = 1 / sqrt(0.9), where it is 0.7027: the image of a lens with that distortion ends
// there.
TEST(Lens, BeyondTheFoldOfALensNothingIsSeen) {
  const dvec4 barrel(-0.3, 0, 0, 0);
  const double end = 1 / std::sqrt(0.9), radius = end * (1 - 0.3 * end * end);
  EXPECT_NEAR(foam::lensRange(foam::kLensRadialTangential, barrel, kNone), end, 1e-3);
  EXPECT_NEAR(foam::lensRange(foam::kLensKannalaBrandt, barrel, kNone), end, 1e-3);
  dvec3 direction;
  for (const int kind : {foam::kLensRadialTangential, foam::kLensKannalaBrandt}) {
    for (double turn = 0; turn < 6; turn += 0.7) {
      const dvec2 towards(std::cos(turn), std::sin(turn));
      EXPECT_TRUE(lookUp<double>(kind, 0.99 * radius * towards, barrel, kNone, direction));
      EXPECT_FALSE(lookUp<double>(kind, 1.01 * radius * towards, barrel, kNone, direction));
      EXPECT_FALSE(lookUp<double>(kind, 50.0 * towards, barrel, kNone, direction));
    }
  }
}

TEST(Lens, WhateverTheCoefficientsARayThatIsGivenIsTheOneThatThePointShows) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  int seen = 0;
  for (int i = 0; i < 20000; ++i) {
    const double size = std::pow(10, 2 * unit(random) - 1);
    const dvec4 first = size * dvec4(unit(random), unit(random), unit(random), unit(random));
    const dvec4 second = size * dvec4(unit(random), unit(random), unit(random), unit(random));
    const dvec2 point = 2.0 * dvec2(unit(random), unit(random));
    dvec3 direction;
    if (lookUp<double>(foam::kLensKannalaBrandt, point, first, kNone, direction)) {
      ++seen;
      ASSERT_LT(glm::length(drawKannalaBrandt(direction, first) - point), 1e-6) << i;
    }
    if (lookUp<double>(foam::kLensRadialTangential, point, first, second, direction)) {
      ++seen;
      ASSERT_LT(glm::length(drawRadialTangential(direction, first, second) - point), 1e-3) << i;
    }
  }
  EXPECT_GT(seen, 5000);
  for (const double huge : {1e300, -1e300, HUGE_VAL}) {
    dvec3 direction;
    lookUp<double>(foam::kLensKannalaBrandt, {0.5, 0.5}, dvec4(huge), kNone, direction);
    lookUp<double>(foam::kLensRadialTangential, {0.5, 0.5}, dvec4(huge), dvec4(huge), direction);
    EXPECT_FALSE(lookUp<double>(foam::kLensKannalaBrandt, {huge, 0}, kNone, kNone, direction));
    EXPECT_FALSE(lookUp<double>(foam::kLensRadialTangential, {huge, 0}, kNone, kNone, direction));
  }
}

}  // namespace
}  // namespace froth
