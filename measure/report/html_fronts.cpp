// The sections of report.html on fronts: error over milliseconds and over bytes.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "measure/report/html_parts.h"
#include "measure/report/svg_plot.h"

namespace froth {
namespace {

bool holds(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

// What was not timed was measured for its slope alone.
bool isCandidate(const ReportPoint& point, const std::vector<std::string>& front) {
  return isTimed(point) || holds(front, point.id);
}

PlotPoint frontPoint(const Report& report, const ReportPoint& point, Cost cost,
                     const std::vector<std::string>& front, const ByteUnit& unit) {
  PlotPoint drawn;
  drawn.y = point.errors.psnr;
  if (cost == Cost::kTime) {
    drawn.x = point.total.median;
    drawn.xLow = point.total.p5;
    drawn.xHigh = point.total.p95;
  } else {
    drawn.x = double(point.diskBytes) / unit.bytes;
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

// Fronts are what the eye shall go to: points far worse than all of them would press them together.
double lowestDrawn(const Report& report, const std::vector<std::string>& front) {
  constexpr double kBelowFronts = 6;  // [dB]
  double lowest = std::numeric_limits<double>::infinity();
  for (const ReportPoint& point : report.points) {
    const bool counts = isDefault(point) || point.id == report.chosen || holds(front, point.id);
    if (counts) lowest = std::min(lowest, point.errors.psnr);
  }
  return lowest - kBelowFronts;
}

Plot frontPlot(const Report& report, Cost cost, const std::vector<std::string>& front) {
  double largest = 0;
  for (const ReportPoint& point : report.points) largest = std::max(largest, double(point.diskBytes));
  const ByteUnit unit = unitOfBytes(largest);
  Plot plot;
  plot.title = cost == Cost::kTime ? "Error over milliseconds" : "Error over bytes";
  plot.x = {cost == Cost::kTime ? std::string("time of a frame [ms], 5th to 95th percentile")
                                : fmt::format("size on disk [{}]", unit.name),
            true,
            {},
            {},
            {}};
  plot.y.label = "PSNR [dB], up is better";
  plot.width = 1080;
  plot.height = 460;
  const double lowest = lowestDrawn(report, front);
  if (std::any_of(report.points.begin(), report.points.end(), [&](const ReportPoint& point) {
        return isCandidate(point, front) && point.errors.psnr < lowest;
      })) {
    plot.y.from = lowest;
  }
  for (const std::string& renderer : renderersOf(report)) {
    std::vector<const ReportPoint*> points;
    PlotSeries drawn{renderer, {}}, line;
    for (const ReportPoint& point : report.points) {
      if (point.renderer == renderer && isCandidate(point, front)) points.push_back(&point);
    }
    std::stable_sort(points.begin(), points.end(), [&](const ReportPoint* a, const ReportPoint* b) {
      return rankOf(report, *a, front) < rankOf(report, *b, front);
    });
    for (const ReportPoint* point : points)
      drawn.points.push_back(frontPoint(report, *point, cost, front, unit));
    for (const std::string& id : front) {
      const ReportPoint* point = findPoint(report, id);
      if (point && point->renderer == renderer)
        line.points.push_back(frontPoint(report, *point, cost, front, unit));
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
  const auto countWhere = [&](const auto& holdsFor) {
    return std::count_if(report.points.begin(), report.points.end(), holdsFor);
  };
  const double lowest = lowestDrawn(report, front);
  const auto equal = countWhere(
      [&](const ReportPoint& point) { return isCandidate(point, front) && std::isinf(point.errors.psnr); });
  const auto below = countWhere(
      [&](const ReportPoint& point) { return isCandidate(point, front) && point.errors.psnr < lowest; });
  if (below > 0)
    body += paragraph(
        fmt::format("{} points with less than {} dB lie below the drawing.", below, decibels(lowest)));
  if (equal > 0)
    body += paragraph(
        fmt::format("{} points equal the reference and have no place on the axis of decibels.", equal));
  body += frontTable(report, cost, front);
  return cost == Cost::kTime ? section("time", "Error over milliseconds", body)
                             : section("bytes", "Error over bytes", body);
}

}  // namespace

std::string frontSections(const Report& report) {
  if (report.points.empty()) return "";
  return frontSection(report, Cost::kTime) + frontSection(report, Cost::kDiskBytes);
}

}  // namespace froth
