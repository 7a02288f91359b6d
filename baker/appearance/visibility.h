// How much each detail site of a foam shows in the input's cameras: what lossy steps weigh their errors by.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

struct VisibilityOptions {
  double nearRatio = 4, nearDepth = 0;  // where a view does not say
  double detailSharpness = 10;
  uint32_t maxPixelsPerView = 0;  // views are reduced to about this size; 0: the implementation's default
};

// A detail site shows in a pixel with s = T alpha omega_k / sum omega; an error of its colour counts there as
// s^2. It is seen from a view with weight sum over pixels of s^2, in pixels of the full-size view. Compressed
// rows over detail sites; entries ascend by view.
struct Visibility {
  std::vector<glm::vec3> eyes;    // [views] [scene units]
  std::vector<double> pixels;     // [views] of the full-size view
  uint32_t detailsPerRow = 1;     // detail sites that follow each other and show alike; 1, or K
  std::vector<uint64_t> offsets;  // [N*K / detailsPerRow + 1]
  std::vector<uint16_t> views;    // [offsets.back()]
  std::vector<float> weights;     // [offsets.back()] > 0
  // [N * K(K-1)/2] for k < l, row by row: sum s_k s_l / sqrt(sum s_k^2 sum s_l^2) [0..1]; empty: all 0
  std::vector<float> overlaps;
  std::vector<float> contributions;  // [N] the largest T alpha of the cell in any pixel of any view
};

// The same input gives the same bits on any number of threads. Fails with kCancelled.
Result<Visibility> measureVisibility(const Foam& foam, std::span<const View> views, const VisibilityOptions& options,
                                     const Progress& progress = {});

// [N] The weights of each cell in all views, summed.
std::vector<double> sumCellWeights(const Foam& foam, const Visibility& visibility);

}  // namespace froth
