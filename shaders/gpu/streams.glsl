// A ray through several instances. What each shows along it comes as a stream of intervals, front to back, and the
// streams are merged by distance. Where intervals of several overlap, their densities add, and each colour counts by
// its share of the density.
//
// The shader that includes this defines how a stream goes on in one instance, in the asset's units, with frameAtHand
// set:
//   struct Cursor
//   bool isAtEnd(Cursor cursor, float end)  // end: nothing lies behind it
//   bool meetNext(Shading shading, uvec2 pixel, float end, inout Cursor cursor, out Segment segment, out vec3 colour,
//                 out uint slot, out CellRecord cell)
//     // goes on by a cell or more; returns whether the ray gains anything in the last of them
#ifndef FROTH_GPU_STREAMS_GLSL
#define FROTH_GPU_STREAMS_GLSL
#include "gpu/box.glsl"
#include "gpu/merged_pixels.glsl"

// In the world's units and axes.
struct Interval {
  Segment segment;
  float density, exposure;
  vec3 colour, normal;
  uint part, cellCode;  // of the densest
};

struct Stream {
  uint part;
  float end;  // where the ray leaves the instance's box, or where the scene stops it [asset units]
  Cursor cursor;
  Interval ahead;  // the newest one; behind the ray's present place once that has passed its end
};

// The streams of a ray that have not ended.
Stream streams[kMostInstances];
uint streamCount;
float rayEnd;  // [world units] where the scene stops the ray

// [1 / world unit] As opaque as any; sums of it times colours are finite.
const float kMostDensity = 1e30;

// Of the instance at hand, if the ray meets its box. Up to there nothing is ahead: the stream goes on once the ray has
// passed that place, and not if it ends before.
void startStream(uint part, vec3 ray, Cursor cursor) {
  Segment inside = insideBox(ray);
  float scale = FRAME.scale;
  float begin = inside.tNear * scale;
  if (isEmpty(inside) || !(begin < rayEnd)) return;
  streams[streamCount].part = part;
  streams[streamCount].end = min(inside.tFar, rayEnd / scale);
  streams[streamCount].cursor = cursor;
  streams[streamCount].ahead = Interval(Segment(begin, begin), 0.0, 0.0, vec3(0.0), vec3(0.0), part, kNoCell);
  ++streamCount;
}

// On by one cell, or a few that the ray misses. A stream that has ended makes room for another.
void advance(uvec2 pixel, uint index) {
  selectPart(streams[index].part);
  Cursor cursor = streams[index].cursor;
  float scale = FRAME.scale;
  float end = streams[index].end;
  if (isAtEnd(cursor, end)) {
    streams[index] = streams[--streamCount];
    return;
  }
  Segment segment;
  vec3 colour;
  uint slot;
  CellRecord cell;
  bool isMet = meetNext(loadShading(), pixel, end, cursor, segment, colour, slot, cell);
  streams[index].cursor = cursor;
  if (!isMet) return;
  countWork(kWorkColours, 1);
  streams[index].ahead.segment = Segment(segment.tNear * scale, segment.tFar * scale);
  streams[index].ahead.density = min(cell.face.w / scale, kMostDensity);
  streams[index].ahead.exposure = FRAME.exposure;
  streams[index].ahead.colour = colour;
  if (isFull) {
    streams[index].ahead.normal = inWorld(cell.ball.w * cell.face.xyz);
    streams[index].ahead.cellCode = cellCodeOf(slot);
  }
}

// The first stream that has nothing beyond `passed` to offer yet; streamCount: none.
uint streamBehind(float passed) {
  for (uint i = 0; i < streamCount; ++i) {
    if (!(streams[i].ahead.segment.tFar > passed)) return i;
  }
  return streamCount;
}

// The first interval beyond `passed` in which no stream begins or ends, once all have something ahead.
Interval findInterval(float passed) {
  Interval interval = Interval(Segment(kInfinity, kInfinity), 0.0, 0.0, vec3(0.0), vec3(0.0), 0, kNoCell);
  float densest = 0.0;
  for (uint i = 0; i < streamCount; ++i) {
    interval.segment.tNear = min(interval.segment.tNear, max(streams[i].ahead.segment.tNear, passed));
  }
  for (uint i = 0; i < streamCount; ++i) {
    Interval ahead = streams[i].ahead;
    if (ahead.segment.tNear > interval.segment.tNear) {
      interval.segment.tFar = min(interval.segment.tFar, ahead.segment.tNear);
      continue;
    }
    interval.segment.tFar = min(interval.segment.tFar, ahead.segment.tFar);
    interval.density += ahead.density;
    interval.colour += ahead.density * ahead.colour;
    interval.exposure += ahead.density * ahead.exposure;
    if (!isFull) continue;
    interval.normal += ahead.density * ahead.normal;
    if (ahead.density > densest) {
      densest = ahead.density;
      interval.part = streams[i].part;
      interval.cellCode = ahead.cellCode;
    }
  }
  interval.colour /= interval.density;
  interval.exposure /= interval.density;
  interval.normal /= interval.density;
  return interval;
}

// Composites what the started streams hold. One loop whose turn goes on by a cell and composites an interval where none
// is behind, not a loop within another: the rays of a workgroup wait for each other at every turn.
Merged mergeStreams(uvec2 pixel) {
  Radiance radiance = emptyRadiance();
  float exposures = 0.0;
  uint part = 0;
  uvec4 quarterParts = uvec4(0);
  selectPart(0);  // its limits are those of all
  Shading limits = loadShading();
  float passed = 0.0;
  while (streamCount > 0 && !isSaturated(limits, radiance)) {
    uint behind = streamBehind(passed);
    if (behind < streamCount) {
      advance(pixel, behind);
      if (streamCount == 0 || streamBehind(passed) < streamCount) continue;
    }
    Interval interval = findInterval(passed);
    if (interval.density > 0.0) {
      if (isFull && isinf(radiance.distance)) {
        part = interval.part;
        radiance.cell = interval.cellCode;
      }
      float opticalDepth = interval.density * (interval.segment.tFar - interval.segment.tNear);
      float shown = exp(radiance.logTransmittance) * opacity(opticalDepth);
      vec4 quarters = radiance.quarters;
      composite(limits, interval.segment, interval.density, interval.colour, interval.normal, radiance);
      if (keepsQuarters) {
        quarterParts = mix(quarterParts, uvec4(interval.part), notEqual(quarters, radiance.quarters));
      }
      exposures += interval.exposure * shown;
    }
    passed = interval.segment.tFar;
  }
  return Merged(radiance, part, quarterParts, exposures);
}

void findRayEnd(uvec2 pixel) {
  selectPart(0);
  rayEnd = isFull ? sceneDistance(pixel, rayOf(pixel)) * FRAME.scale : kInfinity;
}

#endif
