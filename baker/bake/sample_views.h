// What a lossy asset looks like beside its input. Internal to baker/bake.
#pragma once

#include "baker/bake/bake.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"

namespace froth {

inline constexpr double kMaxPsnr = 200;  // stands for equal images

// PSNR over all pixels of some reduced views; by the float reference. [dB], at most kMaxPsnr
struct SampledPsnr {
  double given = 0;                  // of the cameras, or around the foam if there are none
  double drawn = 0, worstDrawn = 0;  // from other eyes of the region than the bake was given; 0: it has no others
};

// Fails with kCancelled.
Result<SampledPsnr> measurePsnr(const Foam& input, const Foam& baked, const EyeRegion& eyes, const BakeOptions& options,
                                const Progress& progress);

}  // namespace froth
