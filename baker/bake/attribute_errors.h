// How far the stored attributes lie from the input. Internal to baker/bake.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "format/asset_contents.h"

namespace froth {

struct ErrorSum {
  double squares = 0, max = 0, weight = 0;

  void add(double error) { add(error * error, std::abs(error), 1); }
  void add(double weightedSquares, double largest, double weightSum) {
    squares += weightedSquares;
    max = std::fmax(max, largest);
    weight += weightSum;
  }
};

// Over the live cells; summed in the order of the asset, so the same on any number of threads.
struct AttributeErrors {
  ErrorSum sites, radii, densities, normals, detailSites, detailHeights, colours;

  std::vector<AttributeError> list() const;
};

}  // namespace froth
