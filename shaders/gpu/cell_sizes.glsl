// Which cells matter most where a view has no room for all: those that are largest on screen.
#ifndef FROTH_GPU_CELL_SIZES_GLSL
#define FROTH_GPU_CELL_SIZES_GLSL
#include "gpu/asset.glsl"

// Bits above the second digit of a square: that of a sixteenth of a pixel, the least size that is told from smaller
// ones.
const uint kSquareShift = 22;
const uint kLeastSquare = (127 - 8) << 1;
// [square radians] What stands for a pixel of a mapped lens.
const float kMappedPixel = 1.0 / (512.0 * 512.0);

// [pixels] The radius on screen of the largest balls of a class.
float radiusOfClass(uint sizeClass) { return exp2(0.25 * float(sizeClass) - 4.0); }

// At unit distance, or everywhere along parallel rays.
float pixelArea() {
  if (lensClass == kLensClassMapped) return kMappedPixel;
  vec4 stepX = FRAME.rayX, stepY = FRAME.rayY;  // whole loads: see cull_cells.comp
  return length(cross(stepX.xyz, stepY.xyz));
}

// 0 of balls that show nothing.
uint sizeClassOf(Ball ball) {
  if (!(ball.radius > 0.0)) return 0;
  precise float square = ball.radius * ball.radius;
  if (lensClass != kLensClassOrthographic) square /= max(dot(ball.centre, ball.centre), square);
  uint digits = floatBitsToUint(square / pixelArea()) >> kSquareShift;
  return clamp(digits, kLeastSquare, kLeastSquare + kSizeClasses - 2) - kLeastSquare + 1;
}

// Grows with the size. Among cells of one class it is as good as random, but the same in every frame: what goes of them
// is spread over the image.
uint sizeKey(Chunk chunk, uint cell, Ball ball) {
  uint scattered = (cell + chunk.index) * 0x9e3779b9u;  // multiples of the golden ratio
  return sizeClassOf(ball) * kKeysPerSize + scattered / (0xffffffffu / kKeysPerSize + 1);
}

#endif
