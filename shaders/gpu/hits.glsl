// Leaves where the ray of a pixel was stopped for the passes over hits (write_ids.comp and so on).
#ifndef FROTH_GPU_HITS_GLSL
#define FROTH_GPU_HITS_GLSL
#include "gpu/asset.glsl"

// Of the cell in a slot of the list of visible cells; kNoCell stays.
uint cellCodeOf(uint slot) {
  if (slot == kNoCell) return kNoCell;
  uvec2 cell = namedCell(FRAME.visibleCells.v[checked(slot, FRAME.visibleCapacity)].xy);
  return FRAME.localBits < 32 ? cell.x << FRAME.localBits | cell.y : cell.y;
}

// `pixel` counts from the region's corner; distance in world units; part: of the instance in the recording.
void writeHit(uvec2 pixel, float distance, uint part, uint cellCode) {
  uint place = kHitWords * (pixel.y * FRAME.regionWidth + pixel.x);
  FRAME.hits.v[place] = floatBitsToUint(distance);
  FRAME.hits.v[place + 1] = part;
  FRAME.hits.v[place + 2] = cellCode;
}

// Places in world units; parts: of their instances.
void writeQuarters(uvec2 pixel, vec4 places, uvec4 parts) {
  FRAME.quarters.v[pixel.y * FRAME.regionWidth + pixel.x] = (floatBitsToUint(places) & ~kQuarterPartMask) | parts;
}

bool wantsQuarters() { return (FRAME.flags & kFlagQuarters) != 0; }

bool wantsHits() { return (FRAME.flags & kFlagHits) != 0; }

#endif
