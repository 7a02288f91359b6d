// The colour of one detail site, seen along a direction, from the cell's bits.
#ifndef FROTH_GPU_DETAIL_COLOUR_GLSL
#define FROTH_GPU_DETAIL_COLOUR_GLSL
#include "gpu/cell_bits.glsl"
#include "foam/appearance.h"

// direction: unit.
vec3 detailColour(CellCode code, CellHeader header, Lobes lobes, vec3 base, vec3 direction) {
  float weightSum = 0.0;
  vec3 colourSum = vec3(0.0);
  float largest = -3.402823466e38;
  for (uint lobe = 0; lobe < lobes.count; ++lobe) {
    float exponent = lobeExponent(takeAxis(code, header, lobes), direction);
    addLobe(exponent, takeLobeColour(code, header, lobes), largest, weightSum, colourSum);
  }
  return lobeColour(base, weightSum, colourSum);
}

#endif
