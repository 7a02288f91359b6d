// The section of report.html on one knob at a time.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "measure/report/html_parts.h"
#include "measure/report/svg_plot.h"

namespace froth {
namespace {

struct SweepPoint {
  const ReportPoint* point;
  std::string value;
  double number;
};

// By growing number; none where the knob is none of this renderer's.
std::vector<SweepPoint> pointsOf(const Report& report, const Sweep& sweep, const std::string& renderer) {
  std::vector<SweepPoint> points;
  for (const std::string& id : sweep.points) {
    const ReportPoint* point = findPoint(report, id);
    if (!point || point->renderer != renderer) continue;
    const Setting& place = placeOnSweep(sweep, *point);
    points.push_back({point, place.value, place.number});
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const SweepPoint& a, const SweepPoint& b) { return a.number < b.number; });
  return points;
}

// Where a value stands on the axis. Off (0) has no logarithm: it stands a step below the smallest.
class Places {
 public:
  Places(const Report& report, const Sweep& sweep) : isLogarithmic_(sweep.isLogarithmic) {
    std::set<double> numbers;
    for (const std::string& renderer : renderersOf(report)) {
      for (const SweepPoint& point : pointsOf(report, sweep, renderer)) {
        if (point.number > 0) numbers.insert(point.number);
        labels_[point.number] = point.value;
      }
    }
    if (numbers.empty()) {
      isLogarithmic_ = false;
    } else {
      const double step = numbers.size() > 1 ? *std::next(numbers.begin()) / *numbers.begin() : 10;
      zeroAt_ = *numbers.begin() / step;
    }
  }
  double of(double number) const { return isLogarithmic_ && number <= 0 ? zeroAt_ : number; }
  PlotAxis axis(const Sweep& sweep) const {
    PlotAxis axis{
        sweep.knob + (sweep.unit.empty() ? "" : " [" + sweep.unit + "]"), isLogarithmic_, {}, {}, {}};
    for (const auto& [number, label] : labels_) axis.ticks.push_back({of(number), label});
    return axis;
  }

 private:
  bool isLogarithmic_;
  double zeroAt_ = 0;
  std::map<double, std::string> labels_;
};

enum class SweepFigure { kError, kTime, kBytes };

// Time is drawn over that of the renderer's own default, so that a fast and a slow one can be read side by
// side.
PlotPoint sweepMarker(const SweepPoint& swept, double x, const ReportPoint* standard, SweepFigure figure) {
  PlotPoint drawn;
  drawn.x = x;
  drawn.tooltip = tooltipOf(*swept.point);
  drawn.isRinged = isDefault(*swept.point);
  if (figure == SweepFigure::kError) {
    drawn.y = swept.point->errors.meanError;
  } else if (figure == SweepFigure::kBytes) {
    drawn.y = double(swept.point->diskBytes);
  } else {
    const double base = standard && isTimed(*standard) ? standard->total.median : swept.point->total.median;
    drawn.y = swept.point->total.median / base;
    drawn.yLow = swept.point->total.p5 / base;
    drawn.yHigh = swept.point->total.p95 / base;
  }
  return drawn;
}

// Small differences shall look small: errors span a decade at least, times a tenth to either side, sizes
// begin at 0.
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
    const double middle = std::sqrt(low * high);
    plot.y.from = middle / std::sqrt(10.0);
    plot.y.to = middle * std::sqrt(10.0);
  } else if (figure == SweepFigure::kTime) {
    const double margin = (high - low) / 20;
    plot.y.from = std::min(0.9, low - margin);
    plot.y.to = std::max(1.1, high + margin);
  } else if (figure == SweepFigure::kBytes) {
    const ByteUnit unit = unitOfBytes(high);
    for (PlotSeries& series : plot.series) {
      for (PlotPoint& point : series.points) point.y /= unit.bytes;
    }
    plot.y.label = std::string(unit.name) + " on disk";
    plot.y.from = 0;
    plot.y.to = high / unit.bytes * 1.08;
  }
}

Plot sweepPlot(const Report& report, const Sweep& sweep, SweepFigure figure) {
  const Places places(report, sweep);
  Plot plot;
  plot.width = 350;
  plot.height = 230;
  plot.x = places.axis(sweep);
  plot.y.label = figure == SweepFigure::kError  ? "mean error"
                 : figure == SweepFigure::kTime ? "time over the default's"
                                                : "on disk";
  plot.y.isLogarithmic = figure == SweepFigure::kError;
  plot.title = plot.y.label + " over " + sweep.knob;
  for (const std::string& renderer : renderersOf(report)) {
    PlotSeries series{figure == SweepFigure::kBytes ? "" : renderer, {}, PlotLine::kSolid};
    series.colour = colourOf(report, renderer);
    for (const SweepPoint& swept : pointsOf(report, sweep, renderer)) {
      if (figure == SweepFigure::kTime && !isTimed(*swept.point)) continue;
      series.points.push_back(
          sweepMarker(swept, places.of(swept.number), defaultOf(report, renderer), figure));
    }
    if (series.points.empty()) continue;
    plot.series.push_back(std::move(series));
    if (figure == SweepFigure::kBytes) break;  // one asset for all renderers
  }
  setRange(plot, figure);
  return plot;
}

bool hasTimes(const Report& report, const Sweep& sweep) {
  return std::any_of(sweep.points.begin(), sweep.points.end(), [&](const std::string& id) {
    const ReportPoint* point = findPoint(report, id);
    return point && isTimed(*point);
  });
}

bool changesBytes(const Report& report, const Sweep& sweep) {
  std::set<uint64_t> sizes;
  for (const std::string& renderer : renderersOf(report)) {
    for (const SweepPoint& swept : pointsOf(report, sweep, renderer)) sizes.insert(swept.point->diskBytes);
  }
  return sizes.size() > 1;
}

std::string sweepTable(const Report& report, const Sweep& sweep) {
  std::vector<std::string> head{sweep.knob + (sweep.unit.empty() ? "" : " [" + sweep.unit + "]"), "renderer"};
  for (const std::string& title : errorHead()) head.push_back(title);
  if (hasPhotos(report)) head.push_back("PSNR, photos");
  head.insert(head.end(), {"ms", "against default", "on disk", "resident"});
  Table table(head);
  for (const std::string& renderer : renderersOf(report)) {
    const ReportPoint* standard = defaultOf(report, renderer);
    for (const SweepPoint& swept : pointsOf(report, sweep, renderer)) {
      const ReportPoint& point = *swept.point;
      std::vector<Cell> row{textCell(swept.value), textCell(renderer)};
      if (isDefault(point)) row[0].html += " <span class=\"badge\">default</span>";
      if (point.id == report.chosen) row[0].html += " <span class=\"badge pick\">picked</span>";
      for (const Cell& cell : errorCells(point.errors)) row.push_back(cell);
      if (hasPhotos(report))
        row.push_back(numberCell(point.photoErrors ? decibels(point.photoErrors->psnr) : "–"));
      row.push_back(timeCell(point.total));
      row.push_back(standard && standard != &point ? changeCell(point.total, standard->total)
                                                   : numberCell("–"));
      row.push_back(bytesCell(point.diskBytes));
      row.push_back(bytesCell(point.residentBytes));
      table.add(row, isDefault(point));
    }
  }
  return table.html();
}

std::string sweepPart(const Report& report, const Sweep& sweep) {
  std::string html =
      "<h3>" + escapeMarkup(sweep.knob) + "</h3>\n" + paragraph(sweep.meaning) + "<div class=\"plots\">\n";
  html += drawPlot(sweepPlot(report, sweep, SweepFigure::kError));
  if (hasTimes(report, sweep)) html += drawPlot(sweepPlot(report, sweep, SweepFigure::kTime));
  if (changesBytes(report, sweep)) html += drawPlot(sweepPlot(report, sweep, SweepFigure::kBytes));
  return html + "</div>\n" + sweepTable(report, sweep);
}

}  // namespace

std::string sweepsSection(const Report& report) {
  if (report.sweeps.empty()) return "";
  std::string body = paragraph(
      "One knob at a time is turned away from the default (ringed, and marked in the tables); all others "
      "stay. Bars and small "
      "figures are the 5th to 95th percentile of repeated frames. A tie: the intervals overlap, so noise "
      "alone explains the "
      "difference.");
  for (const Sweep& sweep : report.sweeps) body += sweepPart(report, sweep);
  return section("sweeps", "One knob at a time", body);
}

}  // namespace froth
