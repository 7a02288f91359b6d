#include "trainer/loss/image_loss.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "trainer/loss/pixel_loss.h"

namespace froth {
namespace {

bool counts(const LossTarget& target, size_t pixel) { return !target.counted || target.counted[pixel]; }

template <class Real>
Real photoValue(const LossTarget& target, size_t pixel, int channel) {
  return Real(target.rgba[4 * pixel + channel]) / 255;
}

// What the photo does not know: 1 - alpha.
template <class Real>
Real photoGap(const LossTarget& target, size_t pixel) {
  return Real(255 - target.rgba[4 * pixel + 3]) / 255;
}

template <class Work>
void forRows(const LossTarget& target, const Work& work) {
  tbb::parallel_for(uint32_t{0}, target.height, work);
}

double sumOf(const std::vector<double>& rows) {
  double sum = 0;
  for (const double row : rows) sum += row;
  return sum;
}

// out[i] += weight in[i + offset] where both lie in a row of `count`.
template <class Real>
void addShifted(const Real* in, Real* out, uint32_t count, int offset, Real weight) {
  const int first = std::max(0, -offset), end = static_cast<int>(count) - std::max(0, offset);
  for (int i = first; i < end; ++i) out[i] += weight * in[i + offset];
}

// One row of the window's sums along rows, and one of its sums along columns.
template <class Real>
void blurAlongRow(const Real* in, Real* out, uint32_t count) {
  std::fill_n(out, count, Real(0));
  for (int offset = -foam::kSimilarityRadius; offset <= foam::kSimilarityRadius; ++offset) {
    addShifted(in, out, count, offset, foam::similarityWeight(offset, Real()));
  }
}

template <class Real>
void blurAcrossRows(const std::vector<Real>& in, Real* out, uint32_t y, const LossTarget& target) {
  std::fill_n(out, target.width, Real(0));
  const int first = std::max(0, static_cast<int>(y) - foam::kSimilarityRadius);
  const int end = std::min(static_cast<int>(target.height), static_cast<int>(y) + foam::kSimilarityRadius + 1);
  for (int row = first; row < end; ++row) {
    const Real weight = foam::similarityWeight(row - static_cast<int>(y), Real());
    addShifted(&in[size_t(row) * target.width], out, target.width, 0, weight);
  }
}

}  // namespace

template <class Real>
double ImageLoss<Real>::addSquares(const LossTarget& target, std::span<const glm::vec<4, Real>> rendered,
                                   std::span<glm::vec<4, Real>> gradients) {
  const Real perPixel = Real(1) / Real(rendered.size());
  forRows(target, [&](uint32_t y) {
    double sum = 0;
    for (size_t pixel = size_t{y} * target.width; pixel < size_t{y + 1} * target.width; ++pixel) {
      gradients[pixel] = glm::vec<4, Real>(0);
      if (!counts(target, pixel)) continue;
      const Real gap = rendered[pixel].w - photoGap<Real>(target, pixel);
      for (int channel = 0; channel < 3; ++channel) {
        const Real error = rendered[pixel][channel] - photoValue<Real>(target, pixel, channel);
        Real byColour, byTransmittance;
        sum += double(foam::squareOverBackgrounds(error, gap, byColour, byTransmittance));
        gradients[pixel][channel] = perPixel * byColour;
        gradients[pixel].w += perPixel * byTransmittance;
      }
    }
    rowSums_[y] = sum;
  });
  return sumOf(rowSums_);
}

template <class Real>
void ImageLoss<Real>::blurMoments(const LossTarget& target, std::span<const glm::vec<4, Real>> rendered, int channel) {
  forRows(target, [&](uint32_t y) {
    const size_t first = size_t{y} * target.width;
    std::vector<Real> products[kMoments];
    for (std::vector<Real>& product : products) product.assign(target.width, Real(0));
    Real *xs = rendered_.row(target, y), *ys = wanted_.row(target, y);
    for (uint32_t i = 0; i < target.width; ++i) {
      const Real x = xs[i] = foam::overGrey(rendered[first + i][channel], rendered[first + i].w);
      const Real v = ys[i] =
          foam::overGrey(photoValue<Real>(target, first + i, channel), photoGap<Real>(target, first + i));
      if (!counts(target, first + i)) continue;
      const Real values[kMoments] = {1, x, v, x * x, v * v, x * v};
      for (int k = 0; k < kMoments; ++k) products[k][i] = values[k];
    }
    for (int k = 0; k < kMoments; ++k) blurAlongRow(products[k].data(), moments_[k].row(target, y), target.width);
  });
}

template <class Real>
double ImageLoss<Real>::compareWindows(const LossTarget& target) {
  forRows(target, [&](uint32_t y) {
    std::vector<Real> moments[kMoments];
    for (int k = 0; k < kMoments; ++k) {
      moments[k].resize(target.width);
      blurAcrossRows(moments_[k].values, moments[k].data(), y, target);
    }
    double sum = 0;
    for (uint32_t i = 0; i < target.width; ++i) {
      glm::vec<3, Real> gradient(0);
      const Real total = moments[0][i];  // > 0: the pixel itself counts
      if (counts(target, size_t{y} * target.width + i)) {
        const Real value = foam::similarity(moments[1][i] / total, moments[2][i] / total, moments[3][i] / total,
                                            moments[4][i] / total, moments[5][i] / total, gradient);
        sum += 1 - double(value);
        gradient /= total;
      }
      for (int k = 0; k < kFields; ++k) fields_[k].row(target, y)[i] = gradient[k];
    }
    rowSums_[y] = sum;
  });
  return sumOf(rowSums_);
}

// A pixel belongs to the windows around it: what they say of their means goes back by the same weights.
template <class Real>
void ImageLoss<Real>::spreadGradients(const LossTarget& target, Real scale, int channel,
                                      std::span<glm::vec<4, Real>> gradients) {
  forRows(target, [&](uint32_t y) {
    for (int k = 0; k < kFields; ++k) {
      blurAlongRow(fields_[k].row(target, y), blurred_[k].row(target, y), target.width);
    }
  });
  forRows(target, [&](uint32_t y) {
    std::vector<Real> fields[kFields];
    for (int k = 0; k < kFields; ++k) {
      fields[k].resize(target.width);
      blurAcrossRows(blurred_[k].values, fields[k].data(), y, target);
    }
    const Real *xs = rendered_.row(target, y), *ys = wanted_.row(target, y);
    for (uint32_t i = 0; i < target.width; ++i) {
      const size_t pixel = size_t{y} * target.width + i;
      if (!counts(target, pixel)) continue;
      const Real gradient = scale * (fields[0][i] + 2 * xs[i] * fields[1][i] + ys[i] * fields[2][i]);
      gradients[pixel][channel] += gradient;
      gradients[pixel].w += Real(0.5) * gradient;
    }
  });
}

template <class Real>
LossValue ImageLoss<Real>::evaluate(const LossTarget& target, std::span<const glm::vec<4, Real>> rendered,
                                    double similarityWeight, std::span<glm::vec<4, Real>> gradients) {
  const size_t pixels = rendered.size();
  rowSums_.resize(target.height);
  LossValue value;
  value.squares = addSquares(target, rendered, gradients) / double(pixels);
  if (similarityWeight == 0) return value;
  for (Plane* plane : {&rendered_, &wanted_}) plane->values.resize(pixels);
  for (Plane& plane : moments_) plane.values.resize(pixels);
  for (Plane& plane : fields_) plane.values.resize(pixels);
  for (Plane& plane : blurred_) plane.values.resize(pixels);
  const Real scale = Real(-similarityWeight / (3 * double(pixels)));
  for (int channel = 0; channel < 3; ++channel) {
    blurMoments(target, rendered, channel);
    value.dissimilarity += compareWindows(target) / (3 * double(pixels));
    spreadGradients(target, scale, channel, gradients);
  }
  return value;
}

template class ImageLoss<float>;
template class ImageLoss<double>;

}  // namespace froth
