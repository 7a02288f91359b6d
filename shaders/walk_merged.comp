// Walks one ray per pixel through several instances at once.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_RAYS 1
#define FROTH_MERGED
#include "gpu/hit_records.glsl"
#include "gpu/pixels.glsl"
#include "gpu/walk_steps.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

// Where a ray is in an instance.
struct Cursor {
  Step current;
  bool isInside;
  uint steps;
};

Cursor cursors[kMostInstances];
float begins[kMostInstances];

float beginOf(uint part) { return begins[part]; }

// Bits of the instances in which the ray begins to walk.
uint startWalks(uvec2 pixel) {
  uint parts = 0;
  for (uint part = 0; part < push.partCount; ++part) {
    selectPart(part);
    if (!startWalk(loadShading(), pixel, rayOf(pixel), cursors[part].current)) continue;
    cursors[part].isInside = true;
    cursors[part].steps = 0;
    begins[part] = cursors[part].current.entry * FRAME.scale;
    parts |= 1u << part;
  }
  return parts;
}

// Whether the walk goes on in the instance at hand.
bool mayStep(Cursor cursor, float end) {
  if (!cursor.isInside || !(cursor.current.entry < end) || isBehindKnown(cursor.current.entry)) return false;
  bool isLimit = cursor.steps == FRAME.maxSteps || cursor.current.neighbours >= FRAME.maxNeighbours;
  if (isLimit) atomicAdd(COUNTERS.stepLimit, 1u);
  return !isLimit;
}

// What the ray gains in one instance.
void walkPart(uint part, uvec2 pixel, float logTransmittance) {
  startPart(part);
  Shading shading = loadShading();
  vec3 ray = rayOf(pixel);
  float end = endInPart(ray);
  Cursor cursor = cursors[part];
  while (!isCut && mayStep(cursor, end)) {
    ++cursor.steps;
    countWork(kWorkSteps, 1);
    float entry = cursor.current.entry;
    uint visible;
    CellRecord cell;
    cursor.isInside = takeStep(shading, cursor.current, ray, visible, cell);
    if (visible == kNoCell) continue;
    Segment segments[kRays];
    segments[0] = meetInside(cell, ray, entry, min(cursor.current.entry, end));
    vec3 colours[kRays];
    if (isEmpty(segments[0]) || !shadeSegments(shading, visible, cell, vec3[](ray), segments, colours)) continue;
    countWork(kWorkColours, 1);
    recordHit(shading, segments[0], cell.face.w, colours[0], visible, logTransmittance);
  }
  cursors[part] = cursor;
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  selectPart(0);
  if (!isInRegion(pixel)) return;
  float end = findRayEnd(pixel);
  startRay(startWalks(pixel), end);
  Merged merged = emptyMerged();
  bool goesOn = partsOfRay != 0;
  while (goesOn) {
    known = rayEnd;
    for (uint left = partsOfRay; left != 0;) walkPart(takeNearest(left), pixel, merged.radiance.logTransmittance);
    goesOn = mergeRecords(merged);
  }
  writeMerged(pixel, merged);
}
