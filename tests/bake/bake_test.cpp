#include "baker/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "foam/morton_order.h"
#include "shaders/foam/cell.h"
#include "tests/bake/random_foam.h"

namespace froth {
namespace {

// Without Steiner cells: these tests are about those of the input.
BakeResult bake(const Foam& foam, BakeOptions options = {}) {
  options.steiner = false;
  Result<BakeResult> result = bakeFoam(foam, options);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

uint64_t findLeftOut(const BakeResult& result, const std::string& what) {
  for (const LeftOut& leftOut : result.leftOut) {
    if (leftOut.what == what) return leftOut.savedBytes;
  }
  return 0;
}

std::vector<CellRef> rowOf(const ChunkContents& chunk, uint32_t place) {
  return {chunk.neighbours.begin() + chunk.neighbourOffsets[place],
          chunk.neighbours.begin() + chunk.neighbourOffsets[place + 1]};
}

TEST(Bake, KeepsTheBitsOfEveryAttributeThroughTheReordering) {
  const Foam foam = makeMixedFoam();
  const BakeResult result = bake(foam);
  const ChunkContents& chunk = result.contents.chunks.at(0);
  ASSERT_EQ(result.sourceCells.size(), chunk.cellCount);
  EXPECT_EQ(chunk.origin, (std::array<double, 3>{0, 0, 0}));
  for (uint32_t place = 0; place < chunk.cellCount; ++place) {
    const uint32_t cell = result.sourceCells[place];
    ASSERT_EQ(chunk.sites[place], foam.sites[cell]);
    ASSERT_EQ(chunk.radii[place], foam.radii[cell]);
    if (place >= chunk.liveCount) continue;
    ASSERT_EQ(chunk.densities[place], foam.densities[cell]);
    ASSERT_EQ(chunk.orientations[place], foam.orientations[cell]);
    for (uint32_t k = 0; k < 2; ++k) {
      ASSERT_EQ(chunk.detailSites[2 * place + k], foam.detailSites[2 * cell + k]);
      ASSERT_EQ(chunk.detailHeights[2 * place + k], foam.detailHeights[2 * cell + k]);
    }
    for (uint32_t m = 0; m < 6; ++m) {
      ASSERT_EQ(chunk.lobeAxes[6 * place + m], foam.lobeAxes[6 * cell + m]);
      ASSERT_EQ(chunk.lobeColours[6 * place + m], foam.lobeColours[6 * cell + m]);
    }
  }
}

TEST(Bake, PutsLiveCellsFirstAndDropsHiddenOnes) {
  const Foam foam = makeMixedFoam();
  const Result<RegularTriangulation> triangulation = triangulateRegular(foam.sites, foam.radii);
  ASSERT_TRUE(triangulation);
  const AlphaComplex alpha = computeAlphaComplex(foam.sites, foam.radii, *triangulation);
  const BakeResult result = bake(foam);
  const ChunkContents& chunk = result.contents.chunks.at(0);

  uint64_t dead = 0, empty = 0;
  for (uint32_t place = 0; place < chunk.cellCount; ++place) {
    const uint32_t cell = result.sourceCells[place];
    EXPECT_FALSE(triangulation->isHidden[cell]);
    const bool isLive = foam.densities[cell] > 0 && !alpha.isEmpty[cell];
    EXPECT_EQ(isLive, place < chunk.liveCount) << cell;
    empty += alpha.isEmpty[cell];
    dead += !alpha.isEmpty[cell] && foam.densities[cell] == 0;
  }
  const BakeStatistics& statistics = result.contents.statistics;
  EXPECT_GT(dead, 0u);
  EXPECT_GT(empty, 0u);
  EXPECT_EQ(statistics.inputCells, 400u);
  EXPECT_EQ(statistics.deadCells, dead);
  EXPECT_EQ(statistics.emptyCells, empty);
  EXPECT_EQ(statistics.duplicatesMerged, triangulation->duplicates);
  EXPECT_EQ(statistics.duplicatesMerged, 20u);
  EXPECT_GT(statistics.hiddenDropped, statistics.duplicatesMerged);
  EXPECT_EQ(statistics.hiddenDropped + chunk.cellCount, 400u);
  EXPECT_EQ(statistics.walkPairs * 2, chunk.neighbours.size());
  EXPECT_EQ(statistics.steinerCells, 0u);
  EXPECT_EQ(statistics.alphaPairs * 2, alpha.graph.neighbours.size());
}

// Within each group cells follow the Morton curve of the group.
TEST(Bake, OrdersEachGroupAlongItsMortonCurve) {
  const Foam foam = makeMixedFoam();
  const BakeResult result = bake(foam);
  const ChunkContents& chunk = result.contents.chunks.at(0);
  const auto isOrdered = [&](uint32_t first, uint32_t last) {
    const std::vector<uint32_t> curve = mortonOrder(std::span(chunk.sites).subspan(first, last - first));
    return std::is_sorted(curve.begin(), curve.end());
  };
  EXPECT_TRUE(isOrdered(0, chunk.liveCount));
  EXPECT_TRUE(isOrdered(chunk.liveCount, chunk.cellCount));
}

TEST(Bake, RowsStartWithTheAlphaComplexNearestPlaneFirst) {
  const Foam foam = makeMixedFoam();
  const Result<RegularTriangulation> triangulation = triangulateRegular(foam.sites, foam.radii);
  ASSERT_TRUE(triangulation);
  const AlphaComplex alpha = computeAlphaComplex(foam.sites, foam.radii, *triangulation);
  const BakeResult result = bake(foam);
  const ChunkContents& chunk = result.contents.chunks.at(0);
  const auto expectedSet = [&](const CellGraph& graph, uint32_t cell) {
    return std::set<uint32_t>(graph.neighbours.begin() + graph.offsets[cell],
                              graph.neighbours.begin() + graph.offsets[cell + 1]);
  };
  for (uint32_t place = 0; place < chunk.cellCount; ++place) {
    const std::vector<CellRef> row = rowOf(chunk, place);
    const uint32_t alphaCount = place < chunk.liveCount ? chunk.alphaCounts[place] : 0;
    std::vector<double> distances;
    std::set<uint32_t> alphaCells, cells;
    for (uint32_t k = 0; k < row.size(); ++k) {
      const glm::dvec3 d = glm::dvec3(chunk.sites[row[k]]) - glm::dvec3(chunk.sites[place]);
      distances.push_back(foam::radicalOffset(d, double{chunk.radii[place]}, double{chunk.radii[row[k]]}) /
                          glm::length(d));
      cells.insert(result.sourceCells[row[k]]);
      if (k < alphaCount) alphaCells.insert(result.sourceCells[row[k]]);
    }
    const uint32_t cell = result.sourceCells[place];
    EXPECT_EQ(cells, expectedSet(triangulation->graph, cell));
    EXPECT_TRUE(place >= chunk.liveCount || alphaCells == expectedSet(alpha.graph, cell)) << cell;
    EXPECT_TRUE(std::is_sorted(distances.begin(), distances.begin() + alphaCount));
    EXPECT_TRUE(std::is_sorted(distances.begin() + alphaCount, distances.end()));
  }
}

TEST(Bake, KeepsDeadCellsAsCuttersOfTheirNeighbours) {
  Foam foam = makeRandomFoam(2, 1, 1, 1);
  foam.sites = {{0, 0, 0}, {1, 0, 0}};
  foam.radii = {1, 1};
  foam.densities = {0, 5};
  const ChunkContents chunk = bake(foam).contents.chunks.at(0);
  EXPECT_EQ(chunk.cellCount, 2u);
  EXPECT_EQ(chunk.liveCount, 1u);
  EXPECT_EQ(chunk.sites[0], foam.sites[1]);
  EXPECT_THAT(chunk.neighbours, testing::ElementsAre(1, 0));
  EXPECT_THAT(chunk.alphaCounts, testing::ElementsAre(1));
}

TEST(Bake, CallsACellDeadOnlyIfNoImageCanShowIt) {
  Foam foam = makeRandomFoam(1, 1, 1, 1);
  foam.radii = {0.5f};
  foam.densities = {0x1p-24f};  // 2 r sigma at the limit
  EXPECT_EQ(bake(foam).contents.statistics.deadCells, 0u);
  foam.densities = {std::nextafter(0x1p-24f, 0.0f)};
  EXPECT_EQ(bake(foam).contents.statistics.deadCells, 1u);
}

TEST(Bake, LeavesOutHeightsThatAreAllZero) {
  Foam foam = makeRandomFoam(30, 2, 1, 1);
  const BakeResult displaced = bake(foam);
  EXPECT_EQ(displaced.contents.chunks[0].detailHeights.size(), 2u * displaced.contents.chunks[0].liveCount);
  EXPECT_EQ(displaced.contents.chunks[0].cellHeights.size(), displaced.contents.chunks[0].liveCount);
  std::fill(foam.detailHeights.begin(), foam.detailHeights.end(), 0.0f);
  const BakeResult flat = bake(foam);
  EXPECT_TRUE(flat.contents.chunks[0].detailHeights.empty());
  EXPECT_TRUE(flat.contents.chunks[0].cellHeights.empty());
  EXPECT_EQ(findLeftOut(flat, "displacement"), 2u * 4 * flat.contents.chunks[0].liveCount);
  EXPECT_EQ(findLeftOut(displaced, "displacement"), 0u);
}

TEST(Bake, LeavesOutLobesThatLookTheSameFromEverywhere) {
  Foam foam = makeRandomFoam(30, 2, 3, 1);
  EXPECT_EQ(bake(foam).contents.lobeCount, 3u);
  for (size_t lobe = 0; lobe < foam.lobeColours.size(); ++lobe) foam.lobeColours[lobe] = foam.lobeColours[lobe / 3 * 3];
  const BakeResult result = bake(foam);
  const ChunkContents& chunk = result.contents.chunks[0];
  EXPECT_EQ(result.contents.lobeCount, 0u);
  EXPECT_TRUE(chunk.lobeColours.empty());
  ASSERT_EQ(chunk.baseColours.size(), 2u * chunk.liveCount);
  for (uint32_t place = 0; place < chunk.liveCount; ++place) {
    EXPECT_EQ(chunk.baseColours[2 * place + 1], foam.lobeColours[6 * result.sourceCells[place] + 3]);
  }
  EXPECT_EQ(findLeftOut(result, "view dependence"), 24u * 6 * chunk.liveCount);
}

TEST(Bake, GivesEveryLiveCellAColourAndAHeight) {
  Foam foam = makeRandomFoam(1, 2, 1, 1);
  foam.lobeColours = {glm::vec3(0.25f, 0, 1), glm::vec3(-0.25f, 0.125f, 1)};
  foam.detailHeights = {0.25f, 0.5f};
  const BakeResult result = bake(foam);
  const ChunkContents& chunk = result.contents.chunks[0];
  EXPECT_THAT(chunk.cellHeights, testing::ElementsAre(0.375f));
  // The mean of 1/2 + colour, to a byte: (0.5, 0.5625, 1.5).
  EXPECT_THAT(chunk.cellColours, testing::ElementsAre(glm::vec3(128.0f, 143.0f, 255.0f) / 255.0f));
}

TEST(Bake, TakesStartViewAndFlightPathFromTheCameras) {
  View view;
  view.width = 200;
  view.height = 100;
  view.fx = 125;  // pixels that are not square: the height counts
  view.fy = 50;
  view.worldFromCamera[3] = 7;
  CameraSet cameras;
  cameras.views = {view};
  BakeOptions options;
  options.cameras = &cameras;
  const Foam foam = makeRandomFoam(5, 1, 1, 1);

  AssetContents contents = bake(foam, options).contents;
  EXPECT_TRUE(contents.hasStartView);
  EXPECT_EQ(contents.startView.worldFromCamera[3], 7);
  EXPECT_DOUBLE_EQ(contents.startView.tanHalfFovY, 1);
  EXPECT_TRUE(contents.flightPath.empty());

  cameras.flight = {view, view};
  cameras.flight[0].worldFromCamera[3] = 9;
  contents = bake(foam, options).contents;
  EXPECT_EQ(contents.startView.worldFromCamera[3], 9);
  EXPECT_EQ(contents.flightPath.size(), 2u);
  EXPECT_FALSE(bake(foam).contents.hasStartView);
}

TEST(Bake, PassesItsOptionsOnAndReportsItsStages) {
  BakeOptions options;
  options.nearRatio = 2;
  options.nearDepth = 0.25f;
  options.source = "model.pt";
  const BakeResult result = bake(makeRandomFoam(50, 3, 2, 1), options);
  EXPECT_EQ(result.contents.nearRatio, 2);
  EXPECT_EQ(result.contents.nearDepth, 0.25f);
  EXPECT_EQ(result.contents.source, "model.pt");
  EXPECT_EQ(result.contents.preset, "exact");
  EXPECT_EQ(result.contents.detailCount, 3u);
  EXPECT_EQ(result.contents.lobeCount, 2u);
  EXPECT_EQ(result.contents.localBits, 32u);
  ASSERT_FALSE(result.stages.empty());
  const auto triangulate = std::find_if(result.stages.begin(), result.stages.end(),
                                        [](const StageReport& stage) { return stage.stage == "triangulate"; });
  ASSERT_NE(triangulate, result.stages.end());
  EXPECT_EQ(triangulate->items, 50u);
  EXPECT_GT(triangulate->peakBytes, 0u);
}

TEST(Bake, HandsItsSeedToSteinerCellsAndCodebook) {
  Foam foam = makeRandomFoam(200, 4, 4, 5);
  for (glm::vec3& site : foam.sites) site *= 3.0f;  // space between the balls
  BakeOptions options;
  options.measure = false;
  options.knobs.compressColours = true;
  options.knobs.appearance.codebookSize = 64;
  const auto bakeWith = [&](uint64_t seed) {
    options.seed = seed;
    Result<BakeResult> result = bakeFoam(foam, options);
    EXPECT_TRUE(result) << result.error().message;
    return std::move(result->contents);
  };
  const AssetContents first = bakeWith(1), again = bakeWith(1), second = bakeWith(2);
  EXPECT_GT(first.chunks[0].cellCount, foam.cellCount);
  EXPECT_EQ(first.chunks[0].sites, again.chunks[0].sites);
  EXPECT_NE(first.chunks[0].sites, second.chunks[0].sites);
  EXPECT_EQ(first.axisCodebook, again.axisCodebook);
  EXPECT_NE(first.axisCodebook, second.axisCodebook);
}

TEST(Bake, OfOneCellIsThatCell) {
  const BakeResult result = bake(makeRandomFoam(1, 1, 1, 1));
  EXPECT_EQ(result.contents.chunks[0].liveCount, 1u);
  EXPECT_THAT(result.contents.chunks[0].neighbourOffsets, testing::ElementsAre(0, 0));
}

TEST(Bake, RefusesUnknownPresetsBrokenFoamsAndKnobsOutOfRange) {
  const Result<BakeKnobs> wrongPreset = presetKnobs("tiny");
  ASSERT_FALSE(wrongPreset);
  EXPECT_EQ(wrongPreset.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(wrongPreset.error().message, testing::HasSubstr("'tiny'"));

  const Foam good = makeRandomFoam(5, 1, 1, 1);
  BakeOptions options;
  options.knobs.positionBits = 30;
  const Result<BakeResult> wrongKnob = bakeFoam(good, options);
  ASSERT_FALSE(wrongKnob);
  EXPECT_EQ(wrongKnob.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(wrongKnob.error().message, testing::HasSubstr("position bits: found 30; give 10 to 22"));

  Foam shortArray = good;
  shortArray.lobeColours.pop_back();
  const Result<BakeResult> wrongLength = bakeFoam(shortArray, {});
  ASSERT_FALSE(wrongLength);
  EXPECT_THAT(wrongLength.error().message, testing::HasSubstr("lobeColours"));

  EXPECT_FALSE(bakeFoam(Foam{}, {}));
  Foam infinite = good;
  infinite.sites[3].y = INFINITY;
  EXPECT_FALSE(bakeFoam(infinite, {}));
}

TEST(Bake, StopsInEveryStageWhenAskedTo) {
  const Foam foam = makeRandomFoam(500, 1, 1, 1);
  std::set<std::string> stages;
  const auto collect = [&](std::string_view stage, uint64_t, uint64_t) { return stages.emplace(stage), true; };
  ASSERT_TRUE(bakeFoam(foam, {}, collect));
  EXPECT_GE(stages.size(), 5u);
  for (const std::string& stop : stages) {
    const auto refuse = [&](std::string_view stage, uint64_t, uint64_t) { return stage != stop; };
    const Result<BakeResult> result = bakeFoam(foam, {}, refuse);
    ASSERT_FALSE(result) << stop;
    EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
  }
}

}  // namespace
}  // namespace froth
