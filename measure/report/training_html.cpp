#include "measure/report/training_html.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/image/formats.h"
#include "measure/report/fill_template.h"
#include "measure/report/html_parts.h"
#include "measure/report/shrink_image.h"
#include "measure/report/svg_plot.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kPairWidth = 960;  // [pixels] most
constexpr uint32_t kPairGap = 8;
constexpr int kCurveWidth = 540, kCurveHeight = 300;

Json curveOf(const TrainingReport& report, const char* label, double (*valueOf)(const TrainingPoint&)) {
  Plot plot;
  plot.title = fmt::format("{} over seconds", label);
  plot.x.label = "steps took [s]";
  plot.y.label = label;
  plot.width = kCurveWidth;
  plot.height = kCurveHeight;
  PlotSeries curve;
  curve.line = "solid";
  for (const TrainingPoint& point : report.points) {
    PlotPoint drawn{point.seconds, valueOf(point)};
    drawn.tooltip = fmt::format("{} steps, {:.1f} s: {:.2f}", point.steps, point.seconds, drawn.y);
    curve.points.push_back(drawn);
  }
  plot.series.push_back(curve);
  return layOutPlot(plot);
}

void pasteAt(Image& target, uint32_t left, const Image& image) {
  for (uint32_t y = 0; y < image.height; ++y) {
    std::copy_n(image.pixel(0, y), size_t{3} * image.width, target.pixel(left, y));
  }
}

}  // namespace

std::string trainingAsHtml(const TrainingReport& report) {
  const TrainingPoint& last = report.points.back();
  const bool hasTests = last.psnr > 0;
  Json page{{"title", report.title}, {"isRunning", report.position < 1}};
  page["now"] = {{"steps", last.steps}, {"seconds", last.seconds},        {"cells", last.cells},
                 {"psnr", last.psnr},   {"share", 100 * report.position}, {"hasTests", hasTests}};
  page["plots"] = Json::array();
  if (hasTests) page["plots"].push_back(curveOf(report, "PSNR [dB]", [](const TrainingPoint& p) { return p.psnr; }));
  page["plots"].push_back(curveOf(report, "cells", [](const TrainingPoint& p) { return double(p.cells); }));
  page["pictures"] = picturesAsJson(report.pictures);
  return fillTemplate("training.html", page);
}

Result<ReportImage> makePair(std::string title, std::string caption, const Image& left, const Image& right) {
  const Image parts[] = {shrinkToWidth(left, kPairWidth / 2), shrinkToWidth(right, kPairWidth / 2)};
  Image pair{parts[0].width + kPairGap + parts[1].width, std::max(parts[0].height, parts[1].height), 3, {}};
  pair.values.assign(size_t{3} * pair.width * pair.height, 1.0f);
  pasteAt(pair, 0, parts[0]);
  pasteAt(pair, parts[0].width + kPairGap, parts[1]);
  Result<std::vector<uint8_t>> png = encodePng(pair, title);
  if (!png) return png.error();
  return ReportImage{std::move(title), std::move(caption), std::move(*png)};
}

}  // namespace froth
