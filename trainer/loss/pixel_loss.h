// What a pixel of a rendering costs against its photo, and the gradient of that. Templates over real, for the CPU and
// for CUDA kernels (shaders/foam/prelude.h).
//
// A photo is premultiplied and says with alpha a < 1 that it does not know what lies behind. So both images are laid
// over a background B, uniform in 0..1, another one for each pixel and channel: a rendering with colour c and
// transmittance T, of a photo with colour g, becomes c + T B, the photo g + (1 - a) B.
#ifndef FROTH_PIXEL_LOSS_H
#define FROTH_PIXEL_LOSS_H
#include "shaders/foam/prelude.h"

// SSIM (Wang et al. 2004): a Gaussian of 11 x 11 pixels with sigma 1.5, and constants for values in 0..1.
const int kSimilarityRadius = 5;

// exp(-offset^2 / (2 sigma^2)) over its sum from -5 to 5; the window is the product of two. offset in -5..5.
FOAM_FN real similarityWeight(int offset, real) {
  const real weights[6] = {real(0.26601172486179436), real(0.21300553771125370), real(0.10936068950970003),
                           real(0.03600077212843083), real(0.00759875813523919), real(0.00102838008447911)};
  return weights[offset < 0 ? -offset : offset];
}

// Both images over middle grey, the mean of the backgrounds: SSIM compares structure, and random backgrounds would be
// structure that neither scene nor photo has.
FOAM_FN real overGrey(real premultiplied, real transmittance) { return premultiplied + real(0.5) * transmittance; }

// One channel's expected square over all backgrounds: with e = c - g and D = T - (1 - a), the mean of (e + D B)^2 is
// (e + D/2)^2 + D^2/12. No random numbers, so no noise.
FOAM_FN real squareOverBackgrounds(real e, real D, FOAM_OUT(real) byColour, FOAM_OUT(real) byTransmittance) {
  real middle = e + real(0.5) * D;
  byColour = real(2) * middle;
  byTransmittance = middle + D / real(6);
  return middle * middle + D * D / real(12);
}

// SSIM of a window from its means of x, y, x^2, y^2 and x y, and its derivatives by the means of x, x^2 and x y.
FOAM_FN real similarity(real x, real y, real xx, real yy, real xy, FOAM_OUT(real3) gradient) {
  real c1 = real(0.01 * 0.01);
  real c2 = real(0.03 * 0.03);
  real means = real(2) * x * y + c1;
  real meanSquares = x * x + y * y + c1;
  real covariance = real(2) * (xy - x * y) + c2;
  real variances = xx - x * x + yy - y * y + c2;
  real scale = real(1) / (meanSquares * variances);
  real value = means * covariance * scale;
  gradient = real3(
      real(2) * y * (covariance - means) * scale + real(2) * x * value * (real(1) / variances - real(1) / meanSquares),
      -value / variances, real(2) * means * scale);
  return value;
}

#include "shaders/foam/postlude.h"
#endif
