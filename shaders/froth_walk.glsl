// Rays through Froth's foams, for compute, fragment and ray generation shaders of an engine:
//
//   #define FROTH_WALK_SET 2  // the number of the descriptor set that frothRecordWalkSet gives
//   #include "froth_walk.glsl"  // in Slang: "froth_walk.slang", which is made from this text
//
// To be included once, before any declaration: in GLSL 4.60 for Vulkan 1.2 or later (it enables
// GL_EXT_buffer_reference), or in Slang 2026.14 or later, compiled with -fp-mode precise. All names begin with froth,
// Froth or FROTH. Places are relative to FrothWalkInfo::eye; directions, lengths: world axes and units.
//
// May be defined before:
//   FROTH_WALK_NO_COUNTERS  no binding 1: in stages without atomics (fragmentStoresAndAtomics); frothGetWalkStatus
//                           counts nothing
//   FROTH_WALK_STREAMS      most instances that a ray may be in at the same time [4]; 1: faster where none overlap
//   FROTH_WALK_ALONE        frothRadiance, frothTransmittance and frothClosest meet the first instance of the set and leave
//                           out all others: faster where it has one
//   FROTH_WALK_PREPARED     FrothRayPreparation of which all instances of the set are [0]; a constant, or the name of a
//                           specialization constant. The code that is compiled for it is faster
#ifndef FROTH_WALK_GLSL
#define FROTH_WALK_GLSL

#define FROTH_WALK_ABI 8u

// FrothHit::status
#define FROTH_WALK_DONE 0u
#define FROTH_WALK_STEP_LIMIT 1u    // ended by FrothWalkInfo::maxSteps or maxNeighbours: what lies beyond is missing
// an instance was left out: more overlap than FROTH_WALK_STREAMS, or there are more with FROTH_WALK_ALONE
#define FROTH_WALK_STREAM_LIMIT 2u
#define FROTH_WALK_VERSION 3u       // the set is one of another library; nothing was met
#define FROTH_WALK_UNPREPARED 4u    // less is prepared of an instance than FROTH_WALK_PREPARED; nothing was met

// FrothRay::colours
#define FROTH_COLOURS_SEEN 0u  // as they are seen along the ray
#define FROTH_COLOURS_BASE 1u  // without view dependence, as an asset of two layers shows them: cheaper, for what is seen in mirrors

#define FROTH_INFINITY uintBitsToFloat(0x7f800000u)
#define FROTH_NONE 0xffffffffu  // no instance, no cell

#if !defined(FROTH_WALK_STREAMS)
#define FROTH_WALK_STREAMS 4
#endif

#include "gpu/walk_stream.glsl"
#include "foam/colour.h"
#include "foam/compositing.h"

struct FrothRay {
  vec3 origin;
  vec3 direction;  // unit
  float tMin;      // where the ray begins,
  float tMax;      // and ends; FROTH_INFINITY: nowhere
  // colours are seen from the point that lies this far behind the origin. 0: the origin itself. Of a ray that a plane
  // mirror reflects: the length of its path from the camera, for there the mirrored camera stands
  float apex;
  uint colours;    // FROTH_COLOURS_...
  uint mask;       // meets instances whose FrothInstanceInfo::mask shares a bit with it
  uvec4 hint;      // where to look for the cell in which the walk begins: instance, chunk, cell of a hit nearby
};

struct FrothHit {
  // from the origin, whatever tMin, to where transmittance falls below FrothWalkInfo::quantile; FROTH_INFINITY: never,
  // and what follows is 0 or FROTH_NONE
  float distance;
  vec3 normal;     // of the face of the cell that is met there; unit
  uint instance;   // of the walk set; where several overlap the densest
  uint chunk;
  uint cell;
  uint userId;     // FrothInstanceInfo::userId
  uint status;     // FROTH_WALK_...
};

// A walk that goes on, segment by segment.
struct FrothWalk {
  FrothRay ray;
  FrothHit hit;  // as far as the walk has come
  vec3 start;    // where the ray enters the first instance: t of what follows counts from here,
  float tStart;  // which is so far from the origin
  float passed;
  float logTransmittance;
  float nextEntry;    // of the next instance that the ray enters, from the origin
  uint nextInstance;  // FROTH_NONE: there is no more
  uint cells;         // walked through
  Stream streams[FROTH_WALK_STREAMS];
};

// An interval of the ray with the same cells all along: their densities add, colours and exposures mix by them.
struct Interval {
  float tNear, tFar, density, exposure;
  vec3 colour;
  uint instance;  // the densest,
  uvec2 cell;     // and its cell
};

uvec4 frothNoHint() { return uvec4(FROTH_NONE); }

FrothRay frothRay(vec3 origin, vec3 direction) {
  return FrothRay(origin, direction, 0.0, FROTH_INFINITY, 0.0, FROTH_COLOURS_SEEN, FROTH_NONE, frothNoHint());
}

// FROTH_WALK_DONE, or why nothing can be met.
uint checkSet() {
  if (walkSet.block.abi != FROTH_WALK_ABI) {
#if !defined(FROTH_WALK_NO_COUNTERS)
    atomicAdd(walkCounters.v.version, 1u);
#endif
    return FROTH_WALK_VERSION;
  }
  return walkSet.block.prepared < FROTH_WALK_PREPARED ? FROTH_WALK_UNPREPARED : FROTH_WALK_DONE;
}

// Where the ray enters the box of an instance, from its origin; false: it does not.
bool entersInstance(FrothRay ray, uint instance, out float entry) {
  instanceAtHand = instance;
  entry = ray.tMin;
  if ((FRAME.mask & ray.mask) == 0) return false;
  LocalRay local = localRay(ray.origin, ray.direction);
  float scale = FRAME.scale;
  precise float tNear = ray.tMin / scale;
  precise float tFar = ray.tMax / scale;
  bool isMet = clipByBox(local, tNear, tFar);
  precise float tWorld = tNear * scale;
  entry = tWorld;
  return isMet;
}

// The instance that the ray enters after the last one that was found, in order of entries, then numbers.
void findNextInstance(inout FrothWalk walk) {
  float last = walk.nextEntry;
  uint lastInstance = walk.nextInstance;
  walk.nextEntry = FROTH_INFINITY;
  walk.nextInstance = FROTH_NONE;
  for (uint i = 0; i < walkSet.block.instanceCount; ++i) {
    float entry;
    if (!entersInstance(walk.ray, i, entry)) continue;
    bool isLater = entry > last || (entry == last && i > lastInstance);
    if (isLater && entry < walk.nextEntry) {
      walk.nextEntry = entry;
      walk.nextInstance = i;
    }
  }
}

FrothHit noHit(uint status) {
  return FrothHit(FROTH_INFINITY, vec3(0.0), FROTH_NONE, FROTH_NONE, FROTH_NONE, 0u, status);
}

FrothWalk frothBeginWalk(FrothRay ray) {
  FrothWalk walk;
  walk.ray = ray;
  walk.hit = noHit(checkSet());
  walk.start = ray.origin;
  walk.tStart = 0.0;
  walk.passed = -FROTH_INFINITY;
  walk.logTransmittance = 0.0;
  walk.nextEntry = -FROTH_INFINITY;
  walk.nextInstance = FROTH_NONE;
  walk.cells = 0;
  countWalkWork(kRayWorkRays, 1u);
  for (uint i = 0; i < FROTH_WALK_STREAMS; ++i) walk.streams[i].isAhead = false;
  if (walk.hit.status != FROTH_WALK_DONE) return walk;
  findNextInstance(walk);
  if (walk.nextInstance != FROTH_NONE) {
    walk.tStart = walk.nextEntry;
    walk.start = ray.origin + walk.tStart * ray.direction;
  }
  return walk;
}

void startNextStream(inout FrothWalk walk, inout WalkWork work) {
  uint place = 0;
  while (place < FROTH_WALK_STREAMS && walk.streams[place].isAhead) ++place;
  if (place < FROTH_WALK_STREAMS) {
    walk.streams[place] = startStream(walk.nextInstance, walk.start, walk.ray.direction, walk.nextEntry - walk.tStart,
                                      walk.ray.tMax - walk.tStart, walk.ray.hint, work);
  } else {
    walk.hit.status = max(walk.hit.status, FROTH_WALK_STREAM_LIMIT);
  }
  findNextInstance(walk);
}

void noteStepLimit(inout FrothHit hit) {
#if !defined(FROTH_WALK_NO_COUNTERS)
  if (hit.status == FROTH_WALK_DONE) atomicAdd(walkCounters.v.stepLimit, 1u);
#endif
  hit.status = max(hit.status, FROTH_WALK_STEP_LIMIT);
}

// Where the next segment beyond what is passed begins. isBehind: not known yet, for a stream has come to none.
float advanceStreams(inout FrothWalk walk, bool isSeen, out bool isBehind, inout WalkWork work) {
  float first = FROTH_INFINITY;
  isBehind = false;
  Sight sight = Sight(isSeen, walk.ray.colours == FROTH_COLOURS_SEEN, walk.tStart + walk.ray.apex);
  for (uint i = 0; i < FROTH_WALK_STREAMS; ++i) {
    if (walk.streams[i].isAhead && walk.streams[i].tFar <= walk.passed) {
      advanceStream(walk.streams[i], walk.start, walk.ray.direction, sight, work);
      if (walk.streams[i].isCut) noteStepLimit(walk.hit);
    }
    if (!walk.streams[i].isAhead) continue;
    isBehind = isBehind || walk.streams[i].tFar <= walk.passed;
    first = min(first, max(walk.streams[i].tNear, walk.passed));
  }
  return first;
}

// From `begin`, where some segment begins or goes on, up to `end` at most.
Interval findInterval(FrothWalk walk, float begin, float end, bool isSeen) {
  Interval interval =
      Interval(begin, min(end, walk.nextEntry - walk.tStart), 0.0, 0.0, vec3(0.0), FROTH_NONE, uvec2(kNoCell));
  float most = 0.0;
  for (uint i = 0; i < FROTH_WALK_STREAMS; ++i) {
    if (!walk.streams[i].isAhead) continue;
    if (walk.streams[i].tNear > begin) {
      interval.tFar = min(interval.tFar, walk.streams[i].tNear);
      continue;
    }
    float density = walk.streams[i].density;
    interval.tFar = min(interval.tFar, walk.streams[i].tFar);
    interval.density += density;
    interval.colour += density * walk.streams[i].colour;
    if (isSeen) interval.exposure += density * walkSet.block.instances.v[walk.streams[i].instance].exposure;
    if (density > most) {
      interval.instance = walk.streams[i].instance;
      interval.cell = walk.streams[i].metCell;
    }
    most = max(most, density);
  }
  interval.colour /= interval.density;
  interval.exposure /= interval.density;
  return interval;
}

// cell: that stops the ray.
void describeHit(inout FrothHit hit, uvec2 cell) {
  hit.normal = normalOf(hit.instance, cell);  // the instance is at hand
  uvec2 name = namedCell(cell);
  hit.chunk = name.x;
  hit.cell = name.y;
  hit.userId = FRAME.userId;
}

// On to tEnd, or to where the walk ends: premultiplied linear colour of this part (isSeen), and its opacity. The part's
// exposure is the mean of what the instances contribute to it.
vec4 gather(inout FrothWalk walk, float tEnd, bool isSeen, bool isClosestOnly) {
  float logCutoff = walkSet.block.logCutoff, logQuantile = walkSet.block.logQuantile;
  float logBefore = walk.logTransmittance;
  float logPassed = 0.0;  // of this part alone: beyond the floats, both its ends are at -infinity
  float end = min(tEnd, walk.ray.tMax) - walk.tStart;
  vec3 colour = vec3(0.0);
  float exposures = 0.0;
  uvec2 stopping = uvec2(kNoCell);
  WalkWork work = WalkWork(0u, 0u, 0u, 0u, 0u);
  // One loop, of which a turn goes on by a few cells and composites what that completes: in loops within it the rays of
  // a subgroup would wait for each other at every turn.
  while (walk.logTransmittance >= logCutoff) {
    bool isBehind;
    float begin = advanceStreams(walk, isSeen, isBehind, work);
    if (isBehind) continue;
    if (walk.nextInstance != FROTH_NONE && walk.nextEntry - walk.tStart <= min(begin, end)) {
      startNextStream(walk, work);
      continue;
    }
    if (!(begin < end)) break;
    Interval interval = findInterval(walk, begin, end, isSeen);
    float opticalDepth = interval.density * (interval.tFar - interval.tNear);
    if (isSeen) {
      float shown = exp(logPassed) * opacity(opticalDepth);
      colour += shown * interval.colour;
      exposures += shown * interval.exposure;
    }
    logPassed -= opticalDepth;
    float logAfter = logBefore + logPassed;
    bool isHit = walk.logTransmittance >= logQuantile && logAfter < logQuantile;
    if (isHit) {
      walk.hit.distance =
          walk.tStart + quantileDistance(interval.tNear, walk.logTransmittance, logQuantile, interval.density);
      walk.hit.instance = interval.instance;
      stopping = interval.cell;
    }
    walk.passed = interval.tFar;
    walk.logTransmittance = logAfter;
    if (isHit && isClosestOnly) break;
  }
  walk.cells += work.cells;
  countWork(work);
  if (stopping.x != kNoCell) describeHit(walk.hit, stopping);
  float coverage = coverageOf(logPassed);
  float exposure = coverage > 0.0 ? exposures / coverage : 1.0;
  return vec4(exposure * linearPremultiplied(colour, coverage), coverage);
}

// Premultiplied linear colour of the ray's part from where the walk stands to tEnd, times FrothInstanceInfo::exposure,
// and 1 - T of this part. Each part is decoded by itself: over a part in front of it, it blends as colour += T * part,
// T *= 1 - part.w.
vec4 frothRadianceSegment(inout FrothWalk walk, float tEnd) { return gather(walk, tEnd, true, false); }

// A ray from its begin to its end.
struct Passage {
  FrothHit hit;
  vec4 radiance;  // premultiplied linear colour, 1 - T
  float transmittance;
  uint cells;  // walked through
};

#if defined(FROTH_WALK_ALONE)
// Through the first instance: as gather(), in the instance's units, without what other instances and a way in parts
// need. What a thread holds bounds these rays: without colours it is a quarter less (docs/notes/performance.md).
Passage castRay(FrothRay ray, bool isSeen, bool isClosestOnly) {
  FrothHit hit = noHit(checkSet());
  WalkWork work = WalkWork(0u, 0u, 0u, 0u, 0u);
  countWalkWork(kRayWorkRays, 1u);
  vec3 colour = vec3(0.0);
  float logTransmittance = 0.0, entry;
  uvec2 stopping = uvec2(kNoCell);
  uint cells = 0;
  bool isMet = hit.status == FROTH_WALK_DONE && walkSet.block.instanceCount > 0 && entersInstance(ray, 0u, entry);
  if (isMet) {
    vec3 start = ray.origin + entry * ray.direction;
    Stream stream = startStream(0u, start, ray.direction, 0.0, ray.tMax - entry, ray.hint, work);
    LocalRay local = localRay(start, ray.direction);
    float scale = FRAME.scale, logCutoff = walkSet.block.logCutoff, logQuantile = walkSet.block.logQuantile;
    Sight sight = Sight(false, ray.colours == FROTH_COLOURS_SEEN, (entry + ray.apex) / scale);
    Shown shown[kShownAtOnce];
    for (bool isDone = false; !isDone;) {
      uint shownCount = 0;
      while (shownCount < kShownAtOnce) {
        isDone = !(stream.isAhead && logTransmittance >= logCutoff);
        if (isDone) break;
        CellSegment segment;
        if (!meetNext(stream, local, sight, segment, work)) continue;
        float opticalDepth = segment.density * (segment.tFar - segment.tNear);
        if (isSeen) {
          float weight = exp(logTransmittance) * opacity(opticalDepth);
          shown[shownCount] = Shown(segment.cell, segment.tNear, weight);
          ++shownCount;
        }
        float logAfter = logTransmittance - opticalDepth;
        bool isHit = logTransmittance >= logQuantile && logAfter < logQuantile;
        if (isHit) {
          float t = quantileDistance(segment.tNear, logTransmittance, logQuantile, segment.density);
          hit.distance = entry + scale * t;
          stopping = segment.cell;
        }
        logTransmittance = logAfter;
        isDone = isHit && isClosestOnly;
        if (isDone) break;
      }
      for (uint i = 0; i < shownCount; ++i) colour += shown[i].weight * colourShown(shown[i], local, sight, work);
    }
    if (stream.isCut) noteStepLimit(hit);
    cells = stream.steps;
  }
  countWork(work);
  if (stopping.x != kNoCell) {
    hit.instance = 0u;
    describeHit(hit, stopping);
  }
  if (walkSet.block.instanceCount > 1) hit.status = max(hit.status, FROTH_WALK_STREAM_LIMIT);
  float coverage = coverageOf(logTransmittance);
  vec3 linear = isMet ? FRAME.exposure * linearPremultiplied(colour, coverage) : vec3(0.0);
  return Passage(hit, vec4(linear, coverage), exp(logTransmittance), cells);
}
#else
Passage castRay(FrothRay ray, bool isSeen, bool isClosestOnly) {
  FrothWalk walk = frothBeginWalk(ray);
  vec4 radiance = gather(walk, FROTH_INFINITY, isSeen, isClosestOnly);
  return Passage(walk.hit, radiance, exp(walk.logTransmittance), walk.cells);
}
#endif

// Premultiplied linear colour and 1 - T over [tMin, tMax]; ends below the cut-off.
vec4 frothRadiance(FrothRay ray, out FrothHit hit) {
  Passage passage = castRay(ray, true, false);
  hit = passage.hit;
  return passage.radiance;
}

// T over [tMin, tMax]; ends below the cut-off. status: as FrothHit::status.
float frothTransmittance(FrothRay ray, out uint status) {
  Passage passage = castRay(ray, false, false);
  status = passage.hit.status;
  return passage.transmittance;
}

// Where transmittance falls below the quantile; false: it does not.
bool frothClosest(FrothRay ray, out FrothHit hit) {
  hit = castRay(ray, false, true).hit;
  return hit.distance < FROTH_INFINITY;
}

// The power cell (chunk, cell) of an instance of the set that holds a point. first: a cell near to it, or
// uvec2(FROTH_NONE). false: there is no such instance, or the search ended at FrothWalkInfo::maxNeighbours.
bool frothLocate(uint instance, vec3 point, uvec2 first, out uvec2 cell) {
  cell = uvec2(FROTH_NONE);
  if (checkSet() != FROTH_WALK_DONE || instance >= walkSet.block.instanceCount) return false;
  instanceAtHand = instance;
  uint steps, neighbours = 0;
  cell = namedCell(locateFrom(assetFromWorld(point) / FRAME.scale, cellOfName(first), steps, neighbours));
  return neighbours < FRAME.maxNeighbours;
}

#endif
