// Planes that the filter leaves out bound no ray.
#include "trainer/step/plane_filter.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/reference/scenes.h"
#include "trainer/cpu/cpu_step.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/view_exchange.h"
#include "trainer/step/ray_cell.h"

namespace froth {
namespace {

// As trainer/cuda/prepare_cells.cu does, with every plane as a remover.
std::vector<uint32_t> keptPlanes(const std::vector<LocalPlane<float>>& planes, float radius) {
  std::vector<uint32_t> kept;
  for (uint32_t j = 0; j < planes.size(); ++j) {
    if (hidesBall(planes[j], radius)) return {j};
    bool isKept = !missesBall(planes[j], radius);
    for (uint32_t k = 0; k < planes.size() && isKept; ++k) {
      isKept = k == j || missesBall(planes[k], radius) || !isRemovedBy(planes[j], planes[k], radius);
    }
    if (isKept) kept.push_back(j);
  }
  return kept;
}

glm::vec3 randomIn(std::mt19937& random, float radius) {
  std::normal_distribution<float> normal;
  const glm::vec3 direction(normal(random), normal(random), normal(random));
  return radius * std::uniform_real_distribution<float>(0, 1)(random) * glm::normalize(direction);
}

class PlaneFilterOf : public ::testing::TestWithParam<float> {};

// growth: of all radii.
TEST_P(PlaneFilterOf, RaysEndAtTheSamePlanesWithoutThose) {
  Foam foam = randomFoam(400, 1, 1, 5);
  for (float& radius : foam.radii) radius *= GetParam();
  FoamStorage<float> storage = storeFoam<float>(foam);
  CpuStep<float> step(storage);
  step.activate(1e-2f);
  AdamStep<float> adam{};
  (void)step.render(trainingView<float>(lookAt({0.5, 0.4, -3}, {0.1, 0, 0}, 61, 43, 0.6)), {}, adam);
  const SeenCells<float> seen = step.seen();
  std::mt19937 random(7);
  size_t all = 0, left = 0, met = 0;
  for (uint32_t rank = 0; rank < seen.count; ++rank) {
    const SeenCell<float>& cell = seen.cells[rank];
    if (cell.radius == 0) continue;  // no ray came to it
    std::vector<LocalPlane<float>> planes;
    for (uint32_t e = step.pairs().offsets[cell.cell]; e < step.pairs().offsets[cell.cell + 1]; ++e) {
      planes.push_back(localPlane(storage.balls[cell.cell], storage.balls[step.pairs().neighbours[e]]));
    }
    const std::vector<uint32_t> kept = keptPlanes(planes, cell.radius);
    all += planes.size();
    left += kept.size();
    std::vector<SeenPlane<float>> rows;
    for (const uint32_t place : kept) rows.push_back(seen.planes[cell.planesBegin + place]);
    SeenCell<float> filtered = cell;
    filtered.planesBegin = 0;
    filtered.planesEnd = static_cast<uint32_t>(rows.size());
    for (int i = 0; i < 100; ++i) {
      const glm::vec3 direction = glm::normalize(cell.centre + randomIn(random, 1.05f * cell.radius));
      Segment<float> expected, found;
      const bool isMet = clipByBallAndPlanes(cell, seen.planes + cell.planesBegin, direction, expected);
      ASSERT_EQ(clipByBallAndPlanes(filtered, rows.data(), direction, found), isMet) << rank;
      if (!isMet) continue;
      ++met;
      ASSERT_EQ(found.ballOrPlaneNear, expected.ballOrPlaneNear);
      ASSERT_EQ(found.ballOrPlaneFar, expected.ballOrPlaneFar);
      const auto placeOf = [&](uint32_t surface) { return surface < kBoundedByEye ? kept[surface] : surface; };
      ASSERT_EQ(placeOf(found.nearSurface), expected.nearSurface);
      ASSERT_EQ(placeOf(found.farSurface), expected.farSurface);
    }
  }
  EXPECT_GT(met, 1000u);
  EXPECT_LT(left, 0.8 * static_cast<double>(all));
}

INSTANTIATE_TEST_SUITE_P(Radii, PlaneFilterOf, ::testing::Values(0.5f, 1.0f, 2.5f));

}  // namespace
}  // namespace froth
