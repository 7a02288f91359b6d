// The image loss: its values against formulas written down again, its gradients against differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include <tbb/global_control.h>

#include "base/counter_random.h"
#include "reference/image/metrics.h"
#include "trainer/loss/image_loss.h"

namespace froth {
namespace {

using Pixels = std::vector<glm::dvec4>;

// A photo and a rendering near it; transparent and ignored pixels where they are asked for.
struct Sample {
  uint32_t width, height;
  std::vector<uint8_t> rgba, counted;
  Pixels rendered;

  Sample(uint32_t w, uint32_t h, bool hasAlpha, bool hasMask) : width(w), height(h) {
    const CounterRandom random(5, Purpose::kColour);
    const size_t pixels = size_t{w} * h;
    for (size_t i = 0; i < pixels; ++i) {
      const double alpha = hasAlpha ? random.uniform(9 * i) : 1;
      glm::dvec4 pixel(0, 0, 0, std::clamp(1 - alpha + 0.2 * random.uniform(9 * i + 1), 0.0, 1.0));
      for (int c = 0; c < 3; ++c) {
        const double wave = 0.5 + 0.4 * std::sin(0.7 * double(i % w) + 0.3 * double(i / w) * (c + 1));
        rgba.push_back(uint8_t(255 * alpha * wave));
        pixel[c] = (1 - pixel.w) * std::clamp(wave + 0.3 * (random.uniform(9 * i + 2 + c) - 0.5), 0.0, 1.0);
      }
      rgba.push_back(uint8_t(255 * alpha));
      rendered.push_back(pixel);
      if (hasMask) counted.push_back(random.uniform(9 * i + 8) < 0.7);
    }
  }

  LossTarget target() const { return {width, height, rgba.data(), counted.empty() ? nullptr : counted.data()}; }
  bool counts(size_t i) const { return counted.empty() || counted[i]; }
};

double lossOf(const Sample& sample, const Pixels& rendered, double weight, Pixels* gradients = nullptr) {
  ImageLoss<double> loss;
  Pixels unused(rendered.size());
  const LossValue value =
      loss.evaluate(sample.target(), rendered, weight, gradients ? std::span(*gradients) : std::span(unused));
  return value.squares + weight * value.dissimilarity;
}

// SSIM of one window as its authors write it, in two passes over the pixels that count.
double windowSimilarity(const Sample& sample, uint32_t column, uint32_t row, int channel) {
  double total = 0, meanX = 0, meanY = 0, varianceX = 0, varianceY = 0, covariance = 0;
  const auto visit = [&](const std::function<void(double, double, double)>& use) {
    for (int dy = -5; dy <= 5; ++dy) {
      for (int dx = -5; dx <= 5; ++dx) {
        const int x = int(column) + dx, y = int(row) + dy;
        if (x < 0 || y < 0 || x >= int(sample.width) || y >= int(sample.height)) continue;
        const size_t i = size_t(y) * sample.width + size_t(x);
        if (!sample.counts(i)) continue;
        const double weight = std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5));
        const double photo = (sample.rgba[4 * i + channel] + 0.5 * (255 - sample.rgba[4 * i + 3])) / 255;
        use(weight, sample.rendered[i][channel] + 0.5 * sample.rendered[i].w, photo);
      }
    }
  };
  visit([&](double w, double x, double y) {
    total += w;
    meanX += w * x;
    meanY += w * y;
  });
  meanX /= total;
  meanY /= total;
  visit([&](double w, double x, double y) {
    varianceX += w / total * (x - meanX) * (x - meanX);
    varianceY += w / total * (y - meanY) * (y - meanY);
    covariance += w / total * (x - meanX) * (y - meanY);
  });
  return (2 * meanX * meanY + 1e-4) * (2 * covariance + 9e-4) /
         ((meanX * meanX + meanY * meanY + 1e-4) * (varianceX + varianceY + 9e-4));
}

TEST(ImageLoss, SquaresAreTheMeanOverRandomBackgrounds) {
  const Sample sample(4, 3, true, false);
  const CounterRandom random(1, Purpose::kFrame);
  constexpr int kDraws = 200000;
  double sum = 0;
  uint64_t draw = 0;
  for (size_t i = 0; i < sample.rendered.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < kDraws; ++k) {
        const double background = random.uniform(draw++);
        const double rendered = sample.rendered[i][c] + sample.rendered[i].w * background;
        const double photo = (sample.rgba[4 * i + c] + (255 - sample.rgba[4 * i + 3]) * background) / 255;
        sum += (rendered - photo) * (rendered - photo);
      }
    }
  }
  const double mean = sum / kDraws / double(sample.rendered.size());
  EXPECT_NEAR(lossOf(sample, sample.rendered, 0), mean, 0.003 * mean);  // of 2.4 million draws the mean is off by 1e-3
}

TEST(ImageLoss, DissimilarityIsThatOfItsAuthors) {
  for (const bool hasMask : {false, true}) {
    const Sample sample(17, 13, true, hasMask);
    double sum = 0;
    for (uint32_t y = 0; y < sample.height; ++y) {
      for (uint32_t x = 0; x < sample.width; ++x) {
        if (!sample.counts(size_t{y} * sample.width + x)) continue;
        for (int c = 0; c < 3; ++c) sum += 1 - windowSimilarity(sample, x, y, c);
      }
    }
    ImageLoss<double> loss;
    Pixels gradients(sample.rendered.size());
    const LossValue value = loss.evaluate(sample.target(), sample.rendered, 0.2, gradients);
    EXPECT_NEAR(value.dissimilarity, sum / (3.0 * sample.width * sample.height), 1e-12);
  }
}

TEST(ImageLoss, WholeWindowsAgreeWithTheMetric) {
  const Sample sample(30, 24, false, false);
  Image rendered{30, 24, 3, {}}, photo{30, 24, 3, {}};
  for (size_t i = 0; i < sample.rendered.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      rendered.values.push_back(float(sample.rendered[i][c] + 0.5 * sample.rendered[i].w));
      photo.values.push_back(float(sample.rgba[4 * i + c]) / 255);
    }
  }
  double sum = 0;
  for (uint32_t y = 5; y + 5 < 24; ++y) {
    for (uint32_t x = 5; x + 5 < 30; ++x) {
      for (int c = 0; c < 3; ++c) sum += windowSimilarity(sample, x, y, c);
    }
  }
  const Result<ImageDifference> difference = compareImages(rendered, photo);
  ASSERT_TRUE(difference);
  EXPECT_NEAR(sum / (3.0 * 20 * 14), difference->ssim, 1e-6);
}

TEST(ImageLoss, GradientsAreThoseOfDifferences) {
  constexpr double kStep = 1e-5;
  for (const bool hasMask : {false, true}) {
    const Sample sample(16, 14, true, hasMask);
    for (const double weight : {0.0, 0.2, 5.0}) {
      Pixels gradients(sample.rendered.size());
      lossOf(sample, sample.rendered, weight, &gradients);
      for (size_t i = 0; i < sample.rendered.size(); ++i) {
        for (int c = 0; c < 4; ++c) {
          Pixels moved = sample.rendered;
          moved[i][c] += kStep;
          const double above = lossOf(sample, moved, weight);
          moved[i][c] -= 2 * kStep;
          const double difference = (above - lossOf(sample, moved, weight)) / (2 * kStep);
          // Of a loss near 1 differences lose 2^-53 / kStep, and have an error of kStep^2 times third derivatives.
          ASSERT_NEAR(gradients[i][c], difference, 1e-9 + 1e-6 * std::abs(difference))
              << i << ' ' << c << ' ' << weight;
        }
      }
    }
  }
}

// The published loss took rows for channels, and so compared nothing vertical.
TEST(ImageLoss, RowsAndColumnsCountAlike) {
  const Sample sample(19, 15, true, true);
  Sample turned(15, 19, true, true);
  for (size_t y = 0; y < 15; ++y) {
    for (size_t x = 0; x < 19; ++x) {
      turned.rendered[x * 15 + y] = sample.rendered[y * 19 + x];
      turned.counted[x * 15 + y] = sample.counted[y * 19 + x];
      std::copy_n(&sample.rgba[4 * (y * 19 + x)], 4, &turned.rgba[4 * (x * 15 + y)]);
    }
  }
  EXPECT_NEAR(lossOf(sample, sample.rendered, 1), lossOf(turned, turned.rendered, 1), 1e-13);

  Sample permuted = sample;
  for (size_t i = 0; i < sample.rendered.size(); ++i) {
    permuted.rendered[i] = {sample.rendered[i].z, sample.rendered[i].x, sample.rendered[i].y, sample.rendered[i].w};
    for (int c = 0; c < 3; ++c) permuted.rgba[4 * i + c] = sample.rgba[4 * i + (c + 2) % 3];
  }
  EXPECT_NEAR(lossOf(sample, sample.rendered, 1), lossOf(permuted, permuted.rendered, 1), 1e-13);
}

TEST(ImageLoss, IgnoredPixelsHaveNoInfluence) {
  const Sample sample(20, 16, true, true);
  Pixels gradients(sample.rendered.size()), others(sample.rendered.size());
  const double loss = lossOf(sample, sample.rendered, 0.2, &gradients);
  Sample changed = sample;
  for (size_t i = 0; i < sample.rendered.size(); ++i) {
    if (sample.counts(i)) continue;
    EXPECT_EQ(gradients[i], glm::dvec4(0));
    changed.rendered[i] = glm::dvec4(7, -3, 0.5, 2);
    std::fill_n(&changed.rgba[4 * i], 4, uint8_t(99));
  }
  EXPECT_EQ(lossOf(changed, changed.rendered, 0.2, &others), loss);
  EXPECT_EQ(others, gradients);
}

TEST(ImageLoss, FloatsAreCloseAndTheSameOnAnyNumberOfThreads) {
  const Sample sample(70, 50, true, true);
  std::vector<glm::vec4> rendered(sample.rendered.begin(), sample.rendered.end());
  std::vector<glm::vec4> one(rendered.size()), many(rendered.size());
  Pixels exact(rendered.size());
  ImageLoss<float> loss;
  LossValue first;
  {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1);
    first = loss.evaluate(sample.target(), rendered, 0.2, one);
  }
  const LossValue second = loss.evaluate(sample.target(), rendered, 0.2, many);
  EXPECT_EQ(first.dissimilarity, second.dissimilarity);
  EXPECT_EQ(first.squares, second.squares);
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof one[0]), 0);
  const double value = lossOf(sample, sample.rendered, 0.2, &exact);
  EXPECT_NEAR(first.squares + 0.2 * first.dissimilarity, value, 1e-5 * value);
  double most = 0, worst = 0;
  for (size_t i = 0; i < exact.size(); ++i) {
    for (int c = 0; c < 4; ++c) {
      most = std::max(most, std::abs(exact[i][c]));
      worst = std::max(worst, std::abs(exact[i][c] - double(one[i][c])));
    }
  }
  EXPECT_LT(worst, 1e-4 * most);  // variances are differences of squares: 2^-24 over 0.03^2
}

}  // namespace
}  // namespace froth
