// Cells in few bits draw the images of cells in floats.
#include <cmath>

#include <gtest/gtest.h>

#include "format/quantization.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "runtime/asset/bit_writer.h"
#include "runtime/asset/cell_packer.h"
#include "runtime/query/packed_elements.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kDetails = 3, kLobes = 4, kNormalBits = 10;

// In the middle of the foam, so that there are cells behind it.
View viewFromWithin() { return lookAt({0, 0, 2.6}, {0.1, 0, 4}, 96, 64, 0.7); }

template <class Vector>
Vector snap(Vector values, float step) {
  for (int c = 0; c < values.length(); ++c) values[c] = snapToStep(values[c], step);
  return values;
}

// Everything on a lattice, colours in steps by cell, most axes from a small set, some detail sites without
// lobes.
void snapToLattices(ChunkContents& chunk) {
  for (glm::vec2& site : chunk.detailSites) site = snap(site, 0x1p-6f);
  for (auto* heights : {&chunk.cellHeights, &chunk.detailHeights}) {
    for (float& height : *heights) height = snapToStep(height, 0x1p-5f);
  }
  chunk.lobeCounts.clear();
  std::vector<glm::vec3> axes, colours;
  for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
    chunk.orientations[cell] = orientationOfNormal({cell * 97 % 1023, cell * 31 % 1023}, kNormalBits);
    chunk.colourScales.push_back(static_cast<uint8_t>(cell % 3));
    const float unit = std::ldexp(0x1p-6f, cell % 3);
    for (uint32_t site = cell * kDetails; site < (cell + 1) * kDetails; ++site) {
      const float level = static_cast<float>(cell % 7) - 3;
      chunk.baseColours.push_back(unit * glm::vec3(level, level + static_cast<float>(site % 3), 2 - level));
      chunk.lobeCounts.push_back(static_cast<uint8_t>(site % (kLobes + 1)));
      for (uint32_t lobe = 0; lobe < site % (kLobes + 1); ++lobe) {
        const glm::vec3& axis = chunk.lobeAxes[site % 11 == 0 ? site * kLobes + lobe : lobe];
        axes.push_back(snap(axis, 0x1p-5f));
        colours.push_back(snap(chunk.lobeColours[site * kLobes + lobe], unit));
      }
    }
  }
  chunk.lobeAxes = axes;
  chunk.lobeColours = colours;
}

AssetContents latticeAsset() {
  AssetContents contents = bakeForTest(makeRandomFoam(300, kDetails, kLobes, 5));
  snapToLattices(contents.chunks[0]);
  contents.quantization.normalBits = kNormalBits;
  contents.quantization.detailSiteStep = contents.quantization.colourStep = 0x1p-6f;
  contents.quantization.heightStep = contents.quantization.lobeAxisStep = 0x1p-5f;
  return contents;
}

// The same numbers, which the file does not know to lie on lattices.
AssetContents withoutLattices(AssetContents contents) {
  contents.quantization = {};
  contents.chunks[0].colourScales.clear();
  return contents;
}

size_t packedWords(const AssetContents& contents) {
  const std::vector<uint8_t> bytes = *encodeAsset(contents);
  const Result<AssetReader> reader = AssetReader::openBytes(bytes, "packed");
  const CodedChunk coded = *reader->readCodedChunk(0);
  return packCells(coded.contents, coded.codes, reader->manifest())->words.size();
}

TEST(PackedCells, DrawTheImagesOfFloatsBitForBit) {
  AssetContents packed = latticeAsset();
  // With octahedral normals, which the shaders compute again, an image is not the same bit for bit.
  packed.quantization.normalBits = 0;
  const AssetContents floats = withoutLattices(packed);
  EXPECT_LT(2 * packedWords(packed), packedWords(floats));
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame few = Stage(packed, {96, 64}).draw(method, viewFromWithin());
    const Frame all = Stage(floats, {96, 64}).draw(method, viewFromWithin());
    EXPECT_EQ(few.colour.values, all.colour.values);
    EXPECT_EQ(few.distance.values, all.distance.values);
    EXPECT_EQ(few.normal.values, all.normal.values);
  }
}

TEST(PackedCells, WithOctahedralNormalsDrawTheImagesOfFloats) {
  const AssetContents packed = latticeAsset();
  const Frame few = Stage(packed, {96, 64}).draw(Method::kRaster, viewFromWithin());
  const Frame all = Stage(withoutLattices(packed), {96, 64}).draw(Method::kRaster, viewFromWithin());
  EXPECT_GE(psnr(few.colour, all.colour), 90);
  EXPECT_GE(psnr(few.normal, all.normal), 90);
  AssetContents quaternions = packed;
  quaternions.quantization.normalBits = 0;
  EXPECT_LT(packedWords(packed), packedWords(quaternions));
}

TEST(PackedElements, TakeTheFewestBitsThatHoldTheLargest) {
  EXPECT_EQ(packElements({1, 255, 3}).words, (std::vector<uint32_t>{0x03ff01}));
  EXPECT_EQ(packElements({1, 256, 3}).words, (std::vector<uint32_t>{0x01000001, 3}));
  EXPECT_EQ(packElements({1, 65535}).shift, 1u);
  EXPECT_EQ(packElements({1, 65536}).words, (std::vector<uint32_t>{1, 65536}));
  EXPECT_TRUE(packElements({}).words.empty());
}

TEST(BitWriter, HasTwoWordsBehindAFullOneForReadersOfNoBits) {
  BitWriter bits;
  bits.put(7, 32);
  EXPECT_EQ(bits.finish(), (std::vector<uint32_t>{7, 0, 0}));
}

TEST(BitWriter, PutsNumbersAcrossWords) {
  BitWriter bits;
  bits.put(0xfffffff5, 4);
  bits.put(0x89abcdef, 32);
  bits.put(7, 0);
  EXPECT_EQ(bits.startByte(), 5u);
  bits.put(1, 1);
  EXPECT_EQ(bits.finish(), (std::vector<uint32_t>{0x9abcdef5, 0x108, 0}));
}

}  // namespace
}  // namespace froth::test
