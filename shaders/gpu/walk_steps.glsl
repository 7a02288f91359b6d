// A ray's steps from cell to cell through the regular triangulation.
//
// Most cells on the way are listed: they have a record, and a row of eye planes through which a ray can leave them,
// each with a link to the next record. From a cell without one (its ball lies outside the view, or there was no space)
// a ray goes on by the sites around it.
//
// No rounding can make a walk cycle. Each step has a key, the dot product of the direction and the site it leads to;
// the greatest key so far goes with the walk. From chunk to chunk a step is taken only to a greater key. Within a chunk
// it is taken only to a site that lies farther along the ray: by the orders of the two sites, or by keys that differ by
// more than their rounding. A key and an order are each one fixed number for a ray and a site, so a walk comes to no
// site of a chunk twice in one stay, and stays end.
#ifndef FROTH_GPU_WALK_STEPS_GLSL
#define FROTH_GPU_WALK_STEPS_GLSL
#include "gpu/descend.glsl"
#include "gpu/eye_planes.glsl"
#include "gpu/shade_hit.glsl"
#include "gpu/walk_begin.glsl"

struct Step {
  uint visible;  // of a listed cell; else kNoCell, and
  uvec2 cell;    // its chunk and local index
  float key;
  float entry;   // where the ray enters the cell
  uint neighbours;  // tested so far
};

float nearnessOfNoExit() { return isParallel ? -kInfinity : 0.0; }

float roundingOfNearness(float nearness) { return isinf(nearness) ? 0.0 : kExitRounding * abs(nearness); }

Step stepTo(uvec2 cell, float key, float entry, uint neighbours) {
  return Step(slotOfCell(cell), cell, key, entry, neighbours);
}

// To a site of the chunk; from a ghost on to the cell for which it stands.
Step stepToSite(Chunk chunk, uint site, float key, float entry, uint neighbours) {
  return stepTo(cellOfSite(chunk, site), key, entry, neighbours);
}

// Whether a ray that leaves a cell towards two sites, at one point but for rounding, goes on in that of the first. The
// one that comes before has the ray up to their plane; where the eye lies behind that plane it never has it, and no step
// leads on from there. Only the side of the eye is asked for: eyePlaneTo() would cost all walks 5 % in registers.
bool goesOnInFirst(Chunk chunk, vec3 direction, vec4 first, vec4 second) {
  bool isBefore = comesBefore(direction, first.xyz, second.xyz);
  if (isParallel) return isBefore;
  vec4 before = isBefore ? first : second, behind = isBefore ? second : first;
  vec3 centre = ballOf(chunk, before).centre;
  vec3 toBehind = fromSiteToSite(before.xyz, behind.xyz);
  float offset = radicalOffset(toBehind, before.w, behind.w);
  bool isFar = exitClearance(centre, toBehind, offset, radicalClearance(centre, toBehind, offset)) >= 0.0;
  return isBefore == isFar;
}

// The neighbour through whose plane the ray leaves the cell first, by their sites. Returns false: the ray leaves the
// foam.
bool findNextSite(inout Step current, vec3 ray) {
  vec3 direction = directionOfRay(ray);
  uvec2 cell = current.visible == kNoCell ? current.cell : FRAME.visibleCells.v[current.visible].xy;
  Chunk chunk = loadChunk(cell.x);
  vec4 siteRadius = siteRadiusOf(chunk, cell.y);
  uvec2 row = neighbourRow(chunk, cell.y);
  vec2 order = orderAlong(direction, siteRadius.xyz);
  uint next = kNoCell;
  float nextKey = current.key;
  float exitNearness = nearnessOfNoExit();
  current.neighbours += row.y - row.x;
  countWork(kWorkNeighbours, row.y - row.x);
  for (uint i = row.x; i < row.y; ++i) {
    uint other = neighbourAt(chunk, i);
    vec4 otherSite = siteRadiusOf(chunk, other);
    float key = keyOf(direction, ballOf(chunk, otherSite).centre);
    bool isFar;
    float nearness = nearnessOf(eyePlaneTo(chunk, siteRadius, otherSite, isFar), ray);
    if (!isFar || !(nearness >= exitNearness - roundingOfNearness(exitNearness))) continue;
    if (!mayStepTo(chunk, other, order, orderAlong(direction, otherSite.xyz), current.key, key)) continue;
    bool isTie = next != kNoCell && nearness <= exitNearness + roundingOfNearness(exitNearness);
    exitNearness = max(nearness, exitNearness);
    if (isTie && !goesOnInFirst(chunk, direction, otherSite, siteRadiusOf(chunk, next))) continue;
    next = other;
    nextKey = max(key, current.key);
  }
  float exit = max(distanceAt(exitNearness), current.entry);
  if (next == kNoCell) {
    current.entry = exit;
    return false;
  }
  current = stepToSite(chunk, next, nextKey, exit, current.neighbours);
  return true;
}

// Of the cell behind a link of a listed cell.
vec3 centreBehind(Shading shading, uint visible, uint link) {
  if ((link & kUnlisted) == 0) return shading.records.v[checked(link, FRAME.visibleCapacity)].ball.xyz;
  return ballOfSite(loadChunk(FRAME.visibleCells.v[visible].x), link & ~kUnlisted).centre;
}

// The same by the record's eye planes.
bool findNextRecord(Shading shading, inout Step current, CellRecord cell, vec3 ray) {
  vec3 direction = directionOfRay(ray);
  uint link = kNoCell;
  float exitNearness = nearnessOfNoExit();
  float nextNearness = exitNearness;  // of the second of all exits
  current.neighbours += cell.planeSplit - cell.planeBegin;
  countWork(kWorkNeighbours, cell.planeSplit - cell.planeBegin);
  for (uint i = cell.planeBegin; i < cell.planeSplit; ++i) {
    vec4 plane = shading.planes.v[checked(i, FRAME.planeCapacity)];
    float nearness = nearnessOf(plane.xyz, ray);
    nextNearness = max(nextNearness, min(nearness, exitNearness));
    if (nearness > exitNearness) {
      exitNearness = nearness;
      link = floatBitsToUint(plane.w);
    }
  }
  bool isTie = nextNearness >= exitNearness - roundingOfNearness(exitNearness);
  if (isTie && link != kNoCell) return findNextSite(current, ray);  // which of the sites comes first decides
  float exit = max(distanceAt(exitNearness), current.entry);
  if (link == kNoCell) {
    current.entry = exit;
    return false;
  }
  vec3 centre = centreBehind(shading, current.visible, link);
  float key = keyOf(direction, centre);
  if (!(key > current.key + roundingOfKeys(cell.ball.xyz, centre))) return findNextSite(current, ray);
  if ((link & kUnlisted) == 0) {
    current = Step(link, uvec2(0), key, exit, current.neighbours);
  } else {
    Chunk chunk = loadChunk(FRAME.visibleCells.v[current.visible].x);
    current = stepToSite(chunk, link & ~kUnlisted, key, exit, current.neighbours);
  }
  return true;
}

// False: there was no space for its planes.
bool hasRow(CellRecord cell) { return cell.planeBegin < cell.planeEnd; }

// Whether the ray is in the cell at a distance, by the planes of its record.
bool isInRecord(Shading shading, CellRecord cell, vec3 ray, float distance) {
  float nearness = nearnessAt(distance);
  bool isInside = hasRow(cell);
  for (uint i = cell.planeBegin; i < cell.planeSplit && isInside; ++i) {
    isInside = nearnessOf(shading.planes.v[checked(i, FRAME.planeCapacity)].xyz, ray) <= nearness;
  }
  for (uint i = cell.planeSplit; i < cell.planeEnd && isInside; ++i) {
    isInside = nearnessOf(shading.planes.v[checked(i, FRAME.planeCapacity)].xyz, ray) >= nearness;
  }
  return isInside;
}

// The cell in which a ray begins, near that of its tile's middle ray; the neighbours of a search for it count. Returns
// false: the ray meets nothing.
bool startWalk(Shading shading, uvec2 pixel, vec3 ray, out Step start) {
  uint tile = tileIndex(pixel / kTileSize);
  float distance;
  start = Step(kNoCell, uvec2(0), 0.0, 0.0, 0);
  if (seesNothing(ray) || !findWalkBegin(tile, distance)) return false;
  uint neighbours = 0;
  uvec2 cell = FRAME.walkStart.v[tile];
  uint visible = slotOfCell(cell);
  bool isInside = false;
  if (visible != kNoCell) {
    isInside = isInRecord(shading, shading.records.v[checked(visible, FRAME.visibleCapacity)], ray, distance);
  }
  if (!isInside) cell = cellHolding(pointOnRay(ray, distance), cell, neighbours);
  float key = keyOf(directionOfRay(ray), ballOfSite(loadChunk(cell.x), cell.y).centre);
  start = stepTo(cell, key, distance, neighbours);
  return true;
}

// On to the next cell. Returns false: the ray leaves the foam; current.entry is where it leaves the present cell either
// way. The cell that was left: `visible`, kNoCell if it has no record.
bool takeStep(Shading shading, inout Step current, vec3 ray, out uint visible, out CellRecord cell) {
  visible = current.visible;
  if (visible == kNoCell) return findNextSite(current, ray);
  cell = shading.records.v[checked(visible, FRAME.visibleCapacity)];
  return hasRow(cell) ? findNextRecord(shading, current, cell, ray) : findNextSite(current, ray);
}

// What a ray meets in the ball of a listed cell between entry and exit.
Segment meetInside(CellRecord cell, vec3 ray, float entry, float exit) {
  float tNear, tFar;
  if (!meetBall(cell.ball, ray, tNear, tFar)) return Segment(1.0, 0.0);
  countWork(kWorkBallHits, 1);
  return Segment(max(tNear, entry), min(tFar, exit));
}

#endif
