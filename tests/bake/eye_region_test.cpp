// Bakes for a region of eyes: which views they draw, what they store, and what eyes see that no camera has.
#include "baker/bake/eye_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reference/camera/view_rays.h"
#include "reference/image/metrics.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

// On an arc about the foam.
CameraSet arcOf(std::vector<double> angles) {
  CameraSet cameras;
  for (const double angle : angles) {
    cameras.views.push_back(lookAt({4 * std::cos(angle), 0.3, 4 * std::sin(angle)}, {0, 0, 0}, 96, 72, 0.4));
  }
  return cameras;
}

BakeOptions defaultOptions(const CameraSet* cameras) {
  BakeOptions options;
  options.preset = "default";
  options.knobs = *presetKnobs("default");
  options.nearRatio = 0;
  options.cameras = cameras;
  return options;
}

AssetContents bake(const Foam& foam, const BakeOptions& options) {
  Result<BakeResult> result = bakeFoam(foam, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(result->contents) : AssetContents{};
}

double psnrOf(const Foam& foam, const AssetContents& asset, const View& view) {
  const Result<Foam> baked = foamFromAsset(asset);
  EXPECT_TRUE(baked);
  return compareImages(renderFoam(*baked, view).colour, renderFoam(foam, view).colour)->psnr;
}

// Eyes 11 to 34 degrees beside all cameras.
double worstUnseen(const Foam& foam, const AssetContents& asset) {
  double worst = std::numeric_limits<double>::infinity();
  for (const View& view : arcOf({-0.4, -0.2, 0.4, 0.6, 0.8}).views) worst = std::min(worst, psnrOf(foam, asset, view));
  return worst;
}

TEST(EyeRegion, ShowsItsUnseenEyesBetterThanABakeForTheCameras) {
  const Foam foam = randomFoam(100, 2, 6, 3);
  const CameraSet cameras = arcOf({0, 0.1, 0.2});
  BakeOptions options = defaultOptions(&cameras);
  options.measure = options.steiner = false;
  const double without = worstUnseen(foam, bake(foam, options));
  options.eyes.aroundCameras = 2.4;
  const double with = worstUnseen(foam, bake(foam, options));
  EXPECT_LT(without, 23);
  EXPECT_GT(with, 24);
}

TEST(EyeRegion, OfABoxNeedsNoCameras) {
  const Foam foam = randomFoam(60, 2, 3, 5);
  BakeOptions options = defaultOptions(nullptr);
  options.measure = false;
  options.eyes.box = Box{{3, -0.5, -0.5}, {4, 0.5, 0.5}};
  const AssetContents asset = bake(foam, options);
  ASSERT_EQ(asset.eyes.boxes.size(), 1u);
  EXPECT_EQ(asset.eyes.boxes[0].min, options.eyes.box->min);
  EXPECT_EQ(asset.eyes.boxes[0].max, options.eyes.box->max);
  EXPECT_EQ(asset.eyes.radius, 0);
}

TEST(EyeRegion, IsNothingThatAnExactBakeNeeds) {
  BakeOptions options;
  options.eyes.box = Box{{3, -0.5, -0.5}, {4, 0.5, 0.5}};
  EXPECT_TRUE(bake(randomFoam(60, 2, 3, 5), options).eyes.boxes.empty());
}

TEST(EyeRegion, IsStoredWithWhatItsOtherEyesSee) {
  const Foam foam = randomFoam(60, 2, 3, 5);
  const CameraSet cameras = arcOf({0, 0.4});
  BakeOptions options = defaultOptions(&cameras);
  options.eyes.aroundCameras = 0.5;
  const AssetContents asset = bake(foam, options);
  ASSERT_EQ(asset.eyes.boxes.size(), 2u);
  EXPECT_EQ(asset.eyes.boxes[1].min, asset.eyes.boxes[1].max);
  EXPECT_EQ(asset.eyes.boxes[1].min[0], cameras.views[1].worldFromCamera[3]);
  EXPECT_EQ(asset.eyes.radius, 0.5);
  EXPECT_GT(asset.eyes.worstPsnr, 15);
  EXPECT_GE(asset.eyes.meanPsnr, asset.eyes.worstPsnr);
}

TEST(EyeRegion, IsThatOfTheCamerasWithoutAChoice) {
  const Foam foam = randomFoam(40, 1, 2, 5);
  const CameraSet cameras = arcOf({0, 0.4, 0.8});
  BakeOptions options = defaultOptions(&cameras);
  const AssetContents asset = bake(foam, options);
  EXPECT_EQ(asset.eyes.boxes.size(), 3u);
  EXPECT_EQ(asset.eyes.radius, 0);
  EXPECT_EQ(asset.eyes.meanPsnr, 0);
  options.preset = "exact";
  options.knobs = {};
  EXPECT_TRUE(bake(foam, options).eyes.boxes.empty());  // good for all eyes
}

TEST(EyeRegion, DrawsItsViewsFromEyesWithin) {
  const CameraSet cameras = arcOf({0, 0.4, 0.8});
  BakeOptions options = defaultOptions(&cameras);
  options.eyes.aroundCameras = 0.5;
  const EyeRegion region = makeEyeRegion(options);
  const std::vector<View> views = drawViews(region, &cameras, 64, 1), again = drawViews(region, &cameras, 64, 1);
  const std::vector<View> others = drawViews(region, &cameras, 64, 2);
  ASSERT_EQ(views.size(), 64u);
  for (size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(views[i].worldFromCamera, again[i].worldFromCamera);
    EXPECT_NE(views[i].worldFromCamera, others[i].worldFromCamera);
    double nearest = std::numeric_limits<double>::infinity();
    for (const View& camera : cameras.views) nearest = std::min(nearest, glm::distance(eyeOf(camera), eyeOf(views[i])));
    EXPECT_LE(nearest, 0.5);
  }
}

TEST(EyeRegion, ThatCannotBeIsRefused) {
  const Foam foam = randomFoam(20, 1, 1, 5);
  const CameraSet cameras = arcOf({0});
  const auto errorWith = [&](auto&& edit) {
    BakeOptions options = defaultOptions(&cameras);
    edit(options);
    const Result<BakeResult> result = bakeFoam(foam, options);
    return result ? "no error" : result.error().message;
  };
  using testing::HasSubstr;
  EXPECT_THAT(errorWith([](BakeOptions& o) { o.eyes.aroundCameras = -1; }), HasSubstr("found distance -1"));
  EXPECT_THAT(errorWith([](BakeOptions& o) { o.eyes.aroundCameras = NAN; }), HasSubstr("found distance nan"));
  EXPECT_THAT(errorWith([](BakeOptions& o) {
                o.eyes.aroundCameras = 1;
                o.cameras = nullptr;
              }),
              HasSubstr("give cameras with views"));
  EXPECT_THAT(errorWith([](BakeOptions& o) {
                o.eyes.box = Box{{0, 1, 0}, {1, 0.5, 1}};
              }),
              HasSubstr("found 1 to 0.5 on axis y"));
  EXPECT_THAT(errorWith([](BakeOptions& o) { o.eyes.box = Box{{0, 0, 0}, {1, 1, INFINITY}}; }), HasSubstr("axis z"));
}

}  // namespace
}  // namespace froth
