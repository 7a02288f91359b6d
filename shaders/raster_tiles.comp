// Draws 8 x 8 pixels: reads its tile's list front to back in batches, keeps the cells whose solid ball these pixels can
// meet, and composites them. Ends when every pixel is saturated. A thread draws FROTH_RAYS pixels below each other:
// what costs is reading the cells, and all of them read the same. Long tiles are drawn by a form with one pixel per
// thread, which is done with a list sooner though it costs more. Tiles that several instances share are drawn by
// raster_merged.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "gpu/clip_planes.glsl"
#include "gpu/device_depth.glsl"
#include "gpu/hits.glsl"
#include "gpu/outputs.glsl"
#include "gpu/pixels.glsl"

const uint kRows = kSubTileSize / kRays;  // of threads
const uint kBatch = kSubTileSize * kRows;
const uint kSubTilesAlong = kTileSize / kSubTileSize;
const uint kBatchWords = (kBatch + 31) / 32;
layout(local_size_x = kSubTileSize, local_size_y = kRows) in;

shared vec4 balls[kBatch];
shared uint cells[kBatch];  // slots
shared uvec3 rows[kBatch];  // of planes: begin, split, end
shared uint keptMask[kBatchWords];
shared uint liveMask;

// shadeHits in one piece: two rays per thread are 6 % slower through its two functions, single rays of a walk 6 %
// faster.
void shadeHitsAtOnce(Shading shading, uint visible, CellRecord cell, vec3 rays[kRays], Segment segments[kRays],
                     inout Radiance radiances[kRays]) {
  uint firstDetail = visible * detailCount;
  FaceView view = faceViewOf(cell, rays);
  clipByFace(shading, view, firstDetail, segments);
  bool isAny = false;
  vec3 queries[kRays];
  for (uint r = 0; r < kRays; ++r) {
    isAny = isAny || !isEmpty(segments[r]);
    queries[r] = queryAt(view, r, segments[r].tNear);
  }
  if (!isAny) return;
  vec3 colours[kRays];
  coloursAt(shading, firstDetail, queries, colours);
  compositeCell(shading, visible, cell, segments, colours, radiances);
}

void meetCell(Shading shading, uint index, vec3 rays[kRays], float ends[kRays], inout Radiance radiances[kRays]) {
  vec4 ball = balls[index];
  Segment segments[kRays];
  bool isAny = false;
  for (uint r = 0; r < kRays; ++r) {
    segments[r] = Segment(1.0, 0.0);
    if (isSaturated(shading, radiances[r])) continue;
    float tNear, tFar;
    if (!meetBall(ball, rays[r], tNear, tFar)) continue;
    countWork(kWorkBallHits, 1);
    if (isFull) tFar = min(tFar, ends[r]);
    segments[r] = Segment(tNear, tFar);
    isAny = true;
  }
  if (!isAny) return;
  if (clipByPlanes(shading, rows[index], rays, segments)) {
    shadeHitsAtOnce(shading, cells[index], shading.records.v[cells[index]], rays, segments, radiances);
  }
}

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

// The tile of this workgroup, and its place in the order; false: there is none.
bool findTile(out uint tile, out uint place) {
  place = linearGroup() / kSubTilesPerTile;
  bool isLong = kRays == 1;
  if (!isLong) place += COUNTERS.longTiles;
  if (place >= (isLong ? COUNTERS.longTiles : FRAME.tilesX * FRAME.tilesY)) return false;
  tile = FRAME.tileLists.v[place].x;
  return true;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint tile, place;
  if (!findTile(tile, place)) return;
  uint subTile = linearGroup() % kSubTilesPerTile;
  uvec2 corner = uvec2(tile % FRAME.tilesX, tile / FRAME.tilesX) * kTileSize +
                 uvec2(subTile % kSubTilesAlong, subTile / kSubTilesAlong) * kSubTileSize;
  if (!isInRegion(corner)) return;
  uvec2 firstPixel = corner + gl_LocalInvocationID.xy;
  uvec2 range = FRAME.tileLists.v[place].yz;
  Shading shading = loadShading();
  vec3 rays[kRays];
  float ends[kRays];  // where the scene stops them
  Radiance radiances[kRays];
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = firstPixel + uvec2(0, r * kRows);
    rays[r] = rayOf(pixel);
    ends[r] = isInRegion(pixel) ? sceneDistance(pixel, rays[r]) : 0.0;
    radiances[r] = startOf(pixel, rays[r]);
  }

  for (uint first = range.x; first < range.y; first += kBatch) {
    bool isLive = !areSaturated(shading, radiances);
    if (lane < kBatchWords) keptMask[lane] = 0;
    if (lane == 0) liveMask = 0;
    barrier();
    if (isLive) atomicOr(liveMask, 1u);
    uint count = gatherBatch(first + lane, range.y, corner);
    if (lane == 0) {
      countWork(kWorkEntries, min(range.y - first, kBatch));
      countWork(kWorkEntriesKept, count);
    }
    if (liveMask == 0) break;
    for (uint i = 0; i < count && !areSaturated(shading, radiances); ++i) meetCell(shading, i, rays, ends, radiances);
    barrier();
  }
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = firstPixel + uvec2(0, r * kRows);
    if (!isInRegion(pixel)) continue;
    Radiance radiance = radiances[r];
    if (seesNothing(rays[r])) radiance = emptyRadiance();
    float depth = isFull ? deviceDepthAt(rays[r], radiance.distance) : 0.0;
    float distance = radiance.distance * FRAME.scale;
    writePixel(pixel, radiance.colour, coverageOf(radiance.logTransmittance), FRAME.exposure, distance,
               isFull ? inWorld(radiance.normal) : vec3(0.0), depth);
    if (isFull && wantsHits()) writeHit(pixel, distance, FRAME.part, cellCodeOf(radiance.cell));
    if (keepsQuarters && wantsQuarters()) {
      writeQuarters(pixel, radiance.quarters * FRAME.scale, uvec4(FRAME.part));
    }
  }
}
