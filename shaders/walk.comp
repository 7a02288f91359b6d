// One ray per pixel from cell to cell. The entry into a cell is the exit of the one before.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_RAYS 1
#include "gpu/device_depth.glsl"
#include "gpu/hits.glsl"
#include "gpu/outputs.glsl"
#include "gpu/pixels.glsl"
#include "gpu/walk_steps.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (!isInRegion(pixel)) return;
  vec3 ray = rayOf(pixel);
  Shading shading = loadShading();
  Radiance radiances[kRays];
  radiances[0] = emptyRadiance();

  Step current;
  float end = sceneDistance(pixel, ray);
  bool isInside = startWalk(shading, pixel, ray, current);
  uint steps = 0;
  while (isInside && !isSaturated(shading, radiances[0]) && steps < FRAME.maxSteps &&
         current.neighbours < FRAME.maxNeighbours) {
    if (isFull && !(current.entry < end)) {
      isInside = false;
      break;
    }
    float entry = current.entry;
    uint visible;
    CellRecord cell;
    isInside = takeStep(shading, current, ray, visible, cell);
    if (visible != kNoCell) {
      Segment segment = meetInside(cell, ray, entry, isFull ? min(current.entry, end) : current.entry);
      if (!isEmpty(segment)) shadeHits(shading, visible, cell, vec3[](ray), Segment[](segment), radiances);
    }
    ++steps;
  }
  countWork(kWorkSteps, steps);
  if (isInside && !isSaturated(shading, radiances[0])) atomicAdd(COUNTERS.stepLimit, 1u);
  Radiance radiance = radiances[0];
  float depth = isFull ? deviceDepthAt(ray, radiance.distance) : 0.0;
  float distance = radiance.distance * FRAME.scale;
  writePixel(pixel, radiance.colour, coverageOf(radiance.logTransmittance), FRAME.exposure, distance,
             inWorld(radiance.normal), depth);
  if (isFull && wantsHits()) writeHit(pixel, distance, FRAME.part, cellCodeOf(radiance.cell));
  if (keepsQuarters && wantsQuarters()) {
    writeQuarters(pixel, radiance.quarters * FRAME.scale, uvec4(FRAME.part));
  }
}
