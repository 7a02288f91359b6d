// A small plotter: points, lines and intervals over linear or logarithmic axes. Computes where everything stands;
// templates/plot.svg draws it, readable on light and on dark paper. The same plot gives the same bytes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace froth {

struct PlotTick {
  double at = 0;
  std::string label;
};

struct PlotAxis {
  std::string label;               // with its unit: "time [ms]"
  bool isLogarithmic = false;      // values <= 0 are then left out
  std::vector<PlotTick> ticks;     // empty: chosen to suit
  std::optional<double> from, to;  // empty: the data and a margin; what lies outside is left out
};

struct PlotPoint {
  double x = 0, y = 0;
  double xLow = 0, xHigh = 0, yLow = 0, yHigh = 0;  // an error bar where low < high
  std::string tooltip{};
  std::string label{};    // beside the point, left out where there is no room; earlier points come first
  bool isRinged = false;  // marked: the default
  bool isHollow = false;
};

// Marker shape and colour follow from the place among the series; kNeutral: grey and without a place.
struct PlotSeries {
  std::string name;  // in the legend; empty: not there
  std::vector<PlotPoint> points;
  std::string line{};      // through the points in their order: "solid", "dashed", "dotted"; empty: none
  bool isStepped = false;  // the line keeps its y until the next x, as a Pareto front does
  bool hasMarkers = true;
  int colour = -1;  // 0..7; -1: the place among the series; kNeutral
  static constexpr int kNeutral = -2;
};

struct Plot {
  std::string title;  // the accessible name, and a heading where `showsTitle`
  bool showsTitle = false;
  PlotAxis x, y;
  std::vector<PlotSeries> series;
  int width = 720, height = 380;  // [CSS pixels]
};

// What templates/plot.svg asks for.
nlohmann::ordered_json layOutPlot(const Plot& plot);
// A file of its own.
std::string drawPlotFile(const Plot& plot);

// Ticks within the range: 1, 2 or 5 times a power of ten, or powers of ten; at most `most`.
std::vector<PlotTick> chooseTicks(double from, double to, bool isLogarithmic, int most);

}  // namespace froth
