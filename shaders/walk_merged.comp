// Walks one ray per pixel through several instances at once.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_RAYS 1
#define FROTH_MERGED
#include "gpu/pixels.glsl"
#include "gpu/walk_steps.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

struct Cursor {
  Step current;
  bool isInside;
  uint steps;
};

bool isAtEnd(Cursor cursor, float end) {
  if (!cursor.isInside || !(cursor.current.entry < end)) return true;
  bool isLimit = cursor.steps == FRAME.maxSteps || cursor.current.neighbours >= FRAME.maxNeighbours;
  if (isLimit) atomicAdd(COUNTERS.stepLimit, 1u);
  return isLimit;
}

bool meetNext(Shading shading, uvec2 pixel, float end, inout Cursor cursor, out Segment segment, out vec3 colour,
              out uint visible, out CellRecord cell) {
  vec3 ray = rayOf(pixel);
  ++cursor.steps;
  countWork(kWorkSteps, 1);
  float entry = cursor.current.entry;
  cursor.isInside = takeStep(shading, cursor.current, ray, visible, cell);
  if (visible == kNoCell) return false;
  Segment segments[kRays];
  segments[0] = meetInside(cell, ray, entry, min(cursor.current.entry, end));
  vec3 colours[kRays];
  bool isShown = !isEmpty(segments[0]) && shadeSegments(shading, visible, cell, vec3[](ray), segments, colours);
  segment = segments[0];
  colour = colours[0];
  return isShown;
}

#include "gpu/streams.glsl"

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  selectPart(0);
  if (!isInRegion(pixel)) return;
  findRayEnd(pixel);
  streamCount = 0;
  for (uint part = 0; part < push.partCount; ++part) {
    selectPart(part);
    Step first;
    if (!startWalk(loadShading(), pixel, rayOf(pixel), first)) continue;
    startStream(part, rayOf(pixel), Cursor(first, true, 0));
  }
  writeMerged(pixel, mergeStreams(pixel));
}
