#include "shaders/foam/tone.h"

#include <cmath>

#include "tests/foam/precision.h"
#include "tests/foam/tone_curves.h"

namespace froth {
namespace {

template <class Real>
class ToneMathematics : public InBothPrecisions<Real> {};
TYPED_TEST_SUITE(ToneMathematics, Precisions);

TYPED_TEST(ToneMathematics, EachCurveTurnsItsLightIntoTheColourOfTheDisplay) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (const int curve : {foam::kToneReinhard, foam::kToneAcesNarkowicz, foam::kToneKhronosNeutral}) {
    for (int i = 0; i < 5000; ++i) {
      glm::dvec3 display(this->uniform(0, 0.996), this->uniform(0, 0.996), this->uniform(0, 0.996));
      if (i % 3 == 0) display *= 0.05;                                                             // the dark
      if (curve == foam::kToneKhronosNeutral) display = khronosNeutral(12.0 * display * display);  // what it can reach
      const glm::dvec3 scene(foam::sceneFromDisplay(curve, Vec3(display)));
      const glm::dvec3 shown = applyToneCurve(curve, scene);
      for (int c = 0; c < 3; ++c) {
        ASSERT_GE(scene[c], 0) << curve;
        ASSERT_LE(scene[c], 255.001) << curve;
        ASSERT_NEAR(shown[c], display[c], 200 * this->kEpsilon)
            << curve << ": " << display.x << ", " << display.y << ", " << display.z;
      }
    }
  }
}

TYPED_TEST(ToneMathematics, WhiteAndBeyondStaysFiniteAndIsWhiteInEightBits) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (const int curve : {foam::kToneReinhard, foam::kToneAcesNarkowicz, foam::kToneKhronosNeutral}) {
    for (const double value : {1.0, 1.7}) {
      const glm::dvec3 shown = applyToneCurve(curve, glm::dvec3(foam::sceneFromDisplay(curve, Vec3(TypeParam(value)))));
      const double coded = 1.055 * std::pow(shown.x, 1 / 2.4) - 0.055;
      EXPECT_EQ(std::lround(255 * coded), 255) << curve;
    }
    for (const Vec3& pure : {Vec3(1, 0, 0), Vec3(0, TypeParam(0.9), 0), Vec3(-1, 1, 2)}) {
      const glm::dvec3 scene(foam::sceneFromDisplay(curve, pure));
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(scene[c] >= 0 && scene[c] < 256) << curve;
    }
    const glm::dvec3 black(foam::sceneFromDisplay(curve, Vec3(0)));
    EXPECT_EQ(black, glm::dvec3(0)) << curve;
  }
}

}  // namespace
}  // namespace froth
