// How well a foam in training shows photos that it does not know.
#pragma once

#include <vector>

#include "trainer/cpu/foam_storage.h"
#include "trainer/photos/photos.h"
#include "trainer/step/adam.h"

namespace froth {

// PSNR of a photo, over black and all channels, colours clamped to 0..1, over the pixels that count. 100 where all are
// equal. rendered: colour over black, transmittance.
double psnrOf(const Photo& photo, const std::vector<glm::vec4>& rendered);

// 0 without any.
double meanPsnr(const std::vector<double>& psnrs);

// The PSNR of each photo, on the CPU, before the step `adam`. Activates the balls; all else stays.
std::vector<double> photoPsnrs(FoamStorage<float>& foam, const std::vector<Photo>& photos, const AdamStep<float>& adam);

}  // namespace froth
