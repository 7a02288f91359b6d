// How far two images are apart. Conventions of docs/FOAM.md "Conventions of images and errors".
#pragma once

#include <cstdint>

#include "base/image/image.h"
#include "base/result.h"

namespace froth {

struct ImageDifference {
  // -10 log10 of the mean square over pixels and channels, both clamped to 0..1, peak 1 [dB]; +inf if equal, NaN if a
  // value is.
  double psnr = 0;
  double psnrChannelMean = 0;  // mean over channels of the channel's PSNR, as published figures are [dB]
  // Gaussian window 11x11, sigma 1.5, windows wholly inside, clamped to 0..1, mean over channels; NaN where a side has
  // fewer than 11 pixels.
  double ssim = 0;
  double maxError = 0;   // largest absolute difference, not clamped; +inf where a value is NaN
  double meanError = 0;  // mean absolute difference over pixels and channels, not clamped; +inf where a value is NaN
  uint32_t worstX = 0, worstY = 0;  // the first pixel with the largest difference
  double overOneStep = 0;           // share of pixels with a channel off by more than 1/255
  double overTwoSteps = 0;          // ... by more than 2/255
};

// Fails if sizes or channels differ.
Result<ImageDifference> compareImages(const Image& a, const Image& b);

}  // namespace froth
