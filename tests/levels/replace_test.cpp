// Another file takes the place of an asset while frames go on (froth_replace.h).
#include "froth/froth_replace.h"

#include <gtest/gtest.h>

#include "tests/levels/streamed.h"
#include "tests/surroundings.h"

namespace froth::test {
namespace {

const std::filesystem::path kWithoutLevels = sourceFolder() / "tests/format/golden/version_2_0.froth";
constexpr int kMostLoadingFrames = 100;

const AssetContents& otherSample() {
  static const AssetContents sample = makeLevelSample({.cellCount = 500, .seed = 2});
  return sample;
}

FrothResult replaceBy(Streamed& streamed, Reader& reader) {
  reader.context = streamed.context();
  const FrothReader described = reader.describe();
  auto info = makeStruct<FrothAssetInfo>();
  info.reader = &described;
  return frothReplaceAsset(streamed.context(), streamed.asset(), &info);
}

FrothResult replaceBy(Streamed& streamed, const std::filesystem::path& path) {
  const std::string text = path.string();
  auto info = makeStruct<FrothAssetInfo>();
  info.path = text.c_str();
  return frothReplaceAsset(streamed.context(), streamed.asset(), &info);
}

FrothReplacementStatus replacementOf(const Streamed& streamed) {
  auto status = makeStruct<FrothReplacementStatus>();
  check(frothGetReplacement(streamed.context(), streamed.asset(), &status), "frothGetReplacement");
  return status;
}

// Frames until it has ended; all of them show the asset.
FrothReplacementStatus flyUntilReplaced(Streamed& streamed) {
  EXPECT_EQ(replacementOf(streamed).state, FROTH_REPLACEMENT_LOADING);
  for (int i = 0; i < kMostLoadingFrames && replacementOf(streamed).state == FROTH_REPLACEMENT_LOADING; ++i) {
    streamed.frame(i % 8 < 4 ? kNear : kBetween, i % 2 == 1);
    EXPECT_TRUE(streamed.isWhole) << "frame " << i;
    EXPECT_TRUE(streamed.isReady());
  }
  return replacementOf(streamed);
}

uint32_t cellsOf(const AssetContents& contents) {
  uint32_t cells = 0;
  for (uint32_t chunk = 0; chunk < contents.chunks.size(); ++chunk) {
    if (contents.levels[chunk].madeBy == kNoGroup) cells += contents.chunks[chunk].cellCount;
  }
  return cells;
}

TEST(Replace, ShowsTheOldFileUntilTheNewOneIsThereAndGoesOnStreaming) {
  Reader reader, other(otherSample());
  Streamed streamed(reader);
  streamed.settle(kNear);
  EXPECT_EQ(replacementOf(streamed).state, FROTH_REPLACEMENT_NONE);
  ASSERT_EQ(replaceBy(streamed, other), FROTH_OK);
  EXPECT_EQ(streamed.drawn(), finestCut());
  EXPECT_EQ(flyUntilReplaced(streamed).state, FROTH_REPLACEMENT_DONE);
  EXPECT_EQ(streamed.assetStatus().chunkCount, otherSample().chunks.size());
  streamed.settle(kNear);
  uint64_t drawnCells = 0;
  for (const uint32_t chunk : streamed.drawn()) drawnCells += otherSample().chunks[chunk].cellCount;
  EXPECT_EQ(drawnCells, cellsOf(otherSample()));
  streamed.settle(kFar);
  EXPECT_LT(streamed.drawn().size(), otherSample().chunks.size() / 2);
  EXPECT_TRUE(streamed.messages.empty()) << streamed.messages.front();
}

TEST(Replace, BringsAFileWithoutLevelsAndBack) {
  Reader reader, other(otherSample());
  Streamed streamed(reader);
  streamed.settle(kNear);
  ASSERT_EQ(replaceBy(streamed, kWithoutLevels), FROTH_OK);
  EXPECT_EQ(flyUntilReplaced(streamed).state, FROTH_REPLACEMENT_DONE) << streamed.messages.front();
  EXPECT_TRUE(streamed.drawn().empty());
  for (int i = 0; i < 3; ++i) streamed.frame(kNear);
  EXPECT_TRUE(streamed.isWhole);
  EXPECT_EQ(streamed.status().usedBytes, 0u);
  ASSERT_EQ(replaceBy(streamed, other), FROTH_OK);
  EXPECT_EQ(flyUntilReplaced(streamed).state, FROTH_REPLACEMENT_DONE);
  streamed.settle(kNear);
  EXPECT_FALSE(streamed.drawn().empty());
}

TEST(Replace, KeepsTheOldFileIfTheNewOneIsBroken) {
  Reader reader;
  Streamed streamed(reader);
  streamed.settle(kNear);
  ASSERT_EQ(replaceBy(streamed, sourceFolder() / "README.md"), FROTH_OK);
  const FrothReplacementStatus status = flyUntilReplaced(streamed);
  EXPECT_EQ(status.state, FROTH_REPLACEMENT_FAILED);
  EXPECT_LT(status.error, FROTH_OK);
  ASSERT_EQ(streamed.messages.size(), 1u);
  EXPECT_NE(streamed.messages.front().find("does not replace"), std::string::npos) << streamed.messages.front();
  streamed.settle(kNear);
  EXPECT_EQ(streamed.drawn(), finestCut());
}

TEST(Replace, ShowsTheNewestOfTwo) {
  Reader reader, first(otherSample()), second;
  Streamed streamed(reader);
  streamed.settle(kNear);
  ASSERT_EQ(replaceBy(streamed, first), FROTH_OK);
  streamed.frame(kNear);
  ASSERT_EQ(replaceBy(streamed, second), FROTH_OK);
  EXPECT_EQ(flyUntilReplaced(streamed).state, FROTH_REPLACEMENT_DONE);
  EXPECT_EQ(streamed.assetStatus().chunkCount, levelSample().chunks.size());
  streamed.settle(kNear);
  EXPECT_EQ(streamed.drawn(), finestCut());
}

TEST(Replace, NeverPassesTheBudget) {
  Reader reader, other(otherSample());
  uint64_t whole = 0;
  {
    Streamed unlimited(reader);
    unlimited.settle(kNear);
    whole = unlimited.mostBytes;
  }
  uint32_t done = 0;
  for (const uint64_t sixteenths : {10, 16, 24}) {
    Streamed streamed(reader, whole * sixteenths / 16);
    streamed.settle(kNear);
    ASSERT_EQ(replaceBy(streamed, other), FROTH_OK);
    for (int i = 0; i < kMostLoadingFrames / 2; ++i) streamed.frame(kNear);
    const FrothReplacementStatus status = replacementOf(streamed);
    done += status.state == FROTH_REPLACEMENT_DONE ? 1 : 0;
    if (status.state != FROTH_REPLACEMENT_DONE) {
      EXPECT_EQ(status.error, FROTH_ERROR_MEMORY);
    }
    EXPECT_LE(streamed.mostBytes, whole * sixteenths / 16);
    streamed.settle(kNear);
  }
  EXPECT_GT(done, 0u);
}

TEST(Replace, NeedsAnAssetThatIsDrawn) {
  Reader reader, other(otherSample());
  Streamed streamed(reader);
  EXPECT_EQ(replaceBy(streamed, other), FROTH_ERROR_STATE);
  streamed.settle(kFar);
  const auto nothing = makeStruct<FrothAssetInfo>();
  EXPECT_EQ(frothReplaceAsset(streamed.context(), streamed.asset(), &nothing), FROTH_ERROR_ARGUMENT);
  ASSERT_EQ(replaceBy(streamed, other), FROTH_OK);
  streamed.close();  // ends what loads
  EXPECT_EQ(replaceBy(streamed, other), FROTH_ERROR_HANDLE);
  auto status = makeStruct<FrothReplacementStatus>();
  EXPECT_EQ(frothGetReplacement(streamed.context(), streamed.asset(), &status), FROTH_ERROR_HANDLE);
}

}  // namespace
}  // namespace froth::test
