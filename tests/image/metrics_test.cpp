#include "reference/image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/image/mean_square.h"

namespace froth {
namespace {

Image flat(uint32_t width, uint32_t height, std::vector<float> colour) {
  Image image{width, height, uint32_t(colour.size()), {}};
  for (size_t p = 0; p < size_t{width} * height; ++p) {
    image.values.insert(image.values.end(), colour.begin(), colour.end());
  }
  return image;
}

TEST(Metrics, EqualImagesDifferByNothing) {
  const Image image = flat(12, 11, {0.25f, 0.5f, 1.5f});
  const ImageDifference d = *compareImages(image, image);
  EXPECT_EQ(d.psnr, std::numeric_limits<double>::infinity());
  EXPECT_EQ(d.psnrChannelMean, std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(d.ssim, 1);
  EXPECT_EQ(d.maxError, 0);
  EXPECT_EQ(d.overOneStep, 0);
}

TEST(Metrics, PsnrIsTakenOverPixelsAndChannelsOrAveragedOverChannels) {
  const Image a = flat(4, 4, {0.5f, 0.5f, 0.5f});
  const Image b = flat(4, 4, {0.6f, 0.51f, 0.501f});
  const ImageDifference d = *compareImages(a, b);
  EXPECT_NEAR(d.psnr, -10 * std::log10((1e-2 + 1e-4 + 1e-6) / 3), 1e-4);
  EXPECT_NEAR(decibels(meanSquare(a, b)), d.psnr, 1e-12);
  EXPECT_NEAR(d.psnrChannelMean, (20.0 + 40.0 + 60.0) / 3, 1e-4);
  EXPECT_NEAR(d.maxError, 0.1, 1e-7);
  EXPECT_TRUE(std::isnan(d.ssim));  // smaller than SSIM's window
}

TEST(Metrics, PsnrClampsAndTheMaximumDoesNot) {
  const Image a = flat(3, 3, {1.0f}), b = flat(3, 3, {1.5f});
  EXPECT_EQ(compareImages(a, b)->psnr, std::numeric_limits<double>::infinity());
  EXPECT_EQ(meanSquare(a, b), 0);
  EXPECT_EQ(compareImages(a, b)->maxError, 0.5);
  EXPECT_EQ(compareImages(a, b)->overTwoSteps, 1);
}

TEST(Metrics, ExactlyOneStepOfEightBitsIsNotMoreThanOneStep) {
  for (int k = 1; k < 256; ++k) {
    const Image a = flat(1, 1, {float(k - 1) / 255.0f}), b = flat(1, 1, {float(k) / 255.0f});
    EXPECT_EQ(compareImages(a, b)->overOneStep, 0) << k;
  }
  Image a = flat(4, 1, {0, 0, 0}), b = a;
  b.values[4] = 2.0f / 255;
  b.values[9] = 3.0f / 255;
  EXPECT_EQ(compareImages(a, b)->overOneStep, 0.5);
  EXPECT_EQ(compareImages(a, b)->overTwoSteps, 0.25);
}

TEST(Metrics, ANotANumberIsNeverAGoodScore) {
  Image a = flat(12, 12, {0.5f}), b = a;
  b.values[17] = std::nanf("");
  const ImageDifference d = *compareImages(a, b);
  EXPECT_FALSE(d.psnr > 0);
  EXPECT_EQ(d.maxError, std::numeric_limits<double>::infinity());
  EXPECT_EQ(d.overTwoSteps, 1.0 / 144);
}

TEST(Metrics, TheMeanErrorIsOfAllChannelsAndTheWorstPixelIsTheFirstOfTheLargest) {
  Image a = flat(4, 3, {0.5f, 0.5f, 0.5f}), b = a;
  b.pixel(1, 2)[2] = 1.0f;
  b.pixel(3, 2)[0] = 0.0f;
  b.pixel(0, 0)[1] = 0.25f;
  const ImageDifference d = *compareImages(a, b);
  EXPECT_NEAR(d.meanError, (0.5 + 0.5 + 0.25) / 36, 1e-12);
  EXPECT_EQ(d.worstX, 1u);
  EXPECT_EQ(d.worstY, 2u);
}

TEST(Metrics, ANotANumberIsTheWorstPixel) {
  Image a = flat(4, 3, {0.5f}), b = a;
  *b.pixel(0, 0) = 100;
  *b.pixel(2, 1) = std::nanf("");
  const ImageDifference d = *compareImages(a, b);
  EXPECT_EQ(d.meanError, std::numeric_limits<double>::infinity());
  EXPECT_EQ(d.worstX, 2u);
  EXPECT_EQ(d.worstY, 1u);
}

// With one window only, SSIM has a closed form: a flat image against a flat one has no variance.
TEST(Metrics, SsimOfFlatImagesIsTheLuminanceTerm) {
  const Image a = flat(11, 11, {0.25f}), b = flat(11, 11, {0.75f});
  EXPECT_NEAR(compareImages(a, b)->ssim, (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4), 1e-12);
}

// The windowed sums written out directly, without separating rows from columns.
TEST(Metrics, SsimIsThatOfTheDirectSum) {
  Image a{13, 12, 1, {}}, b = a;
  for (int i = 0; i < 13 * 12; ++i) {
    a.values.push_back(float(i * 37 % 101) / 101);
    b.values.push_back(float(i * 53 % 97) / 97);
  }
  double total = 0;
  for (int oy = 0; oy < 2; ++oy) {
    for (int ox = 0; ox < 3; ++ox) {
      double w = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
      for (int y = 0; y < 11; ++y) {
        for (int x = 0; x < 11; ++x) {
          const double g = std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / (2 * 1.5 * 1.5));
          const double va = *a.pixel(ox + x, oy + y), vb = *b.pixel(ox + x, oy + y);
          w += g, ma += g * va, mb += g * vb, aa += g * va * va, bb += g * vb * vb, ab += g * va * vb;
        }
      }
      ma /= w, mb /= w, aa /= w, bb /= w, ab /= w;
      total += (2 * ma * mb + 1e-4) * (2 * (ab - ma * mb) + 9e-4) /
               ((ma * ma + mb * mb + 1e-4) * (aa - ma * ma + bb - mb * mb + 9e-4));
    }
  }
  EXPECT_NEAR(compareImages(a, b)->ssim, total / 6, 1e-12);
}

TEST(Metrics, ImagesOfDifferentShapeAreNotCompared) {
  EXPECT_FALSE(compareImages(flat(3, 2, {0}), flat(2, 3, {0})));
  EXPECT_FALSE(compareImages(flat(3, 2, {0}), flat(3, 2, {0, 0, 0})));
  EXPECT_FALSE(compareImages(Image{}, Image{}));
}

}  // namespace
}  // namespace froth
