// A chunk's numbers as bits: what a shader reads is what the file holds, at a cost that follows the numbers.
#include <bit>
#include <map>

#include <gtest/gtest.h>

#include "format/lattice.h"
#include "runtime/asset/axis_labels.h"
#include "runtime/asset/cell_packer.h"
#include "tests/format/sample_asset.h"

namespace froth {
namespace {

// `width` bits behind `bit`.
uint32_t bitsAt(const std::vector<uint32_t>& words, uint64_t bit, uint32_t width) {
  const uint64_t both = words[bit / 32] | uint64_t{words[bit / 32 + 1]} << 32;
  return static_cast<uint32_t>(both >> bit % 32 & ((uint64_t{1} << width) - 1));
}

// So no one has to search for an axis: neither the table's, nor those that a cell writes out.
TEST(AxisLabels, AreEqualExactlyWhereAxesAre) {
  CellNumbers axes;
  for (int32_t lobe = 0; lobe < 4000; ++lobe) {
    const int32_t axis = lobe % 2 == 0 ? lobe % 16 : lobe;  // few that are used often, many that are used once or twice
    axes.codes.insert(axes.codes.end(), {axis % 3000, -axis % 3000, 500});
  }
  const AxisLabels labels = labelAxes(axes);
  EXPECT_GE(labels.table.size(), 8u);
  EXPECT_LT(labels.table.size(), labels.axisCount);
  ASSERT_EQ(labels.labels.size(), 4000u);
  std::map<AxisCode, uint32_t> labelOf;
  std::map<uint32_t, AxisCode> axisOf;
  for (size_t lobe = 0; lobe < labels.labels.size(); ++lobe) {
    const AxisCode axis = {axes.codes[3 * lobe], axes.codes[3 * lobe + 1], axes.codes[3 * lobe + 2]};
    const uint32_t label = labels.labels[lobe];
    EXPECT_EQ(labelOf.emplace(axis, label).first->second, label);
    EXPECT_EQ(axisOf.emplace(label, axis).first->second, axis);
    EXPECT_LT(label, labels.axisCount);
    if (label < labels.table.size()) {
      EXPECT_EQ(labels.table[label], axis);
    }
  }
  EXPECT_EQ(axisOf.size(), labels.axisCount);
}

// Of any sign, as a damaged file may have them; the sanitizers watch the arithmetic.
TEST(PackedCells, GiveDensitiesBackBitForBit) {
  AssetContents sample = makeSampleAsset({.cellsPerChunk = 12});
  ChunkContents& chunk = sample.chunks[0];
  for (const std::vector<float>& some : {std::vector<float>{0.3f, -0.0f, 1.1f}, {0.0f, 3e38f, 1e-45f}, {2, 4, 1}}) {
    for (size_t cell = 0; cell < chunk.densities.size(); ++cell) chunk.densities[cell] = some[cell % some.size()];
    const Result<PackedCells> packed = packCells(chunk, {}, sample);
    ASSERT_TRUE(packed);
    for (size_t cell = 0; cell < chunk.densities.size(); ++cell) {
      const uint32_t code = bitsAt(packed->words, uint64_t{packed->starts[cell]} * 8, packed->code.densityBits);
      EXPECT_EQ((code + packed->code.densityLowest) << packed->code.densityShift,
                std::bit_cast<uint32_t>(chunk.densities[cell]));
    }
  }
}

TEST(CellNumbers, OfALatticeAreItsIndicesInTheFinestStepOfACell) {
  const CellNumbers numbers = toNumbers({1, -2, 3, 4}, 0.25f, {}, std::vector<uint8_t>{3, 1});
  EXPECT_EQ(numbers.step, 0.5f);
  EXPECT_EQ(numbers.codes, (std::vector<int32_t>{4, -8, 3, 4}));
  EXPECT_EQ(toColourNumbers({1, 5, 2}, 0.25f, {}).codes, (std::vector<int32_t>{5, -4, -3}));
}

// A shader makes floats of them.
TEST(CellNumbers, AreFloatsWhereAnIndexIsTooLargeForOne) {
  const std::vector<float> values{2.5f, 1e6f};
  const CellNumbers numbers = toNumbers({1, kMaxLatticeIndex}, 0.25f, values, std::vector<uint8_t>{0, 1});
  EXPECT_TRUE(numbers.isRaw());
  EXPECT_EQ(numbers.codes, (std::vector<int32_t>{std::bit_cast<int32_t>(2.5f), std::bit_cast<int32_t>(1e6f)}));
  EXPECT_FALSE(toNumbers({1, kMaxLatticeIndex}, 0.25f, values, std::vector<uint8_t>{1, 1}).isRaw());
}

TEST(CellNumbers, ThatAreAllZeroNeedNoBits) {
  EXPECT_FALSE(toNumbers({}, 0, std::vector<float>{0, 0}).isRaw());
  EXPECT_TRUE(toNumbers({}, 0, std::vector<float>{0, 1}).isRaw());
  EXPECT_TRUE(toNumbers({}, 0, std::vector<float>{0, -0.0f}).isRaw());
}

}  // namespace
}  // namespace froth
