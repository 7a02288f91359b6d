#include "measure/stability/image_bound.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "shaders/foam/colour.h"

namespace froth {
namespace {

constexpr double kUnit = 0x1p-24;  // of float
constexpr double kLeastBound = kUnit / 16;
constexpr double kHalfUnit = 0x1p-10;      // of an image of halves, relative: rounded to either neighbour
constexpr double kLeastHalf = 0x1p-24;     // the same of the smallest ones
constexpr double kStoredColour = 0x1p-11;  // of colours between passes: rounded to the nearest
constexpr double kTransmittanceUnits = 4;  // [u] of T as exp gives it
constexpr double kNotAllowed = 1e30;       // times the bound: what no bound allows; JSON has no infinity
constexpr uint64_t kSeedStride = 16;       // a render may use a few seeds from the one it is given on

// The largest change of each value so far.
void addSpread(const Image& exact, const Image& sample, Image& spread) {
  for (size_t i = 0; i < exact.values.size(); ++i) {
    spread.values[i] = std::max(spread.values[i], std::abs(sample.values[i] - exact.values[i]));
  }
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
  return std::any_of(image.values.begin(), image.values.end(),
                     [](float value) { return value == 0 && std::signbit(value); });
}

// The largest error of a pixel, and that over its bound.
struct PixelError {
  double error = 0, excess = 0;
};
PixelError errorAt(const Image& a, const Image& b, const Image& bound, size_t pixel) {
  PixelError worst;
  for (size_t i = pixel * a.channels; i < (pixel + 1) * a.channels; ++i) {
    const double error = std::abs(double{a.values[i]} - b.values[i]);
    if (!std::isfinite(error)) return {kNotAllowed, kNotAllowed};
    worst.error = std::max(worst.error, error);
    worst.excess = std::max(worst.excess, error / bound.values[i]);
  }
  return worst;
}

// Of a distance against where it may lie, or against another image's.
double excessOfDistance(const DistanceBound& bound, float distance, const float* other, size_t pixel) {
  const auto isAllowed = [&](float value) { return (value < 0 ? bound.mayMiss : bound.mayHit)[pixel] != 0; };
  if (!std::isfinite(distance) || !isAllowed(distance)) return kNotAllowed;
  if (other && (!std::isfinite(*other) || !isAllowed(*other))) return kNotAllowed;
  if (distance < 0 || (other && *other < 0)) return 0;
  return std::abs(double{distance} - (other ? *other : bound.middle.values[pixel])) / bound.margin.values[pixel];
}

// `other`: null to hold `image` against the exact one.
BoundCheck compare(const ImageBound& bound, const RenderedImages& image, const RenderedImages* other) {
  const RenderedImages& against = other ? *other : bound.exact;
  BoundCheck check;
  uint64_t over = 0;
  const size_t pixels = image.alpha.values.size();
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    double worst = 0;
    const auto take = [&](double excess, const char* channel) {
      worst = std::max(worst, excess);
      if (excess <= check.worstExcess) return;
      check.worstExcess = excess;
      check.worstChannel = channel;
      check.worstX = static_cast<uint32_t>(pixel % image.alpha.width);
      check.worstY = static_cast<uint32_t>(pixel / image.alpha.width);
    };
    const PixelError alpha = errorAt(image.alpha, against.alpha, bound.alpha, pixel);
    PixelError colour = alpha;
    if (!image.colour.values.empty()) {
      colour = errorAt(image.colour, against.colour, bound.colour, pixel);
      take(colour.excess, "colour");
    }
    check.maxError = std::max(check.maxError, colour.error);
    take(alpha.excess, "alpha");
    check.colourExcess = std::max(check.colourExcess, worst);
    if (!image.distance.values.empty()) {
      take(excessOfDistance(bound.distance, image.distance.values[pixel],
                            other ? &other->distance.values[pixel] : nullptr, pixel),
           "distance");
    }
    if (!image.normal.values.empty()) take(errorAt(image.normal, against.normal, bound.normal, pixel).excess, "normal");
    if (worst > 1) ++over;
  }
  check.shareOver = static_cast<double>(over) / static_cast<double>(pixels);
  check.isFinite = isFinite(image.colour) && isFinite(image.alpha) && isFinite(image.distance) &&
                   isFinite(image.normal) && !hasNegativeZero(image.colour) && !hasNegativeZero(image.alpha);
  return check;
}

// What the samples say of distances.
class DistanceSamples {
 public:
  explicit DistanceSamples(const RenderedImages& exact) : low_(exact.distance), high_(exact.distance) {
    bound_.mayHit.assign(low_.values.size(), 0);
    bound_.mayMiss.assign(low_.values.size(), 0);
    for (size_t pixel = 0; pixel < low_.values.size(); ++pixel) note(pixel, exact.distance.values[pixel]);
  }
  void add(const Image& distance) {
    for (size_t pixel = 0; pixel < distance.values.size(); ++pixel) {
      const float value = distance.values[pixel];
      note(pixel, value);
      if (value < 0) continue;
      low_.values[pixel] = low_.values[pixel] < 0 ? value : std::min(low_.values[pixel], value);
      high_.values[pixel] = std::max(high_.values[pixel], value);
    }
  }
  // `relative` of a distance is added.
  DistanceBound boundOf(double safety, double relative) {
    bound_.middle = bound_.margin = low_;
    for (size_t pixel = 0; pixel < low_.values.size(); ++pixel) {
      const double low = low_.values[pixel], high = high_.values[pixel];
      bound_.middle.values[pixel] = static_cast<float>((low + high) / 2);
      bound_.margin.values[pixel] =
          static_cast<float>(safety * (high - low) / 2 + relative * high + std::numeric_limits<float>::min());
    }
    return std::move(bound_);
  }

 private:
  void note(size_t pixel, float distance) { (distance < 0 ? bound_.mayMiss : bound_.mayHit)[pixel] = 1; }

  Image low_, high_;  // of what hits; -1: nothing did
  DistanceBound bound_;
};

// Where transmittance ends so close to the quantile that it may lie on either side, any distance may be met, or none.
void allowNearQuantile(const ReferenceOptions& options, const Image& alpha, const Image& alphaBound,
                       DistanceBound& distance) {
  for (size_t pixel = 0; pixel < alpha.values.size(); ++pixel) {
    if (std::abs(1 - alpha.values[pixel] - options.quantile) > alphaBound.values[pixel]) continue;
    distance.margin.values[pixel] = std::numeric_limits<float>::max();
    distance.mayHit[pixel] = distance.mayMiss[pixel] = 1;
  }
}

// Premultiplied display-coded colours as premultiplied linear light.
Image lightOf(const RenderedImages& images) {
  Image light = images.colour;
  for (size_t pixel = 0; pixel < images.alpha.values.size(); ++pixel) {
    float* const values = &light.values[3 * pixel];
    const glm::dvec3 linear =
        foam::linearPremultiplied(glm::dvec3(values[0], values[1], values[2]), double{images.alpha.values[pixel]});
    for (int channel = 0; channel < 3; ++channel) values[channel] = static_cast<float>(linear[channel]);
  }
  return light;
}

// How far x^2.4 may be off, relative, of an x that is off by a few roundings, where Vulkan's rules are kept: exp2(2.4
// log2 x), log2 to 2^-21 or 6 u of itself, exp2 to 6 u and 4 u for each whole of its exponent.
double errorOfPower(double power) { return (30 + 9 * std::abs(std::log2(std::max(power, 1e-3)))) * kUnit; }

// From the spread of light. A L(C / A) is off by 2.4 times what C is, by 1.4 times what A is, and by the power.
Image boundOfLight(const ImageBound& bound, const Image& spread, double safety, double relative) {
  Image light = bound.exactLight;
  for (size_t i = 0; i < light.values.size(); ++i) {
    const double value = std::abs(bound.exactLight.values[i]), alpha = bound.exact.alpha.values[i / 3];
    const double power = alpha > 0 ? value / alpha : 0;
    light.values[i] = static_cast<float>(safety * spread.values[i] + (4 * relative + errorOfPower(power)) * value +
                                         4 * kLeastBound * std::max(1.0, power));
  }
  return light;
}

void widen(const Image& exact, const Image& atTwice, double relative, Image& bound) {
  for (size_t i = 0; i < bound.values.size(); ++i) {
    const double leftOut = std::abs(double{exact.values[i]} - atTwice.values[i]);
    bound.values[i] += static_cast<float>(leftOut + relative * std::abs(exact.values[i]) + kLeastHalf);
  }
}

}  // namespace

Result<ImageBound> boundImage(const ReferenceDraw& draw, const ReferenceOptions& options, const BoundOptions& bound) {
  ReferenceOptions exact = options;
  exact.precision = Precision::kDouble;
  exact.rounding = 0;
  Result<RenderedImages> image = draw(exact);
  if (!image) return image.error();
  ImageBound result;
  result.exact = std::move(*image);
  result.exactLight = lightOf(result.exact);

  Image colour = zerosLike(result.exact.colour), alpha = zerosLike(result.exact.alpha),
        normal = zerosLike(result.exact.normal);
  Image light = colour;
  DistanceSamples distance(result.exact);
  ReferenceOptions rounded = exact;
  rounded.rounding = bound.rounding;
  for (uint32_t i = 0; i < bound.samples; ++i) {
    rounded.roundingSeed = options.roundingSeed + kSeedStride * i;
    const Result<RenderedImages> sample = draw(rounded);
    if (!sample) return sample.error();
    addSpread(result.exact.colour, sample->colour, colour);
    addSpread(result.exact.alpha, sample->alpha, alpha);
    addSpread(result.exact.normal, sample->normal, normal);
    addSpread(result.exactLight, lightOf(*sample), light);
    distance.add(sample->distance);
  }
  const double sum = (bound.cells + 8) * kUnit;
  result.colour = boundOf(result.exact.colour, colour, bound.safety, sum, kLeastBound);
  result.alpha = boundOf(result.exact.alpha, alpha, bound.safety, sum, kLeastBound);
  // Terms of a normal may cancel: their sum is rounded by parts of what they add up to, at most alpha <= 1.
  result.normal = boundOf(result.exact.normal, normal, bound.safety, kHalfUnit, sum + kLeastHalf);
  result.light = boundOfLight(result, light, bound.safety, sum);
  result.distance = distance.boundOf(bound.safety, sum);
  allowNearQuantile(options, result.exact.alpha, result.alpha, result.distance);
  for (const float value : result.colour.values) {
    result.largest = std::max(result.largest, double{value});
    result.mean += value / static_cast<double>(result.colour.values.size());
  }
  return result;
}

Result<ImageBound> boundImage(const ReferenceRenderer& renderer, const View& view, const ReferenceOptions& options,
                              const BoundOptions& bound) {
  return boundImage([&](const ReferenceOptions& own) { return renderer.render(view, own); }, options, bound);
}

ImageBound boundOfRays(const ImageBound& bound) {
  ImageBound rays = bound;
  rays.exact.colour = bound.exactLight;
  rays.colour = bound.light;
  for (float& value : rays.alpha.values) value += static_cast<float>(kTransmittanceUnits * kUnit);
  return rays;
}

ImageBound boundShippedForm(const ImageBound& bound, const RenderedImages& atTwice) {
  ImageBound shipped = bound;
  widen(bound.exact.colour, atTwice.colour, kStoredColour + kHalfUnit, shipped.colour);
  widen(bound.exact.alpha, atTwice.alpha, kHalfUnit, shipped.alpha);
  return shipped;
}

BoundCheck checkBound(const ImageBound& bound, const RenderedImages& image) { return compare(bound, image, nullptr); }

BoundCheck checkBound(const ImageBound& bound, const RenderedImages& image, const RenderedImages& other) {
  return compare(bound, image, &other);
}

bool hasSameBits(const RenderedImages& a, const RenderedImages& b) {
  const auto isSame = [](const Image& one, const Image& other) {
    return std::ranges::equal(one.values, other.values, {}, std::bit_cast<uint32_t, float>,
                              std::bit_cast<uint32_t, float>);
  };
  return isSame(a.colour, b.colour) && isSame(a.alpha, b.alpha) && isSame(a.distance, b.distance) &&
         isSame(a.normal, b.normal);
}

}  // namespace froth
