#include "reference/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <tbb/parallel_for.h>

namespace froth {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Colour {
  float x = 0, y = 0, z = 0;
};

// --- Colour spaces. sRGB primaries in CIE XYZ, as fractions, so that the rows sum to the white point (IEC
// 61966-2-1).
constexpr double kXyzFromRgb[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                      {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                      {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double kRgbFromXyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                      {-0.969224334, 1.875930071, 0.041554224},
                                      {0.055639423, -0.204011202, 1.057148933}};
constexpr float kWhiteX = 0.950428545f, kWhiteZ = 1.088900371f;  // Y of white is 1

Colour transform(const double (&m)[3][3], Colour v) {
  return {float(m[0][0]) * v.x + float(m[0][1]) * v.y + float(m[0][2]) * v.z,
          float(m[1][0]) * v.x + float(m[1][1]) * v.y + float(m[1][2]) * v.z,
          float(m[2][0]) * v.x + float(m[2][1]) * v.y + float(m[2][2]) * v.z};
}

float decodeDisplay(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

// XYZ over that of white.
Colour whiteRelative(Colour linear) {
  const Colour xyz = transform(kXyzFromRgb, linear);
  return {xyz.x / kWhiteX, xyz.y, xyz.z / kWhiteZ};
}

// Opponent channels, linear in light: luminance, red-green, blue-yellow (section 4.1.1).
Colour opponentFromLinear(Colour linear) {
  const Colour v = whiteRelative(linear);
  return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}

Colour linearFromOpponent(Colour opponent) {
  const float y = (opponent.x + 16) / 116;
  return transform(kRgbFromXyz, {(y + opponent.y / 500) * kWhiteX, y, (y - opponent.z / 200) * kWhiteZ});
}

float labCurve(float t) {
  constexpr float kDelta = 6.0f / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
}

// L*a*b*, its chroma scaled by lightness: differences of dark colours are seen less (Hunt; section 4.1.2).
Colour huntFromLinear(Colour linear) {
  const Colour v = whiteRelative(linear);
  const float x = labCurve(v.x), y = labCurve(v.y), z = labCurve(v.z);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

// Far-apart colours: city block along lightness, Euclidean in chroma (HyAB; section 4.1.3).
float hybridDistance(Colour a, Colour b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// --- Filters. All of them are products of a filter along rows and one along columns; the image's edge goes
// on outside it.
using Plane = std::vector<float>;
using Kernel = std::vector<float>;  // of odd length, centred

// Values of f at -radius .. radius.
Kernel sampleKernel(int radius, const std::function<double(double)>& f) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(float(f(i)));
  return kernel;
}

double sumOf(const Kernel& kernel) {
  double sum = 0;
  for (float weight : kernel) sum += weight;
  return sum;
}

Kernel scaled(Kernel kernel, double factor) {
  for (float& weight : kernel) weight = float(weight * factor);
  return kernel;
}

Kernel normalized(const Kernel& kernel) { return scaled(kernel, 1 / sumOf(kernel)); }

// Positive and negative weights each sum to one (section 4.2): a step of full height then measures 1.
Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (float weight : kernel) (weight > 0 ? positive : negative) += std::abs(weight);
  for (float& weight : kernel) weight = float(weight / (weight > 0 ? positive : negative));
  return kernel;
}

Plane filterRows(const Plane& plane, uint32_t width, uint32_t height, const Kernel& kernel) {
  const size_t radius = kernel.size() / 2;
  Plane filtered(plane.size());
  tbb::parallel_for(uint32_t{0}, height, [&](uint32_t y) {
    const float* row = &plane[size_t{y} * width];
    Plane padded(width + 2 * radius);
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, width, padded.begin() + radius);
    std::fill_n(padded.end() - radius, radius, row[width - 1]);
    float* out = &filtered[size_t{y} * width];
    for (size_t i = 0; i < kernel.size(); ++i) {
      for (uint32_t x = 0; x < width; ++x) out[x] += kernel[i] * padded[x + i];
    }
  });
  return filtered;
}

Plane filterColumns(const Plane& plane, uint32_t width, uint32_t height, const Kernel& kernel) {
  const int64_t radius = int64_t(kernel.size() / 2);
  Plane filtered(plane.size());
  tbb::parallel_for(uint32_t{0}, height, [&](uint32_t y) {
    float* out = &filtered[size_t{y} * width];
    for (size_t i = 0; i < kernel.size(); ++i) {
      const int64_t from = std::clamp<int64_t>(int64_t{y} + int64_t(i) - radius, 0, int64_t{height} - 1);
      const float* row = &plane[size_t(from) * width];
      for (uint32_t x = 0; x < width; ++x) out[x] += kernel[i] * row[x];
    }
  });
  return filtered;
}

Plane filterBoth(const Plane& plane, uint32_t width, uint32_t height, const Kernel& kernel) {
  return filterColumns(filterRows(plane, width, height, kernel), width, height, kernel);
}

// --- The eye's contrast sensitivity as Gaussians over degrees, a sqrt(pi/b) exp(-pi^2 x^2 / b) (table 1).
// Blue-yellow is a sum of two.
constexpr double kLuminanceB = 0.0047, kRedGreenB = 0.0053;
constexpr double kBlueYellow[2][2] = {{34.1, 0.04}, {13.5, 0.025}};  // a, b

struct ContrastKernels {
  Kernel luminance, redGreen, blueYellow[2];

  explicit ContrastKernels(double pixelsPerDegree) {
    // Three deviations of the widest Gaussian.
    const int radius = int(std::ceil(3 * std::sqrt(kBlueYellow[0][1] / (2 * kPi * kPi)) * pixelsPerDegree));
    const auto gaussian = [&](double b) {
      return sampleKernel(
          radius, [&](double i) { return std::exp(-kPi * kPi * i * i / (pixelsPerDegree * pixelsPerDegree * b)); });
    };
    luminance = normalized(gaussian(kLuminanceB));
    redGreen = normalized(gaussian(kRedGreenB));
    // The sum over both Gaussians and both directions is one; each direction carries the square root of the
    // share.
    double weights[2], total = 0;
    for (int g = 0; g < 2; ++g) {
      const double line = sumOf(gaussian(kBlueYellow[g][1]));
      weights[g] = kBlueYellow[g][0] * std::sqrt(kPi / kBlueYellow[g][1]);
      total += weights[g] * line * line;
    }
    for (int g = 0; g < 2; ++g) blueYellow[g] = scaled(gaussian(kBlueYellow[g][1]), std::sqrt(weights[g] / total));
  }
};

// First and second derivatives of a Gaussian of the width that the eye resolves edges and points with
// (section 4.2).
struct FeatureKernels {
  Kernel smooth, edge, point;

  explicit FeatureKernels(double pixelsPerDegree) {
    constexpr double kWidth = 0.082;  // [degrees] of a peak to valley of the detector
    const double deviation = 0.5 * kWidth * pixelsPerDegree;
    const int radius = int(std::ceil(3 * deviation));
    const auto gaussian = [&](double i) { return std::exp(-i * i / (2 * deviation * deviation)); };
    smooth = normalized(sampleKernel(radius, gaussian));
    edge = balanced(sampleKernel(radius, [&](double i) { return -i * gaussian(i); }));
    point =
        balanced(sampleKernel(radius, [&](double i) { return (i * i / (deviation * deviation) - 1) * gaussian(i); }));
  }
};

// Length of the vector of the detector's answers along x and y.
Plane featureLength(const Plane& grey, uint32_t width, uint32_t height, const Kernel& detector, const Kernel& smooth) {
  const Plane alongX = filterColumns(filterRows(grey, width, height, detector), width, height, smooth);
  Plane length = filterRows(filterColumns(grey, width, height, detector), width, height, smooth);
  for (size_t p = 0; p < length.size(); ++p) length[p] = std::hypot(alongX[p], length[p]);
  return length;
}

struct Opponents {
  Plane luminance, redGreen, blueYellow;
};

Opponents splitOpponents(const Image& image) {
  const size_t pixels = size_t{image.width} * image.height;
  Opponents planes{Plane(pixels), Plane(pixels), Plane(pixels)};
  tbb::parallel_for(uint32_t{0}, image.height, [&](uint32_t y) {
    for (uint32_t x = 0; x < image.width; ++x) {
      const float* value = image.pixel(x, y);
      const auto channel = [&](uint32_t c) {
        return decodeDisplay(std::clamp(value[image.channels == 1 ? 0 : c], 0.0f, 1.0f));
      };
      const Colour opponent = opponentFromLinear({channel(0), channel(1), channel(2)});
      const size_t p = size_t{y} * image.width + x;
      planes.luminance[p] = opponent.x;
      planes.redGreen[p] = opponent.y;
      planes.blueYellow[p] = opponent.z;
    }
  });
  return planes;
}

// --- Pooling of both pipelines into 0..1 (sections 4.1.3, 4.3).
constexpr float kColourExponent = 0.7f, kFeatureExponent = 0.5f;
// Colour differences up to 0.4 of the largest take 0..0.95: what is larger cannot be told apart as well.
constexpr float kBreakAt = 0.4f, kBreakTo = 0.95f;

// Between the two sRGB colours that are farthest apart in this space: green and blue.
float largestColourDistance() {
  return std::pow(hybridDistance(huntFromLinear({0, 1, 0}), huntFromLinear({0, 0, 1})), kColourExponent);
}

float colourDifference(Colour a, Colour b, float largest) {
  const float distance = std::pow(hybridDistance(a, b), kColourExponent), limit = kBreakAt * largest;
  if (distance < limit) return distance * kBreakTo / limit;
  return kBreakTo + (distance - limit) / (largest - limit) * (1 - kBreakTo);
}

float featureDifference(float edgeA, float edgeB, float pointA, float pointB) {
  const float largest = std::max(std::abs(edgeA - edgeB), std::abs(pointA - pointB));
  return std::pow(largest / std::sqrt(2.0f), kFeatureExponent);
}

}  // namespace

Result<FlipImage> prepareFlip(const Image& image, double pixelsPerDegree) {
  if (image.width == 0 || image.height == 0 || !(pixelsPerDegree > 0) || !std::isfinite(pixelsPerDegree)) {
    return makeError(ErrorKind::kBadInput, "FLIP of %u x %u pixels at %g pixels per degree: all must be above 0",
                     image.width, image.height, pixelsPerDegree);
  }
  const uint32_t width = image.width, height = image.height;
  Opponents planes = splitOpponents(image);
  const ContrastKernels contrast(pixelsPerDegree);
  const FeatureKernels features(pixelsPerDegree);

  FlipImage prepared{width, height, pixelsPerDegree, {}, {}, {}, {}, {}};
  prepared.lightness = filterBoth(planes.luminance, width, height, contrast.luminance);
  prepared.redGreen = filterBoth(planes.redGreen, width, height, contrast.redGreen);
  prepared.blueYellow = filterBoth(planes.blueYellow, width, height, contrast.blueYellow[0]);
  const Plane second = filterBoth(planes.blueYellow, width, height, contrast.blueYellow[1]);
  tbb::parallel_for(uint32_t{0}, height, [&](uint32_t y) {
    for (size_t p = size_t{y} * width; p < size_t{y + 1} * width; ++p) {
      const Colour seen =
          linearFromOpponent({prepared.lightness[p], prepared.redGreen[p], prepared.blueYellow[p] + second[p]});
      const Colour lab = huntFromLinear(
          {std::clamp(seen.x, 0.0f, 1.0f), std::clamp(seen.y, 0.0f, 1.0f), std::clamp(seen.z, 0.0f, 1.0f)});
      prepared.lightness[p] = lab.x;
      prepared.redGreen[p] = lab.y;
      prepared.blueYellow[p] = lab.z;
    }
  });
  for (float& value : planes.luminance) value = (value + 16) / 116;
  prepared.edges = featureLength(planes.luminance, width, height, features.edge, features.smooth);
  prepared.points = featureLength(planes.luminance, width, height, features.point, features.smooth);
  return prepared;
}

Result<FlipDifference> compareFlip(const FlipImage& reference, const FlipImage& test) {
  if (reference.width != test.width || reference.height != test.height ||
      reference.pixelsPerDegree != test.pixelsPerDegree) {
    return makeError(
        ErrorKind::kBadInput, "cannot compare %u x %u pixels at %g per degree with %u x %u at %g; make both alike",
        reference.width, reference.height, reference.pixelsPerDegree, test.width, test.height, test.pixelsPerDegree);
  }
  const float largest = largestColourDistance();
  FlipDifference difference;
  difference.map = {reference.width, reference.height, 1, std::vector<float>(reference.edges.size())};
  tbb::parallel_for(uint32_t{0}, reference.height, [&](uint32_t y) {
    for (size_t p = size_t{y} * reference.width; p < size_t{y + 1} * reference.width; ++p) {
      const auto lab = [p](const FlipImage& image) {
        return Colour{image.lightness[p], image.redGreen[p], image.blueYellow[p]};
      };
      const float colour = colourDifference(lab(reference), lab(test), largest);
      const float feature = featureDifference(reference.edges[p], test.edges[p], reference.points[p], test.points[p]);
      const float error = std::pow(colour, 1 - feature);
      difference.map.values[p] = std::isnan(error) ? 1.0f : error;
    }
  });
  for (float error : difference.map.values) difference.mean += error;
  difference.mean /= double(difference.map.values.size());
  return difference;
}

Image colourErrorMap(const Image& map) {
  // Every 15th of the 256 colours of matplotlib's magma (S. van der Walt, N. Smith; CC0); between them
  // linear.
  constexpr std::array<Colour, 18> kMagma{{{0.0015f, 0.0005f, 0.0139f},
                                           {0.0355f, 0.0284f, 0.1252f},
                                           {0.1028f, 0.0630f, 0.2579f},
                                           {0.1915f, 0.0648f, 0.3962f},
                                           {0.2914f, 0.0646f, 0.4755f},
                                           {0.3843f, 0.0979f, 0.5010f},
                                           {0.4758f, 0.1346f, 0.5079f},
                                           {0.5692f, 0.1675f, 0.5041f},
                                           {0.6649f, 0.1981f, 0.4888f},
                                           {0.7611f, 0.2312f, 0.4602f},
                                           {0.8521f, 0.2761f, 0.4186f},
                                           {0.9259f, 0.3468f, 0.3750f},
                                           {0.9697f, 0.4469f, 0.3603f},
                                           {0.9894f, 0.5579f, 0.3917f},
                                           {0.9966f, 0.6683f, 0.4562f},
                                           {0.9967f, 0.7768f, 0.5410f},
                                           {0.9924f, 0.8843f, 0.6401f},
                                           {0.9871f, 0.9914f, 0.7495f}}};
  Image picture{map.width, map.height, 3, {}};
  picture.values.reserve(map.values.size() * 3);
  for (float value : map.values) {
    const float place = (value > 0 ? std::min(value, 1.0f) : 0.0f) * (kMagma.size() - 1);
    const size_t below = std::min(size_t(place), kMagma.size() - 2);
    const float t = place - float(below);
    const Colour a = kMagma[below], b = kMagma[below + 1];
    picture.values.insert(picture.values.end(), {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)});
  }
  return picture;
}

}  // namespace froth
