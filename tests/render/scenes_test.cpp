// Raster and walk against the double reference renderer.
#include <cmath>

#include <gtest/gtest.h>

#include "baker/synth/synth.h"
#include "shaders/foam/cell.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 160, kHeight = 120;

View frontView() { return lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, kWidth, kHeight, 0.6); }

Foam synthesize(const char* name, uint32_t cells) {
  Result<Foam> foam = synthesizeFoam({name, cells, 1});
  EXPECT_TRUE(foam) << foam.error().message;
  return *foam;
}

// The share of pixels where one image has a distance and the other has none, or they differ by more than
// 1e-3.
double distanceMismatch(const Image& runtime, const Image& reference) {
  size_t off = 0;
  for (size_t i = 0; i < runtime.values.size(); ++i) {
    const float found = std::isinf(runtime.values[i]) ? -1.0f : runtime.values[i];
    if (!(std::abs(found - reference.values[i]) <= 1e-3f)) ++off;
  }
  return static_cast<double>(off) / static_cast<double>(runtime.values.size());
}

void expectWalkAgrees(const Frame& walk, const Frame& raster) {
  EXPECT_GE(psnr(walk.colour, raster.colour), 60);
  EXPECT_LE(overTwoSteps(walk.colour, raster.colour), 1e-4);
  EXPECT_EQ(walk.status.bits, 0u);
}

void expectReference(const Foam& foam, const View& view) {
  const RenderedImages expected = renderReference(foam, view);
  Stage stage(bakeForTest(foam), {view.width, view.height});
  const Frame raster = stage.draw(Method::kRaster, view);
  EXPECT_GE(psnr(raster.colour, expected.colour), 60);
  EXPECT_GE(psnr(raster.alpha, expected.alpha), 60);
  EXPECT_GE(psnr(raster.normal, expected.normal), 60);
  EXPECT_LE(distanceMismatch(raster.distance, expected.distance), 1e-3);
  const Frame walk = stage.draw(Method::kWalk, view);
  expectWalkAgrees(walk, raster);
  EXPECT_LE(distanceMismatch(walk.distance, expected.distance), 1e-3);
}

class SmallScene : public testing::TestWithParam<const char*> {};

TEST_P(SmallScene, IsDrawnAsTheReferenceDrawsItByRasterAndWalk) {
  expectReference(synthesize(GetParam(), 0), frontView());
}

INSTANTIATE_TEST_SUITE_P(Named, SmallScene, testing::Values("one", "two", "grid", "shell", "random"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(Scenes, AGalleryOfFiveThousandCellsIsDrawnAsTheReferenceDrawsIt) {
  const View view = resizeView(galleryCameras().views.at(0), kWidth, kHeight);
  expectReference(synthesize("gallery", 5000), view);
}

struct Shape {
  uint32_t details, lobes;
};

class AssetShapes : public testing::TestWithParam<Shape> {};

TEST_P(AssetShapes, AreDrawnAsTheReferenceDrawsThem) {
  const View view = lookAt({0.2, 0.3, -2.5}, {0, 0, 3}, 64, 48, 0.4);
  expectReference(makeRandomFoam(60, GetParam().details, GetParam().lobes, 5), view);
}

INSTANTIATE_TEST_SUITE_P(DetailsAndLobes, AssetShapes, testing::Values(Shape{1, 1}, Shape{4, 2}, Shape{32, 32}),
                         [](const auto& shape) {
                           return std::to_string(shape.param.details) + "x" + std::to_string(shape.param.lobes);
                         });

TEST(Scenes, AnEyeInsideBallsSeesThemWithTheNearTestsOff) {
  View view = lookAt({0.1, 0.0, 3.0}, {0.4, 0.3, 4}, kWidth, kHeight, 1.2);
  expectReference(synthesize("random", 0), view);
}

// Points on the radical planes of the first cells with their nearest neighbours.
std::vector<glm::dvec3> pointsOnPlanes(const ChunkContents& chunk, uint32_t cells) {
  std::vector<glm::dvec3> points;
  for (uint32_t cell = 0; cell < cells; ++cell) {
    const uint32_t other = chunk.neighbours[chunk.neighbourOffsets[cell]];
    const glm::dvec3 site(chunk.sites[cell]), toNeighbour = glm::dvec3(chunk.sites[other]) - site;
    const double offset = foam::radicalOffset(toNeighbour, double{chunk.radii[cell]}, double{chunk.radii[other]});
    points.push_back(site + toNeighbour * (offset / glm::dot(toNeighbour, toNeighbour)) +
                     glm::dvec3(chunk.origin[0], chunk.origin[1], chunk.origin[2]));
  }
  return points;
}

// Rounding says on which side of the plane the eye lies, in each pass for itself.
TEST(Scenes, AnEyeOnARadicalPlaneWalksAsItRasterizes) {
  const Foam foam = synthesize("random", 0);
  const AssetContents contents = bakeForTest(foam);
  constexpr VkExtent2D kSmall{24, 16};
  Stage stage(contents, kSmall);
  for (const glm::dvec3& eye : pointsOnPlanes(contents.chunks[0], 100)) {
    const View view = lookAt(eye, eye + glm::dvec3(0.3, -0.1, 1), kSmall.width, kSmall.height, 1.2);
    const Frame walk = stage.draw(Method::kWalk, view);
    EXPECT_EQ(walk.status.bits & FROTH_VIEW_STEP_LIMIT, 0u);
    EXPECT_GE(psnr(walk.colour, stage.draw(Method::kRaster, view).colour), 60);
  }
}

TEST(Scenes, NearTestsSkipTheCellsThatTheReferenceSkips) {
  View view = frontView();
  view.nearRatio = 18;
  view.nearDepth = 5.0;
  expectReference(synthesize("random", 0), view);
}

TEST(Scenes, TheCutoffEndsRaysAsInTheReference) {
  const Foam foam = synthesize("random", 0);
  const View view = frontView();
  Stage stage(bakeForTest(foam), {kWidth, kHeight});
  for (const double cutoff : {0.0, 0.1}) {
    const RenderedImages expected = renderReference(foam, view, cutoff);
    FrothRenderInfo info = infoOf(view);
    info.cutoff = cutoff > 0 ? static_cast<float>(cutoff) : -1.0f;
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      EXPECT_GE(psnr(stage.draw(method, info, {kWidth, kHeight}).colour, expected.colour), 80) << cutoff;
    }
  }
}

TEST(Scenes, TheStepLimitEndsWalksAndIsReported) {
  Stage stage(bakeForTest(synthesize("random", 0)), {kWidth, kHeight});
  FrothRenderInfo info = infoOf(frontView());
  info.maxSteps = 3;
  EXPECT_EQ(stage.draw(Method::kWalk, info, {kWidth, kHeight}).status.bits, uint32_t{FROTH_VIEW_STEP_LIMIT});
}

TEST(Scenes, TwoDrawsGiveTheSameBits) {
  Stage stage(bakeForTest(synthesize("random", 0)), {kWidth, kHeight});
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame first = stage.draw(method, frontView());
    const Frame second = stage.draw(method, frontView());
    EXPECT_EQ(first.colour.values, second.colour.values);
    EXPECT_EQ(first.distance.values, second.distance.values);
    EXPECT_EQ(first.normal.values, second.normal.values);
  }
}

TEST(Scenes, ARasterAndAWalkInOneFrameAreWhatEachIsAlone) {
  Host& host = sharedHost();
  Stage stage(bakeForTest(synthesize("random", 0)), {kWidth, kHeight});
  const View other = lookAt({0.5, -0.3, 0}, {0, 0, 3}, kWidth, kHeight, 0.8);
  Result<HostImage> first = host.createImage(VK_FORMAT_R32G32B32A32_SFLOAT, {kWidth, kHeight});
  Result<HostImage> second = host.createImage(VK_FORMAT_R32G32B32A32_SFLOAT, {kWidth, kHeight});
  FrothRenderInfo raster = infoOf(frontView()), walk = infoOf(other);
  raster.colour = host.describe(*first);
  walk.colour = host.describe(*second);
  std::vector<std::vector<float>> texels;
  const auto read = [&](const HostImage& image) { texels.push_back(*host.readImage(image)); };
  EXPECT_EQ(stage.submit({{Method::kRaster, raster}, {Method::kWalk, walk}}).passCount, 7u);
  read(*first);
  read(*second);
  stage.submit(Method::kRaster, raster);
  stage.submit(Method::kWalk, walk);
  read(*first);
  read(*second);
  EXPECT_EQ(texels[0], texels[2]);
  EXPECT_EQ(texels[1], texels[3]);
  host.destroyImage(*first);
  host.destroyImage(*second);
}

TEST(Scenes, AssetsWithoutHeightsAreDrawnWithFlatFaces) {
  Foam foam = synthesize("random", 0);
  foam.detailHeights.assign(foam.detailHeights.size(), 0.0f);
  expectReference(foam, frontView());
}

TEST(Scenes, TheLinearImageDecodesTheDisplayCodedOneOncePerPixel) {
  Stage stage(bakeForTest(synthesize("random", 0)), {kWidth, kHeight});
  FrothRenderInfo info = infoOf(frontView());
  const Frame coded = stage.draw(Method::kRaster, info, {kWidth, kHeight});
  info.displayCoded = 0;
  const Frame linear = stage.draw(Method::kRaster, info, {kWidth, kHeight});
  const auto decode = [](float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); };
  for (size_t i = 0; i < coded.alpha.values.size(); ++i) {
    const float coverage = coded.alpha.values[i];
    if (!(coverage > 0)) continue;
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(linear.colour.values[3 * i + c], coverage * decode(coded.colour.values[3 * i + c] / coverage), 1e-4);
    }
  }
}

TEST(Scenes, HalfFloatColourIsTheFloatColourRounded) {
  Stage stage(bakeForTest(synthesize("random", 0)), {kWidth, kHeight});
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame wide = stage.draw(method, infoOf(frontView()), {kWidth, kHeight});
    const Frame half = stage.draw(method, infoOf(frontView()), {kWidth, kHeight}, VK_FORMAT_R16G16B16A16_SFLOAT);
    EXPECT_GE(psnr(wide.colour, half.colour), 65);  // halves near 1 have steps of 5e-4
  }
}

// 120 balls around the eye, drawn whole, cover all 143 tiles of widePairView(): more pairs than a view starts with.
AssetContents makeAssetOfManyPairs() {
  Foam foam = makeRandomFoam(120, 1, 1, 9);
  for (glm::vec3& site : foam.sites) site -= glm::vec3(0, 0, 3);
  foam.radii.assign(foam.cellCount, 10.0f);
  foam.densities.assign(foam.cellCount, 100.0f);
  AssetContents contents = bakeForTest(foam);
  for (ChunkContents& chunk : contents.chunks) chunk.solidBalls.clear();
  return contents;
}

View widePairView() { return lookAt({0, 0, 0}, {0, 0, 1}, 416, 352, 1); }

TEST(Scenes, PairsBeyondTheSpaceAreReportedAndTheNextFrameIsWhole) {
  const View view = widePairView();
  Stage stage(makeAssetOfManyPairs(), {view.width, view.height});
  const Frame first = stage.draw(Method::kRaster, view);
  EXPECT_EQ(first.status.bits, uint32_t{FROTH_VIEW_PAIR_OVERFLOW});
  EXPECT_EQ(first.status.pairs, uint64_t{120} * 13 * 11);
  const Frame second = stage.draw(Method::kRaster, view);
  EXPECT_EQ(second.status.bits, 0u);
  EXPECT_EQ(second.status.pairs, first.status.pairs);
  expectWalkAgrees(stage.draw(Method::kWalk, view), second);
}

// Without messages: a view that meets the budget sends one.
FrothContext* createContextOfBudget(uint64_t deviceBudget) {
  FrothContextInfo info = sharedContextInfo();
  info.deviceBudget = deviceBudget;
  FrothContext* context = nullptr;
  EXPECT_EQ(frothCreateContext(&info, &context), FROTH_OK);
  return context;
}

uint64_t deviceBytesOf(FrothContext* context) {
  FrothFrameStatus status{};
  status.structSize = sizeof(status);
  const Status submitted = sharedHost().submit([&](VkCommandBuffer, uint64_t serial) {
    const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
    EXPECT_EQ(frothUpdate(context, &frame, &status), FROTH_OK);
    return Status();
  });
  EXPECT_TRUE(submitted);
  return status.deviceBytes;
}

constexpr size_t kIdleViews = 2;

// Views besides the stage's, which take memory.
std::vector<FrothView> createIdleViews(FrothContext* context, VkExtent2D extent, size_t count) {
  std::vector<FrothView> views(count);
  for (FrothView& view : views) {
    const FrothViewInfo info{sizeof(FrothViewInfo), extent, 0, 0, 0, 0, 0, {}, 0, 0};
    EXPECT_EQ(frothCreateView(context, &info, &view), FROTH_OK);
  }
  return views;
}

// [bytes] A stage and idle views before anything is drawn.
uint64_t measureStart(const AssetContents& contents, VkExtent2D extent, size_t idleViews) {
  FrothContext* context = createContextOfBudget(0);
  uint64_t bytes = 0;
  {
    Stage stage(contents, extent, context);
    createIdleViews(context, extent, idleViews);
    bytes = deviceBytesOf(context);
  }
  frothDestroyContext(context, UINT64_MAX);
  return bytes;
}

TEST(Scenes, AViewThatTheBudgetKeepsFromGrowingGoesOnDrawingWhatItHolds) {
  const AssetContents contents = makeAssetOfManyPairs();
  const View view = widePairView();
  const VkExtent2D extent{view.width, view.height};
  const uint64_t startBytes = measureStart(contents, extent, 0);
  constexpr uint64_t kSlack = 64 << 10;  // enough to start, too little for the pairs
  FrothContext* limited = createContextOfBudget(startBytes + kSlack);
  {
    Stage stage(contents, extent, limited);
    const Frame first = stage.draw(Method::kRaster, view);
    const Frame second = stage.draw(Method::kRaster, view);
    EXPECT_EQ(first.status.bits, uint32_t{FROTH_VIEW_PAIR_OVERFLOW});
    EXPECT_EQ(second.status.bits, uint32_t{FROTH_VIEW_PAIR_OVERFLOW} | FROTH_VIEW_MAY_LACK_CELLS) << "known before";
    EXPECT_EQ(second.colour.values, first.colour.values);
  }
  frothDestroyContext(limited, UINT64_MAX);
}

TEST(Scenes, AViewThatTheBudgetKeptFromGrowingGrowsOnceThereIsRoom) {
  const AssetContents contents = makeAssetOfManyPairs();
  const View view = widePairView();
  const VkExtent2D extent{view.width, view.height};
  const uint64_t startBytes = measureStart(contents, extent, kIdleViews);
  FrothContext* limited = createContextOfBudget(startBytes + (64 << 10));
  {
    Stage stage(contents, extent, limited);
    const std::vector<FrothView> idleViews = createIdleViews(limited, extent, kIdleViews);
    EXPECT_LE(deviceBytesOf(limited), startBytes);
    for (int frame = 0; frame < 2; ++frame) {
      EXPECT_NE(stage.draw(Method::kRaster, view).status.bits & FROTH_VIEW_PAIR_OVERFLOW, 0u);
    }
    for (const FrothView idle : idleViews) EXPECT_EQ(frothDestroyView(limited, idle), FROTH_OK);
    stage.draw(Method::kRaster, view);  // after it the memory is back
    EXPECT_EQ(stage.draw(Method::kRaster, view).status.bits, 0u);
  }
  frothDestroyContext(limited, UINT64_MAX);
}

}  // namespace
}  // namespace froth::test
