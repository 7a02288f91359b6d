#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "measure/report/report.h"

namespace froth {
namespace {

std::vector<double> powersOfTwo(int from, int to) {
  std::vector<double> x;
  for (int k = from; k <= to; ++k) x.push_back(std::exp2(k));
  return x;
}

std::vector<double> valuesAt(const std::vector<double>& x, const std::function<double(double)>& f) {
  std::vector<double> y;
  for (double value : x) y.push_back(f(value));
  return y;
}

TEST(Slope, OfAnExactPowerLawIsItsPower) {
  const std::vector<double> x = powersOfTwo(-10, -2);
  const Slope slope = fitSlope("error over step", 1.5, x, valuesAt(x, [](double v) { return 3 * std::pow(v, 1.5); }));
  EXPECT_NEAR(slope.measured, 1.5, 1e-12);
  EXPECT_NEAR(slope.atOne, 3, 1e-11);
  EXPECT_EQ(slope.fitted, x.size());
  EXPECT_EQ(slope.floor, 0);
  EXPECT_EQ(slope.verdict, kVerdictAsDerived);
}

TEST(Slope, IsFittedAboveTheFloorWhichIsNamed) {
  const std::vector<double> x = powersOfTwo(-16, -2);
  const Slope slope = fitSlope("error over step", 1, x, valuesAt(x, [](double v) { return std::hypot(v, 1e-3); }));
  EXPECT_EQ(slope.verdict, kVerdictFloor);
  EXPECT_NEAR(slope.measured, 1, 0.05);
  EXPECT_NEAR(slope.floor, 1e-3, 1e-5);
  EXPECT_LT(slope.fitted, x.size());
  EXPECT_NE(slope.note.find("0.00100"), std::string::npos) << slope.note;
  EXPECT_EQ(slope.x.size(), x.size());
}

TEST(Slope, OfWhatStaysConstantDoesNotFall) {
  const std::vector<double> x = powersOfTwo(-10, -2);
  const Slope flat =
      fitSlope("error over step", 1, x, valuesAt(x, [](double v) { return 1e-3 * (1 + 0.2 * std::sin(1e4 * v)); }));
  EXPECT_EQ(flat.verdict, kVerdictDoesNotFall);
  EXPECT_NE(flat.note, "");
  const Slope rising = fitSlope("error over step", 1, x, valuesAt(x, [](double v) { return 1e-6 / v; }));
  EXPECT_EQ(rising.verdict, kVerdictDoesNotFall);
  EXPECT_NEAR(rising.measured, -1, 1e-12);
}

TEST(Slope, OfAnotherPowerIsSaidToBeOne) {
  const std::vector<double> x = powersOfTwo(-10, -2);
  const Slope slope = fitSlope("error over step", 2, x, valuesAt(x, [](double v) { return v; }));
  EXPECT_EQ(slope.verdict, kVerdictOtherOrder);
  EXPECT_NEAR(slope.measured, 1, 1e-12);
  const Slope floored = fitSlope("error over step", 2, x, valuesAt(x, [](double v) { return std::max(v, 0.01); }));
  EXPECT_EQ(floored.verdict, kVerdictOtherOrder);
  EXPECT_NEAR(floored.measured, 1, 0.01);
}

TEST(Slope, WithTooFewPointsIsNotJudged) {
  EXPECT_EQ(fitSlope("", 1, {}, {}).verdict, kVerdictTooFew);
  EXPECT_EQ(fitSlope("", 1, {1, 2}, {1, 2}).verdict, kVerdictTooFew);
  EXPECT_EQ(fitSlope("", 1, {1, 1, 1}, {1, 2, 3}).verdict, kVerdictTooFew);
  EXPECT_EQ(fitSlope("", 1, {1, 1.1, 1.2}, {1, 1.1, 1.2}).verdict, kVerdictTooFew);  // x spans too little
  // Two points above a floor.
  const Slope slope = fitSlope("", 1, {1e-4, 1e-3, 1e-2, 1e-1}, {1e-3, 1e-3, 1e-2, 1e-1});
  EXPECT_EQ(slope.verdict, kVerdictTooFew);
  EXPECT_NE(slope.note.find("2 of 4"), std::string::npos) << slope.note;
}

TEST(Slope, ValuesWithoutALogarithmAreLeftOut) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Slope slope = fitSlope("", 1, {0, 4, 1, 2, 8, 16, 32}, {7, 4, 1, 2, 0, infinity, std::nan("")});
  EXPECT_EQ(slope.fitted, 3u);
  EXPECT_NEAR(slope.measured, 1, 1e-12);
  EXPECT_EQ(slope.x, (std::vector<double>{0, 1, 2, 4, 8, 16, 32}));
  EXPECT_EQ(slope.y[1], 1);
}

TEST(Slope, OfASweepOfBitsIsOverTheStep) {
  std::vector<ReportPoint> points(5);
  Sweep sweep;
  sweep.knob = "positionBits";
  sweep.isBits = true;
  sweep.expectedOrder = 1;
  sweep.base = {"positionBits", "14", 14};
  sweep.points = {"raster", "walk"};
  points[0].id = points[0].renderer = "raster";
  points[0].errors.meanError = std::exp2(-14);
  points[1].id = points[1].renderer = "walk";
  for (int k = 0; k < 3; ++k) {
    const int bits = 8 + 2 * k;
    points[2 + k].id = "raster positionBits=" + std::to_string(bits);
    points[2 + k].renderer = "raster";
    points[2 + k].settings = {{"positionBits", std::to_string(bits), double(bits)}};
    points[2 + k].errors.meanError = std::exp2(-bits);
    sweep.points.push_back(points[2 + k].id);
  }
  const Slope slope = fitConvergence(points, sweep, "raster");
  EXPECT_EQ(slope.what, "raster: mean error over step of positionBits");
  EXPECT_EQ(slope.fitted, 4u);  // with the default
  EXPECT_EQ(slope.verdict, kVerdictAsDerived);
  EXPECT_EQ(fitConvergence(points, sweep, "walk").x.size(), 1u);
}

}  // namespace
}  // namespace froth
