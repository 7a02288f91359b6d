// Which cells matter most where a view has no room for all: those that cover most of the screen, by the area of their
// balls and their opacity.
#ifndef FROTH_GPU_CELL_SIZES_GLSL
#define FROTH_GPU_CELL_SIZES_GLSL
#include "gpu/cell_bits.glsl"
#include "foam/compositing.h"

// A class is what stands above the second binary digit of the square of a size, from a sixteenth of a pixel on.
const uint kSquareShift = 22;
const uint kLeastSquare = (127 - 8) << 1;
const float kMappedPixel = 1.0 / (512.0 * 512.0);  // [square radians] what stands for one of a mapped lens

// [pixels] The radius on screen of the largest opaque balls of a class.
float radiusOfClass(uint sizeClass) { return exp2(0.25 * float(sizeClass) - 4.0); }

// Of a pixel at unit distance, or everywhere along parallel rays.
float pixelArea() {
  if (lensClass == kLensClassMapped) return kMappedPixel;
  vec4 stepX = FRAME.rayX, stepY = FRAME.rayY;  // whole loads: see cull_cells.comp
  return length(cross(stepX.xyz, stepY.xyz));
}

uint sizeClassOf(Ball ball, float density) {
  precise float square = ball.radius * ball.radius;
  if (lensClass != kLensClassOrthographic) square /= max(dot(ball.centre, ball.centre), square);
  square *= opacity(2.0 * ball.radius * density) / pixelArea();
  uint digits = floatBitsToUint(square) >> kSquareShift;
  return clamp(digits, kLeastSquare, kLeastSquare + kSizeClasses - 2) - kLeastSquare + 1;
}

// Grows with the size; cells that show nothing have the least. Among cells of one class it is as good as random, but
// the same in every frame: what goes of them is spread over the image.
uint sizeKey(Chunk chunk, uint cell, Ball ball) {
  uint scattered = (cell + chunk.index) * 0x9e3779b9u;  // multiples of the golden ratio
  uint sizeClass = 0;
  if (ball.radius > 0.0) {
    BitCursor bits = cellBits(chunk.index, cell);
    sizeClass = sizeClassOf(ball, takeDensity(FRAME.chunks.v[chunk.index].code, bits));
  }
  return sizeClass * kKeysPerSize + scattered / (0xffffffffu / kKeysPerSize + 1);
}

#endif
