// What holds of the levels of a bake (docs/STREAMING.md).
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "tests/bake/same_bake.h"
#include "tests/lod/level_scene.h"

namespace froth {
namespace {

constexpr uint32_t kChunkCells = 200;

const Foam& sampleFoam() {
  static const Foam foam = makeRandomFoam(3000, 2, 2, 5);
  return foam;
}

const BakeResult& sampleBake() {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 4);
  static const BakeResult baked = bakeLevels(sampleFoam(), kChunkCells, "default");
  return baked;
}

using Site = std::tuple<float, float, float>;
Site siteOf(const ChunkContents& chunk, uint32_t local) {
  const glm::vec3 site = worldSite(chunk, local);
  return {site.x, site.y, site.z};
}

TEST(Levels, StandInTheOrderOfTheFileAndGetCoarser) {
  const AssetContents& contents = sampleBake().contents;
  ASSERT_EQ(contents.levels.size(), contents.chunks.size());
  ASSERT_FALSE(contents.groups.empty());
  std::map<uint32_t, uint64_t> live;  // of each level
  for (size_t k = 0; k < contents.chunks.size(); ++k) {
    const ChunkLevel& place = contents.levels[k];
    live[place.level] += contents.chunks[k].liveCount;
    EXPECT_LE(contents.chunks[k].liveCount, kChunkCells);
    EXPECT_EQ(place.madeBy == kNoGroup, place.level == 0);
    if (place.madeBy != kNoGroup) {
      EXPECT_EQ(contents.groups[place.madeBy].level + 1, place.level);
    }
    if (place.in != kNoGroup) {
      EXPECT_EQ(contents.groups[place.in].level, place.level);
    }
    if (k == 0) continue;
    const ChunkLevel& before = contents.levels[k - 1];
    EXPECT_LE(before.in != kNoGroup, place.in != kNoGroup) << "the floor comes first";
    if ((before.in == kNoGroup) == (place.in == kNoGroup)) {
      EXPECT_GE(before.level, place.level);
    }
  }
  EXPECT_GE(live.size(), 3u);
  for (const auto& [level, count] : live) {
    if (level > 0) {
      EXPECT_LT(count, 0.85 * static_cast<double>(live[level - 1]));
    }
  }
}

TEST(Levels, EveryGroupHasBothForms) {
  const AssetContents& contents = sampleBake().contents;
  std::vector<uint32_t> fine(contents.groups.size()), coarse(contents.groups.size());
  for (size_t k = 0; k < contents.chunks.size(); ++k) {
    const ChunkLevel& place = contents.levels[k];
    if (place.in != kNoGroup) fine[place.in] += contents.chunks[k].liveCount;
    if (place.madeBy != kNoGroup) coarse[place.madeBy] += contents.chunks[k].liveCount;
  }
  for (size_t group = 0; group < fine.size(); ++group) {
    EXPECT_GT(coarse[group], 0u);
    EXPECT_LE(coarse[group], 0.85 * fine[group]);
  }
}

// The gallery's sky lies far behind its walls and is large: merged, one of its cells covers all others. And chunks that
// never get coarser keep those beside them from it, up to the last level.
TEST(Levels, EveryGroupGetsCoarserDownToOneChunk) {
  const BakeResult baked = bakeLevels(*synthesizeFoam({"gallery", 15000, 1, 1, 1}), 300, "default");
  for (size_t level = 0; level < baked.levels.size(); ++level) EXPECT_EQ(baked.levels[level].failed, 0u) << level;
  const auto isOfFloor = [](const ChunkLevel& place) { return place.in == kNoGroup; };
  EXPECT_EQ(std::ranges::count_if(baked.contents.levels, isOfFloor), 1);
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return glm::distance(glm::dvec3(a[0], a[1], a[2]), glm::dvec3(b[0], b[1], b[2]));
}

TEST(Levels, ErrorsGrowAndBallsNest) {
  const AssetContents& contents = sampleBake().contents;
  uint32_t steps = 0;
  for (size_t k = 0; k < contents.chunks.size(); ++k) {
    const ChunkContents& chunk = contents.chunks[k];
    const ChunkLevel& place = contents.levels[k];
    for (const uint32_t number : {place.in, place.madeBy}) {
      if (number == kNoGroup) continue;
      const LevelGroup& group = contents.groups[number];
      EXPECT_GT(group.error, 0);
      for (uint32_t local = 0; local < chunk.liveCount; ++local) {
        const glm::dvec3 site(worldSite(chunk, local));
        EXPECT_LE(distance({site.x, site.y, site.z}, group.centre) + chunk.radii[local], group.radius);
      }
    }
    if (place.in == kNoGroup || place.madeBy == kNoGroup) continue;
    const LevelGroup &finer = contents.groups[place.madeBy], &coarser = contents.groups[place.in];
    EXPECT_LT(static_cast<float>(finer.error), static_cast<float>(coarser.error));
    EXPECT_LE(distance(finer.centre, coarser.centre) + finer.radius, coarser.radius);
    ++steps;
  }
  EXPECT_GT(steps, 0u);
}

// All that a live cell is but for its neighbours.
void expectSameCell(const ChunkContents& a, uint32_t i, const ChunkContents& b, uint32_t j, uint32_t details) {
  EXPECT_EQ(siteOf(a, i), siteOf(b, j));
  EXPECT_EQ(a.radii[i], b.radii[j]);
  if (i >= a.liveCount || j >= b.liveCount) return;
  EXPECT_EQ(a.densities[i], b.densities[j]);
  EXPECT_EQ(a.orientations[i], b.orientations[j]);
  EXPECT_EQ(a.cellColours[i], b.cellColours[j]);
  for (uint32_t k = 0; k < details; ++k) {
    EXPECT_EQ(a.detailSites[i * details + k], b.detailSites[j * details + k]);
    EXPECT_EQ(a.detailHeights[i * details + k], b.detailHeights[j * details + k]);
    EXPECT_EQ(a.baseColours[i * details + k], b.baseColours[j * details + k]);
    EXPECT_EQ(a.lobeCounts[i * details + k], b.lobeCounts[j * details + k]);
  }
}

TEST(Levels, ACellOfSeveralChunksIsTheSameInAll) {
  const AssetContents& contents = sampleBake().contents;
  std::map<uint32_t, std::pair<uint32_t, uint32_t>> first;  // border number: chunk, local index
  uint32_t repeated = 0;
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    const ChunkContents& chunk = contents.chunks[index];
    for (size_t k = 0; k < chunk.borderCells.size(); ++k) {
      ASSERT_LT(chunk.borderNumbers[k], contents.borderCount);
      const auto [place, isNew] = first.try_emplace(chunk.borderNumbers[k], index, chunk.borderCells[k]);
      if (isNew) continue;
      ++repeated;
      const auto [otherIndex, otherLocal] = place->second;
      EXPECT_NE(contents.levels[index].level, contents.levels[otherIndex].level);
      expectSameCell(chunk, chunk.borderCells[k], contents.chunks[otherIndex], otherLocal, contents.detailCount);
    }
  }
  EXPECT_GT(repeated, 100u);
  EXPECT_EQ(first.size(), contents.borderCount) << "each number is some cell's";
}

// Cells of level 0 by site: live or not, and their neighbours' sites.
std::map<Site, std::pair<bool, std::set<Site>>> mapLevel0(const AssetContents& contents) {
  std::map<Site, std::pair<bool, std::set<Site>>> cells;
  for (size_t index = 0; index < contents.chunks.size(); ++index) {
    if (!contents.levels.empty() && contents.levels[index].level > 0) continue;
    const ChunkContents& chunk = contents.chunks[index];
    for (uint32_t local = 0; local < chunk.cellCount; ++local) {
      auto& [isLive, neighbours] = cells[siteOf(chunk, local)];
      isLive = local < chunk.liveCount;
      for (uint32_t k = chunk.neighbourOffsets[local]; k < chunk.neighbourOffsets[local + 1]; ++k) {
        neighbours.insert(siteOf(chunk, chunk.neighbours[k]));
      }
    }
  }
  return cells;
}

TEST(Levels, Level0IsTheBakeWithoutLevels) {
  BakeOptions options;
  options.preset = "default";
  options.knobs = *presetKnobs("default");
  options.measure = false;
  const Result<BakeResult> plain = bakeFoam(sampleFoam(), options);
  ASSERT_TRUE(plain) << plain.error().message;
  ASSERT_TRUE(plain->contents.levels.empty());
  EXPECT_EQ(mapLevel0(plain->contents), mapLevel0(sampleBake().contents));
  const std::vector<AttributeError>&errors = plain->contents.errors, &others = sampleBake().contents.errors;
  ASSERT_EQ(errors.size(), others.size());
  for (size_t k = 0; k < errors.size(); ++k) EXPECT_EQ(errors[k].max, others[k].max) << errors[k].name;
}

TEST(Levels, ThreadsDoNotMatter) {
  const BakeResult& many = sampleBake();  // before the limit, which would hold for it too
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const BakeResult one = bakeLevels(sampleFoam(), kChunkCells, "default");
  expectSameBake(one, many);
  ASSERT_EQ(one.contents.groups.size(), many.contents.groups.size());
  for (size_t k = 0; k < one.contents.groups.size(); ++k) {
    EXPECT_EQ(one.contents.groups[k].centre, many.contents.groups[k].centre);
    EXPECT_EQ(one.contents.groups[k].radius, many.contents.groups[k].radius);
    EXPECT_EQ(one.contents.groups[k].error, many.contents.groups[k].error);
  }
}

// Chunks above level 0 hold cells of the input and merged ones by turns.
TEST(Levels, ProgressOfColoursGrowsToItsTotal) {
  BakeOptions options;
  options.knobs = *presetKnobs("default");
  options.chunkCells = kChunkCells;
  options.levels = true;
  options.measure = false;
  uint64_t before = 0, reports = 0;
  const auto check = [&](std::string_view stage, uint64_t done, uint64_t total) {
    if (stage != "colours") return true;
    EXPECT_LE(done, total);
    EXPECT_GE(done, before);
    before = done;
    ++reports;
    return true;
  };
  ASSERT_TRUE(bakeFoam(sampleFoam(), options, check));
  EXPECT_GT(reports, 3u);
}

TEST(Levels, ASceneOfOneChunkHasNone) {
  const BakeResult baked = bakeLevels(makeRandomFoam(300, 1, 1, 3), 400);
  EXPECT_TRUE(baked.contents.levels.empty());
  EXPECT_TRUE(baked.contents.groups.empty());
  EXPECT_EQ(baked.contents.borderCount, 0u);
  EXPECT_EQ(baked.contents.chunks.size(), 1u);
  EXPECT_TRUE(baked.contents.chunks[0].borderCells.empty());
}

TEST(Levels, NeedTheWalkGraph) {
  BakeOptions options;
  options.levels = true;
  options.walkGraph = false;
  const Result<BakeResult> result = bakeFoam(makeRandomFoam(300, 1, 1, 3), options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace froth
