// The image of a step, by pixel, row by row.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace froth {

template <class Real>
struct PixelArrays {
  glm::vec<4, Real>* rendered;   // [pixels] colour over black (display-coded), transmittance T_N
  Real* logTransmittances;       // [pixels] ln T_N, which the backward pass begins with: T_N may be 0 in floats
  uint32_t* ends;                // [pixels] how many cells of the tile's list the ray looked at
  glm::vec<4, Real>* gradients;  // [pixels] of the loss, by `rendered`: what the image loss writes
  const glm::vec<4, Real>*
      wanted;  // [pixels] colour of the photo over the mean of backgrounds; w: 1, or 0 where a mask ignores the pixel
};

}  // namespace froth
