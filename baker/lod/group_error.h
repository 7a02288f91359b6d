// From which size of a pixel on a coarse form of a group stands for its fine form.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foam/foam.h"

namespace froth {

// How far two forms are apart in images of one resolution.
struct ErrorAtSize {
  double pixel = 0;  // [scene units]
  double worst = 0;  // mean squared difference in the worst direction
};

// Both forms alone, along parallel rays, over black and over white; each pixel is the mean of its rays. `eyes`: from
// where the foam is seen [scene units]: at most 14 directions, of every so many eyes. Foams that were trained on photos
// have no sense from where no photo was taken. Empty: 14 directions from all sides, which the seed turns. The
// difference counts over what either form covers, so empty space around does not dilute it. From the smallest pixel,
// one ray, to the largest. All cores; the same result on any number of them.
std::vector<ErrorAtSize> measureErrorCurve(const Foam& fine, const Foam& coarse, uint64_t seed,
                                           std::span<const glm::vec3> eyes = {});

// The PSNR that the forms keep in the worst direction, by docs/notes/levels.md.
inline constexpr double kGroupPsnr = 38;  // [dB]

// Size of a pixel [scene units] from which on `coarse` stands for `fine`: the worst direction has kGroupPsnr. Between
// the sizes of the curve, and outside of them, by powers; 0 where both forms look the same.
double measureGroupError(const Foam& fine, const Foam& coarse, uint64_t seed, std::span<const glm::vec3> eyes = {});

}  // namespace froth
