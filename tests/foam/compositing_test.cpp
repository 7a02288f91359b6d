#include "shaders/foam/compositing.h"

#include <cmath>

#include "tests/foam/precision.h"

namespace froth {
namespace {

template <class Real>
class CompositingMathematics : public InBothPrecisions<Real> {};
TYPED_TEST_SUITE(CompositingMathematics, Precisions);

TYPED_TEST(CompositingMathematics, ARayThatMetNothingCoversZeroAndNotMinusZero) {
  const TypeParam coverage = foam::coverageOf(TypeParam(0));
  EXPECT_EQ(coverage, 0);
  EXPECT_FALSE(std::signbit(coverage));
  EXPECT_NEAR(foam::coverageOf(TypeParam(-1)), 1 - std::exp(-1.0), 1e-6);
}

TYPED_TEST(CompositingMathematics, OpacityKeepsItsDigitsInThinCells) {
  for (double depth = 1e-30; depth < 50; depth *= 1.7) {
    const TypeParam rounded = TypeParam(depth);
    const double exact = -std::expm1(-double(rounded));
    EXPECT_NEAR(foam::opacity(rounded) / exact, 1, 2 * this->kEpsilon) << depth;
  }
  EXPECT_EQ(foam::opacity(TypeParam(0)), TypeParam(0));
  EXPECT_EQ(foam::opacity(TypeParam(1e4)), TypeParam(1));
}

// The shaders take the series below 1/16 and 1 - exp above; both sides of the seam must hold in float.
TYPED_TEST(CompositingMathematics, TheSeriesOfTheShadersIsAsGoodAsFloatBelowOneSixteenth) {
  constexpr double kFloatEpsilon = 1.0 / (1 << 23);
  for (double depth = 1e-30; depth < 0.0625; depth *= 1.1) {
    const TypeParam rounded = TypeParam(depth);
    EXPECT_NEAR(foam::seriesOpacity(rounded) / -std::expm1(-double(rounded)), 1, 2 * kFloatEpsilon) << depth;
  }
  const float seam = 0.0625f;
  EXPECT_NEAR((1.0f - std::exp(-seam)) / -std::expm1(-double(seam)), 1, 16 * kFloatEpsilon);
}

TYPED_TEST(CompositingMathematics, AtTheQuantileDistanceTransmittanceIsTheQuantile) {
  for (int i = 0; i < 100; ++i) {
    const double before = this->uniform(0.5, 1), density = this->uniform(0.01, 100), tNear = this->uniform(0, 10);
    const TypeParam t = foam::quantileDistance(TypeParam(tNear), TypeParam(std::log(before)), TypeParam(std::log(0.5)),
                                               TypeParam(density));
    EXPECT_GE(t, TypeParam(tNear));
    const double slack = 20 * this->kEpsilon * (1 + density * (tNear + 1));
    EXPECT_NEAR(before * std::exp(-density * (double(t) - tNear)), 0.5, slack);
  }
}

}  // namespace
}  // namespace froth
