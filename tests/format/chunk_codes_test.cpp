// The lattice indices that the reader hands out are those of its floats.
#include <gtest/gtest.h>

#include "base/float_span.h"
#include "file_surgery.h"
#include "format/lattice.h"
#include "format/read/asset_reader.h"
#include "sample_asset.h"

namespace froth {
namespace {

struct Read {
  AssetContents manifest;
  CodedChunk chunk;
};

Read readCodes(const AssetContents& contents, Layer last = Layer::kViewDependence) {
  const std::vector<uint8_t> bytes = encodeOrFail(contents);
  const Result<AssetReader> reader = AssetReader::openBytes(bytes, "sample", last);
  EXPECT_TRUE(reader);
  Result<CodedChunk> chunk = reader->readCodedChunk(0);
  EXPECT_TRUE(chunk);
  return {reader->manifest(), std::move(*chunk)};
}

// `cellOf`: of a number.
template <class CellOf>
void expectFloatsOfCodes(std::span<const float> floats, const std::vector<int32_t>& codes, float step,
                         const std::vector<uint8_t>& scales, CellOf cellOf, const char* name) {
  ASSERT_EQ(codes.size(), floats.size()) << name;
  ASSERT_FALSE(codes.empty()) << name;
  for (size_t i = 0; i < codes.size(); ++i) {
    ASSERT_EQ(static_cast<float>(codes[i]) * unitOf(step, scales, cellOf(i)), floats[i]) << name << ' ' << i;
  }
}

void expectFloatsOfCodes(const Read& read) {
  const auto& [contents, codes] = read.chunk;
  const Quantization& steps = read.manifest.quantization;
  const size_t details = read.manifest.detailCount;
  const auto cellOfPair = [&](size_t i) { return i / 2 / details; };
  const auto cellOfOne = [&](size_t i) { return i / details; };
  const auto cellOfColour = [&](size_t i) { return i / 3 / details; };
  expectFloatsOfCodes(floatsOf(contents.detailSites), codes.detailSites, steps.detailSiteStep, contents.detailScales,
                      cellOfPair, "detail sites");
  expectFloatsOfCodes(contents.detailHeights, codes.detailHeights, steps.heightStep, contents.detailScales, cellOfOne,
                      "heights");
  if (!contents.baseColours.empty()) {
    expectFloatsOfCodes(floatsOf(contents.baseColours), codes.baseColours, steps.colourStep, contents.colourScales,
                        cellOfColour, "base colours");
  }
  std::vector<size_t> cellOfLobe;
  for (size_t detail = 0; detail < contents.liveCount * details; ++detail) {
    const size_t count = contents.lobeCounts.empty() ? read.manifest.lobeCount : contents.lobeCounts[detail];
    cellOfLobe.insert(cellOfLobe.end(), count, detail / details);
  }
  expectFloatsOfCodes(
      floatsOf(contents.lobeAxes), codes.lobeAxes, codes.axisStep, {}, [](size_t) { return 0; }, "axes");
  expectFloatsOfCodes(
      floatsOf(contents.lobeColours), codes.lobeColours, steps.colourStep, contents.colourScales,
      [&](size_t i) { return cellOfLobe[i / 3]; }, "lobe colours");
  ASSERT_EQ(codes.normals.size(), contents.orientations.size());
  for (size_t cell = 0; cell < codes.normals.size(); ++cell) {
    EXPECT_EQ(orientationOfNormal(codes.normals[cell], steps.normalBits), contents.orientations[cell]);
  }
}

TEST(ChunkCodes, AreTheIndicesOfTheFloats) {
  expectFloatsOfCodes(readCodes(makeSampleAsset({.isQuantized = true})));
  expectFloatsOfCodes(readCodes(makeSampleAsset({.isQuantized = true, .hasLayers = true})));
  expectFloatsOfCodes(readCodes(makeSampleAsset({.isQuantized = true, .hasLayers = true, .codebookSize = 5})));
}

TEST(ChunkCodes, AreEmptyWithoutLattices) {
  const ChunkCodes codes = readCodes(makeSampleAsset({.hasLayers = true})).chunk.codes;
  EXPECT_TRUE(codes.normals.empty() && codes.detailSites.empty() && codes.detailHeights.empty());
  EXPECT_TRUE(codes.baseColours.empty() && codes.lobeAxes.empty() && codes.lobeColours.empty());
}

// Entries of the codebook are floats of any step; differences to them lie on the lattice.
TEST(ChunkCodes, HaveTheStepOfTheCodebookWhereItIsTheFinerOne) {
  AssetContents contents = makeSampleAsset({.isQuantized = true, .codebookSize = 5});
  const float step = readCodes(contents).chunk.codes.axisStep;
  EXPECT_EQ(step, commonStep(floatsOf(contents.axisCodebook)));
  EXPECT_LT(step, contents.quantization.lobeAxisStep);
}

TEST(ChunkCodes, HaveNoAxesWhereTheCodebookHasNoStep) {
  AssetContents contents = makeSampleAsset({.isQuantized = true, .codebookSize = 5});
  contents.axisCodebook.push_back({1e-30f, 1, 0});  // no lobe has it
  const Read read = readCodes(contents);
  EXPECT_TRUE(read.chunk.codes.lobeAxes.empty());
  EXPECT_EQ(read.chunk.contents.lobeAxes, contents.chunks[0].lobeAxes);
}

TEST(CommonStep, IsTheLargestOfWhichAllAreMultiples) {
  EXPECT_EQ(commonStep(std::vector<float>{0.75f, -1.5f, 0, 6}), 0.75f / 3);
  EXPECT_EQ(commonStep(std::vector<float>{0, 0}), 1);
  EXPECT_EQ(commonStep(std::vector<float>{0.5f, -0.0f}), 0);
  EXPECT_EQ(commonStep(std::vector<float>{1e-40f}), 0);
  EXPECT_EQ(commonStep(std::vector<float>{1, 0x1p24f}), 0);
  EXPECT_EQ(commonStep(std::vector<float>{1, 0x1p24f - 1}), 1);
}

// The heights of the cells stand for those of the detail sites, their colours for the base colours.
TEST(ChunkCodes, OfTheFirstLayerAloneAreThoseOfTheCells) {
  const Read read = readCodes(makeSampleAsset({.isQuantized = true, .hasLayers = true}), Layer::kGeometry);
  const auto& [contents, codes] = read.chunk;
  expectFloatsOfCodes(
      contents.detailHeights, codes.detailHeights, read.manifest.quantization.heightStep, {}, [](size_t) { return 0; },
      "heights");
  EXPECT_TRUE(codes.baseColours.empty());
  EXPECT_FALSE(contents.baseColours.empty());
}

}  // namespace
}  // namespace froth
