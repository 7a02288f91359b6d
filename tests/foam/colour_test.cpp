#include "shaders/foam/colour.h"

#include <cmath>

#include "tests/foam/precision.h"

namespace froth {
namespace {

template <class Real>
class ColourMathematics : public InBothPrecisions<Real> {};
TYPED_TEST_SUITE(ColourMathematics, Precisions);

TYPED_TEST(ColourMathematics, TheCurveIsThatOfSrgb) {
  EXPECT_EQ(foam::linearFromDisplay(TypeParam(0)), TypeParam(0));
  EXPECT_NEAR(foam::linearFromDisplay(TypeParam(0.5)), 0.21404114, 1e-7);
  EXPECT_NEAR(foam::linearFromDisplay(TypeParam(1)), 1, 4 * this->kEpsilon);
  EXPECT_NEAR(foam::displayFromLinear(TypeParam(0.5)), 0.73535698, 1e-6);
  // The two branches meet.
  EXPECT_NEAR(foam::linearFromDisplay(TypeParam(0.04045)), foam::linearFromDisplay(TypeParam(0.040451)), 1e-6);
  EXPECT_NEAR(foam::displayFromLinear(TypeParam(0.0031308)), foam::displayFromLinear(TypeParam(0.003131)), 1e-5);
}

TYPED_TEST(ColourMathematics, DecodingUndoesEncodingPastWhiteToo) {
  for (double value = 0; value < 4; value += 0.01) {
    const TypeParam there = foam::linearFromDisplay(TypeParam(value));
    // The standard's rounded constants leave a step of 1e-8 where the branches meet.
    EXPECT_NEAR(foam::displayFromLinear(there), value, 1e-7 + 20 * this->kEpsilon * (1 + value));
  }
}

TYPED_TEST(ColourMathematics, PremultipliedColoursAreDecodedAtFullCoverage) {
  using Vec3 = glm::vec<3, TypeParam>;
  const Vec3 linear = foam::linearPremultiplied(Vec3(0.25, 0.05, 0), TypeParam(0.5));
  EXPECT_NEAR(linear.x, 0.5 * 0.21404114, 1e-7);  // decode(0.5), not decode(0.25)
  EXPECT_NEAR(linear.y, 0.5 * foam::linearFromDisplay(0.1), 1e-7);
  EXPECT_EQ(linear.z, TypeParam(0));
  const Vec3 back = foam::displayPremultiplied(linear, TypeParam(0.5));
  EXPECT_NEAR(back.x, 0.25, 1e-6);
  EXPECT_NEAR(back.y, 0.05, 1e-6);
}

TYPED_TEST(ColourMathematics, NoCoverageIsBlack) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (double coverage : {0.0, -1e-9, double(NAN)}) {
    EXPECT_EQ(foam::linearPremultiplied(Vec3(1), TypeParam(coverage)), Vec3(0));
    EXPECT_EQ(foam::displayPremultiplied(Vec3(1), TypeParam(coverage)), Vec3(0));
  }
}

}  // namespace
}  // namespace froth
