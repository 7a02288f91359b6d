// What a pixel shows of several instances, and how it is written.
#ifndef FROTH_GPU_MERGED_PIXELS_GLSL
#define FROTH_GPU_MERGED_PIXELS_GLSL
#include "gpu/device_depth.glsl"
#include "gpu/hits.glsl"
#include "gpu/outputs.glsl"
#include "gpu/pixels.glsl"
#include "gpu/shade_hit.glsl"

struct Merged {
  Radiance radiance;   // in the world's units and axes, with the code of its cell
  uint part;           // whose that is
  uvec4 quarterParts;  // whose Radiance::quarters are
  float exposures;     // of the instances, each weighed by what it contributes
};

Merged emptyMerged() { return Merged(emptyRadiance(), 0u, uvec4(0), 0.0); }

void writeMerged(uvec2 pixel, Merged merged) {
  Radiance radiance = merged.radiance;
  selectPart(0);
  float depth = isFull ? deviceDepthAt(rayOf(pixel), radiance.distance / FRAME.scale) : 0.0;
  float coverage = coverageOf(radiance.logTransmittance);
  float exposure = coverage > 0.0 ? merged.exposures / coverage : 1.0;
  writePixel(pixel, radiance.colour, coverage, exposure, radiance.distance, radiance.normal, depth);
  if (isFull && wantsHits()) writeHit(pixel, radiance.distance, merged.part, radiance.cell);
  if (keepsQuarters && wantsQuarters()) writeQuarters(pixel, radiance.quarters, merged.quarterParts);
}

#endif
