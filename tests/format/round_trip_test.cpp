// What the writer is given, the reader gives back.
#include <algorithm>

#include <gtest/gtest.h>

#include "asset_equality.h"
#include "file_surgery.h"
#include "format/lattice.h"
#include "format/read/asset_reader.h"
#include "sample_asset.h"

namespace froth {
namespace {

AssetContents decode(const std::vector<uint8_t>& bytes, Layer last = Layer::kViewDependence) {
  Result<AssetContents> contents = decodeAsset(bytes, last);
  if (contents) return *contents;
  ADD_FAILURE() << contents.error().message;
  return {};
}

void expectRoundTrip(const AssetContents& contents) { expectSameAsset(decode(encodeOrFail(contents)), contents); }

TEST(RoundTrip, KeepsEveryBitOfEveryArray) {
  expectRoundTrip(makeSampleAsset());
  expectRoundTrip(makeSampleAsset({.hasLayers = true}));
}

TEST(RoundTrip, KeepsEveryBitOfValuesOnLattices) {
  expectRoundTrip(makeSampleAsset({.isQuantized = true}));
  expectRoundTrip(makeSampleAsset({.isQuantized = true, .hasLayers = true}));
}

TEST(RoundTrip, KeepsEveryCombinationOfWhatAnAssetMayHave) {
  for (uint32_t choice = 0; choice < 128; ++choice) {
    const auto has = [choice](uint32_t bit) { return (choice >> bit & 1) != 0; };
    SCOPED_TRACE("combination " + std::to_string(choice));
    expectRoundTrip(makeSampleAsset({.chunkCount = has(0) ? 3u : 1u,
                                     .cellsPerChunk = 7,
                                     .localBits = 5,
                                     .detailCount = has(1) ? 3u : 1u,
                                     .lobeCount = has(2) ? 3u : 0u,
                                     .hasHeights = has(3),
                                     .hasWalkGraph = has(4),
                                     .isQuantized = has(5),
                                     .hasLayers = has(6),
                                     .codebookSize = has(2) && has(5) ? 5u : 0u}));
  }
}

TEST(RoundTrip, KeepsAxesThatAreEntriesOfACodebookWithoutLattice) {
  expectRoundTrip(makeSampleAsset({.codebookSize = 3}));
}

TEST(RoundTrip, KeepsChunksOfDifferentLattices) {
  AssetContents contents = makeSampleAsset({.chunkCount = 2, .localBits = 8});
  contents.quantization.heightStep = 0x1p-6f;  // heights alone lie on a lattice
  for (ChunkContents& chunk : contents.chunks) {
    for (float& height : chunk.detailHeights) height = snapToStep(height, contents.quantization.heightStep);
  }
  expectRoundTrip(contents);
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
  contents.errors.clear();
  contents.eyes = {};
  for (size_t length = 0; length < 16; ++length) {  // moves the empty path through every alignment
    contents.source.assign(length, 'x');
    expectRoundTrip(contents);
  }
}

TEST(RoundTrip, KeepsAnAssetOfManyCells) {
  expectRoundTrip(makeSampleAsset({.cellsPerChunk = 300, .detailCount = 8, .lobeCount = 8}));
  expectRoundTrip(makeSampleAsset({.chunkCount = 2,
                                   .cellsPerChunk = 200,
                                   .localBits = 14,
                                   .detailCount = 8,
                                   .lobeCount = 8,
                                   .isQuantized = true,
                                   .hasLayers = true,
                                   .codebookSize = 300}));
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

// ---- What is left out ----

size_t countSections(const AssetContents& contents, SectionType type) {
  const Draft draft = draftOf(contents);
  return static_cast<size_t>(
      std::count_if(draft.records.begin(), draft.records.end(),
                    [&](const SectionRecord& record) { return record.type == static_cast<uint32_t>(type); }));
}

TEST(RoundTrip, LeavesOutArraysThatSayNothing) {
  AssetContents contents = makeSampleAsset({.isQuantized = true, .hasLayers = true});
  ChunkContents& chunk = contents.chunks[0];
  std::fill(chunk.detailHeights.begin(), chunk.detailHeights.end(), 0.0f);
  std::fill(chunk.cellHeights.begin(), chunk.cellHeights.end(), 0.0f);
  std::fill(chunk.solidBalls.begin(), chunk.solidBalls.end(), kWholeBall);
  std::fill(chunk.detailSites.begin(), chunk.detailSites.end(), glm::vec2(0));
  std::fill(chunk.baseColours.begin(), chunk.baseColours.end(), glm::vec3(0));
  std::fill(chunk.colourScales.begin(), chunk.colourScales.end(), uint8_t{0});
  std::fill(chunk.detailScales.begin(), chunk.detailScales.end(), uint8_t{0});
  for (const SectionType type :
       {SectionType::kDetailHeights, SectionType::kCellHeights, SectionType::kDetailSites, SectionType::kBaseColours,
        SectionType::kColourScales, SectionType::kDetailScales, SectionType::kSolidBalls}) {
    EXPECT_EQ(countSections(contents, type), 0u) << sectionName(static_cast<uint32_t>(type));
  }
  const ChunkContents found = decode(encodeOrFail(contents)).chunks[0];
  EXPECT_TRUE(found.detailHeights.empty());
  EXPECT_TRUE(found.cellHeights.empty());
  EXPECT_TRUE(found.solidBalls.empty());
  EXPECT_TRUE(found.baseColours.empty());
  EXPECT_TRUE(found.colourScales.empty());
  EXPECT_TRUE(found.detailScales.empty());
  EXPECT_TRUE(haveSameBits(found.detailSites, chunk.detailSites));
}

TEST(RoundTrip, LeavesOutLobeCountsThatAreAllTheSame) {
  AssetContents contents = makeSampleAsset();
  EXPECT_EQ(countSections(contents, SectionType::kLobeCounts), 0u);
  ChunkContents& chunk = contents.chunks[0];
  chunk.lobeCounts.assign(chunk.liveCount * contents.detailCount, 0);
  chunk.lobeAxes.clear();
  chunk.lobeColours.clear();
  EXPECT_EQ(countSections(contents, SectionType::kLobeCounts), 0u);
  expectRoundTrip(contents);
}

TEST(RoundTrip, LeavesOutWhatAxesDifferByFromTheCodebookIfItIsNothing) {
  AssetContents contents = makeSampleAsset({.isQuantized = true, .codebookSize = 4});
  EXPECT_EQ(countSections(contents, SectionType::kLobeAxes), 1u);
  for (glm::vec3& axis : contents.chunks[0].lobeAxes) axis = contents.axisCodebook[2];
  EXPECT_EQ(countSections(contents, SectionType::kLobeAxes), 0u);
  expectRoundTrip(contents);
}

// ---- Layers ----

TEST(Layers, StandInTheFileInTheirOrder) {
  const AssetContents contents =
      makeSampleAsset({.chunkCount = 3, .localBits = 8, .isQuantized = true, .hasLayers = true, .codebookSize = 4});
  std::vector<SectionRecord> records = draftOf(contents).records;
  std::sort(records.begin(), records.end(), [](const auto& a, const auto& b) { return a.offset < b.offset; });
  EXPECT_EQ(records[0].chunk, kSharedChunk);
  const auto place = [](const SectionRecord& record) {
    return std::pair(sectionLayer(static_cast<SectionType>(record.type)), record.chunk);
  };
  EXPECT_TRUE(std::is_sorted(records.begin() + 1, records.end(),
                             [&](const auto& a, const auto& b) { return place(a) < place(b); }));
  EXPECT_EQ(place(records.back()), std::pair(Layer::kViewDependence, 2u));
}

TEST(Layers, GeometryAloneIsOneDetailSitePerCellOfTheCellsColourAndHeight) {
  for (const bool isQuantized : {false, true}) {
    const AssetContents contents = makeSampleAsset({.isQuantized = isQuantized, .hasLayers = true});
    const AssetContents found = decode(encodeOrFail(contents), Layer::kGeometry);
    const ChunkContents &chunk = found.chunks[0], &full = contents.chunks[0];
    EXPECT_EQ(found.detailCount, 1u);
    EXPECT_EQ(found.lobeCount, 0u);
    EXPECT_TRUE(haveSameBits(chunk.sites, full.sites));
    EXPECT_TRUE(haveSameBits(chunk.neighbours, full.neighbours));
    EXPECT_TRUE(haveSameBits(chunk.orientations, full.orientations));
    EXPECT_TRUE(haveSameBits(chunk.detailHeights, full.cellHeights));
    EXPECT_EQ(chunk.detailSites, std::vector<glm::vec2>(full.liveCount, glm::vec2(0)));
    ASSERT_EQ(chunk.baseColours.size(), full.liveCount);
    EXPECT_EQ(chunk.baseColours[1], full.cellColours[1] - 0.5f);
    EXPECT_TRUE(chunk.lobeCounts.empty() && chunk.lobeAxes.empty() && chunk.lobeColours.empty());
  }
}

TEST(Layers, GeometryAloneOfAnAssetWithoutCellColoursIsGrey) {
  const ChunkContents chunk = decode(encodeOrFail(makeSampleAsset()), Layer::kGeometry).chunks[0];
  EXPECT_TRUE(chunk.baseColours.empty());
  EXPECT_TRUE(chunk.detailHeights.empty());
}

TEST(Layers, DetailsAreAllButTheLobes) {
  const AssetContents contents = makeSampleAsset({.isQuantized = true, .hasLayers = true, .codebookSize = 4});
  AssetContents expected = contents;
  expected.lobeCount = 0;
  expected.axisCodebook.clear();
  expected.chunks[0].lobeCounts.clear();
  expected.chunks[0].lobeAxes.clear();
  expected.chunks[0].lobeColours.clear();
  expectSameAsset(decode(encodeOrFail(contents), Layer::kDetails), expected);
}

// Sections of the layers behind the last one may be anything.
TEST(Layers, BehindTheLastOneAreNotRead) {
  const AssetContents contents = makeSampleAsset({.isQuantized = true, .hasLayers = true, .codebookSize = 4});
  std::vector<uint8_t> bytes = encodeOrFail(contents);
  for (const SectionRecord& record : draftOf(contents).records) {
    if (sectionLayer(static_cast<SectionType>(record.type)) == Layer::kViewDependence) {
      std::fill_n(bytes.begin() + static_cast<ptrdiff_t>(record.offset), record.storedSize, uint8_t{0xaa});
    }
  }
  EXPECT_FALSE(decodeAsset(bytes));
  EXPECT_TRUE(decodeAsset(bytes, Layer::kDetails));
}

}  // namespace
}  // namespace froth
