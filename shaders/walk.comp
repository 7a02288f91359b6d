// One ray per pixel from cell to cell through the regular triangulation. The entry into a cell is the exit of the one
// before; the key dot(direction, site), one fixed formula, grows with every step, so no rounding can make a walk cycle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "gpu/outputs.glsl"
#include "gpu/pixels.glsl"
#include "gpu/shade_hit.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

struct Step {
  uvec2 cell;
  float key;
  float entry;   // where the ray enters the cell
  bool isInside; // false: the ray has left the foam
};

float orderAlong(vec3 direction, vec3 centre) {
  precise float key = direction.x * centre.x + direction.y * centre.y + direction.z * centre.z;
  return key;
}

// The neighbour through whose plane the ray leaves the cell first.
Step nextStep(Step from, vec3 direction) {
  vec4 siteRadius = siteRadiusOf(from.cell);
  vec3 centre = ballOf(from.cell.x, siteRadius).centre;
  uvec2 row = neighbourRow(from.cell);
  Step next = Step(from.cell, from.key, kInfinity, false);
  for (uint i = row.x; i < row.y; ++i) {
    uvec2 other = neighbourAt(from.cell.x, i);
    vec4 otherSite = siteRadiusOf(other);
    float key = orderAlong(direction, ballOf(other.x, otherSite).centre);
    if (!(key > from.key)) continue;
    vec3 toNeighbour = fromSiteToSite(from.cell, siteRadius.xyz, other, otherSite.xyz);
    float q = dot(toNeighbour, direction);
    if (!(q > 0.0)) continue;
    float exit = radicalClearance(centre, toNeighbour, radicalOffset(toNeighbour, siteRadius.w, otherSite.w)) / q;
    if (exit < next.entry) next = Step(other, key, exit, true);
  }
  next.entry = max(next.entry, from.entry);
  return next;
}

uint visibleOfCell(uvec2 cell) {
  uint chunk = checkedChunk(cell.x);
  if (cell.y >= FRAME.chunks.v[chunk].liveCount) return kNoCell;
  return FRAME.slotOfCell.v[checked(FRAME.chunks.v[chunk].liveStart + cell.y, FRAME.visibleCapacity)];
}

void meetCell(uint visible, vec3 direction, float entry, float exit, inout Radiance radiance) {
  CellRecord cell = FRAME.records.v[checked(visible, FRAME.visibleCapacity)];
  float tNear, tFar;
  if (!intersectBall(cell.ball.xyz, cell.ball.w, direction, tNear, tFar)) return;
  tNear = max(tNear, entry);
  tFar = min(tFar, exit);
  if (tFar > tNear) shadeHit(visible, cell, direction, tNear, tFar, radiance);
}

void countSteps(uint steps, bool isCut) {
  if (isCut) atomicAdd(COUNTERS.stepLimit, 1u);
  if (!checkIndices) return;
  uint before = atomicAdd(COUNTERS.walkStepsLow, steps);
  if (before + steps < before) atomicAdd(COUNTERS.walkStepsHigh, 1u);
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= FRAME.regionWidth || pixel.y >= FRAME.regionHeight) return;
  vec3 direction = normalize(pixelRay(vec2(pixel)));
  Radiance radiance = emptyRadiance();

  uvec2 start = FRAME.walkStart.v[0];
  Step current = Step(start, orderAlong(direction, ballOfCell(start).centre), 0.0, true);
  uint steps = 0;
  while (current.isInside && !isSaturated(radiance) && steps < FRAME.maxSteps) {
    Step next = nextStep(current, direction);
    uint visible = visibleOfCell(current.cell);
    if (visible != kNoCell) meetCell(visible, direction, current.entry, next.entry, radiance);
    current = next;
    ++steps;
  }
  countSteps(steps, current.isInside && !isSaturated(radiance));
  writePixel(pixel, radiance.colour, opacity(-radiance.logTransmittance), radiance.distance, radiance.normal);
}
