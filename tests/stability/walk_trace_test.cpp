// Walks on the CPU do what theory promises, and a wrong graph is told.
#include "measure/stability/walk_trace.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

CellGraph graphOf(const Foam& foam) {
  const Result<RegularTriangulation> triangulation = triangulateRegular(foam.sites, foam.radii);
  EXPECT_TRUE(triangulation) << triangulation.error().message;
  return triangulation->graph;
}

TEST(WalkTraces, KeepToTheOrderAndReachTheLastCell) {
  const Foam foam = foamOfCells(cloud(200, 4));
  const CellGraph graph = graphOf(foam);
  std::vector<View> views = outsideViews();
  views.push_back(caseView({0.1, 0, 0.2}, {1, 0.3, 1}));
  views.push_back(orthographicView({0, 0, -3}, {0, 0, 0}, 1.2));
  for (const View& view : views) {
    const WalkTrace trace = traceWalks(foam, graph, view);
    EXPECT_EQ(trace.rays, 32u * 24);
    EXPECT_GT(trace.steps, 4 * trace.rays);
    EXPECT_LE(trace.mostSteps, 200u);
    EXPECT_EQ(trace.violations, 0u);
    EXPECT_EQ(trace.lost, 0u);
  }
}

// The neighbours of one cell in the middle are taken out of its row.
TEST(WalkTraces, AreLostWhereACellHasNoNeighbours) {
  const Foam foam = foamOfCells(cloud(200, 4));
  CellGraph graph = graphOf(foam);
  uint32_t middle = 0;
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    const bool isInGraph = graph.offsets[cell] < graph.offsets[cell + 1];
    if (isInGraph && glm::length(foam.sites[cell]) < glm::length(foam.sites[middle])) middle = cell;
  }
  const uint32_t begin = graph.offsets[middle], count = graph.offsets[middle + 1] - begin;
  graph.neighbours.erase(graph.neighbours.begin() + begin, graph.neighbours.begin() + begin + count);
  for (uint32_t cell = middle + 1; cell <= foam.cellCount; ++cell) graph.offsets[cell] -= count;
  EXPECT_GT(traceWalks(foam, graph, outsideViews().front()).lost, 0u);
}

}  // namespace
}  // namespace froth
