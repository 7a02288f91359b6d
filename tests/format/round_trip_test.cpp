// What the writer is given, the reader gives back.
#include <algorithm>

#include <gtest/gtest.h>

#include "asset_equality.h"
#include "file_surgery.h"
#include "format/asset_reader.h"
#include "sample_asset.h"

namespace froth {
namespace {

AssetContents decode(const std::vector<uint8_t>& bytes) {
  Result<AssetContents> contents = decodeAsset(bytes);
  if (contents) return *contents;
  ADD_FAILURE() << contents.error().message;
  return {};
}

void expectRoundTrip(const AssetContents& contents) {
  expectSameAsset(decode(encodeOrFail(contents)), contents);
}

TEST(RoundTrip, KeepsEveryBitOfEveryArray) {
  expectRoundTrip(makeSampleAsset());
}

TEST(RoundTrip, KeepsSeveralChunks) {
  expectRoundTrip(makeSampleAsset({.chunkCount = 3, .cellsPerChunk = 7, .localBits = 4}));
}

TEST(RoundTrip, KeepsAnAssetWithoutWalkGraph) {
  expectRoundTrip(makeSampleAsset({.hasWalkGraph = false}));
}

TEST(RoundTrip, KeepsAChunkWithoutLiveCells) {
  AssetContents contents = makeSampleAsset({.cellsPerChunk = 1});
  ChunkContents& chunk = contents.chunks[0];
  ASSERT_TRUE(chunk.neighbours.empty());
  chunk.liveCount = 0;
  chunk.alphaCounts.clear();
  chunk.densities.clear();
  chunk.orientations.clear();
  chunk.detailSites.clear();
  chunk.detailHeights.clear();
  chunk.lobeAxes.clear();
  chunk.lobeColours.clear();
  expectRoundTrip(contents);
}

TEST(RoundTrip, KeepsAnAssetWithoutCameras) {
  AssetContents contents = makeSampleAsset();
  contents.hasStartView = false;
  contents.startView = {};
  contents.flightPath.clear();
  contents.statistics = {};
  for (size_t length = 0; length < 16; ++length) {  // moves the empty path through every alignment
    contents.source.assign(length, 'x');
    expectRoundTrip(contents);
  }
}

TEST(RoundTrip, KeepsAnAssetOfManyCells) {
  AssetContents contents = makeSampleAsset({.cellsPerChunk = 300, .detailCount = 8, .lobeCount = 8});
  expectRoundTrip(contents);
}

TEST(RoundTrip, LeavesOutHeightsThatAreAllZero) {
  AssetContents contents = makeSampleAsset();
  std::fill(contents.chunks[0].detailHeights.begin(), contents.chunks[0].detailHeights.end(), 0.0f);
  EXPECT_TRUE(decode(encodeOrFail(contents)).chunks[0].detailHeights.empty());
}

// Arrays of equal numbers compress better than the format's limit of expansion allows; the writer pads them.
TEST(RoundTrip, KeepsArraysThatCompressExtremelyWell) {
  AssetContents contents = makeSampleAsset({.cellsPerChunk = 200, .detailCount = 32, .lobeCount = 32});
  for (glm::vec3& axis : contents.chunks[0].lobeAxes) axis = glm::vec3(0);
  for (glm::vec3& colour : contents.chunks[0].lobeColours) colour = glm::vec3(0.5f);
  const std::vector<uint8_t> bytes = encodeOrFail(contents);
  EXPECT_LT(bytes.size(), sizeof(glm::vec3) * contents.chunks[0].lobeAxes.size() / 4);
  expectSameAsset(decode(bytes), contents);
}

TEST(RoundTrip, GivesTheSameBytesForTheSameContents) {
  const SampleOptions options{.chunkCount = 2, .cellsPerChunk = 50, .localBits = 8};
  EXPECT_EQ(encodeOrFail(makeSampleAsset(options)), encodeOrFail(makeSampleAsset(options)));
}

TEST(RoundTrip, TellsTheBoundsOfLiveCellsBeforeASectionIsRead) {
  AssetContents contents = makeSampleAsset({.cellsPerChunk = 3});
  ASSERT_EQ(contents.chunks[0].liveCount, 2u);
  contents.chunks[0].sites = {{1, 2, 3}, {-4, 2, 3}, {100, 100, 100}};
  contents.chunks[0].radii = {0.5f, 1, 1};
  const std::vector<uint8_t> bytes = encodeOrFail(contents);
  Result<AssetReader> reader = AssetReader::openBytes(bytes, "memory");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->liveBounds(0).min, (std::array<double, 3>{-5, 1, 2}));
  EXPECT_EQ(reader->liveBounds(0).max, (std::array<double, 3>{1.5, 3, 4}));
}

}  // namespace
}  // namespace froth
