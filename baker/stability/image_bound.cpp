#include "baker/stability/image_bound.h"

#include <algorithm>
#include <cmath>

namespace froth {
namespace {

constexpr double kUnit = 0x1p-24;  // of float
constexpr double kLeastBound = kUnit / 16;
constexpr uint64_t kSeedStride = 16;  // a render may use a few seeds from the one it is given on

// The largest change of each value so far.
void addSpread(const Image& exact, const Image& sample, Image& spread) {
  for (size_t i = 0; i < exact.values.size(); ++i)
    spread.values[i] = std::max(spread.values[i], std::abs(sample.values[i] - exact.values[i]));
}

// From the spread to the bound; `relative` of the exact value.
Image boundOf(const Image& exact, const Image& spread, double safety, double relative, double absolute) {
  Image bound = exact;
  for (size_t i = 0; i < bound.values.size(); ++i) {
    const double value = std::abs(exact.values[i]);
    bound.values[i] = static_cast<float>(safety * spread.values[i] + relative * value + absolute);
  }
  return bound;
}

Image zerosLike(const Image& image) {
  Image zeros = image;
  std::fill(zeros.values.begin(), zeros.values.end(), 0.0f);
  return zeros;
}

bool isFinite(const Image& image) {
  return std::all_of(image.values.begin(), image.values.end(), [](float value) { return std::isfinite(value); });
}

bool hasNegativeZero(const Image& image) {
  return std::any_of(image.values.begin(), image.values.end(), [](float value) { return value == 0 && std::signbit(value); });
}

// The largest error of a pixel, and that over its bound; NaN is infinitely far off.
struct PixelError {
  double error = 0, excess = 0;
};
PixelError errorAt(const Image& a, const Image& b, const Image& bound, double times, uint32_t x, uint32_t y) {
  PixelError worst;
  for (uint32_t channel = 0; channel < a.channels; ++channel) {
    const double error = std::abs(double{a.pixel(x, y)[channel]} - b.pixel(x, y)[channel]);
    if (!std::isfinite(error)) return {HUGE_VAL, HUGE_VAL};
    worst.error = std::max(worst.error, error);
    worst.excess = std::max(worst.excess, error / (times * bound.pixel(x, y)[channel]));
  }
  return worst;
}

BoundCheck compare(const ImageBound& bound, const RenderedImages& a, const RenderedImages& b, double times) {
  BoundCheck check;
  uint64_t over = 0;
  for (uint32_t y = 0; y < a.colour.height; ++y) {
    for (uint32_t x = 0; x < a.colour.width; ++x) {
      const PixelError colour = errorAt(a.colour, b.colour, bound.colour, times, x, y),
                       alpha = errorAt(a.alpha, b.alpha, bound.alpha, times, x, y);
      check.maxError = std::max(check.maxError, colour.error);
      const double excess = std::max(colour.excess, alpha.excess);
      if (excess > 1) ++over;
      if (excess <= check.worstExcess) continue;
      check.worstExcess = excess;
      check.worstX = x;
      check.worstY = y;
    }
  }
  check.shareOver = static_cast<double>(over) / (double{1} * a.colour.width * a.colour.height);
  check.isFinite = isFinite(a.colour) && isFinite(a.alpha) && isFinite(a.depth) && isFinite(a.normal) &&
                   !hasNegativeZero(a.colour) && !hasNegativeZero(a.alpha);
  return check;
}

}  // namespace

Result<ImageBound> boundImage(const ReferenceRenderer& renderer, const View& view, const ReferenceOptions& options,
                              const BoundOptions& bound) {
  ReferenceOptions exact = options;
  exact.precision = Precision::kDouble;
  exact.rounding = 0;
  Result<RenderedImages> image = renderer.render(view, exact);
  if (!image) return image.error();
  ImageBound result;
  result.exact = std::move(*image);

  Image colour = zerosLike(result.exact.colour), alpha = zerosLike(result.exact.alpha);
  ReferenceOptions rounded = exact;
  rounded.rounding = bound.rounding;
  for (uint32_t i = 0; i < bound.samples; ++i) {
    rounded.roundingSeed = options.roundingSeed + kSeedStride * i;
    const Result<RenderedImages> sample = renderer.render(view, rounded);
    if (!sample) return sample.error();
    addSpread(result.exact.colour, sample->colour, colour);
    addSpread(result.exact.alpha, sample->alpha, alpha);
  }
  const double sum = (bound.cells + 8) * kUnit;
  result.colour = boundOf(result.exact.colour, colour, bound.safety, bound.storage + sum, bound.storageError + kLeastBound);
  result.alpha = boundOf(result.exact.alpha, alpha, bound.safety, sum, kLeastBound);
  for (const float value : result.colour.values) {
    result.largest = std::max(result.largest, double{value});
    result.mean += value / static_cast<double>(result.colour.values.size());
  }
  return result;
}

BoundCheck checkBound(const ImageBound& bound, const RenderedImages& image) {
  return compare(bound, image, bound.exact, 1);
}

BoundCheck checkBound(const ImageBound& bound, const RenderedImages& image, const RenderedImages& other) {
  return compare(bound, image, other, 2);
}

}  // namespace froth
