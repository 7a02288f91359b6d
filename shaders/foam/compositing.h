// Front-to-back compositing along one ray. Transmittance T is carried as its logarithm.
#ifndef FROTH_FOAM_COMPOSITING_H
#define FROTH_FOAM_COMPOSITING_H
#include "prelude.h"

// 1 - exp(-opticalDepth) by its series: below 1/16 five terms leave a relative error under 2^-24.
FOAM_FN real seriesOpacity(real opticalDepth) {
  real x = opticalDepth;
  return x * (real(1) - x * (real(0.5) - x * (real(1.0 / 6.0) - x * (real(1.0 / 24.0) - x * real(1.0 / 120.0)))));
}

// 1 - exp(-opticalDepth), to full relative precision for thin cells (GLSL has no expm1).
FOAM_FN real opacity(real opticalDepth) {
#if defined(__cplusplus)
  return -std::expm1(-opticalDepth);
#else
  return opticalDepth < real(0.0625) ? seriesOpacity(opticalDepth) : real(1) - exp(-opticalDepth);
#endif
}

// 1 - T of a ray; 0, not -0, where it met nothing.
FOAM_FN real coverageOf(real logTransmittance) { return opacity(abs(logTransmittance)); }

// Distance at which transmittance falls to `quantile` inside a cell that the ray enters at tNear with T > quantile.
FOAM_FN real quantileDistance(real tNear, real logTransmittance, real logQuantile, real density) {
  return tNear + (logTransmittance - logQuantile) / density;
}

#include "postlude.h"
#endif
