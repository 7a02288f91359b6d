#include "reference/image/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/image/mean_square.h"

namespace froth {
namespace {

constexpr int kWindow = 11;  // SSIM (Wang et al. 2004): Gaussian window, sigma, and the two stabilizers for peak 1
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

// Images of 8 bits that differ by one step differ by 1/255 up to float rounding; that is not "more than a
// step".
constexpr double kStep = 1.0 / 255 + 1e-6;

double clampUnit(float value) { return std::clamp(double(value), 0.0, 1.0); }

std::array<double, kWindow> gaussianWindow() {
  std::array<double, kWindow> window;
  double sum = 0;
  for (int i = 0; i < kWindow; ++i) {
    const double offset = i - kWindow / 2;
    window[i] = std::exp(-offset * offset / (2 * kSigma * kSigma));
    sum += window[i];
  }
  for (double& weight : window) weight /= sum;
  return window;
}

struct Moments {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;

  void add(double weight, const Moments& other) {
    a += weight * other.a;
    b += weight * other.b;
    aa += weight * other.aa;
    bb += weight * other.bb;
    ab += weight * other.ab;
  }
};

double similarity(const Moments& m) {
  const double varianceA = m.aa - m.a * m.a, varianceB = m.bb - m.b * m.b, covariance = m.ab - m.a * m.b;
  return (2 * m.a * m.b + kC1) * (2 * covariance + kC2) /
         ((m.a * m.a + m.b * m.b + kC1) * (varianceA + varianceB + kC2));
}

// Mean over the windows that lie wholly inside the image. The window is separable: rows first, then columns.
double channelSimilarity(const Image& a, const Image& b, uint32_t channel) {
  const std::array<double, kWindow> window = gaussianWindow();
  const uint32_t columns = a.width - kWindow + 1, rows = a.height - kWindow + 1;
  std::vector<Moments> line(a.width), filtered(size_t{columns} * a.height);
  for (uint32_t y = 0; y < a.height; ++y) {
    for (uint32_t x = 0; x < a.width; ++x) {
      const double va = clampUnit(a.pixel(x, y)[channel]), vb = clampUnit(b.pixel(x, y)[channel]);
      line[x] = {va, vb, va * va, vb * vb, va * vb};
    }
    for (uint32_t x = 0; x < columns; ++x) {
      for (int i = 0; i < kWindow; ++i) filtered[size_t{y} * columns + x].add(window[i], line[x + i]);
    }
  }
  double sum = 0;
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < columns; ++x) {
      Moments moments;
      for (int i = 0; i < kWindow; ++i) moments.add(window[i], filtered[size_t{y + i} * columns + x]);
      sum += similarity(moments);
    }
  }
  return sum / (double(rows) * columns);
}

double meanSimilarity(const Image& a, const Image& b) {
  if (a.width < kWindow || a.height < kWindow) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (uint32_t c = 0; c < a.channels; ++c) sum += channelSimilarity(a, b, c);
  return sum / a.channels;
}

}  // namespace

Result<ImageDifference> compareImages(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) {
    return makeError(ErrorKind::kBadInput,
                     "cannot compare an image of %u x %u pixels and %u channels with one of %u x %u and %u; "
                     "render both at one size",
                     a.width, a.height, a.channels, b.width, b.height, b.channels);
  }
  const size_t pixels = size_t{a.width} * a.height;
  if (pixels == 0) return makeError(ErrorKind::kBadInput, "cannot compare images without pixels");

  ImageDifference difference;
  std::vector<double> squares(a.channels, 0.0);
  size_t overOne = 0, overTwo = 0;
  double absolute = 0;
  for (size_t p = 0; p < pixels; ++p) {
    double worst = 0;
    for (uint32_t c = 0; c < a.channels; ++c) {
      const float va = a.values[p * a.channels + c], vb = b.values[p * a.channels + c];
      const double clamped = clampUnit(va) - clampUnit(vb);
      squares[c] += clamped * clamped;
      const double exact = std::abs(double(va) - vb);
      const double error = std::isnan(exact) ? std::numeric_limits<double>::infinity() : exact;
      worst = std::max(worst, error);
      absolute += error;
    }
    if (worst > difference.maxError) {
      difference.maxError = worst;
      difference.worstX = uint32_t(p % a.width);
      difference.worstY = uint32_t(p / a.width);
    }
    overOne += worst > kStep;
    overTwo += worst > 2 * kStep;
  }
  double meanSquare = 0;
  for (double sum : squares) {
    meanSquare += sum / double(pixels) / a.channels;
    difference.psnrChannelMean += decibels(sum / double(pixels)) / a.channels;
  }
  difference.psnr = decibels(meanSquare);
  difference.meanError = absolute / (double(pixels) * a.channels);
  difference.ssim = meanSimilarity(a, b);
  difference.overOneStep = double(overOne) / double(pixels);
  difference.overTwoSteps = double(overTwo) / double(pixels);
  return difference;
}

}  // namespace froth
