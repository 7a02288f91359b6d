// Draws the tiles that several instances share whose boxes do not meet, one instance behind the other (parts are ordered
// so: runtime/render/part_order.h), and those that none has cells in.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_MERGED
#include "gpu/device_depth.glsl"
#include "gpu/hits.glsl"
#include "gpu/outputs.glsl"
#include "gpu/shared_tiles.glsl"
#include "gpu/tile_list.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kRows) in;

// What a pixel shows of the parts so far, in the world's units and axes.
struct Shown {
  vec3 colour, normal;
  float logTransmittance, distance;
  float exposures;  // weighed by what each part contributes
  uint part, cellCode;
  vec4 quarters;
  uvec4 quarterParts;
};

// In units of the part at hand, as far as it is to go on from there.
Radiance partOf(Shown shown) {
  return Radiance(shown.colour, shown.logTransmittance, vec3(0.0), shown.distance, kNoCell, shown.quarters);
}

void takePart(uint part, Radiance radiance, inout Shown shown) {
  float scale = FRAME.scale;
  shown.exposures += FRAME.exposure * (exp(shown.logTransmittance) - exp(radiance.logTransmittance));
  shown.colour = radiance.colour;
  shown.logTransmittance = radiance.logTransmittance;
  if (keepsQuarters) {
    bvec4 isNew = notEqual(shown.quarters, radiance.quarters);
    shown.quarters = mix(shown.quarters, radiance.quarters * scale, isNew);
    shown.quarterParts = mix(shown.quarterParts, uvec4(part), isNew);
  }
  if (!isFull) return;
  shown.normal += inWorld(radiance.normal);
  if (!isinf(shown.distance)) return;
  shown.distance = radiance.distance * scale;
  if (radiance.cell == kNoCell) return;
  shown.part = part;
  shown.cellCode = cellCodeOf(radiance.cell);
}

void drawPart(uint part, uvec2 range, uvec2 corner, inout Shown shown[kRays]) {
  selectPart(part);
  Shading shading = loadShading();
  vec3 rays[kRays];
  float ends[kRays];
  Radiance radiances[kRays];
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = pixelOfThread(corner, r);
    rays[r] = rayOf(pixel);
    ends[r] = isInRegion(pixel) ? sceneDistance(pixel, rays[r]) : 0.0;
    radiances[r] = partOf(shown[r]);
  }
  drawList(shading, range, corner, rays, ends, radiances);
  for (uint r = 0; r < kRays; ++r) takePart(part, radiances[r], shown[r]);
  barrier();  // the next list may overwrite what its last batch was asked for
}

void writeShown(uvec2 pixel, Shown shown) {
  vec3 ray = rayOf(pixel);
  float depth = isFull ? deviceDepthAt(ray, shown.distance / FRAME.scale) : 0.0;
  float coverage = coverageOf(seesNothing(ray) ? 0.0 : shown.logTransmittance);
  float exposure = coverage > 0.0 ? shown.exposures / coverage : 1.0;
  writePixel(pixel, shown.colour, coverage, exposure, shown.distance, shown.normal, depth);
  if (isFull && wantsHits()) writeHit(pixel, shown.distance, shown.part, shown.cellCode);
  if (keepsQuarters && wantsQuarters()) writeQuarters(pixel, shown.quarters, shown.quarterParts);
}

void main() {
  selectPart(0);
  uvec2 corner = gl_WorkGroupID.xy * kSubTileSize;
  uint tile = corner.y / kTileSize * FRAME.tilesX + corner.x / kTileSize;
  uint parts = partsIn(tile);
  if (!isInRegion(corner) || !isInOrder(parts)) return;
  Shown shown[kRays];
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = pixelOfThread(corner, r);
    float begin = startOf(pixel, rayOf(pixel)).logTransmittance;
    shown[r] = Shown(vec3(0.0), vec3(0.0), begin, kInfinity, 0.0, 0u, kNoCell, vec4(kInfinity), uvec4(0));
  }
  for (uint part = 0; part < push.partCount; ++part) {
    if ((parts >> part & 1) != 0) drawPart(part, tileRange(push.parts[part], tile), corner, shown);
  }
  selectPart(0);
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = pixelOfThread(corner, r);
    if (isInRegion(pixel)) writeShown(pixel, shown[r]);
  }
}
