// What a lossy asset looks like beside its input. Internal to baker/bake.
#pragma once

#include "baker/bake/bake.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"

namespace froth {

// PSNR over a few reduced views of the cameras, or around the foam if there are none; by the float reference. [dB], at most
// kMaxPsnr. Fails with kCancelled.
inline constexpr double kMaxPsnr = 200;  // stands for equal images
Result<double> measurePsnr(const Foam& input, const Foam& baked, const BakeOptions& options, const Progress& progress);

}  // namespace froth
