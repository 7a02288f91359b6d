// Trained foams against the published renders. Found through FROTH_DATA; skipped where they are absent.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "baker/checkpoint/checkpoint.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

struct RealFoam {
  AssetContents contents;
  CameraSet cameras;
  std::filesystem::path folder;
};

std::filesystem::path folderOf(const char* name) {
  const char* data = std::getenv("FROTH_DATA");
  const std::filesystem::path root = data ? data : FROTH_SOURCE_DIR "/../shared/data";
  return root / "foams" / name;
}

RealFoam loadFoam(const std::filesystem::path& folder) {
  Result<Foam> foam = importCheckpoint(folder / "model.pt");
  EXPECT_TRUE(foam) << foam.error().message;
  Result<CameraSet> cameras = readCameras(folder / "cameras.json");
  EXPECT_TRUE(cameras) << cameras.error().message;
  return {bakeForTest(*foam), *cameras, folder};
}

// The asset's defaults where the view has no limits of its own.
View withNearLimits(const RealFoam& foam, size_t index) {
  View view = foam.cameras.views.at(index);
  if (!view.nearRatio) view.nearRatio = foam.contents.nearRatio;
  if (!view.nearDepth) view.nearDepth = foam.contents.nearDepth;
  return view;
}

// At the size of the golden image, which is full size: seconds per view on a software device.
void expectGolden(const RealFoam& foam, Stage& stage, size_t index, double least) {
  const View view = withNearLimits(foam, index);
  const Frame raster = stage.draw(Method::kRaster, view);
  const Result<Image> golden = readImage(foam.folder / view.goldenColour, &raster.colour);
  ASSERT_TRUE(golden) << golden.error().message;
  EXPECT_GE(psnr(raster.colour, *golden), least);
}

// A quarter of the size, to bound the time.
void expectWalkAgrees(const RealFoam& foam, Stage& stage, size_t index) {
  const View full = withNearLimits(foam, index);
  const View view = resizeView(full, full.width / 4, full.height / 4);
  const Frame raster = stage.draw(Method::kRaster, view);
  const Frame walk = stage.draw(Method::kWalk, view);
  EXPECT_GE(psnr(walk.colour, raster.colour), 60);
  EXPECT_LE(overTwoSteps(walk.colour, raster.colour), 1e-4);
  EXPECT_EQ(walk.status.bits, 0u) << "a walk was cut by the step limit";
}

TEST(RealFoam, MikuPlushIsRasterizedAsThePublishedRendersShowItAndWalksAgree) {
  const std::filesystem::path folder = folderOf("miku_plush");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder << "; set FROTH_DATA";
  const RealFoam foam = loadFoam(folder);
  Stage stage(foam.contents, {1319, 989});
  expectGolden(foam, stage, 0, 60);
  expectGolden(foam, stage, 6, 60);
  expectWalkAgrees(foam, stage, 0);
}

TEST(RealFoam, TheRoughTankardIsRasterizedAsPublishedAndItsWalksEnd) {
  const std::filesystem::path folder = folderOf("tankard_rough");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder << "; set FROTH_DATA";
  const RealFoam foam = loadFoam(folder);
  Stage stage(foam.contents, {1152, 1152});
  expectGolden(foam, stage, 2, 52);
  expectWalkAgrees(foam, stage, 2);
}

}  // namespace
}  // namespace froth::test
