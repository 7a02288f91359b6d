// The cells of any cut are a power diagram, each with the neighbours that its own chunk names: against a triangulation
// of the mixed cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "baker/graph/graph.h"
#include "base/counter_random.h"
#include "tests/lod/level_scene.h"

namespace froth {
namespace {

// Groups come in the order in which they were made, so those that a group's coarse chunks are in come later.
std::vector<uint8_t> drawRandomCut(const AssetContents& contents, uint64_t seed) {
  const CounterRandom random(seed, Purpose::kSite);
  const auto groupCount = static_cast<uint32_t>(contents.groups.size());
  const double share = random.uniform(groupCount);
  std::vector<uint8_t> isRefined(groupCount, 0);
  for (uint32_t group = groupCount; group-- > 0;) {
    isRefined[group] = random.uniform(group) < share;
    for (const ChunkLevel& place : contents.levels) {
      if (place.madeBy == group && place.in != kNoGroup && !isRefined[place.in]) isRefined[group] = 0;
    }
  }
  return isRefined;
}

struct Differences {
  uint64_t cells = 0, faults = 0, hidden = 0, missing = 0, extra = 0;
  uint64_t empty = 0, missingAlpha = 0;  // of live cells
};

uint64_t countMissing(std::span<const uint32_t> row, std::span<const uint32_t> from) {
  return std::ranges::count_if(row, [&](uint32_t cell) { return !std::ranges::binary_search(from, cell); });
}

void compare(const DrawnCells& drawn, Differences& differences) {
  const Result<RegularTriangulation> whole = triangulateRegular(drawn.sites, drawn.radii);
  ASSERT_TRUE(whole) << whole.error().message;
  const AlphaComplex alpha = computeAlphaComplex(drawn.sites, drawn.radii, *whole);
  differences.cells += drawn.sites.size();
  differences.faults += drawn.faults;
  for (uint32_t cell = 0; cell < drawn.sites.size(); ++cell) {
    differences.hidden += whole->isHidden[cell];
    differences.missing += countMissing(neighboursOf(whole->graph, cell), drawn.rows[cell]);
    differences.extra += countMissing(drawn.rows[cell], neighboursOf(whole->graph, cell));
    if (!drawn.isLive[cell]) continue;
    differences.empty += alpha.isEmpty[cell];
    differences.missingAlpha += countMissing(neighboursOf(alpha.graph, cell), drawn.alphaRows[cell]);
  }
}

void expectDiagrams(const Foam& foam, uint32_t chunkCells, const char* preset, uint32_t cuts) {
  const BakeResult baked = bakeLevels(foam, chunkCells, preset);
  const AssetContents& contents = baked.contents;
  ASSERT_GE(baked.levels.size(), 2u);
  Differences differences;
  for (uint32_t cut = 0; cut < cuts; ++cut) compare(drawCut(contents, drawRandomCut(contents, cut)), differences);
  EXPECT_GT(differences.cells, 0u);
  EXPECT_EQ(differences.faults, 0u);
  EXPECT_EQ(differences.hidden, 0u);
  EXPECT_EQ(differences.missing, 0u);
  EXPECT_EQ(differences.extra, 0u);
  EXPECT_EQ(differences.empty, 0u);
  EXPECT_EQ(differences.missingAlpha, 0u);
}

TEST(Cuts, OfARandomFoamArePowerDiagrams) { expectDiagrams(makeRandomFoam(2500, 1, 0, 7), 160, "exact", 500); }

TEST(Cuts, OfAShellOnLatticesArePowerDiagrams) {
  expectDiagrams(*synthesizeFoam({"shell", 3000}), 200, "default", 440);
}

TEST(Cuts, OfAGalleryArePowerDiagrams) {
  expectDiagrams(*synthesizeFoam({"gallery", 15000, 1, 1, 1}), 1000, "default", 60);
}

}  // namespace
}  // namespace froth
