// How well a foam in training shows photos.
#pragma once

#include <vector>

#include "trainer/loop/step_executor.h"

namespace froth {

// PSNR of a photo, over black and all channels, colours clamped to 0..1, over the pixels that count. 100 where all are
// equal. rendered: colour over black, transmittance.
double psnrOf(const Photo& photo, const std::vector<glm::vec4>& rendered);

// 0 without any.
double meanPsnr(const std::vector<double>& psnrs);

// Of `count` photos, spread over all; their views are in the normalised scene. `adam` as for StepExecutor::show().
Result<std::vector<double>> photoPsnrs(StepExecutor& executor, const std::vector<Photo>& photos, size_t count,
                                       const AdamStep<float>& adam);

}  // namespace froth
