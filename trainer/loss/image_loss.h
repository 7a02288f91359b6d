// The loss of a rendering against its photo, on the CPU:
//
//   L = 1/N sum over pixels of  sum over channels E[(rgb' - gt')^2]  +  weight (1 - SSIM(rgb', gt'))
//
// N is the number of pixels of the photo, also where a mask ignores some: each photographed pixel then counts the same
// in every view. E[] is the mean over random backgrounds (pixel_loss.h).
//
// SSIM is of each channel, with windows that are normalised over the pixels that count: beyond the border and under a
// mask nothing does. Padding with zeros would put the same black border into both images, and hide what differs there.
// Ignored pixels have no window of their own, and so no influence at all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

struct LossTarget {
  uint32_t width = 0, height = 0;
  const uint8_t* rgba = nullptr;     // [height * width * 4] premultiplied
  const uint8_t* counted = nullptr;  // [height * width] 0: ignored; null: all count
};

struct LossValue {
  double squares = 0;        // the first term
  double dissimilarity = 0;  // mean of 1 - SSIM over pixels and channels, without its weight
};

// Keeps its buffers between calls: some 60 bytes per pixel in float. One thread calls; TBB's threads work. Sums have a
// fixed order, so that the same images give the same bits on any number of threads. Real: float or double.
template <class Real>
class ImageLoss {
 public:
  // rendered: [pixels] colour over black, transmittance. Writes dL/d(rendered) for each pixel, 0 where it is ignored.
  LossValue evaluate(const LossTarget& target, std::span<const glm::vec<4, Real>> rendered, double similarityWeight,
                     std::span<glm::vec<4, Real>> gradients);

 private:
  // Planes of one value per pixel.
  struct Plane {
    std::vector<Real> values;
    const Real* row(const LossTarget& target, uint32_t y) const { return &values[size_t{y} * target.width]; }
    Real* row(const LossTarget& target, uint32_t y) { return &values[size_t{y} * target.width]; }
  };
  static constexpr int kMoments = 6;  // 1, x, y, x^2, y^2, x y
  static constexpr int kFields = 3;   // derivatives by the means of x, x^2, x y

  double addSquares(const LossTarget& target, std::span<const glm::vec<4, Real>> rendered,
                    std::span<glm::vec<4, Real>> gradients);
  void blurMoments(const LossTarget& target, std::span<const glm::vec<4, Real>> rendered, int channel);
  double compareWindows(const LossTarget& target);
  void spreadGradients(const LossTarget& target, Real scale, int channel, std::span<glm::vec<4, Real>> gradients);

  Plane rendered_, wanted_;  // over grey
  Plane moments_[kMoments];  // blurred along rows
  Plane fields_[kFields], blurred_[kFields];
  std::vector<double> rowSums_;
};

}  // namespace froth
