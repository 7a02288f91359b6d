// What verifyAsset finds in assets that read well.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "file_surgery.h"
#include "format/asset_reader.h"
#include "format/asset_writer.h"
#include "format/atomic_file.h"
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

std::string verifyContents(const AssetContents& contents) {
  return verifyBytes(encodeOrFail(contents));
}

// The first row of the first chunk.
std::span<CellRef> firstRow(AssetContents& contents) {
  ChunkContents& chunk = contents.chunks[0];
  return {chunk.neighbours.data(), chunk.neighbourOffsets[1]};
}

TEST(VerifyAsset, FindsNothingWrongWithAValidAsset) {
  EXPECT_EQ(verifyContents(makeSampleAsset()), "no error");
  EXPECT_EQ(verifyContents(makeSampleAsset({.hasWalkGraph = false})), "no error");
  EXPECT_EQ(verifyContents(makeSampleAsset({.chunkCount = 3, .cellsPerChunk = 5, .localBits = 16})),
            "no error");
  EXPECT_EQ(verifyContents(makeSampleAsset({.chunkCount = 3, .localBits = 30, .hasWalkGraph = false})),
            "no error");
}

TEST(VerifyAsset, FindsWhatReadingFinds) {
  EXPECT_THAT(verifyBytes({'n', 'o'}), HasSubstr("do not lie within"));
}

TEST(VerifyAsset, FindsACellThatIsItsOwnNeighbour) {
  AssetContents contents = makeSampleAsset();
  firstRow(contents)[0] = 0;
  EXPECT_THAT(verifyContents(contents), HasSubstr("section 'neighbours': cell 0 is its own neighbour"));
}

TEST(VerifyAsset, FindsANeighbourThatIsThereTwice) {
  AssetContents contents = makeSampleAsset();
  firstRow(contents)[1] = firstRow(contents)[0];
  EXPECT_THAT(verifyContents(contents), HasSubstr("cell 0 has a neighbour twice"));
  contents = makeSampleAsset();
  firstRow(contents).back() = firstRow(contents).front();  // once as alpha neighbour, once as another
  EXPECT_THAT(verifyContents(contents), HasSubstr("cell 0 has a neighbour twice"));
}

// Takes the last neighbour out of the first row, whose back reference stays.
TEST(VerifyAsset, FindsAPairOfOneDirection) {
  for (const uint32_t chunkCount : {1u, 3u}) {
    AssetContents contents =
        makeSampleAsset({.chunkCount = chunkCount, .localBits = chunkCount == 1 ? 32u : 8u});
    ChunkContents& chunk = contents.chunks[0];
    chunk.neighbours.erase(chunk.neighbours.begin() + chunk.neighbourOffsets[1] - 1);
    for (uint32_t cell = 1; cell <= chunk.cellCount; ++cell) --chunk.neighbourOffsets[cell];
    EXPECT_THAT(verifyContents(contents), HasSubstr("the graph holds one direction only"));
  }
}

TEST(VerifyAsset, FindsAnAlphaPairOfOneDirection) {
  AssetContents contents = makeSampleAsset();
  contents.chunks[0].alphaCounts[0] = 0;
  EXPECT_THAT(verifyContents(contents), HasSubstr("the alpha-complex holds one direction only"));
}

TEST(VerifyAsset, FindsOtherNeighboursWithoutAWalkGraph) {
  AssetContents contents = makeSampleAsset();
  contents.hasWalkGraph = false;
  EXPECT_THAT(verifyContents(contents), HasSubstr("the asset no walk graph"));
}

TEST(VerifyAsset, FindsARowThatIsNotNearestFirst) {
  AssetContents contents = makeSampleAsset({.cellsPerChunk = 12});
  ASSERT_GE(contents.chunks[0].alphaCounts[0], 2u);
  std::swap(firstRow(contents)[0], firstRow(contents)[1]);
  EXPECT_THAT(verifyContents(contents),
              HasSubstr("its plane is nearer than that of the neighbour before it"));
}

TEST(VerifyAsset, AcceptsEqualPlanesInAnyOrder) {
  AssetContents contents = makeSampleAsset({.cellsPerChunk = 3});
  ChunkContents& chunk = contents.chunks[0];
  chunk.sites = {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  chunk.radii = {1, 1, 1};
  chunk.alphaCounts = {2, 1};
  for (const std::array<CellRef, 2> row : {std::array<CellRef, 2>{1, 2}, std::array<CellRef, 2>{2, 1}}) {
    chunk.neighbours = {row[0], row[1], 0, 2, 0, 1};
    EXPECT_EQ(verifyContents(contents), "no error");
  }
}

TEST(VerifyAsset, FindsTwoNeighboursAtOnePoint) {
  AssetContents contents = makeSampleAsset();
  contents.chunks[0].sites[firstRow(contents)[0]] = contents.chunks[0].sites[0];
  EXPECT_THAT(verifyContents(contents), HasSubstr("the same point"));
}

TEST(VerifyAsset, FindsAFrameThatIsNoRotation) {
  AssetContents contents = makeSampleAsset();
  contents.chunks[0].orientations[2] = {2, 0, 0, 0};
  EXPECT_THAT(
      verifyContents(contents),
      AllOf(HasSubstr("section 'orientations': cell 2: quaternion of length 2, not 1"), HasSubstr("bake")));
}

TEST(VerifyAsset, FindsBoundsThatAreNotThoseOfTheCells) {
  const std::vector<uint8_t> bytes = withChunk(encodeOrFail(makeSampleAsset()), [](fb::Chunk& c) {
    c = fb::Chunk(c.origin(), c.cell_count(), c.live_count(), c.neighbour_count(), fb::Box());
  });
  EXPECT_THAT(verifyBytes(bytes), HasSubstr("live_bounds"));
}

}  // namespace
}  // namespace froth
