// One ray per pixel from cell to cell through the regular triangulation. The entry into a cell is the exit of the one
// before.
//
// Most cells on the way are listed: they have a record, and a row of eye planes through which a ray can leave them, each with a
// link to the next record. From a cell without one (its ball lies outside the view, or there was no space) a ray goes on by the
// sites around it.
//
// No rounding can make a walk cycle: each step has a key, the dot product of the direction and the site it leads to, and is
// taken only to a greater key. The key of a record is one fixed number for a ray, and so is that of a site of a chunk, be it a
// cell or a ghost; the key of the last step goes with the walk. So no record and no site comes twice.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROTH_RAYS 1
#include "gpu/descend.glsl"
#include "gpu/device_depth.glsl"
#include "gpu/eye_planes.glsl"
#include "gpu/hits.glsl"
#include "gpu/outputs.glsl"
#include "gpu/pixels.glsl"
#include "gpu/shade_hit.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

struct Step {
  uint visible;  // of a listed cell; else kNoCell, and
  uvec2 cell;    // its chunk and local index
  float key;
  float entry;   // where the ray enters the cell
};

float nearnessOfNoExit() { return isParallel ? -kInfinity : 0.0; }

float orderAlong(vec3 direction, vec3 centre) {
  precise float key = direction.x * centre.x + direction.y * centre.y + direction.z * centre.z;
  return key;
}

Step stepTo(uvec2 cell, float key, float entry) { return Step(slotOfCell(cell), cell, key, entry); }

// To a site of the chunk; from a ghost on to the cell for which it stands.
Step stepToSite(Chunk chunk, uint site, float key, float entry) {
  return stepTo(cellOfSite(chunk, site), key, entry);
}

// The neighbour through whose plane the ray leaves the cell first, by their sites. Returns false: the ray leaves the foam.
bool findNextSite(inout Step current, vec3 ray) {
  vec3 direction = directionOfRay(ray);
  uvec2 cell = current.visible == kNoCell ? current.cell : FRAME.visibleCells.v[current.visible].xy;
  Chunk chunk = loadChunk(cell.x);
  vec4 siteRadius = siteRadiusOf(chunk, cell.y);
  uvec2 row = neighbourRow(chunk, cell.y);
  uint next = kNoCell;
  float nextKey = current.key;
  float exitNearness = nearnessOfNoExit();
  countWork(kWorkNeighbours, row.y - row.x);
  for (uint i = row.x; i < row.y; ++i) {
    uint other = neighbourAt(chunk, i);
    vec4 otherSite = siteRadiusOf(chunk, other);
    float key = orderAlong(direction, ballOf(chunk, otherSite).centre);
    bool isFar;
    float nearness = dot(eyePlaneTo(chunk, siteRadius, otherSite, isFar), ray);
    if (isFar && key > current.key && nearness > exitNearness) {
      exitNearness = nearness;
      next = other;
      nextKey = key;
    }
  }
  float exit = max(distanceAt(exitNearness), current.entry);
  if (next == kNoCell) {
    current.entry = exit;
    return false;
  }
  current = stepToSite(chunk, next, nextKey, exit);
  return true;
}

// The same by the record's eye planes.
bool findNextRecord(Shading shading, inout Step current, CellRecord cell, vec3 ray) {
  vec3 direction = directionOfRay(ray);
  uint link = kNoCell;
  float exitNearness = nearnessOfNoExit();
  countWork(kWorkNeighbours, cell.planeSplit - cell.planeBegin);
  for (uint i = cell.planeBegin; i < cell.planeSplit; ++i) {
    vec4 plane = shading.planes.v[checked(i, FRAME.planeCapacity)];
    float nearness = dot(plane.xyz, ray);
    if (nearness > exitNearness) {
      exitNearness = nearness;
      link = floatBitsToUint(plane.w);
    }
  }
  float exit = max(distanceAt(exitNearness), current.entry);
  if (link == kNoCell) {
    current.entry = exit;
    return false;
  }
  if ((link & kUnlisted) != 0) {
    Chunk chunk = loadChunk(FRAME.visibleCells.v[current.visible].x);
    uint site = link & ~kUnlisted;
    float key = orderAlong(direction, ballOfSite(chunk, site).centre);
    if (!(key > current.key)) return findNextSite(current, ray);
    current = stepToSite(chunk, site, key, exit);
    return true;
  }
  float key = orderAlong(direction, shading.records.v[checked(link, FRAME.visibleCapacity)].ball.xyz);
  if (!(key > current.key)) return findNextSite(current, ray);
  current = Step(link, uvec2(0), key, exit);
  return true;
}

void meetCell(Shading shading, uint visible, CellRecord cell, vec3 ray, float entry, float exit,
              inout Radiance radiance[kRays]) {
  float tNear, tFar;
  if (!meetBall(cell.ball, ray, tNear, tFar)) return;
  countWork(kWorkBallHits, 1);
  Segment segment = Segment(max(tNear, entry), min(tFar, exit));
  if (isEmpty(segment)) return;
  shadeHits(shading, visible, cell, vec3[](ray), Segment[](segment), radiance);
}

// Parallel rays start in cells of their own, near that of the tile.
uvec2 startCell(uvec2 pixel, vec3 ray) {
  if (!isParallel) return FRAME.walkStart.v[0];
  uvec2 tile = pixel / kTileSize;
  return cellHolding(startOfRay(ray), FRAME.walkStart.v[tile.y * FRAME.tilesX + tile.x]);
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (!isInRegion(pixel)) return;
  vec3 ray = rayOf(pixel);
  Shading shading = loadShading();
  Radiance radiances[kRays];
  radiances[0] = emptyRadiance();

  uvec2 start = startCell(pixel, ray);
  float startKey = orderAlong(directionOfRay(ray), ballOfSite(loadChunk(start.x), start.y).centre);
  Step current = stepTo(start, startKey, 0.0);
  float end = sceneDistance(pixel, ray);
  bool isInside = !seesNothing(ray);
  uint steps = 0;
  while (isInside && !isSaturated(shading, radiances[0]) && steps < FRAME.maxSteps) {
    if (isFull && !(current.entry < end)) {
      isInside = false;
      break;
    }
    uint visible = current.visible;
    float entry = current.entry;
    if (visible == kNoCell) {
      isInside = findNextSite(current, ray);
    } else {
      CellRecord cell = shading.records.v[checked(visible, FRAME.visibleCapacity)];
      bool hasRow = cell.planeBegin < cell.planeEnd;
      isInside = hasRow ? findNextRecord(shading, current, cell, ray) : findNextSite(current, ray);
      meetCell(shading, visible, cell, ray, entry, isFull ? min(current.entry, end) : current.entry, radiances);
    }
    ++steps;
  }
  countWork(kWorkSteps, steps);
  if (isInside && !isSaturated(shading, radiances[0])) atomicAdd(COUNTERS.stepLimit, 1u);
  Radiance radiance = radiances[0];
  float depth = isFull ? deviceDepthAt(ray, radiance.distance) : 0.0;
  writePixel(pixel, radiance.colour, opacity(-radiance.logTransmittance), radiance.distance, radiance.normal, depth);
  if (isFull && wantsHits()) writeHit(pixel, radiance.distance, 0, cellCodeOf(radiance.cell));
}
