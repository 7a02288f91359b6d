// The bound of an image lets pass what rounding does, and nothing else.
#include "baker/stability/image_bound.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "baker/stability/case_parts.h"

namespace froth {
namespace {

class ImageBounds : public testing::Test {
 protected:
  ImageBounds() : foam_(foamOfCells(cloud(40, 3))), renderer_(foam_), view_(outsideViews().back()) { options_.nearRatio = 0; }

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

TEST_F(ImageBounds, HoldAFloatImageWithoutAShareOfStorage) {
  BoundOptions options;
  options.storage = 0;
  const BoundCheck check = checkBound(bound(options), render(foam_, Precision::kFloat));
  EXPECT_TRUE(check.isFinite);
  EXPECT_GT(check.maxError, 0);
  EXPECT_LE(check.worstExcess, 1);
  EXPECT_EQ(check.shareOver, 0);
}

TEST_F(ImageBounds, AreFarBelowAStepOfAByteForAWellConditionedScene) { EXPECT_LT(bound().mean, 0.1 / 255); }

TEST_F(ImageBounds, TellAPixelThatIsOffByMoreThanItsBound) {
  const ImageBound limit = bound();
  RenderedImages image = limit.exact;
  EXPECT_EQ(checkBound(limit, image).worstExcess, 0);
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

TEST_F(ImageBounds, LetTwoImagesDifferByTheirBoundsTogether) {
  const ImageBound limit = bound();
  RenderedImages above = limit.exact, below = limit.exact;
  const float step = 0.9f * limit.colour.pixel(16, 12)[0];
  above.colour.pixel(16, 12)[0] += step;
  below.colour.pixel(16, 12)[0] -= step;
  EXPECT_NEAR(checkBound(limit, above, below).worstExcess, 0.9, 0.01);
}

}  // namespace
}  // namespace froth
