// The bound of an image lets pass what rounding does, and nothing else.
#include "measure/stability/image_bound.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "measure/stability/cases/case_parts.h"
#include "reference/image/distances.h"

namespace froth {
namespace {

class ImageBounds : public testing::Test {
 protected:
  ImageBounds() : foam_(foamOfCells(cloud(40, 3))), renderer_(foam_), view_(outsideViews().back()) {
    options_.nearRatio = 0;
  }

  ImageBound bound(const BoundOptions& options = {}) const {
    const Result<ImageBound> bound = boundImage(renderer_, view_, options_, options);
    EXPECT_TRUE(bound) << bound.error().message;
    return *bound;
  }
  RenderedImages render(const Foam& foam, Precision precision) const {
    ReferenceOptions options = options_;
    options.precision = precision;
    const Result<RenderedImages> images = ReferenceRenderer(foam).render(view_, options);
    EXPECT_TRUE(images) << images.error().message;
    return *images;
  }

  const Foam foam_;
  const ReferenceRenderer renderer_;
  const View view_;
  ReferenceOptions options_;
};

TEST_F(ImageBounds, HoldAFloatImage) {
  const BoundCheck check = checkBound(bound(), render(foam_, Precision::kFloat));
  EXPECT_TRUE(check.isFinite);
  EXPECT_GT(check.maxError, 0);
  EXPECT_LE(check.worstExcess, 1);
  EXPECT_EQ(check.shareOver, 0);
}

TEST_F(ImageBounds, AreFarBelowAStepOfAByteForAWellConditionedScene) { EXPECT_LT(bound().mean, 0.1 / 255); }

TEST_F(ImageBounds, TellAPixelThatIsOffByMoreThanItsBound) {
  const ImageBound limit = bound();
  RenderedImages image = limit.exact;
  EXPECT_EQ(checkBound(limit, image).colourExcess, 0);
  image.colour.pixel(16, 12)[1] += 3 * limit.colour.pixel(16, 12)[1];
  const BoundCheck check = checkBound(limit, image);
  EXPECT_NEAR(check.worstExcess, 3, 0.01);
  EXPECT_EQ(check.worstX, 16u);
  EXPECT_EQ(check.worstY, 12u);
  EXPECT_DOUBLE_EQ(check.shareOver, 1.0 / (32 * 24));
}

TEST_F(ImageBounds, TellAFoamThatIsOffByAThousandth) {
  const ImageBound limit = bound();
  Foam changed = foam_;
  for (float& density : changed.densities) density *= 1.002f;
  EXPECT_GT(checkBound(limit, render(changed, Precision::kDouble)).worstExcess, 1) << "densities";
  changed = foam_;
  for (float& height : changed.detailHeights) height += 0.002f;
  EXPECT_GT(checkBound(limit, render(changed, Precision::kDouble)).worstExcess, 1) << "heights";
  changed = foam_;
  for (glm::vec3& site : changed.sites) site.x *= 1.0005f;
  EXPECT_GT(checkBound(limit, render(changed, Precision::kDouble)).worstExcess, 1) << "sites";
}

TEST_F(ImageBounds, TellValuesThatAreNoNumbersAndNegativeZeros) {
  const ImageBound limit = bound();
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    RenderedImages image = limit.exact;
    *image.alpha.pixel(3, 4) = value;
    const BoundCheck check = checkBound(limit, image);
    EXPECT_FALSE(check.isFinite);
    EXPECT_GT(check.worstExcess, 1);
  }
  RenderedImages image = limit.exact;
  ASSERT_EQ(*image.alpha.pixel(0, 0), 0);
  *image.alpha.pixel(0, 0) = -0.0f;
  EXPECT_FALSE(checkBound(limit, image).isFinite);
}

TEST_F(ImageBounds, LetTwoImagesDifferByOneBound) {
  const ImageBound limit = bound();
  RenderedImages above = limit.exact, below = limit.exact;
  const float step = 0.9f * limit.colour.pixel(16, 12)[0];
  above.colour.pixel(16, 12)[0] += step;
  below.colour.pixel(16, 12)[0] -= step;
  EXPECT_NEAR(checkBound(limit, above, below).worstExcess, 1.8, 0.01);
}

TEST_F(ImageBounds, HoldDistances) {
  const ImageBound limit = bound();
  const size_t hit = 12 * 32 + 16;
  ASSERT_GT(limit.exact.distance.values[hit], 0);
  ASSERT_EQ(limit.exact.distance.values[0], -1);
  const auto check = [&](size_t pixel, float depth) {
    RenderedImages image = limit.exact;
    image.distance.values[pixel] = depth;
    return checkBound(limit, image);
  };
  const float depth = limit.exact.distance.values[hit], margin = limit.distance.margin.values[hit];
  EXPECT_LT(margin, 1e-4f * depth);
  EXPECT_LE(check(hit, limit.distance.middle.values[hit] + 0.5f * margin).worstExcess, 1);
  EXPECT_STREQ(check(hit, depth + 4 * margin).worstChannel, "distance");
  EXPECT_GT(check(hit, depth + 4 * margin).worstExcess, 1);
  EXPECT_GT(check(hit, -1).worstExcess, 1) << "a ray that is stopped has a distance";
  EXPECT_GT(check(0, 3).worstExcess, 1) << "one that is not has none";
  EXPECT_FALSE(check(hit, std::numeric_limits<float>::infinity()).isFinite);
}

// Two balls, one before the other; the nearer one takes half of the light, so that rounding decides in which of them
// the median lies.
TEST_F(ImageBounds, LetADistanceLieInEitherCellWhereRoundingMovesTheMedian) {
  std::vector<CaseCell> cells = {{{0, 0, 0}, 0.5f, 0.69314718f, kFaceToViewer, 5, 0},
                                 {{0, 0, 2}, 0.5f, 20, kFaceToViewer, 5, 1}};
  const Foam foam = foamOfCells(cells);
  const ReferenceRenderer renderer(foam);
  const Result<ImageBound> limit =
      boundImage(renderer, caseView({0, 0, -3}, {0, 0, 0}, 1, 1), options_, {.samples = 64});
  ASSERT_TRUE(limit);
  RenderedImages image = limit->exact;
  for (const float depth : {3.5f, 4.5f}) {
    image.distance.values[0] = depth;
    EXPECT_LE(checkBound(*limit, image).worstExcess, 1) << depth;
  }
  image.distance.values[0] = 20;
  EXPECT_GT(checkBound(*limit, image).worstExcess, 1);
}

TEST_F(ImageBounds, HoldNormals) {
  const ImageBound limit = bound();
  RenderedImages image = limit.exact;
  image.normal.pixel(16, 12)[2] += 3 * limit.normal.pixel(16, 12)[2];
  const BoundCheck check = checkBound(limit, image);
  EXPECT_NEAR(check.worstExcess, 3, 0.01);
  EXPECT_STREQ(check.worstChannel, "normal");
}

// What twice the cut-off leaves out, and two roundings to half; nothing else.
TEST_F(ImageBounds, OfTheShippedFormKnowTheCutOffAndHalves) {
  const ImageBound limit = bound();
  const auto cutAt = [&](double cutoff) {
    ReferenceOptions options = options_;
    options.cutoff = cutoff;
    Result<RenderedImages> images = renderer_.render(view_, options);
    EXPECT_TRUE(images);
    images->distance = images->normal = {};  // which that form does not have
    return std::move(*images);
  };
  const ImageBound shipped = boundShippedForm(limit, cutAt(2e-3));
  EXPECT_LE(checkBound(shipped, cutAt(1e-3)).worstExcess, 1);
  EXPECT_GT(checkBound(shipped, cutAt(2e-2)).worstExcess, 1) << "a cut-off that is twenty times too large";
  EXPECT_GT(checkBound(limit, cutAt(1e-3)).worstExcess, 1) << "the form without a cut-off is not entitled to one";
  RenderedImages image = limit.exact;
  for (float& value : image.colour.values) value *= 1 + 0x1p-10f + 0x1p-11f;
  EXPECT_LE(checkBound(shipped, image).worstExcess, 1);
  for (float& value : image.colour.values) value *= 1.01f;
  EXPECT_GT(checkBound(shipped, image).worstExcess, 1);
}

// sRGB as IEC 61966-2-1 has it, of premultiplied colours.
RenderedImages inLinearLight(RenderedImages images) {
  for (size_t pixel = 0; pixel < images.alpha.values.size(); ++pixel) {
    const double alpha = images.alpha.values[pixel];
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      const double value = alpha > 0 ? images.colour.values[i] / alpha : 0;
      const double linear = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
      images.colour.values[i] = static_cast<float>(alpha * linear);
    }
  }
  return images;
}

TEST_F(ImageBounds, OfRaysHoldColoursInLinearLight) {
  const ImageBound whole = bound(), rays = boundOfRays(whole);
  EXPECT_LE(checkBound(rays, inLinearLight(whole.exact)).worstExcess, 1);
  EXPECT_LE(checkBound(rays, inLinearLight(render(foam_, Precision::kFloat))).worstExcess, 1);
  EXPECT_GT(checkBound(rays, whole.exact).worstExcess, 1e3) << "display-coded colours";
  RenderedImages image = inLinearLight(whole.exact);
  for (float& value : image.colour.values) value *= 1.001f;
  EXPECT_GT(checkBound(rays, image).worstExcess, 1) << "light that is off by a thousandth";
  image = rays.exact;
  image.colour.pixel(16, 12)[1] += 3 * rays.colour.pixel(16, 12)[1];
  const BoundCheck check = checkBound(rays, image);
  EXPECT_NEAR(check.worstExcess, 3, 0.01);
  EXPECT_STREQ(check.worstChannel, "colour");
}

// Light of C / A grows by 2.4 times what C does, relative: a bound of the light that is as narrow as that of the code
// refuses floats.
TEST_F(ImageBounds, OfRaysAreAsWideInLightAsDecodingMakesThem) {
  const ImageBound whole = bound({.rounding = 0}), rays = boundOfRays(whole);
  RenderedImages image = whole.exact;
  for (size_t i = 0; i < image.colour.values.size(); ++i) image.colour.values[i] += 0.95f * whole.colour.values[i];
  for (size_t i = 0; i < image.alpha.values.size(); ++i) image.alpha.values[i] -= 0.95f * whole.alpha.values[i];
  EXPECT_LE(checkBound(whole, image).worstExcess, 1);
  const BoundCheck check = checkBound(rays, inLinearLight(image));
  EXPECT_LE(check.worstExcess, 1);
  EXPECT_GT(check.worstExcess, 0.5);
}

// A transmittance comes as a float, so an opacity is off by units of 1 however small it is; by four of them, no more.
TEST_F(ImageBounds, OfRaysKnowThatTransmittanceIsAFloat) {
  const ImageBound whole = bound(), rays = boundOfRays(whole);
  ASSERT_EQ(*whole.exact.alpha.pixel(0, 0), 0);
  const auto excessOf = [](const ImageBound& limit, float error) {
    RenderedImages image = limit.exact;
    *image.alpha.pixel(0, 0) += error;
    return checkBound(limit, image).worstExcess;
  };
  EXPECT_LE(excessOf(rays, 0x1p-22f), 1);
  EXPECT_GT(excessOf(rays, 0x1.1p-22f), 1);
  EXPECT_GT(excessOf(whole, 0x1p-22f), 1);
  for (size_t i = 0; i < rays.alpha.values.size(); ++i) {
    ASSERT_NEAR(rays.alpha.values[i] - whole.alpha.values[i], 0x1p-22, 1e-9);
  }
}

// Their distances are the same, and a form without colours is not asked for them.
TEST_F(ImageBounds, OfRaysHoldDistancesAsTheyAre) {
  const ImageBound whole = bound(), rays = boundOfRays(whole);
  EXPECT_EQ(rays.distance.middle.values, whole.distance.middle.values);
  EXPECT_EQ(rays.distance.margin.values, whole.distance.margin.values);
  RenderedImages image = rays.exact;
  image.colour = image.normal = {};
  EXPECT_LE(checkBound(rays, image).worstExcess, 1);
  image.distance.values[0] = 3;
  EXPECT_GT(checkBound(rays, image).worstExcess, 1);
}

TEST(SameBits, TellZerosAndNaNsApart) {
  RenderedImages a;
  a.colour = {1, 1, 1, {0.0f}};
  a.alpha = {1, 1, 1, {std::numeric_limits<float>::quiet_NaN()}};
  RenderedImages b = a;
  EXPECT_TRUE(hasSameBits(a, b)) << "NaN is equal to itself";
  b.colour.values[0] = -0.0f;
  EXPECT_FALSE(hasSameBits(a, b));
}

TEST(MissingDepth, IsWhatIsInfinitelyFarAndNothingElse) {
  const float infinity = std::numeric_limits<float>::infinity();
  Image depth{4, 1, 1, {infinity, -infinity, -1.0f, 2.0f}};
  markMissingDistances(depth);
  EXPECT_EQ(depth.values[0], -1);
  EXPECT_TRUE(std::isnan(depth.values[1]));
  EXPECT_TRUE(std::isnan(depth.values[2]));
  EXPECT_EQ(depth.values[3], 2);
}

}  // namespace
}  // namespace froth
