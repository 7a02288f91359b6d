#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "measure/report/report.h"
#include "measure/report/text.h"

namespace froth {
namespace {

// RFC 4180: quoted where it holds a comma, a quote or a line end.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string field(double value) {
  return std::isnan(value) ? "nan" : std::isinf(value) ? (value > 0 ? "inf" : "-inf") : fmt::format("{:.9g}", value);
}

std::string settingsOf(const ReportPoint& point) {
  std::string text;
  for (const Setting& setting : point.settings) {
    text += (text.empty() ? "" : "; ") + setting.knob + "=" + setting.value;
  }
  return text;
}

std::vector<std::string> passNames(const Report& report) {
  std::vector<std::string> names;
  for (const ReportPoint& point : report.points) {
    for (const PassTimes& pass : point.passes) {
      if (std::find(names.begin(), names.end(), pass.pass) == names.end()) names.push_back(pass.pass);
    }
  }
  return names;
}

void append(std::vector<std::string>& row, const ErrorFigures* errors) {
  if (!errors) return void(row.insert(row.end(), 7, ""));
  for (double value : {errors->psnr, errors->ssim, errors->flip, errors->meanError, errors->maxError,
                       errors->overOneStep, errors->distanceError}) {
    row.push_back(field(value));
  }
}

std::string joined(const std::vector<std::string>& row) {
  std::string line;
  for (size_t i = 0; i < row.size(); ++i) line += (i ? "," : "") + row[i];
  return line + "\n";
}

}  // namespace

std::string reportAsCsv(const Report& report) {
  const std::vector<std::string> passes = passNames(report);
  std::vector<std::string> head{"id",
                                "renderer",
                                "settings",
                                "psnr",
                                "ssim",
                                "flip",
                                "meanError",
                                "maxError",
                                "overOneStep",
                                "distanceError",
                                "photoPsnr",
                                "photoSsim",
                                "photoFlip",
                                "photoMeanError",
                                "photoMaxError",
                                "photoOverOneStep",
                                "photoDistanceError",
                                "msMedian",
                                "msP5",
                                "msP95",
                                "diskBytes",
                                "residentBytes",
                                "wholePsnr",
                                "wholeMaxError",
                                "drawnBytes",
                                "viewBytes",
                                "drawnCells",
                                "bakeSeconds",
                                "onTimeFront",
                                "onBytesFront",
                                "chosen"};
  for (const std::string& pass : passes) head.push_back(field("ms " + pass));
  std::string csv = joined(head);
  for (const ReportPoint& point : report.points) {
    std::vector<std::string> row{field(point.id), field(point.renderer), field(settingsOf(point))};
    append(row, &point.errors);
    append(row, point.photoErrors ? &*point.photoErrors : nullptr);
    for (double value : {point.total.median, point.total.p5, point.total.p95}) row.push_back(field(value));
    row.push_back(std::to_string(point.diskBytes));
    row.push_back(std::to_string(point.residentBytes));
    row.push_back(point.wholeErrors ? field(point.wholeErrors->psnr) : "");
    row.push_back(point.wholeErrors ? field(point.wholeErrors->maxError) : "");
    for (uint64_t count : {point.drawnBytes, point.viewBytes, point.drawnCells}) row.push_back(std::to_string(count));
    row.push_back(field(point.bakeSeconds));
    row.push_back(holds(report.frontOverTime, point.id) ? "1" : "0");
    row.push_back(holds(report.frontOverBytes, point.id) ? "1" : "0");
    row.push_back(point.id == report.chosen ? "1" : "0");
    for (const std::string& name : passes) {
      const auto pass =
          std::find_if(point.passes.begin(), point.passes.end(), [&](const PassTimes& p) { return p.pass == name; });
      row.push_back(pass == point.passes.end() ? "" : field(pass->time.median));
    }
    csv += joined(row);
  }
  return csv;
}

}  // namespace froth
