// Which cells are removed and split.
#include "trainer/loop/cell_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "tests/reference/scenes.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/loop/schedule.h"
#include "trainer/step/crowds.h"

namespace froth {
namespace {

class CellPlanOf : public ::testing::Test {
 protected:
  static constexpr uint32_t kCells = 200;

  explicit CellPlanOf(uint32_t cells = kCells)
      : foam_(storeFoam<float>(randomFoam(cells, 2, 2, 4))), overlaps_(cells, kMostOverlaps) {
    for (uint32_t i = 0; i < cells; ++i) {
      for (uint32_t c = 0; c < 4; ++c) orientations()[4 * i + c] = c == 0 ? 1.0f : 0.0f;
      foam_.balls[i] = ballOfCell(i);
      foam_.contributions[i] = i % 20 == 0 ? 0.0f : 0.01f;
      foam_.errors[i] = 1e-3f;
      foam_.firstMoments[0][3 * i] = float(i);
      foam_.lastSteps[i] = i;
    }
  }

  glm::vec4 ballOfCell(uint32_t i) const {
    const std::vector<float>& points = foam_.values[0];
    return {points[3 * i], points[3 * i + 1], points[3 * i + 2], 0.5f};
  }
  CellPlan plan(uint32_t wanted, uint64_t seed = 1) const {
    return planCells(factsOf(foam_, overlaps_), wanted, {}, seed, 99);
  }
  std::vector<float>& orientations() { return foam_.values[static_cast<size_t>(Parameter::kOrientations)]; }

  FoamStorage<float> foam_;
  std::vector<uint32_t> overlaps_;  // none is crowded
};

TEST_F(CellPlanOf, RemovesWhatDoesNotShowAndSplitsUntilThereAreAsManyAsWanted) {
  const CellPlan made = plan(300);
  EXPECT_EQ(made.sources.size(), 300u);
  std::map<uint32_t, int> copies;
  for (const uint32_t source : made.sources) ++copies[source];
  for (const auto& [source, count] : copies) {
    EXPECT_NE(source % 20, 0u);
    EXPECT_LE(count, 2);  // without replacement
  }
  EXPECT_EQ(copies.size(), 190u);
}

// Far from the cameras balls are large, and so is the step.
TEST_F(CellPlanOf, PartsFartherWhereTheUnitIsLarger) {
  const glm::vec3 eye(0, 0, 1000);
  const CellPlan made = planCells(factsOf(foam_, overlaps_), 300, {eye, 0}, 1, 99);
  for (const CellChange& change : made.changes) {
    EXPECT_TRUE(change.shift == glm::vec3(0) || std::abs(glm::length(change.shift) - 0.3f * 0.5f) < 1e-5f);
  }
}

TEST_F(CellPlanOf, RemovesATenthAtMostAndAllWithoutNumbers) {
  std::fill(foam_.contributions.begin(), foam_.contributions.end(), 1e-9f);  // nothing was seen yet
  EXPECT_EQ(plan(kCells / 2).sources.size(), 180u);
  foam_.balls[50].x = std::numeric_limits<float>::quiet_NaN();
  const CellPlan made = plan(kCells / 2);
  EXPECT_EQ(std::ranges::count(made.sources, 50u), 0);
}

TEST_F(CellPlanOf, IsThatOfItsSeed) {
  EXPECT_EQ(plan(250).sources, plan(250).sources);
  EXPECT_NE(plan(250, 1).sources, plan(250, 2).sources);
}

TEST_F(CellPlanOf, DrawsParentsByTheirError) {
  for (uint32_t i = 0; i < kCells; ++i) foam_.errors[i] = i < 40 ? 1.0f : 1e-6f;
  const CellPlan made = plan(210);
  std::map<uint32_t, int> copies;
  for (const uint32_t source : made.sources) ++copies[source];
  for (const auto& [source, count] : copies) {
    EXPECT_TRUE(count == 1 || source < 40) << source;
  }
}

TEST_F(CellPlanOf, PartsParentAndChildOnTheFaceAndCopiesTheRest) {
  for (uint32_t i = 1; i < kCells; i += 2) foam_.balls[i].w = 0.1f;
  const CellPlan made = plan(300);
  const FoamStorage<float> next = rearrange(foam_, made);
  std::map<uint32_t, glm::vec3> shiftSums;
  for (size_t i = 0; i < made.sources.size(); ++i) {
    const uint32_t source = made.sources[i];
    shiftSums[source] += made.changes[i].shift;
    EXPECT_EQ(made.changes[i].shift.x, 0);  // the normal is x
    const bool isSplit = made.changes[i].shift != glm::vec3(0);
    EXPECT_NEAR(glm::length(made.changes[i].shift), !isSplit ? 0 : source % 2 == 0 ? 0.05f : 0.3f * 0.1f, 1e-6);
    EXPECT_EQ(next.values[0][3 * i + 1], foam_.values[0][3 * source + 1] + made.changes[i].shift.y);
    EXPECT_EQ(next.firstMoments[0][3 * i], float(source));
    EXPECT_EQ(next.lastSteps[i], source);
    EXPECT_EQ(next.errors[i], foam_.errors[source] * (isSplit ? 0.5f : 1.0f));
  }
  for (const auto& [source, sum] : shiftSums) EXPECT_EQ(sum, glm::vec3(0));
}

struct CellPlanOfMany : CellPlanOf {
  CellPlanOfMany() : CellPlanOf(kFewCells) {}
};

TEST_F(CellPlanOfMany, ShrinksCrowdedCellsAndKeepsTheirOpticalDepth) {
  for (uint32_t i = 0; i < kFewCells; ++i) overlaps_[i] = i % 2 == 0 ? kMostOverlaps : i % 3 == 0 ? 25 : 1000;
  float& nothing = foam_.values[static_cast<size_t>(Parameter::kDensity)][5];
  nothing = -2;  // activated, 0
  const CellPlan made = plan(kFewCells + 100);
  const FoamStorage<float> next = rearrange(foam_, made);
  const auto valueOf = [](const FoamStorage<float>& foam, Parameter parameter, uint32_t cell) {
    return foam::softplus(foam.values[static_cast<size_t>(parameter)][cell]);
  };
  for (uint32_t i = 0; i < next.shape.cellCount; ++i) {
    const uint32_t source = made.sources[i];
    const float radius = valueOf(foam_, Parameter::kRadii, source), now = valueOf(next, Parameter::kRadii, i);
    const float density = valueOf(foam_, Parameter::kDensity, source), dense = valueOf(next, Parameter::kDensity, i);
    const float factor = source % 2 == 0 ? 1.0f : source % 3 == 0 ? std::sqrt(24.0f / 25) : 0.95f;
    EXPECT_NEAR(now / radius, factor, 1e-5) << source;  // of parents and of children
    EXPECT_NEAR(now * dense, radius * density, 1e-5 * radius * density) << source;
    if (source == 5) {
      EXPECT_EQ(next.values[static_cast<size_t>(Parameter::kDensity)][i], nothing);
    }
  }
}

TEST_F(CellPlanOf, FewKeepTheirRadiiInACrowd) {
  overlaps_.assign(kCells, 1000);
  for (const CellChange& change : plan(kCells).changes) EXPECT_EQ(change.radiusFactor, 1);
}

TEST_F(CellPlanOf, CountsTheBallsThatOverlap) {
  const std::vector<glm::vec4> balls = {{0, 0, 0, 1}, {1.9f, 0, 0, 1}, {0, 2.1f, 0, 1}, {0, 0, 0.5f, 0.1f}};
  const std::vector<uint32_t> offsets = {0, 3, 4, 5, 6}, neighbours = {1, 2, 3, 0, 0, 0}, reverses = {3, 4, 5, 0, 1, 2};
  const NeighbourRows rows{offsets.data(), neighbours.data(), reverses.data()};
  EXPECT_EQ(countOverlaps(balls.data(), rows, 0), 2u);
  EXPECT_EQ(countOverlaps(balls.data(), rows, 1), 1u);
  EXPECT_EQ(countOverlaps(balls.data(), rows, 2), 0u);
}

TEST(Schedule, ReachesTheCellsThatAreWanted) {
  Schedule schedule;
  schedule.startCells = 100000;
  schedule.mostCells = 500000;
  EXPECT_EQ(cellsAfter(schedule, 99 / 30000.0, 98765), 98765u);
  EXPECT_EQ(cellsAfter(schedule, 24000 / 30000.0, 1), 500000u);
  EXPECT_EQ(cellsAfter(schedule, 26999 / 30000.0, 1), 500000u);
  EXPECT_TRUE(isDensifyStep(schedule, 26999, 26999 / 30000.0));
  EXPECT_FALSE(isDensifyStep(schedule, 27099, 27099 / 30000.0));
}

}  // namespace
}  // namespace froth
