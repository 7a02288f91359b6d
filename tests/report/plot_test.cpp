#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "measure/report/svg_plot.h"
#include "measure/report/text.h"

namespace froth {
namespace {

std::vector<std::string> labels(const std::vector<PlotTick>& ticks) {
  std::vector<std::string> found;
  for (const PlotTick& tick : ticks) found.push_back(tick.label);
  return found;
}

TEST(Plot, TicksAreRoundAndTellNeighboursApart) {
  using Labels = std::vector<std::string>;
  EXPECT_EQ(labels(chooseTicks(0, 10, false, 6)), (Labels{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(labels(chooseTicks(51.21, 51.29, false, 5)), (Labels{"51.22", "51.24", "51.26", "51.28"}));
  EXPECT_EQ(labels(chooseTicks(-0.3, 0.3, false, 4)), (Labels{"−0.2", "0.0", "0.2"}));
  EXPECT_EQ(labels(chooseTicks(0.9e-6, 1.1e-2, true, 6)), (Labels{"1e-6", "1e-5", "1e-4", "0.001", "0.01"}));
  EXPECT_EQ(labels(chooseTicks(0.9, 40, true, 8)), (Labels{"1", "2", "3", "5", "7", "10", "20", "30"}));
  EXPECT_EQ(labels(chooseTicks(1e-9, 1e9, true, 5)), (Labels{"1e-5", "1", "100000"}));
  EXPECT_EQ(labels(chooseTicks(3, 3, false, 5)), Labels{"3.00"});
}

TEST(Plot, TicksLieWithinTheRangeAndAreFewEnough) {
  for (double from : {1e-12, 3e-5, 0.7, 42.0, 9e7}) {
    for (double ratio : {1.001, 1.3, 4.0, 70.0, 1e5, 1e13}) {
      for (int most : {2, 3, 5, 9}) {
        for (bool isLogarithmic : {false, true}) {
          const std::vector<PlotTick> ticks = chooseTicks(from, from * ratio, isLogarithmic, most);
          EXPECT_LE(int(ticks.size()), most + 1) << from << " " << ratio << " " << most << isLogarithmic;
          for (const PlotTick& tick : ticks) {
            EXPECT_GE(tick.at, from - 1e-6 * from * ratio);
            EXPECT_LE(tick.at, from * ratio * (1 + 1e-6));
          }
        }
      }
    }
  }
}

TEST(Plot, NumbersKeepThreeDigits) {
  EXPECT_EQ(shortNumber(0), "0");
  EXPECT_EQ(shortNumber(1.4), "1.40");
  EXPECT_EQ(shortNumber(9.999), "10.0");
  EXPECT_EQ(shortNumber(0.00123), "0.00123");
  EXPECT_EQ(shortNumber(6.1e-4), "6.10e-4");
  EXPECT_EQ(shortNumber(-123456), "−123456");
  EXPECT_EQ(shortNumber(1.5e7), "1.50e7");
  EXPECT_EQ(shortNumber(std::numeric_limits<double>::infinity()), "∞");
  EXPECT_EQ(shortNumber(std::nan("")), "not a number");
}

TEST(Plot, TextIsEscaped) {
  Plot plot;
  plot.title = "<a href='x'>\"&\"</a>\x01\n";
  EXPECT_NE(drawPlotFile(plot).find("\"&lt;a href=&apos;x&apos;&gt;&quot;&amp;&quot;&lt;/a&gt; \""), std::string::npos);
  plot.title = plot.x.label = plot.y.label = "<script>";
  PlotSeries series{"<script>", {}};
  series.points.resize(1);
  series.points[0].x = series.points[0].y = 1;
  series.points[0].tooltip = series.points[0].label = "<script>";
  plot.series.push_back(series);
  EXPECT_EQ(drawPlotFile(plot).find("<script>"), std::string::npos);
}

size_t countOf(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Plot, WhatHasNoPlaceOnTheAxesIsLeftOut) {
  Plot plot;
  plot.x.isLogarithmic = true;
  PlotSeries series;
  const double infinity = std::numeric_limits<double>::infinity();
  for (auto [x, y] :
       std::vector<std::pair<double, double>>{{1, 1}, {10, 2}, {0, 1}, {-1, 1}, {1, infinity}, {std::nan(""), 1}}) {
    series.points.emplace_back();
    series.points.back().x = x;
    series.points.back().y = y;
  }
  plot.series = {series};
  const std::string svg = drawPlotFile(plot);
  EXPECT_EQ(countOf(svg, "class=\"mark"), 2u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  plot.series.clear();
  EXPECT_EQ(countOf(drawPlotFile(plot), "class=\"axis\""), 1u);
}

// Ten points in one place: labels that would lie over each other are left out.
TEST(Plot, LabelsDoNotLieOverEachOther) {
  Plot plot;
  PlotSeries series;
  for (int i = 0; i < 60; ++i) {
    series.points.emplace_back();
    series.points.back().x = series.points.back().y = 1 + 1e-3 * i;
    series.points.back().label = "a rather long label " + std::to_string(i);
  }
  plot.series = {series};
  plot.x.from = plot.y.from = 0;
  plot.x.to = plot.y.to = 2;
  const size_t shown = countOf(drawPlotFile(plot), "class=\"label\"");
  EXPECT_GE(shown, 3u);
  EXPECT_LT(shown, 60u);
}

}  // namespace
}  // namespace froth
