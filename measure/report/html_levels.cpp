// The section on levels of detail of report.html: error over time and over bytes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "measure/report/html_parts.h"
#include "measure/report/svg_plot.h"
#include "measure/report/text.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;
using Points = std::vector<const ReportPoint*>;

// By `knob`, and the default, in the order of their x.
PlotSeries seriesOf(const Points& points, const char* knob, double (*x)(const ReportPoint&)) {
  PlotSeries series{knob, {}, "solid"};
  for (const ReportPoint* point : points) {
    if (!point->settings.empty() && point->settings[0].knob != knob) continue;
    PlotPoint drawn{x(*point), point->wholeErrors->psnr};
    drawn.label = point->settings.empty() ? "default" : point->settings[0].value;
    drawn.tooltip = fmt::format("{}: {} dB, largest error {}; {} ms; {} of chunks", settingsText(*point),
                                decibels(point->wholeErrors->psnr), shortNumber(point->wholeErrors->maxError),
                                shortNumber(point->total.median), bytesText(double(point->drawnBytes)));
    drawn.isRinged = point->settings.empty();
    series.points.push_back(drawn);
  }
  std::stable_sort(series.points.begin(), series.points.end(),
                   [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  return series;
}

// All cells themselves have no error and no place on the axis.
Json plotOf(const Points& points, const char* title, const char* label, double (*x)(const ReportPoint&)) {
  Plot plot;
  plot.title = title;
  plot.showsTitle = true;
  plot.x.label = label;
  plot.x.isLogarithmic = true;
  plot.y.label = "PSNR against all cells [dB]";
  plot.width = 530, plot.height = 330;
  for (const char* knob : {"detail", "budget"}) plot.series.push_back(seriesOf(points, knob, x));
  return layOutPlot(plot);
}

Json rowOf(const ReportPoint& point) {
  Json row = pointAsJson(point);
  row["settingsText"] = settingsText(point);
  row["isDefault"] = point.settings.empty();
  row["bytesPerCell"] = shortNumber(double(point.drawnBytes) / std::max(1.0, double(point.drawnCells)));
  return row;
}

}  // namespace

Json levelsOf(const Report& report) {
  const Points points = levelPoints(report);
  if (points.empty()) return nullptr;
  Json levels;
  Points finite = points;
  std::erase_if(finite, [](const ReportPoint* point) { return std::isinf(point->wholeErrors->psnr); });
  const auto milliseconds = [](const ReportPoint& point) { return point.total.median; };
  const auto megabytes = [](const ReportPoint& point) { return double(point.drawnBytes) / 1e6; };
  levels["plots"] = {plotOf(finite, "Error over milliseconds", "time of a frame [ms]", milliseconds),
                     plotOf(finite, "Error over bytes", "chunks that a view draws [MB]", megabytes)};
  for (const ReportPoint* point : points) levels["rows"].push_back(rowOf(*point));
  for (const LevelNeed& need : levelNeeds(report)) {
    levels["needs"].push_back(
        {{"atLeast", fmt::format("{:g}", need.psnr)}, {"row", need.point ? rowOf(*need.point) : Json(nullptr)}});
  }
  return levels;
}

}  // namespace froth
