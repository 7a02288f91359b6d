// How much each cell of a foam shows: what merging weighs cells by.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

struct ContributionOptions {
  double nearRatio = 4, nearDepth = 0;  // where a view does not say
  uint32_t pixelsPerView = 80'000;      // views are reduced to about this size
};

// [cells] the sum of T alpha over the pixels of the views. The same bits on any number of threads. Fails with
// kCancelled.
Result<std::vector<double>> measureContributions(const Foam& foam, std::span<const View> views,
                                                 const ContributionOptions& options, const Progress& progress = {});

}  // namespace froth
