// A ray through several instances. It looks through one instance after the other, the nearest first, and keeps what it
// gains there; what it knows of all of them is then composited by distance. Where intervals of several overlap, their
// densities add, and each colour counts by its share of the density.
//
// Each instance has room for a share of the records. A ray stops in it when that is full, when the instance alone lets no
// light through, and where one before it stopped: up to there everything is known. What lies behind is looked for in
// further rounds, if the ray comes so far.
#ifndef FROTH_GPU_HIT_RECORDS_GLSL
#define FROTH_GPU_HIT_RECORDS_GLSL
#include "gpu/merged_pixels.glsl"

#include "gpu/box.glsl"

// What a ray gains in a cell. [world units]
struct HitRecord {
  Segment segment;
  float density;
  vec3 colour;
  uint slot;
};

const uint kRecords = 64;

// [1 / world unit] As opaque as any; sums of it times colours are finite.
const float kMostDensity = 1e30;

HitRecord records[kRecords];
uint partsOfRay;                    // bits of the instances that it looks through
uint recordEnds[kMostInstances];    // of an instance's records, which begin at firstRecord()
uint heads[kMostInstances];         // of them, the first one that ends behind `passed`
float passed;                       // [world units] what lies before is composited
float known;                        // ... what is gained before is among the records
float rayEnd;                       // ... there the scene stops the ray
uint partAtHand;
float recordedTo;                   // ... in the instance at hand
bool isCut;                         // the ray has stopped there

// [world units] Where a ray may first gain something in an instance: defined by who includes this.
float beginOf(uint part);

uint shareOfPart() { return kRecords / bitCount(partsOfRay); }

uint firstRecord(uint part) { return bitCount(partsOfRay & ((1u << part) - 1)) * shareOfPart(); }

void startRay(uint parts, float end) {
  partsOfRay = parts;
  passed = 0.0;
  rayEnd = end;
  for (uint left = parts; left != 0; left &= left - 1) recordEnds[findLSB(left)] = firstRecord(findLSB(left));
}

// The nearest of the instances that are left, which it takes away from them.
uint takeNearest(inout uint left) {
  uint nearest = findLSB(left);
  for (uint others = left & (left - 1); others != 0; others &= others - 1) {
    uint other = findLSB(others);
    nearest = beginOf(other) < beginOf(nearest) ? other : nearest;
  }
  left &= ~(1u << nearest);
  return nearest;
}

// Up to the end of the last record of the instance at hand all is known of it.
void stopAtLastRecord() {
  known = min(known, recordedTo);
  isCut = true;
}

// Selects the instance; a ray whose records of it are full is cut from the start.
void startPart(uint part) {
  selectPart(part);
  partAtHand = part;
  uint begin = firstRecord(part), end = recordEnds[part];
  recordedTo = end > begin ? records[end - 1].segment.tFar : passed;
  isCut = false;
  if (end == begin + shareOfPart()) stopAtLastRecord();
}

// [asset units] Where the ray leaves the instance at hand, or where the scene stops it; 0: it does not come there.
float endInPart(vec3 ray) {
  Segment inside = insideBox(ray);
  return isEmpty(inside) ? 0.0 : min(inside.tFar, rayEnd / FRAME.scale);
}

// Whether a distance in the instance at hand [asset units] lies behind what is asked for. Cuts the ray there.
bool isBehindKnown(float distance) {
  if (distance * FRAME.scale >= known) isCut = true;
  return isCut;
}

// A cell that the ray meets behind all before. logTransmittance: of the instance by itself.
void recordHit(Shading shading, Segment segment, float density, vec3 colour, uint slot, inout float logTransmittance) {
  float scale = FRAME.scale;
  segment = Segment(segment.tNear * scale, segment.tFar * scale);
  if (!(segment.tFar > recordedTo)) return;  // since the round before
  density = min(density / scale, kMostDensity);
  records[recordEnds[partAtHand]++] = HitRecord(segment, density, colour, slot);
  logTransmittance -= density * (segment.tFar - max(segment.tNear, passed));
  recordedTo = segment.tFar;
  bool isFull = recordEnds[partAtHand] == firstRecord(partAtHand) + shareOfPart();
  if (isFull || logTransmittance < shading.logCutoff) stopAtLastRecord();
}

// In which no instance's record begins or ends. Empty: nothing is left before `known`.
struct Interval {
  Segment segment;
  float density, exposure;
  vec3 colour, normal;
  uint part, slot;  // of the densest
};

// The first one behind `passed`.
Interval findInterval() {
  Interval interval = Interval(Segment(known, known), 0.0, 0.0, vec3(0.0), vec3(0.0), 0, kNoCell);
  for (uint left = partsOfRay; left != 0; left &= left - 1) {
    uint part = findLSB(left);
    while (heads[part] < recordEnds[part] && !(records[heads[part]].segment.tFar > passed)) ++heads[part];
    if (heads[part] == recordEnds[part]) continue;
    interval.segment.tNear = min(interval.segment.tNear, max(records[heads[part]].segment.tNear, passed));
  }
  if (isEmpty(interval.segment)) return interval;
  float densest = 0.0;
  for (uint left = partsOfRay; left != 0; left &= left - 1) {
    uint part = findLSB(left);
    if (heads[part] == recordEnds[part]) continue;
    HitRecord record = records[heads[part]];
    bool isAhead = record.segment.tNear > interval.segment.tNear;
    interval.segment.tFar = min(interval.segment.tFar, isAhead ? record.segment.tNear : record.segment.tFar);
    if (isAhead) continue;
    selectPart(part);
    interval.density += record.density;
    interval.colour += record.density * record.colour;
    interval.exposure += record.density * FRAME.exposure;
    if (isFull) {
      CellRecord cell = FRAME.records.v[record.slot];
      interval.normal += record.density * inWorld(cell.ball.w * cell.face.xyz);
    }
    if (record.density > densest) {
      densest = record.density;
      interval.part = part;
      interval.slot = record.slot;
    }
  }
  interval.colour /= interval.density;
  interval.exposure /= interval.density;
  interval.normal /= interval.density;
  return interval;
}

void compositeInterval(Shading limits, Interval interval, inout Merged merged) {
  if (isFull && isinf(merged.radiance.distance)) {
    merged.part = interval.part;
    selectPart(interval.part);
    merged.radiance.cell = cellCodeOf(interval.slot);
  }
  float opticalDepth = interval.density * (interval.segment.tFar - interval.segment.tNear);
  merged.exposures += interval.exposure * exp(merged.radiance.logTransmittance) * opacity(opticalDepth);
  vec4 quarters = merged.radiance.quarters;
  composite(limits, interval.segment, interval.density, interval.colour, interval.normal, merged.radiance);
  if (!keepsQuarters) return;
  bvec4 isNew = notEqual(quarters, merged.radiance.quarters);
  merged.quarterParts = mix(merged.quarterParts, uvec4(interval.part), isNew);
}

// What lies behind `known` stays for the next round.
void keepRecordsAhead() {
  for (uint left = partsOfRay; left != 0; left &= left - 1) {
    uint part = findLSB(left), to = firstRecord(part);
    for (uint from = heads[part]; from < recordEnds[part]; ++from) {
      if (records[from].segment.tFar > known) records[to++] = records[from];
    }
    recordEnds[part] = to;
  }
}

// Composites what is known of all instances; returns whether the ray goes on behind that.
bool mergeRecords(inout Merged merged) {
  selectPart(0);  // its limits are those of all
  Shading limits = loadShading();
  for (uint left = partsOfRay; left != 0; left &= left - 1) heads[findLSB(left)] = firstRecord(findLSB(left));
  while (!isSaturated(limits, merged.radiance)) {
    Interval interval = findInterval();
    if (isEmpty(interval.segment)) break;
    if (interval.density > 0.0) compositeInterval(limits, interval, merged);
    passed = interval.segment.tFar;
  }
  if (!(known < rayEnd) || isSaturated(limits, merged.radiance)) return false;
  keepRecordsAhead();
  passed = known;
  return true;
}

float findRayEnd(uvec2 pixel) {
  selectPart(0);
  return isFull ? sceneDistance(pixel, rayOf(pixel)) * FRAME.scale : kInfinity;
}

#endif
