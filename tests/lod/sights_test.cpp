// In which views merged cells show: those of what they were merged from.
#include "baker/lod/sights.h"

#include <gtest/gtest.h>

#include <vector>

namespace froth {
namespace {

constexpr uint32_t kInputCells = 3, kDetails = 2;

// Cell 0 shows in view 1, cell 1 in views 0 and 1, cell 2 in none.
Visibility inputSights() {
  Visibility input;
  input.eyes = {{0, 0, -1}, {0, 0, -2}};
  input.pixels = {100, 200};
  input.offsets = {0, 1, 2, 4, 5, 5, 5};
  input.views = {1, 1, 0, 1, 0};
  input.weights = {4, 2, 1, 3, 5};
  return input;
}

TEST(Sights, OfAMergedCellAreThoseOfItsMembers) {
  const Visibility input = inputSights();
  Visibility merged = beginSights(input, kDetails);
  const std::vector<uint32_t> first = {0, 1}, second = {kInputCells, 2}, third = {2};
  appendSights(input, kInputCells, first, merged);
  appendSights(input, kInputCells, second, merged);  // what was merged before, and a cell that none sees
  appendSights(input, kInputCells, third, merged);
  EXPECT_EQ(merged.eyes, input.eyes);
  EXPECT_EQ(merged.detailsPerRow, kDetails);
  EXPECT_EQ(merged.offsets, (std::vector<uint64_t>{0, 2, 4, 4}));
  EXPECT_EQ(merged.views, (std::vector<uint16_t>{0, 1, 0, 1}));
  EXPECT_EQ(merged.weights, (std::vector<float>{3, 4.5f, 3, 4.5f}));
}

TEST(Sights, EachLevelShowsAsMuchInTheMean) {
  const Visibility input = inputSights();
  Visibility merged = beginSights(input, kDetails);
  const std::vector<uint32_t> members[] = {{0}, {1}, {kInputCells, kInputCells + 1}, {2}};
  for (const std::vector<uint32_t>& cells : members) appendSights(input, kInputCells, cells, merged);
  const LevelReport two{.merges = 2}, one{.merges = 1}, none{.merges = 0};
  const std::vector<LevelReport> reports = {two, none, one, one};
  normaliseSights(reports, merged);
  // 3 by cell 0, 3 and 1.5 by cell 1; their sum is one cell of the next level; nobody sees the last
  EXPECT_EQ(merged.weights, (std::vector<float>{0.8f, 0.8f, 0.4f, 0.4f, 0.6f}));
}

}  // namespace
}  // namespace froth
