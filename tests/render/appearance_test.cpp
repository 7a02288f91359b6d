// What an asset may lack or vary: base colours, lobes by detail site, view dependence, whole layers. Against the double
// reference, which draws the foam that the asset shows.
#include <random>

#include <gtest/gtest.h>

#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/render/split_asset.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 96, kHeight = 72, kDetails = 3, kLobes = 4;

View frontView() { return lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, kWidth, kHeight, 0.4); }

class Appearance : public testing::Test {
 protected:
  Appearance() : contents_(bakeForTest(makeRandomFoam(120, kDetails, kLobes, 21))) {}

  ChunkContents& chunk() { return contents_.chunks[0]; }
  size_t detailSites() { return size_t{chunk().liveCount} * kDetails; }
  float random(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }

  std::vector<glm::vec3> randomColours(size_t count, float low, float high) {
    std::vector<glm::vec3> colours;
    for (size_t i = 0; i < count; ++i) {
      const float r = random(low, high), g = random(low, high), b = random(low, high);
      colours.emplace_back(r, g, b);
    }
    return colours;
  }

  // Keeps 0 to M lobes of each detail site.
  void varyLobes() {
    ChunkContents varied = chunk();
    varied.lobeAxes.clear();
    varied.lobeColours.clear();
    for (size_t site = 0; site < detailSites(); ++site) {
      const auto count = static_cast<uint8_t>(site % (kLobes + 1));
      varied.lobeCounts.push_back(count);
      for (size_t lobe = site * kLobes; lobe < site * kLobes + count; ++lobe) {
        varied.lobeAxes.push_back(chunk().lobeAxes[lobe]);
        varied.lobeColours.push_back(chunk().lobeColours[lobe]);
      }
    }
    chunk() = varied;
  }

  void dropLobes() {
    contents_.lobeCount = 0;
    chunk().lobeAxes.clear();
    chunk().lobeColours.clear();
  }

  // The asset's first layers (0: all) against the foam that `shown` shows.
  void expectReference(const AssetContents& shown, uint32_t layers = 0) {
    const Result<Foam> foam = foamFromAsset(shown);
    ASSERT_TRUE(foam) << foam.error().message;
    const RenderedImages expected = renderReference(*foam, frontView());
    Stage stage(contents_, {kWidth, kHeight}, sharedContext(), layers);
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      const Frame frame = stage.draw(method, frontView());
      EXPECT_GE(psnr(frame.colour, expected.colour), 60);
      EXPECT_GE(psnr(frame.alpha, expected.alpha), 60);
    }
  }

  AssetContents contents_;

 private:
  std::mt19937 engine_{7};
};

TEST_F(Appearance, BaseColoursAreAddedToTheLobes) {
  chunk().baseColours = randomColours(detailSites(), -0.4f, 0.4f);
  expectReference(contents_);
}

TEST_F(Appearance, DetailSitesMayHaveFromNoLobesToAll) {
  chunk().baseColours = randomColours(detailSites(), -0.4f, 0.4f);
  varyLobes();
  expectReference(contents_);
}

TEST_F(Appearance, WithoutLobesIsTheBaseColour) {
  dropLobes();
  chunk().baseColours = randomColours(detailSites(), -0.4f, 0.4f);
  expectReference(contents_);
}

TEST_F(Appearance, WithoutLobesAndBaseColoursIsGrey) {
  dropLobes();
  expectReference(contents_);
}

// Each of these chunks lacks arrays that the other one has.
TEST_F(Appearance, ChunksMayHoldDifferentParts) {
  chunk().baseColours = randomColours(detailSites(), -0.4f, 0.4f);
  contents_ = splitAsset(contents_, 2, 0);
  ChunkContents& even = contents_.chunks[0];
  even.baseColours.clear();
  even.lobeCounts.assign(size_t{even.liveCount} * kDetails, 1);
  even.lobeAxes.resize(even.lobeCounts.size());
  even.lobeColours.resize(even.lobeCounts.size());
  contents_.chunks[1].detailHeights.clear();
  expectReference(contents_);
}

TEST_F(Appearance, OfTheFirstLayerIsOneColourAndOneHeightPerCell) {
  chunk().baseColours = randomColours(detailSites(), -0.4f, 0.4f);
  AssetContents shown = contents_;
  shown.detailCount = 1;
  shown.lobeCount = 0;
  ChunkContents& plain = shown.chunks[0];
  plain.detailSites.assign(plain.liveCount, glm::vec2(0));
  plain.detailHeights = plain.cellHeights;
  plain.baseColours.clear();
  for (const glm::vec3& colour : plain.cellColours) plain.baseColours.push_back(colour - glm::vec3(0.5f));
  plain.lobeAxes.clear();
  plain.lobeColours.clear();
  expectReference(shown, 1);
}

TEST_F(Appearance, OfTwoLayersIsTheDetailWithoutViewDependence) {
  chunk().baseColours = randomColours(detailSites(), -0.4f, 0.4f);
  AssetContents shown = contents_;
  shown.lobeCount = 0;
  shown.chunks[0].lobeAxes.clear();
  shown.chunks[0].lobeColours.clear();
  expectReference(shown, 2);
  expectReference(contents_, 3);
}

}  // namespace
}  // namespace froth::test
