// The photos of a capture, as training compares renderings with them.
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "reference/capture/capture.h"

namespace froth {

enum class AlphaForm { kStraight, kPremultiplied };

struct PhotoOptions {
  double downscale = 1;                     // [>= 1] sides are divided by it and rounded
  AlphaForm alpha = AlphaForm::kStraight;   // of PNG files with alpha; the PNG standard says straight
  bool isMaskAlpha = false;                 // masks cut the object out: what they ignore is background, not unknown
  uint64_t mostBytes = uint64_t{64} << 30;  // of all photos in memory; they are not read if they take more
};

// Display-coded, 4 bytes per pixel: 97 photos of 1319 x 989 take 506 MB.
struct Photo {
  View view;                     // of the photo's own size: intrinsics are scaled with it
  std::vector<uint8_t> rgba;     // [height * width * 4] premultiplied; alpha 0: what is there is not known
  std::vector<uint8_t> counted;  // [height * width] 0: a mask ignores the pixel; empty: all count
};

// In the order of the views, read on all threads. Checks that each file is there, is of its camera's size, and fits
// with its mask; the error is that of the first faulty view in their order. Memory: the photos, and one at full size
// per thread.
Result<std::vector<Photo>> readPhotos(const std::vector<CapturedView>& views, const PhotoOptions& options,
                                      const Progress& progress = {});

}  // namespace froth
