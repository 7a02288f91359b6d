#include "reference/image/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace froth {
namespace {

constexpr uint32_t kWidth = 32, kHeight = 24;

struct Rgb {
  float r, g, b;
};

Image flat(Rgb colour) {
  Image image{kWidth, kHeight, 3, {}};
  for (uint32_t p = 0; p < kWidth * kHeight; ++p) {
    image.values.insert(image.values.end(), {colour.r, colour.g, colour.b});
  }
  return image;
}

Image grey(float value) { return flat({value, value, value}); }

Image lattice(uint32_t multiplier) {
  Image image{kWidth, kHeight, 3, {}};
  for (uint32_t i = 0; i < kWidth * kHeight * 3; ++i) image.values.push_back(float(i * multiplier % 251) / 250);
  return image;
}

Image step(Rgb left, Rgb right) {
  Image image = flat(left);
  const Image other = flat(right);
  for (uint32_t y = 0; y < kHeight; ++y) {
    std::copy_n(other.pixel(kWidth / 2, y), 3 * kWidth / 2, image.pixel(kWidth / 2, y));
  }
  return image;
}

Image dot() {
  Image image = grey(0.5f);
  std::fill_n(image.pixel(16, 12), 3, 1.0f);
  return image;
}

Image waves(uint32_t shift) {
  Image image{kWidth, kHeight, 3, {}};
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) {
      for (uint32_t c = 0; c < 3; ++c) {
        image.values.push_back(float(0.5 + 0.4 * std::sin((x * 2 + y * 3 + c * 5 + shift) / 16.0)));
      }
    }
  }
  return image;
}

FlipDifference flip(const Image& a, const Image& b) { return *compareFlip(*prepareFlip(a), *prepareFlip(b)); }

struct Expected {
  const char* name;
  Image a, b;
  double mean, atCorner, at16x12, at5x20;
};

// From tests/image/flip_expected.py: the paper's formulas in double, its two-dimensional filters summed
// directly. NVIDIA's evaluator (flip-evaluator 1.7), run on the same pictures, agrees with them to 5e-5, the
// rounding of its float.
TEST(Flip, IsThatOfThePaper) {
  const std::vector<Expected> all{
      {"black, white", grey(0), grey(1), 0.967380, 0.967380, 0.967380, 0.967380},
      {"green, blue", flat({0, 1, 0}), flat({0, 0, 1}), 1, 1, 1, 1},
      {"one step of 8 bits", grey(0.5f), grey(0.5f + 1.0f / 255), 0.029870, 0.029870, 0.029870, 0.029870},
      {"chroma alone", flat({0.6f, 0.5f, 0.5f}), flat({0.5f, 0.55f, 0.5f}), 0.305856, 0.305856, 0.305856, 0.305856},
      {"an edge", step({0.2f, 0.2f, 0.2f}, {0.7f, 0.7f, 0.7f}), grey(0.2f), 0.506910, 0, 0.897251, 0},
      {"an edge of colour", step({0.8f, 0.2f, 0.1f}, {0.1f, 0.3f, 0.9f}), flat({0.8f, 0.2f, 0.1f}), 0.579035, 0,
       0.882789, 0},
      {"a dot", dot(), grey(0.5f), 0.005627, 0, 0.380198, 0},
      {"noise", lattice(37), lattice(53), 0.296761, 0.460355, 0.449150, 0.324110},
      {"waves", waves(0), waves(3), 0.272312, 0.303606, 0.156515, 0.097220},
  };
  for (const Expected& expected : all) {
    const FlipDifference found = flip(expected.a, expected.b);
    EXPECT_NEAR(found.mean, expected.mean, 5e-5) << expected.name;
    EXPECT_NEAR(*found.map.pixel(0, 0), expected.atCorner, 5e-5) << expected.name;
    EXPECT_NEAR(*found.map.pixel(16, 12), expected.at16x12, 5e-5) << expected.name;
    EXPECT_NEAR(*found.map.pixel(5, 20), expected.at5x20, 5e-5) << expected.name;
  }
}

TEST(Flip, EqualImagesDifferByNothingAndOrderDoesNotMatter) {
  const FlipImage a = *prepareFlip(lattice(37)), b = *prepareFlip(lattice(53));
  EXPECT_EQ(compareFlip(a, a)->mean, 0);
  EXPECT_EQ(compareFlip(a, b)->map.values, compareFlip(b, a)->map.values);
}

TEST(Flip, OneChannelIsGreyAndValuesAreClamped) {
  const Image one{kWidth, kHeight, 1, std::vector<float>(kWidth * kHeight, 0.25f)};
  EXPECT_EQ(flip(one, grey(0.25f)).mean, 0);
  EXPECT_EQ(flip(grey(1), grey(7)).mean, 0);
  EXPECT_EQ(flip(grey(-3), grey(0)).mean, 0);
}

TEST(Flip, FromFartherAwayNoiseIsSeenLess) {
  const auto seenAt = [](double pixelsPerDegree) {
    return compareFlip(*prepareFlip(lattice(37), pixelsPerDegree), *prepareFlip(lattice(53), pixelsPerDegree))->mean;
  };
  EXPECT_LT(seenAt(90), seenAt(67));
  EXPECT_LT(seenAt(67), seenAt(30));
}

TEST(Flip, ANotANumberIsNeverAGoodScore) {
  Image broken = grey(0.5f);
  broken.pixel(16, 12)[1] = std::numeric_limits<float>::quiet_NaN();
  const FlipDifference found = flip(grey(0.5f), broken);
  EXPECT_EQ(*found.map.pixel(16, 12), 1);
  EXPECT_EQ(*found.map.pixel(0, 0), 0);
  EXPECT_GT(found.mean, 1.0 / (kWidth * kHeight) - 1e-9);
}

TEST(Flip, ImagesOfDifferentShapeAreNotCompared) {
  Image narrow = grey(0.5f);
  narrow.width = kWidth / 2;
  narrow.height = kHeight * 2;
  EXPECT_FALSE(compareFlip(*prepareFlip(grey(0.5f)), *prepareFlip(narrow)));
  EXPECT_FALSE(compareFlip(*prepareFlip(narrow, 30), *prepareFlip(narrow, 40)));
  EXPECT_FALSE(prepareFlip(Image{}));
  EXPECT_FALSE(prepareFlip(narrow, 0));
  EXPECT_FALSE(prepareFlip(narrow, std::nan("")));
}

TEST(Flip, TheMapGoesFromBlackToPaleYellow) {
  const Image picture = colourErrorMap({4, 1, 1, {0, 0.5f, 1, std::nanf("")}});
  EXPECT_LT(picture.pixel(0, 0)[1], 0.01f);
  EXPECT_NEAR(picture.pixel(1, 0)[0], 0.7164f, 0.01f);  // magma at 0.5 is (0.7164, 0.2150, 0.4753)
  EXPECT_NEAR(picture.pixel(1, 0)[1], 0.2150f, 0.01f);
  EXPECT_GT(picture.pixel(2, 0)[1], 0.98f);
  EXPECT_EQ(picture.pixel(3, 0)[1], picture.pixel(0, 0)[1]);
  const auto brightness = [&](uint32_t x) {
    return std::accumulate(picture.pixel(x, 0), picture.pixel(x, 0) + 3, 0.0f);
  };
  EXPECT_LT(brightness(0), brightness(1));
  EXPECT_LT(brightness(1), brightness(2));
}

}  // namespace
}  // namespace froth
