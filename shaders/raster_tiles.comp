// Draws 8 x 8 pixels: reads its tile's list front to back in batches, keeps the cells whose solid ball these pixels can meet, and
// composites them. Ends when every pixel is saturated.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/asset.glsl"
#include "gpu/outputs.glsl"
#include "gpu/pixels.glsl"
#include "gpu/shade_hit.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kSubTileSize) in;

const uint kBatch = kSubTileSize * kSubTileSize;

shared vec4 balls[kBatch];
shared uint cells[kBatch];
shared uint keptMask[kBatch / 32];
shared uint liveMask;

// The part of the ball's interval on the cell's side of all its radical planes.
bool clipByPlanes(CellRecord cell, vec3 direction, inout float tNear, inout float tFar) {
  float inverseFar = 1.0 / tFar;
  for (uint i = cell.planeBegin; i < cell.planeSplit; ++i) {
    inverseFar = max(inverseFar, dot(FRAME.planes.v[checked(i, FRAME.planeCapacity)].xyz, direction));
  }
  tFar = 1.0 / inverseFar;
  if (cell.planeSplit < cell.planeEnd) {
    float inverseNear = kInfinity;
    for (uint i = cell.planeSplit; i < cell.planeEnd; ++i) {
      inverseNear = min(inverseNear, dot(FRAME.planes.v[checked(i, FRAME.planeCapacity)].xyz, direction));
    }
    if (!(inverseNear > 0.0)) return false;
    tNear = max(tNear, 1.0 / inverseNear);
  }
  return tFar > tNear;
}

void meetCell(uint index, vec3 direction, inout Radiance radiance) {
  vec4 ball = balls[index];
  float tNear, tFar;
  if (!intersectBall(ball.xyz, ball.w, direction, tNear, tFar)) return;
  countWork(kWorkBallHits, 1);
  uint visible = cells[index];
  CellRecord cell = FRAME.records.v[visible];
  countWork(kWorkPlanes, cell.planeEnd - cell.planeBegin);
  if (clipByPlanes(cell, direction, tNear, tFar)) shadeHit(visible, cell, direction, tNear, tFar, radiance);
}

// Lists the entries of this batch whose solid ball the 8 x 8 pixels can meet, in order; returns how many.
uint gatherBatch(uint entry, uint end, uvec2 corner) {
  uint lane = gl_LocalInvocationIndex;
  uint visible = 0;
  vec4 ball = vec4(0.0);
  bool isKept = false;
  if (entry < end) {
    visible = checked(FRAME.tileCells.v[checked(entry, FRAME.pairCapacity)], FRAME.visibleCapacity);
    ball = FRAME.records.v[visible].ball;
    Ball solid = solidBall(Ball(ball.xyz, ball.w), FRAME.records.v[visible].solidBall);
    isKept = pixelsMeetBall(solid.centre, solid.radius, corner, kSubTileSize);
  }
  if (isKept) atomicOr(keptMask[lane / 32], 1u << (lane % 32));
  barrier();
  if (isKept) {
    uint place = bitCount(keptMask[lane / 32] & ((1u << (lane % 32)) - 1)) + (lane >= 32 ? bitCount(keptMask[0]) : 0);
    balls[place] = ball;
    cells[place] = visible;
  }
  uint count = bitCount(keptMask[0]) + bitCount(keptMask[1]);
  barrier();
  return count;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uvec2 corner = gl_WorkGroupID.xy * kSubTileSize;
  uvec2 pixel = gl_GlobalInvocationID.xy;
  bool isInside = pixel.x < FRAME.regionWidth && pixel.y < FRAME.regionHeight;
  uvec2 tile = corner / kTileSize;
  uvec2 range = FRAME.tileRanges.v[tile.y * FRAME.tilesX + tile.x];
  vec3 direction = normalize(pixelRay(vec2(pixel)));
  Radiance radiance = emptyRadiance();

  for (uint first = ~range.x; first < range.y; first += kBatch) {
    bool isLive = isInside && !isSaturated(radiance);
    if (lane < kBatch / 32) keptMask[lane] = 0;
    if (lane == 0) liveMask = 0;
    barrier();
    if (isLive) atomicOr(liveMask, 1u);
    uint count = gatherBatch(first + lane, range.y, corner);
    if (lane == 0) {
      countWork(kWorkEntries, min(range.y - first, kBatch));
      countWork(kWorkEntriesKept, count);
    }
    if (liveMask == 0) break;
    if (isLive) {
      for (uint i = 0; i < count && !isSaturated(radiance); ++i) meetCell(i, direction, radiance);
    }
    barrier();
  }
  if (isInside) writePixel(pixel, radiance.colour, opacity(-radiance.logTransmittance), radiance.distance, radiance.normal);
}
