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

// The photos of a run, epoch after epoch.
class PhotoSequence {
 public:
  PhotoSequence(uint32_t count, uint64_t seed) : count_(count), seed_(seed) {}
  // The photos of a step of so many. A step that ends an epoch goes on with the next.
  std::vector<uint32_t> ofStep(uint32_t step, uint32_t photosPerStep);

 private:
  uint32_t count_;
  uint64_t seed_;
  std::vector<uint32_t> order_;
  uint64_t orderOf_ = UINT64_MAX;  // the epoch of order_
};

}  // namespace froth
