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

TileBounds tileBounds(Ball ball) {
  vec3 normal = cross(FRAME.rayX.xyz, FRAME.rayY.xyz);
  TileBounds bounds = TileBounds(ivec2(0), ivec2(FRAME.tilesX, FRAME.tilesY) - 1);
  float low, high;
  if (boundBallImage(ball.centre, ball.radius, cross(FRAME.rayOrigin.xyz, FRAME.rayY.xyz), normal, low, high)) {
    ivec2 columns = tileInterval(low, high, FRAME.regionWidth);
    bounds.first.x = columns.x;
    bounds.last.x = columns.y;
  }
  if (boundBallImage(ball.centre, ball.radius, cross(FRAME.rayX.xyz, FRAME.rayOrigin.xyz), normal, low, high)) {
    ivec2 rows = tileInterval(low, high, FRAME.regionHeight);
    bounds.first.y = rows.x;
    bounds.last.y = rows.y;
  }
  return bounds;
}

bool tileMeetsBall(ivec2 tile, Ball ball) {
  uvec2 firstPixel = uvec2(tile) * kTileSize;
  return pixelsMeetBall(ball.centre, ball.radius, firstPixel, kTileSize);
}

#endif
