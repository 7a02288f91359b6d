// A scene far from the origin, from the asset: placed there in double, or with its chunks' origins there.
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "baker/synth/synth.h"
#include "foam/checkpoint/checkpoint.h"
#include "tests/render/render_harness.h"
#include "tests/surroundings.h"

namespace froth::test {
namespace {

constexpr double kStep = 1.0 / 255;

View movedView(View view, const glm::dvec3& by) {
  for (int row = 0; row < 3; ++row) view.worldFromCamera[4 * static_cast<size_t>(row) + 3] += by[row];
  return view;
}

constexpr glm::dvec3 kFarAway[] = {{1e3, -1e3, 1e3}, {1e6, -1e6, 1e6}, {1e9, -1e9, 1e9}};

// At 10^9 units a double has steps of 1e-7, to which eye and placement are rounded.
void expectTheSameFarAway(const AssetContents& contents, const View& view) {
  Stage stage(contents, {view.width, view.height});
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    stage.place(placementOf({}, glm::vec4(0), 0));
    stage.draw(method, view);  // the view grows to what it needs
    const Frame near = stage.draw(method, view);
    for (const glm::dvec3& by : kFarAway) {
      stage.place(placementOf(by, glm::vec4(0), 0));
      const double found = compareImages(stage.draw(method, movedView(view, by)).colour, near.colour)->maxError;
      EXPECT_LE(found, kStep) << by.x << " units away";
      testing::Test::RecordProperty(
          (std::string(method == Method::kRaster ? "raster" : "walk") + std::to_string(std::lround(std::log10(by.x))))
              .c_str(),
          std::to_string(found));
    }
  }
}

TEST(FarAway, AFoamPlacedThereIsTheSameWithinOneStepOfABytePlacedAtTheOrigin) {
  const Result<Foam> foam = synthesizeFoam({"random", 0, 1});
  ASSERT_TRUE(foam) << foam.error().message;
  expectTheSameFarAway(bakeForTest(*foam), lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 96, 64, 0.6));
}

TEST(FarAway, AnAssetWithItsOriginsThereIsTheSameWithinOneStepOfAByte) {
  const Result<Foam> foam = synthesizeFoam({"random", 0, 1});
  ASSERT_TRUE(foam) << foam.error().message;
  const View view = lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 96, 64, 0.6);
  AssetContents contents = bakeForTest(*foam);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame near = Stage(contents, {view.width, view.height}).draw(method, view);
    for (const glm::dvec3& by : kFarAway) {
      AssetContents moved = contents;
      for (ChunkContents& chunk : moved.chunks) {
        for (size_t axis = 0; axis < 3; ++axis) chunk.origin[axis] += by[static_cast<int>(axis)];
      }
      const Frame far = Stage(moved, {view.width, view.height}).draw(method, movedView(view, by));
      EXPECT_LE(compareImages(far.colour, near.colour)->maxError, kStep) << by.x << " units away";
    }
  }
}

AssetContents bakeAs(const char* preset, const Foam& foam) {
  BakeOptions options;
  options.preset = preset;
  options.knobs = *presetKnobs(preset);
  options.measure = false;
  Result<BakeResult> baked = bakeFoam(foam, options);
  if (baked) return std::move(baked->contents);
  ADD_FAILURE() << baked.error().message;
  return {};
}

// What a checkpoint holds is rounded where it lies: the image is that of the rounded foam, not that of the scene at the
// origin.
TEST(FarAway, AFoamSavedInFloatsThereIsBakedAndDrawnAsItsFloatsSay) {
  const Result<Foam> foam = synthesizeFoam({"random", 0, 1});
  ASSERT_TRUE(foam) << foam.error().message;
  const View view = lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 96, 64, 0.6);
  for (const double distance : {16384.0, 1048576.0}) {
    const glm::dvec3 by(distance, -distance, distance);
    Foam saved = *foam, rounded = *foam;
    // Two loops: in one, gcc 12 takes the way to float and back to be none (SLP vectorizer).
    for (glm::vec3& site : saved.sites) site = glm::dvec3(site) + by;
    for (uint32_t i = 0; i < foam->cellCount; ++i) rounded.sites[i] = glm::dvec3(saved.sites[i]) - by;
    for (const char* preset : {"exact", "default"}) {
      for (const Method method : {Method::kRaster, Method::kWalk}) {
        const Frame near = Stage(bakeAs(preset, rounded), {view.width, view.height}).draw(method, view);
        const Frame far = Stage(bakeAs(preset, saved), {view.width, view.height}).draw(method, movedView(view, by));
        EXPECT_LE(compareImages(far.colour, near.colour)->maxError, kStep)
            << preset << ", " << distance << " units away";
      }
    }
  }
}

TEST(FarAway, MikuPlushPlacedThereIsTheSameWithinOneStepOfAByte) {
  const std::filesystem::path folder = dataFolder() / "foams/miku_plush";
  if (!std::filesystem::exists(folder)) FROTH_SKIP() << "no " << folder << "; set FROTH_DATA";
  const Result<Foam> foam = importCheckpoint(folder / "model.pt");
  ASSERT_TRUE(foam) << foam.error().message;
  const Result<CameraSet> cameras = readCameras(folder / "cameras.json");
  ASSERT_TRUE(cameras) << cameras.error().message;
  expectTheSameFarAway(bakeForTest(*foam), resizeView(cameras->views.at(0), 96, 72));
}

}  // namespace
}  // namespace froth::test
