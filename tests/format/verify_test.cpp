// What verifyAsset finds in assets that read well.
#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "file_surgery.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "sample_asset.h"

namespace froth {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string verifyBytes(const std::vector<uint8_t>& bytes) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) /
      (std::string("verify_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".froth");
  EXPECT_TRUE(writeFileAtomically(path, bytes));
  const Status status = verifyAsset(path);
  std::filesystem::remove(path);
  return status ? "no error" : status.error().message;
}

std::string verifyContents(const AssetContents& contents) { return verifyBytes(encodeOrFail(contents)); }

AssetContents twoChunks() { return makeSampleAsset({.chunkCount = 2, .localBits = 8}); }

TEST(VerifyAsset, FindsNothingWrongWithAValidAsset) {
  EXPECT_EQ(verifyContents(makeSampleAsset()), "no error");
  EXPECT_EQ(verifyContents(makeSampleAsset({.hasWalkGraph = false})), "no error");
  EXPECT_EQ(verifyContents(makeSampleAsset({.chunkCount = 3, .cellsPerChunk = 5, .localBits = 16})), "no error");
  EXPECT_EQ(verifyContents(makeSampleAsset({.chunkCount = 3, .localBits = 30, .hasWalkGraph = false})), "no error");
  EXPECT_EQ(verifyContents(makeSampleAsset({.chunkCount = 3,
                                            .cellsPerChunk = 40,
                                            .localBits = 14,
                                            .isQuantized = true,
                                            .hasLayers = true,
                                            .codebookSize = 9})),
            "no error");
}

TEST(VerifyAsset, FindsWhatReadingFinds) { EXPECT_THAT(verifyBytes({'n', 'o'}), HasSubstr("do not lie within")); }

// Takes the pair of cell 0 and the first ghost out of chunk 0; chunk 1 keeps it.
TEST(VerifyAsset, FindsAPairThatOneChunkAloneKnows) {
  AssetContents contents = twoChunks();
  ChunkContents& chunk = contents.chunks[0];
  const auto first = chunk.neighbours.begin();
  const auto ghost = std::find(first, first + chunk.neighbourOffsets[1], chunk.cellCount);
  const bool isAlpha = ghost - first < chunk.alphaCounts[0];
  chunk.neighbours.erase(ghost);
  if (isAlpha) --chunk.alphaCounts[0];
  for (uint32_t cell = 1; cell <= chunk.cellCount; ++cell) --chunk.neighbourOffsets[cell];
  EXPECT_THAT(verifyContents(contents), HasSubstr("the graph holds one direction only"));
}

// The first row's alpha part ends before its last alpha neighbour that is a live ghost's.
TEST(VerifyAsset, FindsAnAlphaPairThatOneChunkAloneKnows) {
  AssetContents contents = twoChunks();
  ChunkContents& chunk = contents.chunks[0];
  const auto first = chunk.neighbours.begin(), end = first + chunk.alphaCounts[0];
  const auto ghost = std::find_if(first, end, [&](uint32_t site) {
    return site >= chunk.cellCount && site - chunk.cellCount < contents.chunks[1].liveCount;
  });
  ASSERT_NE(ghost, end);
  std::rotate(ghost, ghost + 1, end);
  --chunk.alphaCounts[0];
  EXPECT_THAT(verifyContents(contents), HasSubstr("the alpha-complex holds one direction only"));
}

TEST(VerifyAsset, FindsAGhostThatIsNotItsCell) {
  for (const bool isQuantized : {false, true}) {
    const AssetContents valid = makeSampleAsset({.chunkCount = 2, .localBits = 8, .isQuantized = isQuantized});
    AssetContents contents = valid;
    contents.chunks[1].sites.back().y += 0x1p-12f;
    EXPECT_THAT(verifyContents(contents), HasSubstr("chunk 1: ghost 5 is not where cell 5 of chunk 0 is"));
    contents = valid;
    contents.chunks[1].radii.back() += 0x1p-9f;
    EXPECT_THAT(verifyContents(contents), HasSubstr("chunk 1: ghost 5 is not where cell 5 of chunk 0 is"));
  }
}

TEST(VerifyAsset, FindsTwoNeighboursAtOnePoint) {
  AssetContents contents = makeSampleAsset();
  contents.chunks[0].sites[1] = contents.chunks[0].sites[0];
  EXPECT_THAT(verifyContents(contents), HasSubstr("the same point"));
}

TEST(VerifyAsset, FindsBoundsThatAreNotThoseOfTheCells) {
  Draft draft = draftOf(makeSampleAsset());
  draft.chunks[0].liveBounds = {};
  EXPECT_THAT(verifyBytes(draft.assemble()), HasSubstr("live_bounds"));
}

}  // namespace
}  // namespace froth
