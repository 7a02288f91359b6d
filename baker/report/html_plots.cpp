// The sections of report.html that draw: fronts, sweeps, slopes.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "baker/report/html_parts.h"
#include "baker/report/svg_plot.h"

namespace froth {
namespace {

bool holds(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::string tooltipOf(const ReportPoint& point) {
  return fmt::format("{}: {}\n{} dB, FLIP {}, mean error {}, max {}; {}; {} on disk, {} resident",
                     point.renderer, settingsText(point), decibels(point.errors.psnr),
                     shortNumber(point.errors.flip), shortNumber(point.errors.meanError),
                     shortNumber(point.errors.maxError), intervalText(point.total),
                     bytesText(double(point.diskBytes)), bytesText(double(point.residentBytes)));
}

// --- Fronts

PlotPoint frontPoint(const Report& report, const ReportPoint& point, Cost cost,
                     const std::vector<std::string>& front) {
  PlotPoint drawn;
  drawn.y = point.errors.psnr;
  if (cost == Cost::kTime) {
    drawn.x = point.total.median;
    drawn.xLow = point.total.p5;
    drawn.xHigh = point.total.p95;
  } else {
    drawn.x = double(point.diskBytes) / 1e6;
  }
  drawn.tooltip = tooltipOf(point);
  const bool isPicked = point.id == report.chosen;
  drawn.isRinged = isDefault(point) || isPicked;
  drawn.isHollow = !holds(front, point.id);
  if (isDefault(point)) {
    drawn.label = isPicked ? "default, picked" : "default";
  } else if (isPicked) {
    drawn.label = "picked: " + settingsText(point);
  } else if (holds(front, point.id)) {
    drawn.label = settingsText(point);
  }
  return drawn;
}

// The marked ones first: they have the choice of places for labels, and lie on top.
int rankOf(const Report& report, const ReportPoint& point, const std::vector<std::string>& front) {
  return isDefault(point) ? 0 : point.id == report.chosen ? 1 : holds(front, point.id) ? 2 : 3;
}

Plot frontPlot(const Report& report, Cost cost, const std::vector<std::string>& front) {
  Plot plot;
  plot.title = cost == Cost::kTime ? "Error over milliseconds" : "Error over bytes";
  plot.x = {cost == Cost::kTime ? "time of a frame [ms], 5th to 95th percentile" : "size on disk [MB]",
            true,
            {},
            {},
            {}};
  plot.y.label = "PSNR [dB], up is better";
  plot.width = 1080;
  plot.height = 460;
  for (const std::string& renderer : renderersOf(report)) {
    std::vector<const ReportPoint*> points;
    PlotSeries drawn{renderer, {}}, line;
    for (const ReportPoint& point : report.points) {
      if (point.renderer == renderer) points.push_back(&point);
    }
    std::stable_sort(points.begin(), points.end(), [&](const ReportPoint* a, const ReportPoint* b) {
      return rankOf(report, *a, front) < rankOf(report, *b, front);
    });
    for (const ReportPoint* point : points) drawn.points.push_back(frontPoint(report, *point, cost, front));
    for (const std::string& id : front) {
      const ReportPoint* point = findPoint(report, id);
      if (point && point->renderer == renderer)
        line.points.push_back(frontPoint(report, *point, cost, front));
    }
    for (PlotPoint& point : line.points) point.label.clear();
    line.name = renderer + ": Pareto front";
    line.line = PlotLine::kSolid;
    line.isStepped = true;
    line.hasMarkers = false;
    line.colour = drawn.colour = colourOf(report, renderer);
    plot.series.push_back(std::move(drawn));
    if (!line.points.empty()) plot.series.push_back(std::move(line));
  }
  return plot;
}

// Points that cost the same within the noise, with a larger error; a few by name.
std::string tiesOf(const Report& report, const ReportPoint& point, Cost cost) {
  std::string names;
  int count = 0, named = 0;
  for (const ReportPoint& other : report.points) {
    if (&other == &point || other.renderer != point.renderer) continue;
    const bool ties =
        cost == Cost::kTime ? isTie(other.total, point.total) : other.diskBytes == point.diskBytes;
    if (!ties) continue;
    ++count;
    if (named == 4) continue;
    ++named;
    names += (names.empty() ? "" : "; ") + settingsText(other);
  }
  if (count == 0) return "–";
  return count > named ? fmt::format("{}; and {} more", names, count - named) : names;
}

std::string frontTable(const Report& report, Cost cost, const std::vector<std::string>& front) {
  std::vector<std::string> head{"renderer", "on the front, from cheap to dear"};
  for (const std::string& title : errorHead()) head.push_back(title);
  head.insert(head.end(), {"ms", "on disk", cost == Cost::kTime ? "ties with it in time" : "as large"});
  Table table(head);
  for (const std::string& id : front) {
    const ReportPoint* point = findPoint(report, id);
    if (!point) continue;
    std::vector<Cell> row{textCell(point->renderer), pointCell(report, *point)};
    for (const Cell& cell : errorCells(point->errors)) row.push_back(cell);
    row.push_back(timeCell(point->total));
    row.push_back(numberCell(bytesText(double(point->diskBytes))));
    row.push_back(textCell(tiesOf(report, *point, cost)));
    row.back().style += " small";
    table.add(row, isDefault(*point));
  }
  return table.html();
}

std::string frontSection(const Report& report, Cost cost) {
  const std::vector<std::string>& front = cost == Cost::kTime ? report.frontOverTime : report.frontOverBytes;
  std::string body = figure(
      drawPlot(frontPlot(report, cost, front)),
      "Filled: on the front, no other point is surely cheaper and as good. Hollow: beaten, or a tie with a "
      "point of less error. Ringed: the default, and what this report picks. Point at a marker for its "
      "figures.");
  const auto equal = std::count_if(report.points.begin(), report.points.end(),
                                   [](const ReportPoint& point) { return std::isinf(point.errors.psnr); });
  if (equal > 0)
    body += paragraph(
        fmt::format("{} points equal the reference and have no place on the axis of decibels.", equal));
  body += frontTable(report, cost, front);
  return cost == Cost::kTime ? section("time", "Error over milliseconds", body)
                             : section("bytes", "Error over bytes", body);
}

// --- Sweeps

struct SweepPoint {
  const ReportPoint* point;
  std::string value;
  double number;
};

std::vector<SweepPoint> pointsOf(const Report& report, const Sweep& sweep, const std::string& renderer) {
  std::vector<SweepPoint> points;
  for (const std::string& id : sweep.points) {
    const ReportPoint* point = findPoint(report, id);
    if (!point || point->renderer != renderer) continue;
    const auto setting = std::find_if(point->settings.begin(), point->settings.end(),
                                      [&](const Setting& s) { return s.knob == sweep.knob; });
    if (setting != point->settings.end()) {
      points.push_back({point, setting->value, setting->number});
    } else if (isDefault(*point)) {
      points.push_back({point, sweep.defaultValue, sweep.defaultNumber});
    }
  }
  const ReportPoint* standard = defaultOf(report, renderer);
  const bool isThere =
      std::any_of(points.begin(), points.end(), [&](const SweepPoint& p) { return p.point == standard; });
  if (standard && !isThere && !sweep.defaultValue.empty()) {
    points.push_back({standard, sweep.defaultValue, sweep.defaultNumber});
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

Plot sweepPlot(const Report& report, const Sweep& sweep, SweepFigure figure) {
  const Places places(report, sweep);
  Plot plot;
  plot.width = 350;
  plot.height = 230;
  plot.x = places.axis(sweep);
  plot.y.label = figure == SweepFigure::kError  ? "mean error"
                 : figure == SweepFigure::kTime ? "ms"
                                                : "MB on disk";
  plot.y.isLogarithmic = figure == SweepFigure::kError;
  plot.title = plot.y.label + " over " + sweep.knob;
  for (const std::string& renderer : renderersOf(report)) {
    PlotSeries series{renderer, {}, PlotLine::kSolid};
    series.colour = colourOf(report, renderer);
    for (const SweepPoint& swept : pointsOf(report, sweep, renderer)) {
      PlotPoint drawn;
      drawn.x = places.of(swept.number);
      drawn.tooltip = tooltipOf(*swept.point);
      drawn.isRinged = isDefault(*swept.point);
      if (figure == SweepFigure::kError) {
        drawn.y = swept.point->errors.meanError;
      } else if (figure == SweepFigure::kTime) {
        drawn.y = swept.point->total.median;
        drawn.yLow = swept.point->total.p5;
        drawn.yHigh = swept.point->total.p95;
      } else {
        drawn.y = double(swept.point->diskBytes) / 1e6;
      }
      series.points.push_back(std::move(drawn));
    }
    if (!series.points.empty()) plot.series.push_back(std::move(series));
    if (figure == SweepFigure::kBytes) break;  // one asset for all renderers
  }
  if (figure == SweepFigure::kBytes)
    for (PlotSeries& series : plot.series) series.name.clear();
  return plot;
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
  head.insert(head.end(), {"ms", "to default", "on disk", "resident"});
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
      row.push_back(numberCell(bytesText(double(point.diskBytes))));
      row.push_back(numberCell(bytesText(double(point.residentBytes))));
      table.add(row, isDefault(point));
    }
  }
  return table.html();
}

std::string sweepPart(const Report& report, const Sweep& sweep) {
  std::string html =
      "<h3>" + escapeMarkup(sweep.knob) + "</h3>\n" + paragraph(sweep.meaning) + "<div class=\"plots\">\n";
  html += drawPlot(sweepPlot(report, sweep, SweepFigure::kError));
  html += drawPlot(sweepPlot(report, sweep, SweepFigure::kTime));
  if (changesBytes(report, sweep)) html += drawPlot(sweepPlot(report, sweep, SweepFigure::kBytes));
  return html + "</div>\n" + sweepTable(report, sweep);
}

// --- Slopes

PlotSeries lineThrough(const std::string& name, PlotLine style, double x0, double y0, double x1, double y1) {
  PlotSeries series{name, {}, style};
  series.hasMarkers = false;
  PlotPoint a, b;
  a.x = x0, a.y = y0, b.x = x1, b.y = y1;
  series.points = {a, b};
  return series;
}

Plot slopePlot(const Slope& slope) {
  Plot plot;
  plot.width = 350;
  plot.height = 250;
  plot.title = slope.what;
  plot.showsTitle = true;
  plot.x.isLogarithmic = plot.y.isLogarithmic = true;
  // "raster: mean error over cutoff"
  const size_t over = slope.what.find(" over "), colon = slope.what.find(": ");
  if (over != std::string::npos) {
    plot.x.label = slope.what.substr(over + 6);
    plot.y.label = slope.what.substr(colon == std::string::npos || colon > over ? 0 : colon + 2,
                                     over - (colon == std::string::npos || colon > over ? 0 : colon + 2));
  }
  PlotSeries measured;
  measured.name = "measured";
  double first = 0, last = 0;
  for (size_t i = 0; i < slope.x.size() && i < slope.y.size(); ++i) {
    PlotPoint point;
    point.x = slope.x[i];
    point.y = slope.y[i];
    point.isHollow = slope.floor > 0 && slope.y[i] <= 2 * slope.floor;
    point.tooltip = fmt::format("{} at {}", shortNumber(point.y), shortNumber(point.x));
    measured.points.push_back(point);
    if (!(point.x > 0) || !(point.y > 0)) continue;
    if (first == 0) first = point.x;
    last = point.x;
  }
  plot.series.push_back(std::move(measured));
  if (!(slope.atOne > 0) || !(last > first)) return plot;
  const auto fitted = [&](double x) { return slope.atOne * std::pow(x, slope.measured); };
  const double middle = std::sqrt(first * last);
  const auto derived = [&](double x) { return fitted(middle) * std::pow(x / middle, slope.expected); };
  plot.series.push_back(lineThrough(fmt::format("slope {:.2f}", slope.measured), PlotLine::kSolid, first,
                                    fitted(first), last, fitted(last)));
  plot.series.push_back(lineThrough("derived " + shortNumber(slope.expected), PlotLine::kDashed, first,
                                    derived(first), last, derived(last)));
  plot.series.back().colour = PlotSeries::kNeutral;
  plot.series[1].colour = 0;
  if (slope.floor > 0) {
    plot.series.push_back(lineThrough("floor", PlotLine::kDotted, first, slope.floor, last, slope.floor));
    plot.series.back().colour = 1;
  }
  return plot;
}

Cell verdictCell(const Slope& slope) {
  const char* kind = slope.verdict == kVerdictAsDerived ? "good"
                     : slope.verdict == kVerdictFloor   ? "fair"
                     : slope.verdict == kVerdictTooFew  ? ""
                                                        : "bad";
  return {fmt::format("<span class=\"badge {}\">{}</span>", kind, escapeMarkup(slope.verdict)), "text"};
}

}  // namespace

std::string frontSections(const Report& report) {
  if (report.points.empty()) return "";
  return frontSection(report, Cost::kTime) + frontSection(report, Cost::kDiskBytes);
}

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

std::string slopesSection(const Report& report) {
  if (report.slopes.empty()) return "";
  Table table({"what", "derived", "measured", "points fitted", "verdict", "note"});
  std::string plots;
  for (const Slope& slope : report.slopes) {
    table.add({textCell(slope.what), numberCell(shortNumber(slope.expected)),
               numberCell(slope.atOne > 0 ? fmt::format("{:.2f}", slope.measured) : "–"),
               numberCell(fmt::format("{} of {}", slope.fitted, slope.x.size())), verdictCell(slope),
               textCell(slope.note)});
    plots += drawPlot(slopePlot(slope));
  }
  return section(
      "slopes", "Convergence and scaling",
      paragraph(
          "Log-log slopes by least squares. Error must fall with a knob's step as derived, down to a floor "
          "that something else sets; a knob whose error does not fall is a fault or a floor. Time is held "
          "against cells and pixels in the same way.") +
          table.html() + "<div class=\"plots\">\n" + plots + "</div>\n");
}

}  // namespace froth
