#include "foam/append_cells.h"

#include <gtest/gtest.h>

#include "tests/bake/random_foam.h"

namespace froth {
namespace {

constexpr uint32_t kDetails = 2;

// One without base colours whose detail sites all have three lobes, and one with both of any number.
Foam makePlain() { return makeRandomFoam(5, kDetails, 3, 1); }
Foam makeCompressed() {
  Foam foam = makeRandomFoam(4, kDetails, 3, 2);
  foam.lobeOffsets = {0};
  for (uint64_t detail = 0; detail < 4 * kDetails; ++detail) {
    foam.lobeOffsets.push_back(foam.lobeOffsets.back() + detail % 4);
    foam.baseColours.emplace_back(static_cast<float>(detail));
  }
  foam.lobeAxes.resize(foam.lobeOffsets.back());
  foam.lobeColours.resize(foam.lobeOffsets.back());
  return foam;
}

void expectCell(const Foam& to, uint32_t place, const Foam& from, uint32_t cell) {
  EXPECT_EQ(to.sites[place], from.sites[cell]);
  EXPECT_EQ(to.radii[place], from.radii[cell]);
  EXPECT_EQ(to.densities[place], from.densities[cell]);
  EXPECT_EQ(to.orientations[place], from.orientations[cell]);
  for (uint64_t k = 0; k < kDetails; ++k) {
    const uint64_t a = place * kDetails + k, b = cell * kDetails + k;
    EXPECT_EQ(to.detailSites[a], from.detailSites[b]);
    EXPECT_EQ(to.detailHeights[a], from.detailHeights[b]);
    const glm::vec3 base = to.baseColours.empty() ? glm::vec3(0) : to.baseColours[a];
    EXPECT_EQ(base, from.baseColours.empty() ? glm::vec3(0) : from.baseColours[b]);
    const LobeRange lobes = lobesOf(to, a), expected = lobesOf(from, b);
    ASSERT_EQ(lobes.count, expected.count);
    for (uint32_t m = 0; m < lobes.count; ++m) {
      EXPECT_EQ(to.lobeAxes[lobes.first + m], from.lobeAxes[expected.first + m]);
      EXPECT_EQ(to.lobeColours[lobes.first + m], from.lobeColours[expected.first + m]);
    }
  }
}

TEST(AppendCells, KeepsAllOfACell) {
  const Foam plain = makePlain();
  Foam to;
  const uint32_t first[] = {4, 0, 4}, then[] = {2};
  appendCells(plain, first, to);
  appendCells(plain, then, to);
  ASSERT_EQ(to.cellCount, 4u);
  EXPECT_TRUE(to.lobeOffsets.empty());
  EXPECT_TRUE(to.baseColours.empty());
  uint32_t place = 0;
  for (const uint32_t cell : {4, 0, 4, 2}) expectCell(to, place++, plain, cell);
}

TEST(AppendCells, TakesFoamsWithAndWithoutBaseColoursAndLobesOfAnyNumber) {
  const Foam plain = makePlain(), compressed = makeCompressed();
  const uint32_t cells[] = {1, 3};
  for (const bool isPlainFirst : {false, true}) {
    const Foam &first = isPlainFirst ? plain : compressed, &second = isPlainFirst ? compressed : plain;
    Foam to;
    appendCells(first, cells, to);
    appendCells(second, cells, to);
    ASSERT_EQ(to.cellCount, 4u);
    expectCell(to, 0, first, 1);
    expectCell(to, 1, first, 3);
    expectCell(to, 2, second, 1);
    expectCell(to, 3, second, 3);
  }
}

}  // namespace
}  // namespace froth
