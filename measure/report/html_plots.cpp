// The plots of report.html.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "measure/report/html_parts.h"
#include "measure/report/svg_plot.h"
#include "measure/report/text.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;

PlotPoint plotPoint(const ReportPoint& point, double x, double y) {
  PlotPoint drawn{x, y};
  drawn.isRinged = point.settings.empty();
  drawn.tooltip =
      fmt::format("{}: {}; {} dB, FLIP {}, mean error {}, max {}; {} ms ({} to {}); {} on disk, {} resident",
                  point.renderer, settingsText(point), decibels(point.errors.psnr), shortNumber(point.errors.flip),
                  shortNumber(point.errors.meanError), shortNumber(point.errors.maxError),
                  shortNumber(point.total.median), shortNumber(point.total.p5), shortNumber(point.total.p95),
                  bytesText(double(point.diskBytes)), bytesText(double(point.residentBytes)));
  return drawn;
}

PlotPoint frontPoint(const Report& report, const ReportPoint& point, const std::vector<std::string>& front, Cost cost,
                     double unit) {
  const bool isTime = cost == Cost::kTime, isPicked = point.id == report.chosen, isDefault = point.settings.empty();
  PlotPoint drawn = plotPoint(point, isTime ? point.total.median : double(point.diskBytes) / unit, point.errors.psnr);
  if (isTime) drawn.xLow = point.total.p5, drawn.xHigh = point.total.p95;
  drawn.isRinged = isDefault || isPicked;
  drawn.isHollow = !holds(front, point.id);
  if (drawn.isRinged || !drawn.isHollow) drawn.label = settingsText(point);
  if (isPicked) drawn.label = isDefault ? "default, picked" : "picked: " + drawn.label;
  return drawn;
}

// The marked ones first: they have the choice of places for labels, and lie on top.
int rankOf(const Report& report, const ReportPoint& point, const std::vector<std::string>& front) {
  return point.settings.empty() ? 0 : point.id == report.chosen ? 1 : holds(front, point.id) ? 2 : 3;
}

// Places of a sweep's points on its axis, which gets a tick for each.
PlotAxis axisOf(const Sweep& sweep, const std::vector<SweepPoint>& points, std::vector<double>& places) {
  std::set<double> numbers;
  for (const SweepPoint& swept : points) numbers.insert(swept.number);
  numbers.erase(numbers.begin(), numbers.upper_bound(0));
  PlotAxis axis{titleOf(sweep), sweep.isLogarithmic && !numbers.empty(), {}, {}, {}};
  // Off (0) has no logarithm: it stands a step below the smallest.
  const double least = numbers.empty() ? 0 : *numbers.begin();
  const double step = numbers.size() > 1 ? *std::next(numbers.begin()) / least : 10;
  std::map<double, std::string> labels;
  for (const SweepPoint& swept : points) {
    places.push_back(axis.isLogarithmic && swept.number <= 0 ? least / step : swept.number);
    labels[places.back()] = swept.value;
  }
  for (const auto& [place, label] : labels) axis.ticks.push_back({place, label});
  return axis;
}

enum class SweepFigure { kError, kTime, kBytes };

// Time is drawn over that of the renderer's own default, so that a fast and a slow one can be read side by side.
PlotPoint sweepMarker(const Report& report, const ReportPoint& point, double x, SweepFigure figure) {
  if (figure == SweepFigure::kError) return plotPoint(point, x, point.errors.meanError);
  if (figure == SweepFigure::kBytes) return plotPoint(point, x, double(point.diskBytes));
  const ReportPoint* standard = defaultOf(report, point.renderer);
  const double base = standard && standard->total.median > 0 ? standard->total.median : point.total.median;
  PlotPoint drawn = plotPoint(point, x, point.total.median / base);
  drawn.yLow = point.total.p5 / base, drawn.yHigh = point.total.p95 / base;
  return drawn;
}

// Small differences shall look small: errors span a decade at least, times a tenth to either side, sizes begin at 0.
void setRange(Plot& plot, SweepFigure figure) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const PlotSeries& series : plot.series) {
    for (const PlotPoint& point : series.points) {
      if (!(point.y > 0) || !std::isfinite(point.y)) continue;
      low = std::min(low, point.yLow > 0 ? point.yLow : point.y);
      high = std::max({high, point.y, point.yHigh});
    }
  }
  if (!(high > 0)) return;
  if (figure == SweepFigure::kError && high < 10 * low) {
    plot.y.from = std::sqrt(low * high / 10);
    plot.y.to = std::sqrt(low * high * 10);
  } else if (figure == SweepFigure::kTime) {
    const double margin = (high - low) / 20;
    plot.y.from = std::min(0.9, low - margin);
    plot.y.to = std::max(1.1, high + margin);
  } else if (figure == SweepFigure::kBytes) {
    const ByteUnit unit = unitOfBytes(high);
    for (PlotPoint& point : plot.series[0].points) point.y /= unit.bytes;
    plot.y.label = std::string(unit.name) + " on disk";
    plot.y.from = 0;
    plot.y.to = high / unit.bytes * 1.08;
  }
}

PlotSeries lineThrough(const std::string& name, const char* line, int colour, PlotPoint a, PlotPoint b) {
  PlotSeries series{name, {std::move(a), std::move(b)}, line};
  series.hasMarkers = false;
  series.colour = colour;
  return series;
}

}  // namespace

const ReportPoint* findPoint(const Report& report, const std::string& id) {
  const auto found =
      std::find_if(report.points.begin(), report.points.end(), [&](const auto& p) { return p.id == id; });
  return found == report.points.end() ? nullptr : &*found;
}

const ReportPoint* defaultOf(const Report& report, const std::string& renderer) {
  for (const ReportPoint& point : report.points) {
    if (point.renderer == renderer && point.settings.empty()) return &point;
  }
  return nullptr;
}

std::vector<std::string> renderersOf(const Report& report) {
  std::vector<std::string> renderers;
  for (const ReportPoint& point : report.points) {
    if (!holds(renderers, point.renderer)) renderers.push_back(point.renderer);
  }
  return renderers;
}

std::string settingsText(const ReportPoint& point) {
  std::string text;
  for (const Setting& setting : point.settings) {
    text += (text.empty() ? "" : ", ") + setting.knob + " " + setting.value;
  }
  return text.empty() ? "default" : text;
}

std::string titleOf(const Sweep& sweep) { return sweep.knob + (sweep.unit.empty() ? "" : " [" + sweep.unit + "]"); }

std::vector<SweepPoint> pointsOf(const Report& report, const Sweep& sweep) {
  std::vector<SweepPoint> points;
  for (const std::string& renderer : renderersOf(report)) {
    const size_t first = points.size();
    for (const std::string& id : sweep.points) {
      const ReportPoint* point = findPoint(report, id);
      if (!point || point->renderer != renderer) continue;
      const Setting& place = placeOnSweep(sweep, *point);
      points.push_back({point, place.value, place.number});
    }
    std::stable_sort(points.begin() + ptrdiff_t(first), points.end(),
                     [](const SweepPoint& a, const SweepPoint& b) { return a.number < b.number; });
  }
  return points;
}

std::vector<const ReportPoint*> candidatesOf(const Report& report, const std::vector<std::string>& front) {
  std::vector<const ReportPoint*> candidates;
  for (const ReportPoint& point : report.points) {
    if (point.total.median > 0 || holds(front, point.id)) candidates.push_back(&point);
  }
  return candidates;
}

double lowestDrawn(const Report& report, const std::vector<std::string>& front) {
  constexpr double kBelowFronts = 6;  // [dB]
  double lowest = std::numeric_limits<double>::infinity();
  for (const ReportPoint& point : report.points) {
    if (rankOf(report, point, front) < 3) lowest = std::min(lowest, point.errors.psnr);
  }
  return lowest - kBelowFronts;
}

Json frontPlot(const Report& report, Cost cost, const std::vector<std::string>& front) {
  uint64_t largest = 0;
  for (const ReportPoint& point : report.points) largest = std::max(largest, point.diskBytes);
  const ByteUnit unit = unitOfBytes(double(largest));
  Plot plot;
  plot.title = cost == Cost::kTime ? "Error over milliseconds" : "Error over bytes";
  plot.x.label = cost == Cost::kTime ? "time of a frame [ms], 5th to 95th percentile"
                                     : fmt::format("size on disk [{}]", unit.name);
  plot.x.isLogarithmic = true;
  plot.y.label = "PSNR [dB], up is better";
  plot.width = 1080, plot.height = 460;
  std::vector<const ReportPoint*> candidates = candidatesOf(report, front);
  std::stable_sort(candidates.begin(), candidates.end(), [&](const ReportPoint* a, const ReportPoint* b) {
    return rankOf(report, *a, front) < rankOf(report, *b, front);
  });
  const double lowest = lowestDrawn(report, front);
  const auto isBelow = [&](const ReportPoint* point) { return point->errors.psnr < lowest; };
  if (std::any_of(candidates.begin(), candidates.end(), isBelow)) plot.y.from = lowest;
  int colour = 0;
  for (const std::string& renderer : renderersOf(report)) {
    PlotSeries drawn{renderer, {}}, line{renderer + ": Pareto front", {}, "solid", true, false};
    drawn.colour = line.colour = colour++;
    for (const ReportPoint* point : candidates) {
      if (point->renderer == renderer) drawn.points.push_back(frontPoint(report, *point, front, cost, unit.bytes));
    }
    for (const std::string& id : front) {
      const ReportPoint* point = findPoint(report, id);
      if (!point || point->renderer != renderer) continue;
      line.points.push_back(frontPoint(report, *point, front, cost, unit.bytes));
    }
    plot.series.push_back(std::move(drawn));
    if (!line.points.empty()) plot.series.push_back(std::move(line));
  }
  return layOutPlot(plot);
}

Json sweepPlots(const Report& report, const Sweep& sweep) {
  const std::vector<SweepPoint> points = pointsOf(report, sweep);
  std::vector<double> places;
  const PlotAxis axis = axisOf(sweep, points, places);
  const std::pair<SweepFigure, const char*> figures[] = {{SweepFigure::kError, "mean error"},
                                                         {SweepFigure::kTime, "time over the default's"},
                                                         {SweepFigure::kBytes, "on disk"}};
  std::set<uint64_t> sizes;
  for (const SweepPoint& swept : points) sizes.insert(swept.point->diskBytes);
  Json plots = Json::array();
  for (const auto& [figure, name] : figures) {
    if (figure == SweepFigure::kBytes && sizes.size() < 2) continue;
    Plot plot;
    plot.width = 350, plot.height = 230;
    plot.x = axis;
    plot.y.label = name;
    plot.y.isLogarithmic = figure == SweepFigure::kError;
    plot.title = plot.y.label + " over " + sweep.knob;
    int colour = 0;
    for (const std::string& renderer : renderersOf(report)) {
      PlotSeries series{figure == SweepFigure::kBytes ? "" : renderer, {}, "solid"};
      series.colour = colour++;
      for (size_t i = 0; i < points.size(); ++i) {
        const ReportPoint& point = *points[i].point;
        if (point.renderer != renderer || (figure == SweepFigure::kTime && !(point.total.median > 0))) continue;
        series.points.push_back(sweepMarker(report, point, places[i], figure));
      }
      const bool isOneAsset = figure == SweepFigure::kBytes && !plot.series.empty();  // for all renderers
      if (!series.points.empty() && !isOneAsset) plot.series.push_back(std::move(series));
    }
    setRange(plot, figure);
    if (figure == SweepFigure::kError || !plot.series.empty()) plots.push_back(layOutPlot(plot));
  }
  return plots;
}

Json slopePlot(const Slope& slope) {
  // "raster: mean error over cutoff" as its parts.
  const size_t colon = slope.what.find(": "), from = colon == std::string::npos ? 0 : colon + 2;
  const size_t over = std::min(slope.what.find(" over ", from), slope.what.size());
  Plot plot;
  plot.width = 350, plot.height = 250;
  plot.title = slope.what.substr(0, from) + slope.verdict;
  plot.showsTitle = true;
  plot.x = {slope.what.substr(std::min(over + 6, slope.what.size())), true, {}, {}, {}};
  plot.y = {slope.what.substr(from, over - from), true, {}, {}, {}};
  PlotSeries measured{"measured", {}};
  double first = 0, last = 0;
  for (size_t i = 0; i < slope.x.size() && i < slope.y.size(); ++i) {
    PlotPoint point{slope.x[i], slope.y[i]};
    point.isHollow = slope.floor > 0 && point.y <= kFloorFactor * slope.floor;
    point.tooltip = fmt::format("{} at {}", shortNumber(point.y), shortNumber(point.x));
    measured.points.push_back(point);
    if (!(point.x > 0) || !(point.y > 0)) continue;
    if (first == 0) first = point.x;
    last = point.x;
  }
  plot.series.push_back(std::move(measured));
  if (slope.atOne > 0 && last > first) {
    const double middle = std::sqrt(first * last), atMiddle = slope.atOne * std::pow(middle, slope.measured);
    const auto at = [&](double x, double order) { return PlotPoint{x, atMiddle * std::pow(x / middle, order)}; };
    plot.series.push_back(lineThrough("slope " + signedText(slope.measured, 2), "solid", 0, at(first, slope.measured),
                                      at(last, slope.measured)));
    plot.series.push_back(lineThrough(fmt::format("derived {:g}", slope.expected), "dashed", PlotSeries::kNeutral,
                                      at(first, slope.expected), at(last, slope.expected)));
    if (slope.floor > 0) {
      plot.series.push_back(lineThrough("floor", "dotted", 1, {first, slope.floor}, {last, slope.floor}));
    }
  }
  return layOutPlot(plot);
}

}  // namespace froth
