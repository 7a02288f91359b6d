// Merged cells descend towards pictures of what they were merged from.
#include "baker/lod/level_fit.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numeric>

#include "baker/lod/choose_pairs.h"
#include "baker/lod/fit_views.h"
#include "baker/lod/merge_cells.h"
#include "base/image/mean_square.h"
#include "foam/append_cells.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

constexpr FrontOptions kNoNearCells{.nearRatio = 0};

// From all around, `turned` by some part of the angle between two of them.
std::vector<View> viewsAround(double turned, LensKind lens = LensKind::kPinhole) {
  constexpr int kViews = 8;
  std::vector<View> views;
  for (int k = 0; k < kViews; ++k) {
    const double angle = 2 * 3.141592653589793 * (k + turned) / kViews;
    views.push_back(lookAt({7 * std::cos(angle), 7 * std::sin(angle), 2}, {0, 0, 0}, 40, 30, 0.4));
    views.back().lens.kind = lens;
  }
  return views;
}

// Half of a foam's cells stay, in order; the others are merged in pairs, behind them.
struct Merged {
  Foam foam;
  std::vector<uint8_t> isFree;
};

Merged mergeHalf(const Foam& fine) {
  const std::vector<uint8_t> isLocked(fine.cellCount, 0);
  const std::vector<CellPair> pairs = choosePairs(fine, isLocked, {}, fine.cellCount / 4);
  std::vector<uint8_t> isPaired(fine.cellCount, 0);
  for (const CellPair& pair : pairs) isPaired[pair.first] = isPaired[pair.second] = 1;
  std::vector<uint32_t> kept, all(pairs.size());
  for (uint32_t cell = 0; cell < fine.cellCount; ++cell) {
    if (!isPaired[cell]) kept.push_back(cell);
  }
  std::iota(all.begin(), all.end(), 0u);
  Merged merged;
  appendCells(fine, kept, merged.foam);
  appendCells(mergePairs(fine, pairs, {}), all, merged.foam);
  merged.isFree.assign(kept.size(), 0);
  merged.isFree.resize(merged.foam.cellCount, 1);
  return merged;
}

const Foam& sampleFoam() {
  static const Foam foam = randomFoam(300, 3, 2, 17);
  return foam;
}

Foam fitted(const Merged& merged, LensKind lens = LensKind::kPinhole, size_t viewCount = kFitViews) {
  LevelFit fit(viewsAround(0, lens), kNoNearCells);
  EXPECT_TRUE(fit.takeFinest(sampleFoam(), {}));
  EXPECT_TRUE(fit.isFitting());
  Foam foam = merged.foam;
  EXPECT_TRUE(fit.fit(foam, merged.isFree, viewCount, {}));
  return foam;
}

double meanSquareOver(const std::vector<View>& views, const Foam& foam) {
  double sum = 0;
  for (const View& view : views) {
    sum += meanSquare(renderFoam(sampleFoam(), view).colour, renderFoam(foam, view).colour);
  }
  return sum / static_cast<double>(views.size());
}

TEST(LevelFit, AMergedFoamComesNearerWhereTheFitDidNotLook) {
  const Merged merged = mergeHalf(sampleFoam());
  for (const LensKind lens : {LensKind::kPinhole, LensKind::kFisheye}) {
    const std::vector<View> unseen = viewsAround(0.25, lens);
    const double before = meanSquareOver(unseen, merged.foam), after = meanSquareOver(unseen, fitted(merged, lens));
    EXPECT_LT(after, 0.8 * before) << decibels(before) << " dB before, " << decibels(after) << " after";
  }
}

TEST(LevelFit, FewViewsDoSomeOfIt) {
  const Merged merged = mergeHalf(sampleFoam());
  const std::vector<View> unseen = viewsAround(0.25);
  const auto errorOf = [&](size_t viewCount) {
    return meanSquareOver(unseen, fitted(merged, LensKind::kPinhole, viewCount));
  };
  const double before = meanSquareOver(unseen, merged.foam), few = errorOf(kFitViews / 8), all = errorOf(SIZE_MAX);
  EXPECT_LT(few, 0.95 * before);
  EXPECT_LT(all, 0.95 * few);
  EXPECT_EQ(errorOf(0), before);
}

TEST(LevelFit, OnlyFreeCellsChangeAndNoNeighbours) {
  const Merged merged = mergeHalf(sampleFoam());
  const Foam foam = fitted(merged);
  EXPECT_EQ(foam.sites, merged.foam.sites);
  EXPECT_EQ(foam.radii, merged.foam.radii);
  EXPECT_EQ(foam.lobeAxes, merged.foam.lobeAxes);
  uint32_t changed = 0;
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    const bool isSame = foam.densities[cell] == merged.foam.densities[cell] &&
                        foam.orientations[cell] == merged.foam.orientations[cell] &&
                        foam.detailHeights[size_t{3} * cell] == merged.foam.detailHeights[size_t{3} * cell] &&
                        foam.lobeColours[size_t{6} * cell] == merged.foam.lobeColours[size_t{6} * cell];
    if (!merged.isFree[cell]) {
      EXPECT_TRUE(isSame) << cell;
    }
    changed += !isSame;
  }
  EXPECT_GT(changed, 20u);
}

TEST(LevelFit, PlainFacesStayPlain) {
  Merged merged = mergeHalf(sampleFoam());
  merged.foam.detailHeights.assign(merged.foam.detailHeights.size(), 0.0f);
  EXPECT_EQ(fitted(merged).detailHeights, merged.foam.detailHeights);
}

TEST(LevelFit, TheSameOnAnyNumberOfThreads) {
  const Merged merged = mergeHalf(sampleFoam());
  const auto fittedBy = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return fitted(merged);
  };
  const Foam one = fittedBy(1), three = fittedBy(3);
  EXPECT_EQ(one.densities, three.densities);
  EXPECT_EQ(one.orientations, three.orientations);
  EXPECT_EQ(one.detailSites, three.detailSites);
  EXPECT_EQ(one.detailHeights, three.detailHeights);
  EXPECT_EQ(one.lobeColours, three.lobeColours);
}

TEST(LevelFit, WithoutViewsNothingIsFitted) {
  LevelFit fit({}, kNoNearCells);
  ASSERT_TRUE(fit.takeFinest(sampleFoam(), {}));
  EXPECT_FALSE(fit.isFitting());
}

}  // namespace
}  // namespace froth
