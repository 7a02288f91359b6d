// The reference renderer against a second one, written from the formulas of the definition in the plainest
// way: world coordinates, all pairs of cells, products of transmittances, none of the code of shaders/foam/.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "reference/image/metrics.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

using Vec = glm::dvec3;

struct Pixel {
  Vec colour{0}, normal{0};
  double transmittance = 1, distance = -1;
};

class Textbook {
 public:
  Textbook(const Foam& foam, const Vec& eye) : foam_(foam), eye_(eye), order_(foam.cellCount) {
    for (uint32_t i = 0; i < foam.cellCount; ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) { return power(a) < power(b); });
  }

  Pixel trace(const Vec& d) const {
    Pixel pixel;
    for (uint32_t i : order_) addCell(i, d, pixel);
    return pixel;
  }

 private:
  Vec site(uint32_t i) const { return foam_.sites[i]; }
  double radius(uint32_t i) const { return foam_.radii[i]; }
  double power(uint32_t i) const { return glm::dot(eye_ - site(i), eye_ - site(i)) - radius(i) * radius(i); }

  void addCell(uint32_t i, const Vec& d, Pixel& pixel) const {
    const double b = glm::dot(d, site(i) - eye_), square = b * b - power(i);
    if (square <= 0) return;
    double tNear = std::max(b - std::sqrt(square), 0.0), tFar = b + std::sqrt(square);
    for (uint32_t j = 0; j < foam_.cellCount; ++j) {
      if (j == i) continue;
      const Vec across = site(j) - site(i);
      const double offset = 0.5 * (glm::dot(site(j), site(j)) - glm::dot(site(i), site(i)) + radius(i) * radius(i) -
                                   radius(j) * radius(j));
      const double q = glm::dot(across, d), tFace = (offset - glm::dot(across, eye_)) / q;
      (q >= 0 ? tFar : tNear) = q >= 0 ? std::min(tFar, tFace) : std::max(tNear, tFace);
    }
    if (tNear >= tFar) return;

    const FaceFrame<double> frame = faceFrame<double>(foam_.orientations[i]);
    const double w = glm::dot(frame.normal, d), base = glm::dot(frame.normal, site(i) - eye_);
    const double height = blend(i, frame, eye_ + (w >= 0 ? tNear : std::max(tNear, base / w)) * d, [&](size_t s) {
                            return Vec(radius(i) * double(foam_.detailHeights[s]));
                          }).x;
    (w >= 0 ? tFar : tNear) = w >= 0 ? std::min(tFar, (base + height) / w) : std::max(tNear, (base + height) / w);
    if (tNear >= tFar) return;

    const Vec colour = blend(i, frame, eye_ + tNear * d, [&](size_t s) { return detailColour(i, s, frame); });
    const double sigma = foam_.densities[i], after = pixel.transmittance * std::exp(-sigma * (tFar - tNear));
    if (pixel.transmittance >= 0.5 && after < 0.5) pixel.distance = tNear + std::log(pixel.transmittance / 0.5) / sigma;
    pixel.colour += (pixel.transmittance - after) * colour;
    pixel.normal += (pixel.transmittance - after) * frame.normal;
    pixel.transmittance = after;
  }

  Vec detailSite(uint32_t i, size_t s, const FaceFrame<double>& frame) const {
    return site(i) + radius(i) * (double(foam_.detailSites[s].x) * frame.tangent +
                                  double(foam_.detailSites[s].y) * frame.bitangent);
  }

  template <class Value>
  Vec blend(uint32_t i, const FaceFrame<double>& frame, const Vec& x, Value value) const {
    Vec sum(0);
    double weights = 0;
    for (size_t s = size_t{i} * foam_.detailCount; s < size_t{i + 1} * foam_.detailCount; ++s) {
      const Vec apart = x - detailSite(i, s, frame);
      const double weight = std::exp(-10 * glm::dot(apart, apart) / (radius(i) * radius(i)));
      sum += weight * value(s);
      weights += weight;
    }
    return sum / std::max(weights, 1e-20);
  }

  Vec detailColour(uint32_t i, size_t s, const FaceFrame<double>& frame) const {
    const Vec seen = glm::normalize(detailSite(i, s, frame) - eye_);
    Vec sum(0);
    double weights = 0;
    for (size_t l = s * foam_.lobeCount; l < (s + 1) * foam_.lobeCount; ++l) {
      const Vec axis = foam_.lobeAxes[l];
      const double weight = std::exp(-glm::length(axis) * glm::length(seen - glm::normalize(axis)));
      sum += weight * Vec(foam_.lobeColours[l]);
      weights += weight;
    }
    return glm::max(0.5 + sum / weights, Vec(0));
  }

  const Foam& foam_;
  const Vec eye_;
  std::vector<uint32_t> order_;
};

// The shaders expand |x - s|^2 and take the frame for orthonormal, which a quaternion rounded to float is to
// some 1e-7; the exponent multiplies that by 10 and more.
constexpr double kTolerance = 1e-5;

struct Eye {
  Vec position;
  uint64_t seed;
};
void PrintTo(const Eye& eye, std::ostream* stream) { *stream << "foam " << eye.seed; }
class AgainstTheTextbook : public ::testing::TestWithParam<Eye> {};

TEST_P(AgainstTheTextbook, EveryPixelOfARandomFoamAgrees) {
  const auto [eye, seed] = GetParam();
  const Foam foam = randomFoam(90, 3, 2, seed);
  const View view = lookAt(eye, {0.1, 0, 0}, 48, 40, 0.6);
  const RenderedImages images = renderFoam(foam, view);
  const Textbook textbook(foam, eye);
  int found = 0;
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const Pixel expected = textbook.trace(directionOf(view, x, y));
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(images.colour.pixel(x, y)[c], expected.colour[c], kTolerance) << x << ", " << y;
        ASSERT_NEAR(images.normal.pixel(x, y)[c], expected.normal[c], kTolerance) << x << ", " << y;
      }
      ASSERT_NEAR(*images.alpha.pixel(x, y), 1 - expected.transmittance, kTolerance) << x << ", " << y;
      ASSERT_NEAR(*images.distance.pixel(x, y), expected.distance, kTolerance) << x << ", " << y;
      found += expected.distance > 0;
    }
  }
  EXPECT_GT(found, 500);
}

// From outside, from among the cells (some of which hold the eye), and from far away.
INSTANTIATE_TEST_SUITE_P(Eyes, AgainstTheTextbook,
                         ::testing::Values(Eye{{0.3, -0.4, -3}, 1}, Eye{{2.5, 1, 0.2}, 2}, Eye{{-0.3, 0.2, 0.1}, 3}));

TEST(FloatAgainstDouble, DiffersByLittleOnARandomFoam) {
  const Foam foam = randomFoam(400, 4, 4, 5);
  const View view = lookAt({0.3, -0.4, -3}, {0, 0, 0}, 96, 96, 0.6);
  const RenderedImages exact = renderFoam(foam, view),
                       rounded = renderFoam(foam, view, plainOptions(Precision::kFloat));
  const ImageDifference colour = *compareImages(exact.colour, rounded.colour),
                        alpha = *compareImages(exact.alpha, rounded.alpha);
  EXPECT_GT(colour.psnr, 100);
  EXPECT_GT(alpha.psnr, 100);
  EXPECT_LT(colour.psnr, 200) << "float seems to be computed in double";
}

}  // namespace
}  // namespace froth
