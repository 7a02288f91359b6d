#include <algorithm>
#include <array>

#include "measure/report/report.h"

namespace froth {
namespace {

constexpr std::array kWanted{38.0, 42.0, 46.0};  // [dB]

bool isOfLevels(const ReportPoint& point) {
  const auto turnsLevels = [](const Setting& one) { return one.knob == "detail" || one.knob == "budget"; };
  return point.renderer == "raster" && point.wholeErrors && point.settings.size() <= 1 &&
         std::all_of(point.settings.begin(), point.settings.end(), turnsLevels);
}

}  // namespace

std::vector<const ReportPoint*> levelPoints(const Report& report) {
  std::vector<const ReportPoint*> points;
  for (const ReportPoint& point : report.points) {
    if (isOfLevels(point)) points.push_back(&point);
  }
  return points;
}

std::vector<LevelNeed> levelNeeds(const Report& report) {
  const std::vector<const ReportPoint*> points = levelPoints(report);
  std::vector<LevelNeed> needs;
  if (points.empty()) return needs;
  for (const double psnr : kWanted) {
    LevelNeed need{psnr};
    for (const ReportPoint* point : points) {
      if (point->wholeErrors->psnr < psnr) continue;
      if (!need.point || point->drawnBytes < need.point->drawnBytes) need.point = point;
    }
    needs.push_back(need);
  }
  return needs;
}

}  // namespace froth
