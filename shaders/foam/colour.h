// Colours live, and are blended, in the display-coded space of the photos (sRGB); engines want linear light.
#ifndef FROTH_FOAM_COLOUR_H
#define FROTH_FOAM_COLOUR_H
#include "prelude.h"

// IEC 61966-2-1, extended past 1 by the same power law. value >= 0.
FOAM_FN real linearFromDisplay(real value) {
  return value <= real(0.04045) ? value / real(12.92) : pow((value + real(0.055)) / real(1.055), real(2.4));
}

FOAM_FN real displayFromLinear(real value) {
  return value <= real(0.0031308) ? value * real(12.92) : real(1.055) * pow(value, real(1.0 / 2.4)) - real(0.055);
}

// Premultiplied display-coded colour C with coverage A -> premultiplied linear colour A * decode(C / A).
FOAM_FN real3 linearPremultiplied(real3 colour, real coverage) {
  if (!(coverage > real(0))) return real3(real(0));
  return coverage * real3(linearFromDisplay(colour.x / coverage), linearFromDisplay(colour.y / coverage),
                          linearFromDisplay(colour.z / coverage));
}

// The inverse, used when a linear image is written to a file.
FOAM_FN real3 displayPremultiplied(real3 colour, real coverage) {
  if (!(coverage > real(0))) return real3(real(0));
  return coverage * real3(displayFromLinear(colour.x / coverage), displayFromLinear(colour.y / coverage),
                          displayFromLinear(colour.z / coverage));
}

#include "postlude.h"
#endif
