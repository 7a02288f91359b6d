// The colour image in the engine's terms: exposure of an instance, and light that the engine's tone curve turns into
// the capture.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "shaders/foam/colour.h"
#include "tests/foam/tone_curves.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 120, kHeight = 90;
constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;

Stage& stage() {
  static FrothContext* const context = createCheckedContext(kLenses);
  static Stage* const made =
      new Stage(bakeForTest(makeRandomFoam(400, 4, 2, 57)), {kWidth, kHeight}, context, 0, kLenses);
  return *made;
}

View viewOf(LensKind kind) {
  View view = lookAt({0.6, -0.5, 0.3}, {0.05, 0.1, 3}, kWidth, kHeight, 0.5);
  view.lens.kind = kind;
  view.fx = view.fy = kind == LensKind::kPinhole ? 85 : kind == LensKind::kOrthographic ? 32 : 60;
  return view;
}

// What an engine shows of the light that is over black: its tone curve and the display's coding, at full coverage.
Image show(const Frame& frame, int curve) {
  Image shown = frame.colour;
  for (size_t i = 0; i < frame.alpha.values.size(); ++i) {
    const double coverage = frame.alpha.values[i];
    float* pixel = &shown.values[3 * i];
    if (coverage <= 0) continue;
    const glm::dvec3 display = applyToneCurve(curve, glm::dvec3(pixel[0], pixel[1], pixel[2]) / coverage);
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(coverage * foam::displayFromLinear(display[c]));
  }
  return shown;
}

int mostSteps(const Image& a, const Image& b) {
  long most = 0;
  const auto stepOf = [](float value) { return std::lround(255 * std::clamp(value, 0.0f, 1.0f)); };
  for (size_t i = 0; i < a.values.size(); ++i) {
    most = std::max(most, std::abs(stepOf(a.values[i]) - stepOf(b.values[i])));
  }
  return static_cast<int>(most);
}

// The same image with its brightest colours at white, as the curves end there.
Image clampedToWhite(const Frame& frame) {
  Image image = frame.colour;
  for (size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = std::min(image.values[i], frame.alpha.values[i / 3]);
  }
  return image;
}

void expectCapture(const View& view, FrothToneCurve curve, VkFormat format, Method method) {
  FrothRenderInfo info = infoOf(view);
  const Image capture = clampedToWhite(stage().draw(method, info, {kWidth, kHeight}));
  info.displayCoded = 0;
  info.toneCurve = curve;
  const Frame frame = stage().draw(method, info, {kWidth, kHeight}, format);
  const Image shown = show(frame, curve);
  EXPECT_GE(psnr(shown, capture), 60) << "curve " << curve << ", lens " << static_cast<int>(view.lens.kind);
  EXPECT_LE(mostSteps(shown, capture), 1) << "curve " << curve << ", lens " << static_cast<int>(view.lens.kind);
}

TEST(Colour, TheEnginesToneCurveReturnsTheCapture) {
  for (const FrothToneCurve curve : {FROTH_TONE_REINHARD, FROTH_TONE_ACES_NARKOWICZ, FROTH_TONE_KHRONOS_NEUTRAL}) {
    expectCapture(viewOf(LensKind::kPinhole), curve, VK_FORMAT_R16G16B16A16_SFLOAT, Method::kRaster);
    expectCapture(viewOf(LensKind::kPinhole), curve, VK_FORMAT_R32G32B32A32_SFLOAT, Method::kWalk);
    expectCapture(viewOf(LensKind::kOrthographic), curve, VK_FORMAT_R32G32B32A32_SFLOAT, Method::kRaster);
    expectCapture(viewOf(LensKind::kFisheye), curve, VK_FORMAT_R32G32B32A32_SFLOAT, Method::kRaster);
  }
}

TEST(Colour, ExposureScalesTheLightOfAnInstance) {
  FrothRenderInfo info = infoOf(viewOf(LensKind::kPinhole));
  info.displayCoded = 0;
  for (const FrothToneCurve curve : {FROTH_TONE_NONE, FROTH_TONE_REINHARD}) {
    info.toneCurve = curve;
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      stage().place({});
      const Frame plain = stage().draw(method, info, {kWidth, kHeight});
      FrothInstanceInfo bright{};
      bright.exposure = 2.5f;
      stage().place(bright);
      const Frame exposed = stage().draw(method, info, {kWidth, kHeight});
      EXPECT_EQ(exposed.alpha.values, plain.alpha.values);
      for (size_t i = 0; i < plain.colour.values.size(); ++i) {
        ASSERT_NEAR(exposed.colour.values[i], 2.5f * plain.colour.values[i], 1e-5f * (1 + exposed.colour.values[i]));
      }
    }
  }
  stage().place({});
}

// Where instances meet in a pixel their exposures are weighed by what each contributes; alike they are the one of all.
TEST(Colour, ExposuresOfSeveralInstancesMeetWithoutSeams) {
  FrothRenderInfo info = infoOf(viewOf(LensKind::kPinhole));
  info.displayCoded = 0;
  Stage other(bakeForTest(makeRandomFoam(250, 2, 0, 7)), {kWidth, kHeight}, stage().context());
  const auto drawWith = [&](float first, float second) {
    FrothInstanceInfo one{}, two = placementOf({0.7, 0.2, 0.3}, {0, 0, 0, 1}, 0.8f);
    one.exposure = first;
    two.exposure = second;
    stage().place(one);
    other.place(two);
    return stage().draw(Method::kRaster, info, {kWidth, kHeight});
  };
  const Frame plain = drawWith(1, 1), alike = drawWith(2.5f, 2.5f), mixed = drawWith(1, 2.5f);
  size_t between = 0;
  for (size_t i = 0; i < plain.colour.values.size(); ++i) {
    const float low = plain.colour.values[i], high = alike.colour.values[i], found = mixed.colour.values[i];
    ASSERT_NEAR(high, 2.5f * low, 1e-5f * (1 + high));
    ASSERT_GE(found, low - 1e-5f * (1 + high));
    ASSERT_LE(found, high + 1e-5f * (1 + high));
    between += found > 1.1f * low && found < 2.4f * low;
  }
  EXPECT_GT(between, 0u);
  stage().place({});
}

TEST(Colour, ExposureReachesTheDisplayCodedImageToo) {
  FrothInstanceInfo dim{};
  dim.exposure = 0.3f;
  stage().place(dim);
  FrothRenderInfo info = infoOf(viewOf(LensKind::kPinhole));
  const Frame coded = stage().draw(Method::kRaster, info, {kWidth, kHeight});
  info.displayCoded = 0;
  EXPECT_GE(psnr(coded.colour, show(stage().draw(Method::kRaster, info, {kWidth, kHeight}), FROTH_TONE_NONE)), 80);
  stage().place({});
}

}  // namespace
}  // namespace froth::test
