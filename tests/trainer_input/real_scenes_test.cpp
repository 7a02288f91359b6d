// The three real scenes load, and start: small, for time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/camera/view_points.h"
#include "tests/surroundings.h"
#include "trainer/photos/exposure.h"
#include "trainer/photos/photo_order.h"
#include "trainer/start/start_foam.h"

namespace froth {
namespace {

void expectStart(const std::string& name, bool isMaskAlpha, uint32_t cells, double leastSeen) {
  const std::filesystem::path scene = test::dataFolder() / "scenes" / name;
  if (!std::filesystem::exists(scene)) FROTH_SKIP() << "no " << scene;
  const Result<Capture> capture = readCapture(scene);
  ASSERT_TRUE(capture) << capture.error().message;
  const Result<PhotoSplit> split = splitPhotos(capture->views);
  ASSERT_TRUE(split) << split.error().message;
  std::vector<CapturedView> training;
  for (const uint32_t index : split->training) training.push_back(capture->views[index]);
  const Result<std::vector<Photo>> photos = readPhotos(training, {.downscale = 8, .isMaskAlpha = isMaskAlpha});
  ASSERT_TRUE(photos) << photos.error().message;
  const SceneFrame frame = findSceneFrame(*capture);
  const Result<StartFoam> start = makeStartFoam({*capture, frame, split->training, *photos, 7},
                                                {.cellCount = cells, .detailCount = 2, .lobeCount = 2});
  ASSERT_TRUE(start) << start.error().message;
  const Foam& foam = start->foam;
  std::vector<View> views;
  for (const CapturedView& view : training) views.push_back(normalised(view.view, frame));
  uint32_t seen = 0;
  for (uint32_t i = 0; i < cells; ++i) {
    ASSERT_TRUE(std::isfinite(foam.radii[i]) && foam.radii[i] > 0);
    ASSERT_LT(glm::length(foam.sites[i]), 1000);
    const auto shows = [&](const View& view) { return ViewPoints(view).of(glm::dvec3(foam.sites[i])).has_value(); };
    seen += std::any_of(views.begin(), views.end(), shows);
  }
  EXPECT_GE(seen, leastSeen * cells) << start->points << " points, " << start->mixtures << " mixtures";
}

// Mixtures of points may lie a little outside of what any view frames.
TEST(RealScenes, MikuPlushStarts) { expectStart("miku_plush", false, 20000, 0.99); }
TEST(RealScenes, TankardStarts) { expectStart("mary_rose_tankard", true, 20000, 0.99); }
TEST(RealScenes, FoxStarts) { expectStart("fox", false, 5000, 1); }

// By the same points as structure from motion saw them, photo 003946 is half as bright again as the mean, and 003956 a
// sixth darker.
TEST(RealScenes, MikuPlushHasPhotosOfSeveralExposures) {
  const std::filesystem::path scene = test::dataFolder() / "scenes/miku_plush";
  if (!std::filesystem::exists(scene)) FROTH_SKIP() << "no " << scene;
  const Result<Capture> capture = readCapture(scene);
  ASSERT_TRUE(capture) << capture.error().message;
  const Result<std::vector<Photo>> photos = readPhotos(capture->views, {.downscale = 2});
  ASSERT_TRUE(photos) << photos.error().message;
  const Result<std::vector<glm::dvec3>> exposures = findExposures(*capture, *photos);
  ASSERT_TRUE(exposures) << exposures.error().message;
  for (size_t i = 0; i < photos->size(); ++i) {
    const std::string& name = capture->views[i].view.name;
    if (name == "20240212_003946.jpg") {
      EXPECT_NEAR((*exposures)[i].y, 0.38, 0.08);
    }
    if (name == "20240212_003956.jpg") {
      EXPECT_NEAR((*exposures)[i].y, -0.18, 0.08);
    }
  }
}

}  // namespace
}  // namespace froth
