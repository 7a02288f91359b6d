#include "shaders/foam/appearance.h"

#include <algorithm>
#include <cmath>

#include "tests/foam/precision.h"

namespace froth {
namespace {

template <class Real>
class AppearanceMathematics : public InBothPrecisions<Real> {};
TYPED_TEST_SUITE(AppearanceMathematics, Precisions);

template <class Real>
struct Lobe {
  Real exponent;
  glm::vec<3, Real> colour;
};

template <class Real>
glm::vec<3, Real> blend(const std::vector<Lobe<Real>>& lobes) {
  Real largest = lobes[0].exponent, weightSum = 0;
  glm::vec<3, Real> colourSum(0);
  for (const Lobe<Real>& lobe : lobes) foam::addLobe(lobe.exponent, lobe.colour, largest, weightSum, colourSum);
  return foam::lobeColour(glm::vec<3, Real>(0), weightSum, colourSum);
}

TYPED_TEST(AppearanceMathematics, ADetailSiteUnderTheEyeIsSeenFromBeforeItsFace) {
  using Vec3 = glm::vec<3, TypeParam>;
  const Vec3 normal(0, 0.6, -0.8);
  EXPECT_EQ(foam::directionToDetail(Vec3(0), normal), -normal);
  const Vec3 seen = foam::directionToDetail(Vec3(0, 3, -4), normal);
  EXPECT_NEAR(glm::length(seen - Vec3(0, 0.6, -0.8)), 0, 1e-6);
}

TYPED_TEST(AppearanceMathematics, DetailWeightIsTheGaussianOfTheDistanceInRadii) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 t = this->direction(), b = glm::normalize(glm::cross(t, this->direction()));
    const double radius = this->uniform(0.1, 3), u = this->uniform(-1, 1), v = this->uniform(-1, 1);
    const glm::dvec3 local = radius * this->point(1);
    const Vec3 query = foam::faceQuery(
        foam::inFaceFrame(Vec3(local), Vec3(t), Vec3(b), Vec3(glm::cross(t, b)), TypeParam(1 / radius)));
    const TypeParam weight = foam::detailWeight(query, glm::vec<2, TypeParam>(u, v), TypeParam(10));
    const glm::dvec3 apart = (local - radius * (u * t + v * b)) / radius;
    // The exponent is off by a few epsilon of 10 times squares below 12.
    EXPECT_NEAR(weight, std::exp(-10 * glm::dot(apart, apart)), 300 * this->kEpsilon);
  }
}

TYPED_TEST(AppearanceMathematics, RoundingNeverLiftsAWeightAboveOne) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (int i = 0; i < 1000; ++i) {
    const TypeParam u = TypeParam(this->uniform(-1, 1)), v = TypeParam(this->uniform(-1, 1));
    const Vec3 query = foam::faceQuery(Vec3(u, v, 0));
    EXPECT_LE(foam::detailWeight(query, glm::vec<2, TypeParam>(u, v), TypeParam(10)), TypeParam(1));
  }
}

TYPED_TEST(AppearanceMathematics, FarFromAllDetailSitesValuesFadeInsteadOfDividingByZero) {
  EXPECT_EQ(foam::flooredWeightSum(TypeParam(0)), TypeParam(1e-20));
  EXPECT_EQ(foam::flooredWeightSum(TypeParam(0.3)), TypeParam(0.3));
  const glm::vec<3, TypeParam> query(9, 0, 81);
  const TypeParam weight = foam::detailWeight(query, glm::vec<2, TypeParam>(0, 0), TypeParam(10));
  EXPECT_LT(weight / foam::flooredWeightSum(weight), TypeParam(1e-10));
}

TYPED_TEST(AppearanceMathematics, ALobeIsStrongestAlongItsAxisAndSharperWhenHot) {
  using Vec3 = glm::vec<3, TypeParam>;
  EXPECT_EQ(foam::lobeExponent(Vec3(0, 0, 3), Vec3(0, 0, 1)), TypeParam(0));
  EXPECT_NEAR(foam::lobeExponent(Vec3(0, 0, 3), Vec3(0, 0, -1)), -6, 10 * this->kEpsilon);
  EXPECT_NEAR(foam::lobeExponent(Vec3(500, 0, 0), Vec3(0, 1, 0)), -500 * std::sqrt(2.0), 2000 * this->kEpsilon);
  EXPECT_EQ(foam::lobeExponent(Vec3(0, 0, 0), Vec3(0, 1, 0)),
            TypeParam(0));  // no axis: the same from everywhere
}

TYPED_TEST(AppearanceMathematics, BlendedLobesAreTheirWeightedMeanAboutOneHalf) {
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 direction = this->direction();
    std::vector<Lobe<TypeParam>> lobes;
    glm::dvec3 sum(0);
    double weightSum = 0;
    for (int m = 0; m < 8; ++m) {
      const glm::dvec3 axis = this->uniform(0.1, 20) * this->direction(), colour = this->point(0.5);
      const double weight = std::exp(-glm::length(axis) * glm::length(direction - glm::normalize(axis)));
      sum += weight * colour;
      weightSum += weight;
      lobes.push_back({foam::lobeExponent(glm::vec<3, TypeParam>(axis), glm::vec<3, TypeParam>(direction)), colour});
    }
    const glm::dvec3 expected = 0.5 + sum / weightSum;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(blend(lobes)[c], expected[c], 200 * this->kEpsilon);
  }
}

TYPED_TEST(AppearanceMathematics, HotLobesThatAllPointAwayStillGiveTheirNearestColour) {
  using Vec3 = glm::vec<3, TypeParam>;
  const Vec3 seen(0, 0, 1);
  // exp(-1000) is zero in either precision; only differences of exponents may count.
  std::vector<Lobe<TypeParam>> lobes = {{foam::lobeExponent(Vec3(0, 0, -500), seen), Vec3(0.1)},
                                        {foam::lobeExponent(Vec3(0, 500, 0), seen), Vec3(0.2)},
                                        {foam::lobeExponent(Vec3(-500, 0, 0), seen), Vec3(0.4)}};
  for (int order = 0; order < 6; ++order) {
    const Vec3 colour = blend(lobes);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], 0.8, 1e-3) << order;  // the two at a right angle share
    std::next_permutation(lobes.begin(), lobes.end(),
                          [](const auto& a, const auto& b) { return a.colour.x < b.colour.x; });
  }
}

TYPED_TEST(AppearanceMathematics, ColoursAreHeldAboveBlackAndNotBelowWhite) {
  using Vec3 = glm::vec<3, TypeParam>;
  const Vec3 colour = blend(std::vector<Lobe<TypeParam>>{{0, Vec3(-2, 0, 2)}});
  EXPECT_EQ(colour, Vec3(0, 0.5, 2.5));
}

}  // namespace
}  // namespace froth
