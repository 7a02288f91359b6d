// LDR-FLIP: the difference that a person sees when two pictures alternate at one place. After P. Andersson,
// J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), HPG 2020. Sections and equations below
// are those of the paper.
#pragma once

#include <vector>

#include "base/image/image.h"
#include "base/result.h"

namespace froth {

// The paper's viewer: 0.7 m before a display 0.7 m wide with 3840 pixels, near its middle: 3840 * pi / 180.
constexpr double kFlipPixelsPerDegree = 67.0206432766;

// What FLIP derives from one image alone; made once for a reference that several images are held against.
struct FlipImage {
  uint32_t width = 0, height = 0;
  double pixelsPerDegree = 0;
  std::vector<float> lightness, redGreen,
      blueYellow;                    // filtered as the eye does, L*a*b* with Hunt's correction
  std::vector<float> edges, points;  // lengths of the feature vectors
};

struct FlipDifference {
  double mean = 0;  // [0..1]
  Image map;        // 1 channel [0..1]
};

// Display-coded (sRGB) values of 1 or 3 channels, clamped to 0..1. Fails without pixels or pixelsPerDegree >
// 0. Rows run in parallel; the result does not depend on the number of threads.
Result<FlipImage> prepareFlip(const Image& image, double pixelsPerDegree = kFlipPixelsPerDegree);

// A pixel that a NaN reaches counts as 1. Fails if size or pixels per degree differ.
Result<FlipDifference> compareFlip(const FlipImage& reference, const FlipImage& test);

// A map of 0..1 as a picture of 3 channels: the magma colours, black for 0 to pale yellow for 1.
Image colourErrorMap(const Image& map);

}  // namespace froth
