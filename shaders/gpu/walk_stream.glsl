// A ray through one instance, from cell to cell: the same walk as runtime/query/foam_walk.cpp.
//
// No rounding can make a walk cycle: walk_steps.glsl says why. NaN compares as no, so a ray of them goes nowhere.
#ifndef FROTH_GPU_WALK_STREAM_GLSL
#define FROTH_GPU_WALK_STREAM_GLSL
#include "gpu/descend.glsl"
#include "gpu/prepared_planes.glsl"
#include "gpu/walk_cell.glsl"
#include "gpu/walk_entries.glsl"
#include "foam/next_cell.h"

// t counts from the walk's start, in world units; only `entry` and `end` are in the instance's.
struct Stream {
  uint instance;
  uvec2 cell;   // where the walk stands,
  float entry;  // where the ray enters it,
  float key;    // and its order along the ray
  float end;    // where no more is to come
  uint steps;
  uint neighbours;  // tested so far, in the search for the first cell too
  bool isAhead;  // the segment is one, or will be; else there are no more,
  bool isCut;    // but for the limit of steps or of neighbours
  // Where the ray gains opacity next; tFar = -infinity: nowhere yet.
  float tNear, tFar, density;
  uvec2 metCell;
  vec3 colour;
};

struct WalkWork {
  uint descents, cells, neighbours, met, shaded;
};

void countWork(WalkWork work) {
  countWalkWork(kRayWorkDescents, work.descents);
  countWalkWork(kRayWorkCells, work.cells);
  countWalkWork(kRayWorkNeighbours, work.neighbours);
  countWalkWork(kRayWorkMet, work.met);
  countWalkWork(kRayWorkShaded, work.shaded);
}

vec3 assetFromWorld(vec3 vector) {
  vec4 x = FRAME.worldX, y = FRAME.worldY, z = FRAME.worldZ;
  return vector.x * x.xyz + vector.y * y.xyz + vector.z * z.xyz;
}

vec3 worldFromAsset(vec3 vector) {
  vec4 x = FRAME.worldX, y = FRAME.worldY, z = FRAME.worldZ;
  return vec3(dot(vector, x.xyz), dot(vector, y.xyz), dot(vector, z.xyz));
}

LocalRay localRay(vec3 origin, vec3 direction) {
  return LocalRay(assetFromWorld(origin) / FRAME.scale, assetFromWorld(direction));
}

// A cell near a point of the box.
uvec2 entryCell(vec3 point) { return FRAME.entries.v[entryOfPart(partAt(placeInParts(point)))].xy; }

// The power cell that holds a point; first: where to look, if it is a cell.
uvec2 locateFrom(vec3 point, uvec2 first, out uint steps, inout uint neighbours) {
  uvec2 cell = isCell(first) ? first : entryCell(point);
  return descendTo(point, isCell(cell) ? cell : firstCell(), steps, neighbours);
}

// The origin of a chunk as seen from a ray's, in two floats.
struct ChunkPlace {
  vec3 high, low;
};

ChunkPlace placeFrom(vec3 origin, Chunk chunk) {
  precise vec3 high = chunk.offsetHigh - origin;
  precise vec3 taken = chunk.offsetHigh - high;
  // what `high` is rounded by (Shewchuk 1997, Two-Diff)
  precise vec3 rest = (chunk.offsetHigh - (high + taken)) + (taken - origin);
  precise vec3 low = rest + chunk.offsetLow;
  return ChunkPlace(high, low);
}

// A site of the chunk as seen from there: good to its last digits, however far chunk, origin and eye are from each
// other.
vec3 centreAt(ChunkPlace place, vec3 site) {
  precise vec3 centre = (site + place.high) + place.low;
  return centre;
}

// Cuts [tNear, tFar] by the instance's box; false: nothing is left.
bool clipByBox(LocalRay ray, inout float tNear, inout float tFar) {
  vec4 low = FRAME.boxLow, size = FRAME.boxSize;
  for (uint axis = 0; axis < 3; ++axis) {
    float along = ray.direction[axis];
    precise float inverse = 1.0 / (abs(along) > 1e-30 ? along : 1e-30);  // 0 * infinity would be NaN
    precise float tLow = (low[axis] - low.w - ray.origin[axis]) * inverse;
    precise float tHigh = (low[axis] + size[axis] + low.w - ray.origin[axis]) * inverse;
    tNear = max(tNear, min(tLow, tHigh));
    tFar = min(tFar, max(tLow, tHigh));
  }
  return tNear < tFar;
}

// In the box from `entry` to tEnd [world units from the ray's origin], from the first part on that is not empty.
// hint: as FrothRay::hint.
Stream startStream(uint instance, vec3 origin, vec3 direction, float entry, float tEnd, uvec4 hint,
                   inout WalkWork work) {
  instanceAtHand = instance;
  LocalRay ray = localRay(origin, direction);
  Stream stream;
  stream.instance = instance;
  float tNear = entry / FRAME.scale, tFar = tEnd / FRAME.scale;
  clipByBox(ray, tNear, tFar);
  stream.entry = skipEmptyParts(ray.origin, ray.direction, tNear, tFar);
  stream.end = tFar;
  bool isHinted = hint.x == instance && stream.entry == tNear;  // it lies where the ray begins
  uint steps = 0;
  stream.neighbours = 0;
  stream.cell = firstCell();
  if (stream.entry < stream.end) {
    stream.cell = locateFrom(ray.origin + stream.entry * ray.direction, isHinted ? cellOfName(hint.yz) : uvec2(kNoCell),
                             steps, stream.neighbours);
  }
  work.descents += steps;
  Chunk chunk = loadChunk(stream.cell.x);
  stream.key = keyOf(ray.direction, centreAt(placeFrom(ray.origin, chunk), siteRadiusOf(chunk, stream.cell.y).xyz));
  stream.steps = 0;
  stream.isAhead = true;
  stream.isCut = false;
  stream.tFar = -kInfinity;
  stream.tNear = stream.density = 0.0;
  stream.metCell = uvec2(kNoCell);
  stream.colour = vec3(0.0);
  return stream;
}

// Neighbour through whose plane the ray leaves a cell.
struct Exit {
  uint site;  // kNoCell: it never does
  float t, key;
};

// Through the planes of a part of the cell's row.
Exit findExitAmong(Chunk chunk, ChunkPlace place, uvec2 row, vec4 siteRadius, vec3 direction, float key) {
  vec3 centre = centreAt(place, siteRadius.xyz);
  vec2 order = orderAlong(direction, siteRadius.xyz);
  uint site = kNoCell;
  float siteKey = key;
  float clearance = 1.0, q = 0.0;  // of the nearest plane: t = clearance / q
  for (uint i = row.x; i < row.y; ++i) {
    uint other = neighbourAt(chunk, i);
    vec4 otherSite = siteRadiusOf(chunk, other);
    vec3 toNeighbour = fromSiteToSite(siteRadius.xyz, otherSite.xyz);
    // as findExits() has it
    float otherQ = hasPlanes() ? fixedDot(direction, toNeighbour) : dot(direction, toNeighbour);
    if (!(otherQ > 0.0)) continue;
    vec3 otherCentre = centreAt(place, otherSite.xyz);
    float otherClearance = sharedClearance(centre, otherCentre, toNeighbour, siteRadius.w, otherSite.w);
    float lead = exitLead(otherClearance, otherQ, clearance, q);
    float rounding = kExitRounding * abs(clearance * otherQ);
    if (!(lead >= -rounding)) continue;
    float otherKey = keyOf(direction, otherCentre);
    if (!mayStepTo(chunk, other, order, orderAlong(direction, otherSite.xyz), key, otherKey)) continue;
    bool isTie = site != kNoCell && lead <= rounding;
    if (isTie && !comesBefore(direction, otherSite.xyz, siteRadiusOf(chunk, site).xyz)) continue;
    site = other;
    siteKey = max(otherKey, key);
    clearance = otherClearance;
    q = otherQ;
  }
  return Exit(site, site == kNoCell ? kInfinity : clearance / q, siteKey);
}

// Prepared planes only tell which part of the row matters; the sites decide, so that a ray goes the same way without them.
Exit findExit(Chunk chunk, ChunkPlace place, uint cell, vec4 siteRadius, vec3 direction, float key,
              inout uint neighbours) {
  uvec2 row = neighbourRow(chunk, cell);
  neighbours += row.y - row.x;
  uvec2 part = hasPlanes() ? findExits(chunk, row, centreAt(place, siteRadius.xyz), direction) : row;
  Exit exit;
  for (;;) {
    exit = findExitAmong(chunk, place, part, siteRadius, direction, key);
    bool isWhole = part.x == row.x && part.y == row.y;
    if (exit.site != kNoCell || part.x == part.y || isWhole) break;
    part = row;
    neighbours += row.y - row.x;
  }
  return exit;
}

// What is wanted of the colours along a ray.
struct Sight {
  bool isSeen;    // any
  bool hasLobes;  // as they are seen from the point that lies `behind` the ray's origin; else alike from all sides
  float behind;
};

// Cells that a ray goes on by before it waits for those of its subgroup. To shade one is dear, and half of the cells on
// a ray's way are met: with two more rays shade at a time.
const uint kStepsOfTurn = 1, kStepsOfSeenTurn = 2;

// Walks on to the next live cell whose ball the ray meets, in [tNear, tFar] of it, by `steps` cells at most; false: it
// has come to none.
bool walkOn(inout Stream stream, LocalRay ray, uint steps, out MetCell met, out float tNear, out float tFar,
                inout WalkWork work) {
  Chunk chunk = loadChunk(stream.cell.x);
  ChunkPlace place = placeFrom(ray.origin, chunk);
  uint lastStep = min(FRAME.maxSteps, stream.steps + steps);
  while (stream.entry < stream.end && stream.steps < lastStep && stream.neighbours < FRAME.maxNeighbours) {
    ++stream.steps;
    ++work.cells;
    vec4 siteRadius = siteRadiusOf(chunk, stream.cell.y);
    uint before = stream.neighbours;
    Exit exit = findExit(chunk, place, stream.cell.y, siteRadius, ray.direction, stream.key, stream.neighbours);
    work.neighbours += stream.neighbours - before;
    met = MetCell(stream.cell, centreAt(place, siteRadius.xyz), siteRadius.w);
    bool isMet = stream.cell.y < chunk.liveCount && intersectBall(met.centre, met.radius, ray.direction, tNear, tFar);
    if (isMet) {
      tNear = max(tNear, stream.entry);
      tFar = min(tFar, min(exit.t, stream.end));
    }
    stream.entry = max(exit.t, stream.entry);
    if (exit.site != kNoCell) {
      stream.key = exit.key;
      stream.cell = cellOfSite(chunk, exit.site);
      if (stream.cell.x != chunk.index) {
        chunk = loadChunk(stream.cell.x);
        place = placeFrom(ray.origin, chunk);
      }
    }
    if (isMet && tNear < tFar) return true;
  }
  bool isLimit = stream.steps >= FRAME.maxSteps || stream.neighbours >= FRAME.maxNeighbours;
  stream.isAhead = stream.entry < stream.end && !isLimit;
  stream.isCut = stream.entry < stream.end && isLimit;
  return false;
}

// What a ray gains in one cell, in the instance's units.
struct CellSegment {
  uvec2 cell;
  float tNear, tFar, density;
  vec3 colour;
};

// On towards the next segment: by a few cells, of which a face may leave nothing. False: the ray has come to none.
// ray: of the instance at hand; sight: with `behind` in its units.
bool meetNext(inout Stream stream, LocalRay ray, Sight sight, out CellSegment segment, inout WalkWork work) {
  segment = CellSegment(uvec2(kNoCell), 0.0, 0.0, 0.0, vec3(0.0));
  MetCell met;
  float tNear, tFar;
  uint steps = sight.isSeen ? kStepsOfSeenTurn : kStepsOfTurn;
  if (!walkOn(stream, ray, steps, met, tNear, tFar, work)) return false;
  ++work.met;
  CellCode code = FRAME.chunks.v[met.cell.x].code;
  Face face = loadFace(code, met.cell);
  clipByFace(code, met, face.frame, ray.direction, tNear, tFar);
  if (!(tNear < tFar && face.density > 0.0)) return false;
  segment = CellSegment(met.cell, tNear, tFar, face.density, vec3(0.0));
  if (sight.isSeen) {
    uint shaded;
    segment.colour = colourAt(code, met, face.frame, ray.direction, tNear, sight.behind, sight.hasLobes, shaded);
    work.shaded += shaded;
  }
  return true;
}

// A cell that a ray meets at t, and the part of the ray's light that comes from it.
struct Shown {
  uvec2 cell;
  float t, weight;
};

vec3 colourShown(Shown shown, LocalRay ray, Sight sight, inout WalkWork work) {
  Chunk chunk = loadChunk(shown.cell.x);
  vec4 siteRadius = siteRadiusOf(chunk, shown.cell.y);
  MetCell met = MetCell(shown.cell, centreAt(placeFrom(ray.origin, chunk), siteRadius.xyz), siteRadius.w);
  CellCode code = FRAME.chunks.v[shown.cell.x].code;
  Face face = loadFace(code, shown.cell);
  uint shaded;
  vec3 colour = colourAt(code, met, face.frame, ray.direction, shown.t, sight.behind, sight.hasLobes, shaded);
  work.shaded += shaded;
  return colour;
}

// Cells that a ray meets before it finds their colours. Most rays end before. So the rays of a subgroup walk together,
// then shade together, and a thread holds only what one of the two needs.
const uint kShownAtOnce = 16;

void advanceStream(inout Stream stream, vec3 origin, vec3 direction, Sight sight, inout WalkWork work) {
  instanceAtHand = stream.instance;
  float scale = FRAME.scale;
  CellSegment segment;
  stream.tFar = -kInfinity;
  Sight local = Sight(sight.isSeen, sight.hasLobes, sight.behind / scale);
  if (!meetNext(stream, localRay(origin, direction), local, segment, work)) return;
  stream.colour = segment.colour;
  stream.metCell = segment.cell;
  stream.tNear = segment.tNear * scale;
  stream.tFar = segment.tFar * scale;
  stream.density = segment.density / scale;
}

// World axes, unit.
vec3 normalOf(uint instance, uvec2 cell) {
  instanceAtHand = instance;
  return worldFromAsset(loadFace(FRAME.chunks.v[cell.x].code, cell).frame.normal);
}

#endif
