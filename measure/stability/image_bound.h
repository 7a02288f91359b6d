// How far a renderer may be from the double-precision image, from the conditioning of the foam and view at hand.
//
// Backward error analysis (Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 1.5): arithmetic
// that rounds each operation gives the exact result of inputs that are off by a few roundings. So the double image is
// drawn again with every value that a cell is drawn with off by that much (ReferenceOptions::rounding; Monte Carlo
// arithmetic, Parker 1997); what a pixel then changes by is what it is entitled to.
//
//   bound = safety * spread + (cells + 8) u * exact + u / 16,   u = 2^-24
//
// spread: the largest change of the pixel in any sample. safety: a renderer's errors are one more draw, and need not be
// spread as the samples' are; one beyond four times the largest of 12 is no draw of the kind. A pixel that jumps (a ray
// within rounding of an edge) jumps in the samples too, but one that does so rarely may not in 12 of them: whoever
// finds a pixel over its bound asks again with kSurerSamples.
// cells + 8: a sum of n products of values >= 0 is off by at most (n + 1) u of itself; exp is good to 3 u + 2 |x| u,
// which times T is below 4 u.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/image/image.h"
#include "base/result.h"
#include "reference/camera/camera.h"
#include "reference/render/reference.h"

namespace froth {

inline constexpr uint32_t kSurerSamples = 256;

struct BoundOptions {
  double rounding = 0x1p-21;  // relative: 2^-24 of float, for a chain of some eight operations
  uint32_t samples = 12;      // double images with other roundings
  double safety = 4;
  uint32_t cells = 64;  // that a ray composites
};

// Distances of one view: where transmittance falls to the quantile may move from one cell to another by rounding, so
// the samples give a range.
struct DistanceBound {
  Image middle, margin;                  // 1 channel [scene units]; of pixels that may have a distance
  std::vector<uint8_t> mayHit, mayMiss;  // [pixels] whether it may have one, and none
};

// Of one view: the exact image, and per pixel and channel how far another may be from it.
struct ImageBound {
  RenderedImages exact;
  Image colour;  // 3 channels [display-coded]
  Image alpha;   // 1 channel
  Image normal;  // 3 channels; the runtime's are halves
  DistanceBound distance;
  Image exactLight, light;       // `exact.colour` and `colour` in linear light, still premultiplied: what rays give
  double largest = 0, mean = 0;  // of `colour`
};

// Draws the view at hand under such options.
using ReferenceDraw = std::function<Result<RenderedImages>(const ReferenceOptions&)>;
Result<ImageBound> boundImage(const ReferenceDraw& draw, const ReferenceOptions& options, const BoundOptions& bound);
Result<ImageBound> boundImage(const ReferenceRenderer& renderer, const View& view, const ReferenceOptions& options,
                              const BoundOptions& bound);

// The bound of the form that games draw: colours of detail sites are halves between passes (shaders/gpu/layout.h,
// DetailRecord), off by at most 2^-11 of themselves, and a pixel is a sum of them with weights >= 0; the image is of
// halves, which may be rounded either way (2^-10); and a ray ends when its transmittance falls below a cut-off. What
// that leaves out is what the exact image gains between a cut-off and none. `atTwice`: the exact image with twice the
// cut-off, as transmittance is itself off by rounding.
ImageBound boundShippedForm(const ImageBound& bound, const RenderedImages& atTwice);

// The bound of rays that are cast one by one: their colour is linear, and of a transmittance that was rounded to float
// (exp is good to 3 u + 2 |x| u, which times T is below 4 u) the opacity keeps that error, however small it is.
ImageBound boundOfRays(const ImageBound& bound);

// How an image keeps to it. A form without colours, distances or normals has those images empty, and is not asked for
// them.
struct BoundCheck {
  bool isFinite = true;  // every value of colour, alpha, distance and normal; and no 0 of colour or alpha is -0
  // of colour, as the bound has it: [display-coded], or of rays [linear]; without colours of alpha
  double maxError = 0;
  double worstExcess = 0;  // largest error over its pixel's bound, of all channels; <= 1: all keep to it
  // the same of colour and alpha alone: normals come close to theirs by the halves of their image
  double colourExcess = 0;
  const char* worstChannel = "colour";  // or "alpha", "distance", "normal"
  uint32_t worstX = 0, worstY = 0;
  double shareOver = 0;  // pixels over their bound
};

BoundCheck checkBound(const ImageBound& bound, const RenderedImages& image);
// The same of two images against each other: their difference over one bound, not two. It has no share of what they
// read of the same stored values, so `bound` is the one without.
BoundCheck checkBound(const ImageBound& bound, const RenderedImages& image, const RenderedImages& other);

// Whether all bits are equal: of NaN and of 0 and -0 as well.
bool hasSameBits(const RenderedImages& a, const RenderedImages& b);

}  // namespace froth
