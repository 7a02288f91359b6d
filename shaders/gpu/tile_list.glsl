// Goes through the cells of a tile's list for 8 x 8 pixels: reads it front to back in batches, keeps the cells whose solid
// ball these pixels can meet, and ends when every pixel is saturated. A thread takes FROTH_RAYS pixels below each other:
// what costs is reading the cells, and all of them read the same.
#ifndef FROTH_GPU_TILE_LIST_GLSL
#define FROTH_GPU_TILE_LIST_GLSL
#include "gpu/asset.glsl"
#include "gpu/clip_planes.glsl"
#include "gpu/outputs.glsl"
#include "gpu/pixels.glsl"

const uint kRows = kSubTileSize / kRays;  // of threads
const uint kBatch = kSubTileSize * kRows;
const uint kBatchWords = (kBatch + 31) / 32;

shared vec4 balls[kBatch];
shared uint cells[kBatch];  // slots
shared uvec3 rows[kBatch];  // of planes: begin, split, end
shared uint keptMask[kBatchWords];
shared uint liveMask;

// The entry of the list with which the batch at hand begins.
uint batchBegin;

// What rays do with the kept cell `index` of a batch: defined by who includes this.
void meetCell(Shading shading, uint index, vec3 rays[kRays], float ends[kRays], inout Radiance radiances[kRays]);

// Reads a word of each line of memory that rays in the cell will read, so that the entries of a batch wait for them
// together and not one after the other. Always true, which no compiler can know. (What is read may be anything: a cell
// need not have planes.)
bool fetchCell(uint slot, uvec3 row) {
  uint lastPlane = max(row.z, 1u) - 1;
  uint firstDetail = slot * detailCount;
  uint bits = floatBitsToUint(FRAME.planes.v[min(row.x, lastPlane)].x) ^ floatBitsToUint(FRAME.planes.v[lastPlane].x);
  bits ^= floatBitsToUint(FRAME.details.v[firstDetail].place.x);
  bits ^= floatBitsToUint(FRAME.details.v[firstDetail + detailCount - 1].place.x);
  return (bits & FRAME.zero) == 0;
}

// Lists the entries of this batch whose solid ball the 8 x 8 pixels can meet, in order; returns how many.
uint gatherBatch(uint entry, uint end, uvec2 corner) {
  uint lane = gl_LocalInvocationIndex;
  uint slot = 0;
  vec4 ball = vec4(0.0);
  uvec3 row = uvec3(0);
  bool isKept = false;
  if (entry < end) {
    slot = checked(FRAME.tileCells.v[checked(entry, FRAME.pairCapacity)], FRAME.visibleCapacity);
    ball = FRAME.records.v[slot].ball;
    row = uvec3(FRAME.records.v[slot].planeBegin, FRAME.records.v[slot].planeSplit, FRAME.records.v[slot].planeEnd);
    Ball solid = solidBall(Ball(ball.xyz, ball.w), FRAME.records.v[slot].solidBall);
    isKept = pixelsMeetBall(solid.centre, solid.radius, corner, kSubTileSize) && fetchCell(slot, row);
  }
  if (isKept) atomicOr(keptMask[lane / 32], 1u << (lane % 32));
  barrier();
  uint count = 0;
  for (uint word = 0; word < kBatchWords; ++word) {
    uint mask = keptMask[word];
    if (isKept && word == lane / 32) {
      uint place = count + bitCount(mask & ((1u << (lane % 32)) - 1));
      balls[place] = ball;
      cells[place] = slot;
      rows[place] = row;
    }
    count += bitCount(mask);
  }
  barrier();
  return count;
}

uvec2 pixelOfThread(uvec2 corner, uint ray) { return corner + gl_LocalInvocationID.xy + uvec2(0, ray * kRows); }

// Saturated from the start where there is no pixel, or no ray.
Radiance startOf(uvec2 pixel, vec3 ray) {
  Radiance radiance = emptyRadiance();
  if (!isInRegion(pixel) || seesNothing(ray)) radiance.logTransmittance = -kInfinity;
  return radiance;
}

bool areSaturated(Shading shading, Radiance radiances[kRays]) {
  bool areAll = true;
  for (uint r = 0; r < kRays; ++r) areAll = areAll && isSaturated(shading, radiances[r]);
  return areAll;
}

// Every thread of the workgroup calls it, at the same place.
void drawList(Shading shading, uvec2 range, uvec2 corner, vec3 rays[kRays], float ends[kRays],
              inout Radiance radiances[kRays]) {
  uint lane = gl_LocalInvocationIndex;
  for (uint first = range.x; first < range.y; first += kBatch) {
    bool isLive = !areSaturated(shading, radiances);
    if (lane < kBatchWords) keptMask[lane] = 0;
    if (lane == 0) liveMask = 0;
    barrier();
    if (isLive) atomicOr(liveMask, 1u);
    batchBegin = first;
    uint count = gatherBatch(first + lane, range.y, corner);
    if (lane == 0) {
      countWork(kWorkEntries, min(range.y - first, kBatch));
      countWork(kWorkEntriesKept, count);
    }
    if (liveMask == 0) break;
    for (uint i = 0; i < count && !areSaturated(shading, radiances); ++i) meetCell(shading, i, rays, ends, radiances);
    barrier();
  }
}

#endif
