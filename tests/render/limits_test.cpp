// Work follows the cells, and stops where the caller says, whatever the asset is.
#include <algorithm>
#include <memory>
#include <random>
#include <string_view>

#include <gtest/gtest.h>

#include "runtime/render/pass_recorder.h"
#include "tests/render/ball_asset.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

View frontView(uint32_t size) { return lookAt({0, 0, -1}, {0, 0, 3}, size, size, 0.3); }

// Thin balls behind each other, the farthest first.
std::vector<BallCell> makeColumn(uint32_t count) {
  std::vector<BallCell> cells;
  for (uint32_t i = count; i-- > 0;) {
    const auto place = static_cast<float>(i);
    cells.push_back(
        {{0.01f * place, 0, 2 + 0.1f * place}, 0.5f, 0.2f, {0.01f * place - 0.3f, 0.2f, 0.3f - 0.01f * place}});
  }
  return cells;
}

std::vector<BallCell> makeCloud(uint32_t count) {
  std::mt19937 engine(1);
  const auto random = [&] { return static_cast<float>(engine() >> 8) * 0x1p-23f - 1; };
  std::vector<BallCell> cells;
  for (uint32_t i = 0; i < count; ++i) {
    const float x = random(), y = random(), z = random(), red = random(), green = random(), blue = random();
    cells.push_back({glm::vec3(x, y, z) + glm::vec3(0, 0, 3), 0.02f, 40, 0.5f * glm::vec3(red, green, blue)});
  }
  return cells;
}

TEST(Limits, ATileDrawsItsNearestCellsUpToTheLimit) {
  constexpr uint32_t kCells = 40, kLimit = 12, kSize = 32;
  const std::vector<BallCell> all = makeColumn(kCells);
  FrothRenderInfo info = infoOf(frontView(kSize));
  info.cutoff = -1;
  info.maxEntries = kLimit;
  auto stage = std::make_unique<Stage>(makeBallAsset(all), VkExtent2D{kSize, kSize});
  const Frame cut = stage->draw(Method::kRaster, info, {kSize, kSize});
  EXPECT_EQ(cut.status.bits, uint32_t{FROTH_VIEW_ENTRY_LIMIT});
  EXPECT_EQ(cut.status.longestList, kCells);
  EXPECT_LE(cut.status.work.entries, 16u * kLimit);
  info.maxEntries = kCells;
  const Frame whole = stage->draw(Method::kRaster, info, {kSize, kSize});
  EXPECT_EQ(whole.status.bits, 0u);
  EXPECT_NE(whole.colour.values, cut.colour.values);

  stage.reset();
  info.maxEntries = 0;
  Stage nearest(makeBallAsset({all.end() - kLimit, all.end()}), {kSize, kSize});
  const Frame expected = nearest.draw(Method::kRaster, info, {kSize, kSize});
  EXPECT_EQ(expected.status.bits, 0u);
  EXPECT_EQ(cut.colour.values, expected.colour.values);
  EXPECT_EQ(cut.alpha.values, expected.alpha.values);
}

// A file of 3.6 KB that took 45 s at 256 x 256.
TEST(Limits, EqualBallsInOnePlaceCostWhatTheDefaultAllows) {
  constexpr uint32_t kDefault = 16384, kSize = 8;
  const std::vector<BallCell> balls(20000, {{0, 0, 3}, 1, 1e-6f, {0, 0, 0}});
  Stage stage(makeBallAsset(balls), {kSize, kSize});
  stage.draw(Method::kRaster, frontView(kSize));  // after which the buffers hold all
  const FrothViewStatus status = stage.draw(Method::kRaster, frontView(kSize)).status;
  EXPECT_EQ(status.bits, uint32_t{FROTH_VIEW_ENTRY_LIMIT});
  EXPECT_EQ(status.longestList, balls.size());
  EXPECT_EQ(status.work.entries, kDefault);
}

TEST(Limits, AWalkEndsAtItsMostNeighbours) {
  constexpr uint32_t kLimit = 60, kSize = 32;
  const AssetContents contents = bakeForTest(makeRandomFoam(200, 1, 1, 5));
  const auto& rows = contents.chunks[0].neighbourOffsets;
  uint32_t longest = 0;
  for (size_t cell = 1; cell < rows.size(); ++cell) longest = std::max(longest, rows[cell] - rows[cell - 1]);
  Stage stage(contents, {kSize, kSize});
  FrothRenderInfo info = infoOf(frontView(kSize));
  const FrothViewStatus whole = stage.draw(Method::kWalk, info, {kSize, kSize}).status;
  EXPECT_EQ(whole.bits, 0u);
  info.maxNeighbours = kLimit;
  const FrothViewStatus cut = stage.draw(Method::kWalk, info, {kSize, kSize}).status;
  EXPECT_EQ(cut.bits, uint32_t{FROTH_VIEW_STEP_LIMIT});
  EXPECT_LE(cut.work.neighbours, uint64_t{kSize} * kSize * (kLimit + longest));
  EXPECT_LT(cut.work.neighbours, whole.work.neighbours);
}

TEST(Limits, NoColourOfAFileMakesAPixelThatIsNotFinite) {
  constexpr uint32_t kSize = 16;
  std::vector<BallCell> balls = makeColumn(8);
  for (BallCell& ball : balls) ball.colour = {0x1p50f, -0x1p50f, 60000};
  AssetContents contents = makeBallAsset(balls);
  contents.detailSharpness = 0x1p20f;
  Stage stage(contents, {kSize, kSize});
  FrothRenderInfo info = infoOf(frontView(kSize));
  info.displayCoded = 0;
  for (const VkFormat format : {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
    const Frame frame = stage.draw(Method::kRaster, info, {kSize, kSize}, format);
    for (const float value : frame.colour.values) {
      ASSERT_GE(value, 0);
      ASSERT_LE(value, 65504);
    }
  }
}

uint64_t visibilityBytes(const FrothViewStatus& status) {
  for (uint32_t i = 0; i < status.memoryCount; ++i) {
    if (status.memory[i].name == std::string_view("visibility of all cells")) return status.memory[i].bytes;
  }
  ADD_FAILURE() << "no such memory";
  return 0;
}

// The passes over all cells have a workgroup, and 72 bytes of these buffers, per 256 cells of a chunk.
TEST(Limits, ChunksOfUnlikeSizeCostWhatTheirCellsDo) {
  constexpr uint32_t kLarge = 3000, kSmall = 300, kSize = 64;
  const std::vector<BallCell> cells = makeCloud(kLarge + kSmall);
  std::vector<uint32_t> sizes(kSmall + 1, 1);
  sizes[100] = kLarge;
  const auto draw = [](const AssetContents& contents) {
    return Stage(contents, {kSize, kSize}).draw(Method::kRaster, frontView(kSize));
  };
  const Frame expected = draw(makeBallAsset(cells)), found = draw(makeBallAsset(cells, sizes));
  EXPECT_EQ(found.colour.values, expected.colour.values);
  EXPECT_EQ(found.distance.values, expected.distance.values);
  EXPECT_LE(visibilityBytes(found.status), 72u * (kSmall + (kLarge + 255) / 256));
}

// A legal file; each chunk has a workgroup, and devices take as few as 65,535 along one axis.
TEST(Limits, SeventyThousandChunksOfOneCellAreDrawnAsOneChunk) {
  constexpr uint32_t kCount = 70000, kSize = 64;
  std::vector<BallCell> cells = makeCloud(kCount);
  for (BallCell& cell : cells) cell.site *= glm::vec3(12, 12, 4);  // most of them outside the view
  const auto draw = [](const AssetContents& contents) {
    return Stage(contents, {kSize, kSize}).draw(Method::kRaster, frontView(kSize));
  };
  const Frame expected = draw(makeBallAsset(cells)),
              found = draw(makeBallAsset(cells, std::vector<uint32_t>(kCount, 1)));
  EXPECT_EQ(found.status.bits, 0u);
  EXPECT_GT(found.status.visibleCells, 1000u);
  EXPECT_EQ(found.colour.values, expected.colour.values);
  EXPECT_EQ(found.distance.values, expected.distance.values);
}

uint32_t dispatchedX = 0, dispatchedY = 0;

VKAPI_ATTR void VKAPI_CALL noteDispatch(VkCommandBuffer, uint32_t x, uint32_t y, uint32_t) {
  dispatchedX = x;
  dispatchedY = y;
}

TEST(Limits, DispatchesOverListsFitWhatEveryDeviceTakes) {
  DeviceTable table;
  table.vkCmdDispatch = noteDispatch;
  for (const uint32_t groups : {0u, 1u, 65535u, 65536u, 70000u, 131071u, 100000000u}) {
    dispatchGroups(table, nullptr, groups);
    EXPECT_LE(dispatchedX, 65535u) << groups;
    EXPECT_LE(dispatchedY, 65535u) << groups;
    EXPECT_GE(uint64_t{dispatchedX} * dispatchedY, groups);
    EXPECT_LT(uint64_t{dispatchedX} * dispatchedY, uint64_t{groups} + std::max(dispatchedY, 1u))
        << "at most a row's rest too many";
  }
}

}  // namespace
}  // namespace froth::test
