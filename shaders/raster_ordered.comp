// Draws the tiles that several instances share whose boxes do not meet, one instance behind the other (parts are ordered
// so: runtime/render/part_order.h), and those that none has cells in.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_MERGED
#include "gpu/draw_cell.glsl"
#include "gpu/merged_pixels.glsl"
#include "gpu/shared_tiles.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kRows) in;

// The radiance so far, to be gone on with in the units and axes of the part at hand.
Radiance startPart(Merged merged) {
  Radiance radiance = merged.radiance;
  radiance.normal = vec3(0.0);
  radiance.cell = kNoCell;
  return radiance;
}

// What the part at hand has made of it.
void endPart(uint part, Radiance radiance, inout Merged merged) {
  float scale = FRAME.scale;
  float opticalDepth = merged.radiance.logTransmittance - radiance.logTransmittance;
  if (opticalDepth > 0.0) {  // not where both are infinite
    merged.exposures += FRAME.exposure * exp(merged.radiance.logTransmittance) * opacity(opticalDepth);
  }
  merged.radiance.colour = radiance.colour;
  merged.radiance.logTransmittance = radiance.logTransmittance;
  if (keepsQuarters) {
    bvec4 isNew = notEqual(merged.radiance.quarters, radiance.quarters);
    merged.radiance.quarters = mix(merged.radiance.quarters, radiance.quarters * scale, isNew);
    merged.quarterParts = mix(merged.quarterParts, uvec4(part), isNew);
  }
  if (!isFull) return;
  merged.radiance.normal += inWorld(radiance.normal);
  if (!isinf(merged.radiance.distance)) return;
  merged.radiance.distance = radiance.distance * scale;
  if (radiance.cell == kNoCell) return;
  merged.part = part;
  merged.radiance.cell = cellCodeOf(radiance.cell);
}

void drawPart(uint part, uvec2 range, uvec2 corner, inout Merged merged[kRays]) {
  selectPart(part);
  Shading shading = loadShading();
  vec3 rays[kRays];
  float ends[kRays];
  Radiance radiances[kRays];
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = pixelOfThread(corner, r);
    rays[r] = rayOf(pixel);
    ends[r] = isInRegion(pixel) ? sceneDistance(pixel, rays[r]) : 0.0;
    radiances[r] = startPart(merged[r]);
  }
  drawList(shading, range, corner, rays, ends, radiances);
  for (uint r = 0; r < kRays; ++r) endPart(part, radiances[r], merged[r]);
  barrier();  // the next list may overwrite what its last batch was asked for
}

// Whether any ray of the workgroup goes on. Every thread calls it, at the same place.
bool goesOn(Merged merged[kRays]) {
  Radiance radiances[kRays];
  for (uint r = 0; r < kRays; ++r) radiances[r] = merged[r].radiance;
  if (gl_LocalInvocationIndex == 0) liveMask = 0;
  barrier();
  if (!areSaturated(loadShading(), radiances)) atomicOr(liveMask, 1u);
  barrier();
  bool isAny = liveMask != 0;
  barrier();
  return isAny;
}

void main() {
  selectPart(0);
  uvec2 corner = gl_WorkGroupID.xy * kSubTileSize;
  uint tile = corner.y / kTileSize * FRAME.tilesX + corner.x / kTileSize;
  uint parts = partsIn(tile);
  if (!isInRegion(corner) || !isInOrder(parts)) return;
  Merged merged[kRays];
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = pixelOfThread(corner, r);
    merged[r] = Merged(startOf(pixel, rayOf(pixel)), 0u, uvec4(0), 0.0);
  }
  for (uint part = 0; part < push.partCount; ++part) {
    if ((parts >> part & 1) == 0) continue;
    if (!goesOn(merged)) break;
    drawPart(part, tileRange(push.parts[part], tile), corner, merged);
  }
  selectPart(0);
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = pixelOfThread(corner, r);
    if (!isInRegion(pixel)) continue;
    if (seesNothing(rayOf(pixel))) merged[r].radiance = emptyRadiance();
    writeMerged(pixel, merged[r]);
  }
}
