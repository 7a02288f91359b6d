// How far a renderer may be from the double-precision image, from the conditioning of the foam and view at hand.
//
// Backward error analysis (Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 1.5): arithmetic that rounds each
// operation gives the exact result of inputs that are off by a few roundings. So the double image is drawn again with every value
// that a cell is drawn with off by that much (ReferenceOptions::rounding; Monte Carlo arithmetic, Parker 1997); what a pixel
// then changes by is what it is entitled to.
#pragma once

#include <cstdint>

#include "baker/camera/camera.h"
#include "baker/image/image.h"
#include "baker/reference/reference.h"
#include "format/result.h"

namespace froth {

struct BoundOptions {
  double rounding = 0x1p-21;  // relative: 2^-24 of float, for a chain of some eight operations
  uint32_t samples = 12;      // double images with other roundings
  double storageError = 0;    // [display-coded] of colours between passes
};

// Of one view: the exact image, and per pixel and channel how far another may be from it.
struct ImageBound {
  RenderedImages exact;
  Image colour;  // 3 channels [display-coded]
  Image alpha;   // 1 channel
  double largest = 0, mean = 0;  // of `colour`
};

Result<ImageBound> boundImage(const ReferenceRenderer& renderer, const View& view, const ReferenceOptions& options,
                              const BoundOptions& bound);

// How an image keeps to it.
struct BoundCheck {
  bool isFinite = true;       // every value of colour, alpha and depth
  double maxError = 0;        // [display-coded] of colour
  double worstExcess = 0;     // largest error over its pixel's bound; <= 1: all keep to it
  uint32_t worstX = 0, worstY = 0;
  double shareOver = 0;       // pixels over their bound
};

BoundCheck checkBound(const ImageBound& bound, const RenderedImages& image);

}  // namespace froth
