// One ray per pixel from cell to cell through the regular triangulation. The entry into a cell is the exit of the one
// before. A ray's state of the chunk it is in stays in registers; a step into a ghost changes the chunk.
//
// No rounding can make a walk cycle: a step into a site of a chunk, be it a cell or a ghost, has the key
// dot(direction, site), which is one fixed number for a ray, a chunk and a site. A step is taken only to a greater key, and
// the key goes with the walk into the next chunk. So no (chunk, site) comes twice, however a cell's key is rounded in its
// own chunk and in those that know it as a ghost.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "gpu/outputs.glsl"
#include "gpu/pixels.glsl"
#include "gpu/shade_hit.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

struct Step {
  uint site;     // of the chunk in which the step was made
  float key;
  float entry;   // where the ray enters the cell
  bool isInside; // false: the ray has left the foam
};

float orderAlong(vec3 direction, vec3 centre) {
  precise float key = direction.x * centre.x + direction.y * centre.y + direction.z * centre.z;
  return key;
}

// The neighbour through whose plane the ray leaves the cell first.
Step nextStep(Chunk chunk, Step from, vec3 direction) {
  vec4 siteRadius = siteRadiusOf(chunk, from.site);
  vec3 centre = ballOf(chunk, siteRadius).centre;
  uvec2 row = neighbourRow(chunk, from.site);
  Step next = Step(from.site, from.key, kInfinity, false);
  countWork(kWorkNeighbours, row.y - row.x);
  for (uint i = row.x; i < row.y; ++i) {
    uint other = neighbourAt(chunk, i);
    vec4 otherSite = siteRadiusOf(chunk, other);
    float key = orderAlong(direction, ballOf(chunk, otherSite).centre);
    if (!(key > from.key)) continue;
    vec3 toNeighbour = fromSiteToSite(siteRadius.xyz, otherSite.xyz);
    float q = dot(toNeighbour, direction);
    if (!(q > 0.0)) continue;
    float exit = radicalClearance(centre, toNeighbour, radicalOffset(toNeighbour, siteRadius.w, otherSite.w)) / q;
    if (exit < next.entry) next = Step(other, key, exit, true);
  }
  next.entry = max(next.entry, from.entry);
  return next;
}

uint visibleOfCell(Chunk chunk, uint cell) {
  if (cell >= chunk.liveCount) return kNoCell;
  uint words = FRAME.groupsPerChunk * kMaskWords;
  uvec2 word = FRAME.visibility.v[checked(chunk.index * words + cell / 32, FRAME.chunkCount * words)];
  uint bit = 1u << (cell % 32);
  return (word.x & bit) != 0 ? word.y + bitCount(word.x & (bit - 1)) : kNoCell;
}

// From the ghost that a step has led to, on to the cell for which it stands.
void enterGhost(inout Chunk chunk, inout Step current) {
  uvec2 cell = cellOfGhost(chunk, current.site);
  chunk = loadChunk(cell.x);
  current.site = cell.y;
}

void meetCell(uint visible, vec3 direction, float entry, float exit, inout Radiance radiance) {
  CellRecord cell = FRAME.records.v[checked(visible, FRAME.visibleCapacity)];
  float tNear, tFar;
  if (!intersectBall(cell.ball.xyz, cell.ball.w, direction, tNear, tFar)) return;
  countWork(kWorkBallHits, 1);
  tNear = max(tNear, entry);
  tFar = min(tFar, exit);
  if (tFar > tNear) shadeHit(visible, cell, direction, tNear, tFar, radiance);
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (pixel.x >= FRAME.regionWidth || pixel.y >= FRAME.regionHeight) return;
  vec3 direction = normalize(pixelRay(vec2(pixel)));
  Radiance radiance = emptyRadiance();

  uvec2 start = FRAME.walkStart.v[0];
  Chunk chunk = loadChunk(start.x);
  Step current = Step(start.y, orderAlong(direction, ballOfSite(chunk, start.y).centre), 0.0, true);
  uint steps = 0;
  while (current.isInside && !isSaturated(radiance) && steps < FRAME.maxSteps) {
    Step next = nextStep(chunk, current, direction);
    uint visible = visibleOfCell(chunk, current.site);
    if (visible != kNoCell) meetCell(visible, direction, current.entry, next.entry, radiance);
    current = next;
    if (isGhost(chunk, current.site)) enterGhost(chunk, current);
    ++steps;
  }
  countWork(kWorkSteps, steps);
  if (current.isInside && !isSaturated(radiance)) atomicAdd(COUNTERS.stepLimit, 1u);
  writePixel(pixel, radiance.colour, opacity(-radiance.logTransmittance), radiance.distance, radiance.normal);
}
