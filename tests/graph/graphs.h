// The graphs of a set of balls, as a bake makes them.
#pragma once

#include <utility>

#include <gtest/gtest.h>

#include "baker/graph/graph.h"
#include "tests/graph/ball_sets.h"

namespace froth {

struct Graphs {
  RegularTriangulation triangulation;
  AlphaComplex alpha;
};

inline Graphs makeGraphs(const BallSet& balls) {
  Result<RegularTriangulation> triangulation = triangulateRegular(balls.sites, balls.radii);
  EXPECT_TRUE(triangulation) << triangulation.error().message;
  AlphaComplex alpha = computeAlphaComplex(balls.sites, balls.radii, *triangulation);
  return {std::move(*triangulation), std::move(alpha)};
}

}  // namespace froth
