// Which tiles of kTileSize pixels a ball can meet.
#ifndef FROTH_GPU_TILES_GLSL
#define FROTH_GPU_TILES_GLSL
#include "gpu/asset.glsl"
#include "gpu/pixels.glsl"

// First and last column and row of tiles that hold the ball's image; last < first: none.
struct TileBounds {
  ivec2 first, last;
};

// Tiles that hold the pixels between two pixel coordinates, clamped before the conversion to integers.
ivec2 tileInterval(float low, float high, uint pixels) {
  float most = float(pixels - 1);
  ivec2 interval = ivec2(clamp(ceil(low - kPixelGuard), 0.0, most + 1), clamp(floor(high + kPixelGuard), -1.0, most));
  return interval.x > interval.y ? ivec2(0, -1) : interval / int(kTileSize);
}

// Of the tiles in all blocks that the ball meets.
TileBounds blockBounds(Ball ball) {
  float radius = guardedRadius(ball.centre, ball.radius);
  TileBounds bounds = TileBounds(ivec2(FRAME.tilesX, FRAME.tilesY), ivec2(-1));
  for (uint block = 0; block < FRAME.blocksX * FRAME.blocksY; ++block) {
    if (!blockMeetsBall(block, ball.centre, radius)) continue;
    ivec2 corner = ivec2(block % FRAME.blocksX, block / FRAME.blocksX) * int(kBlockTiles);
    bounds.first = min(bounds.first, corner);
    bounds.last = max(bounds.last, corner + int(kBlockTiles) - 1);
  }
  bounds.last = min(bounds.last, ivec2(FRAME.tilesX, FRAME.tilesY) - 1);
  return bounds;
}

TileBounds parallelBounds(Ball ball) {
  vec2 middle, reach;
  ballOnPixels(ball.centre, ball.radius, middle, reach);
  if (reach.x < 0.0) return TileBounds(ivec2(0), ivec2(-1));
  ivec2 columns = tileInterval(middle.x - reach.x, middle.x + reach.x, FRAME.regionWidth);
  ivec2 rows = tileInterval(middle.y - reach.y, middle.y + reach.y, FRAME.regionHeight);
  return TileBounds(ivec2(columns.x, rows.x), ivec2(columns.y, rows.y));
}

TileBounds tileBounds(Ball ball) {
  if (lensClass == kLensClassOrthographic) return parallelBounds(ball);
  if (lensClass == kLensClassMapped) return blockBounds(ball);
  vec4 stepX = FRAME.rayX, stepY = FRAME.rayY;  // whole loads: see cull_cells.comp
  vec3 normal = cross(stepX.xyz, stepY.xyz);
  TileBounds bounds = TileBounds(ivec2(0), ivec2(FRAME.tilesX, FRAME.tilesY) - 1);
  float low, high;
  if (boundBallImage(ball.centre, ball.radius, cross(FRAME.rayOrigin.xyz, stepY.xyz), normal, low, high)) {
    ivec2 columns = tileInterval(low + stepX.w, high + stepX.w, FRAME.regionWidth);
    bounds.first.x = columns.x;
    bounds.last.x = columns.y;
  }
  if (boundBallImage(ball.centre, ball.radius, cross(stepX.xyz, FRAME.rayOrigin.xyz), normal, low, high)) {
    ivec2 rows = tileInterval(low + stepY.w, high + stepY.w, FRAME.regionHeight);
    bounds.first.y = rows.x;
    bounds.last.y = rows.y;
  }
  return bounds;
}

// The tiles in the bounds of up to kTileCellsPerGroup balls, tested by all threads of a workgroup together: however
// unlike the balls are in size, every thread has as much to do.
struct TileCandidate {
  uint cell;  // place in the workgroup's list
  uvec2 tile;
};

shared vec4 balls[kTileCellsPerGroup];
shared uvec3 corners[kTileCellsPerGroup];  // first column and row, columns
shared uint starts[kTileCellsPerGroup];    // first candidate

// Makes the ball that of this thread, one of the first kTileCellsPerGroup. Returns how many candidates it has.
uint takeBall(Ball ball) {
  TileBounds bounds = tileBounds(ball);
  uvec2 extent = uvec2(max(bounds.last - bounds.first + 1, 0));
  balls[gl_LocalInvocationIndex] = vec4(ball.centre, ball.radius);
  corners[gl_LocalInvocationIndex] = uvec3(bounds.first, extent.x);
  return extent.x * extent.y;
}

// The same with what is seen of the cell of a slot.
uint takeCell(uint slot) {
  return takeBall(visibleBall(FRAME.visibleCells.v[checked(slot, FRAME.visibleCapacity)]));
}

// start: candidates of the threads before. Ends with a barrier.
void startCandidates(uint start) {
  if (gl_LocalInvocationIndex < kTileCellsPerGroup) starts[gl_LocalInvocationIndex] = start;
  barrier();
}

TileCandidate candidateAt(uint index) {
  uint cell = 0;
  for (uint stride = kTileCellsPerGroup / 2; stride > 0; stride /= 2) {
    if (starts[cell + stride] <= index) cell += stride;
  }
  uvec3 corner = corners[cell];
  uint place = index - starts[cell];
  return TileCandidate(cell, uvec2(corner.x + place % corner.z, corner.y + place / corner.z));
}

bool meetsTile(TileCandidate candidate) {
  vec4 ball = balls[candidate.cell];
  return pixelsMeetBall(ball.xyz, ball.w, candidate.tile * kTileSize, kTileSize);
}

#endif
