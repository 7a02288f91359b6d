// Gradients of compositing.h, for training. A ray is taken back to front, so that what lies behind a cell is one
// number: behind = sum over the cells behind it of T alpha e, plus T_N times the derivative of the loss by T_N.
#ifndef FROTH_FOAM_COMPOSITING_GRADIENT_H
#define FROTH_FOAM_COMPOSITING_GRADIENT_H
#include "prelude.h"

// By the optical depth of a cell. shown: e, the derivative of the loss by the cell's weight T alpha. transmittance:
// behind the cell; weight: T alpha. Puts the cell into `behind`.
FOAM_FN real opticalDepthGradient(real transmittance, real weight, real shown, FOAM_INOUT(real) behind) {
  real gradient = transmittance * shown - behind;
  behind = behind + weight * shown;
  return gradient;
}

#include "postlude.h"
#endif
