// Which photos train, which test, and in which order the former come.
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "reference/capture/capture.h"

namespace froth {

// Indices of views, ascending.
struct PhotoSplit {
  std::vector<uint32_t> training, test;
};

// What the capture says; if it says nothing, every `period`-th view from the first tests, by name, and none with 0.
// Fails with fewer than 2 views for training.
Result<PhotoSplit> splitPhotos(const std::vector<CapturedView>& views, uint32_t period = 8);

// A permutation of 0..count-1 for each epoch, from the seed alone.
std::vector<uint32_t> epochOrder(uint32_t count, uint64_t seed, uint64_t epoch);

}  // namespace froth
