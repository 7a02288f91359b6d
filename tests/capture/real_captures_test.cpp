// Real captures: the three scenes, and one model in the spellings that are found in the wild.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reference/camera/view_rays.h"
#include "reference/capture/capture.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

Capture readOrFail(const std::filesystem::path& path) {
  Result<Capture> capture = readCapture(path);
  if (capture) return std::move(*capture);
  ADD_FAILURE() << capture.error().message;
  return {};
}

// Share of the points that lie before each camera that observed them.
double shareBefore(const Capture& capture) {
  uint64_t before = 0, all = 0;
  for (const CapturedPoint& point : capture.points) {
    for (uint32_t i = 0; i < point.observerCount; ++i) {
      const View& view = capture.views[capture.observers[point.firstObserver + i]].view;
      before += glm::dot(point.position - eyeOf(view), forwardOf(view)) > 0;
      ++all;
    }
  }
  return static_cast<double>(before) / static_cast<double>(all);
}

TEST(RealCaptures, TheScenesAreRead) {
  const std::filesystem::path scenes = test::dataFolder() / "scenes";
  if (!std::filesystem::exists(scenes)) FROTH_SKIP() << "no " << scenes;
  const Capture miku = readOrFail(scenes / "miku_plush");
  EXPECT_EQ(miku.views.size(), 97u);
  EXPECT_EQ(miku.points.size(), 19036u);
  EXPECT_EQ(shareBefore(miku), 1);
  const Capture tankard = readOrFail(scenes / "mary_rose_tankard");
  EXPECT_EQ(tankard.views.size(), 69u);
  EXPECT_EQ(tankard.points.size(), 17700u);
  EXPECT_EQ(shareBefore(tankard), 1);
  for (const CapturedView& view : tankard.views) EXPECT_TRUE(std::filesystem::exists(view.mask)) << view.view.name;
  const Capture fox = readOrFail(scenes / "fox");
  EXPECT_EQ(fox.views.size(), 50u);
  EXPECT_EQ(fox.leftOut.size(), 17u);  // frames that were published without their photos
  EXPECT_EQ(fox.points.size(), 0u);
  EXPECT_EQ(fox.views[0].view.lens.kind, LensKind::kRadialTangential);
  for (const Capture* capture : {&miku, &tankard, &fox}) {
    for (const CapturedView& view : capture->views) EXPECT_TRUE(std::filesystem::exists(view.photo)) << view.photo;
  }
}

TEST(RealCaptures, SpellingsOfOneModelAreRead) {
  const std::filesystem::path variants = test::dataFolder() / "malformed/sceaux_colmap_variants";
  if (!std::filesystem::exists(variants)) FROTH_SKIP() << "no " << variants;
  const std::pair<const char*, size_t> sets[] = {{"colmap_example_model_bin", 11},
                                                 {"colmap_example_model_txt", 11},
                                                 {"colmap_example_model_not_shared_txt", 11},
                                                 {"colmap_example_model_txt_missing_cams_and_subfolders", 9}};
  for (const auto& [name, count] : sets) {
    const Capture capture = readOrFail(variants / name);
    EXPECT_EQ(capture.views.size(), count) << name;
    EXPECT_GT(capture.points.size(), 6000u) << name;
    EXPECT_EQ(shareBefore(capture), 1) << name;
  }
}

}  // namespace
}  // namespace froth
