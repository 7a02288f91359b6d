// Pairs per cell of trained foams by three rules; skipped where the data is absent.
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "foam/checkpoint/checkpoint.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

class RealFoamDegrees : public testing::TestWithParam<const char*> {};

// The published rule keeps a pair that has an edge in the regular triangulation and whose balls overlap. A
// face of the alpha-complex asks for more: the balls meet on it.
TEST_P(RealFoamDegrees, TheAlphaComplexHasFewerPairsThanEdgeAndOverlap) {
  const std::filesystem::path path = test::dataFolder() / "foams" / GetParam() / "model.pt";
  if (!std::filesystem::exists(path)) FROTH_SKIP() << "no " << path << "; set FROTH_DATA";
  const Result<Foam> foam = importCheckpoint(path);
  ASSERT_TRUE(foam) << foam.error().message;
  const Result<RegularTriangulation> triangulation = triangulateRegular(foam->sites, foam->radii);
  ASSERT_TRUE(triangulation) << triangulation.error().message;
  const AlphaComplex alpha = computeAlphaComplex(foam->sites, foam->radii, *triangulation);
  const ValidityReport report = checkGraphs(foam->sites, foam->radii, *triangulation, alpha, 1);
  EXPECT_TRUE(report.faults.empty()) << report.faults.front();

  uint64_t overlapping = 0;
  for (uint32_t i = 0; i < foam->cellCount; ++i) {
    for (const uint32_t j : neighboursOf(triangulation->graph, i)) {
      const glm::dvec3 difference = glm::dvec3(foam->sites[i]) - glm::dvec3(foam->sites[j]);
      overlapping += i < j && glm::length(difference) < double{foam->radii[i]} + foam->radii[j];
    }
  }
  EXPECT_LT(report.alphaPairs, overlapping);
  EXPECT_LT(overlapping, report.walkPairs);
  const double cells = foam->cellCount;
  std::printf("%s: pairs per cell: triangulation %.2f, edge and overlap %.2f, alpha-complex %.2f\n", GetParam(),
              static_cast<double>(report.walkPairs) / cells, static_cast<double>(overlapping) / cells,
              static_cast<double>(report.alphaPairs) / cells);
}

INSTANTIATE_TEST_SUITE_P(Trained, RealFoamDegrees, testing::Values("miku_plush", "tankard_rough"));

}  // namespace
}  // namespace froth
