// What a pixel shows, as four places. Along a ray transmittance falls from 1. Each quarter of that range stands where
// transmittance falls below the quarter's middle: for 1 to 3/4 that is 7/8, then 5/8, 3/8, 1/8. A quarter that the ray
// does not reach stands behind the foam.
//
// The reactive mask asks which part of a pixel its motion vector does not explain. A quarter whose own motion differs
// from the pixel's counts by how far they are apart.
#ifndef FROTH_FOAM_QUARTERS_H
#define FROTH_FOAM_QUARTERS_H
#include "prelude.h"

FOAM_FN real middleOfQuarter(int quarter) { return real(0.875) - real(0.25) * real(quarter); }

// The part of a quarter that counts. apart: [pixels] from one pixel on its history is another pixel's.
FOAM_FN real unexplainedPart(real apart) { return min(apart, real(1)); }

#include "postlude.h"
#endif
