// The error that a PSNR is of.
#pragma once

#include "base/image/image.h"

namespace froth {

// Over pixels and channels, both images clamped to 0..1. They must have the same size and channels, and pixels.
double meanSquare(const Image& a, const Image& b);

// -10 log10(meanSquare): PSNR of peak 1 [dB]; +inf for 0, NaN for NaN.
double decibels(double meanSquare);

}  // namespace froth
