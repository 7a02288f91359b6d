#include <algorithm>
#include <cmath>

#include "measure/report/report.h"

namespace froth {
namespace {

// Errors this close are one error: nobody sees a hundredth of a decibel, and a front of such steps would hide
// the real ones.
constexpr double kSameDecibels = 0.01;

struct PricedPoint {
  const ReportPoint* point;
  double psnr;  // in whole steps of kSameDecibels
  Interval cost;
};

Interval costOf(const ReportPoint& point, Cost cost) {
  if (cost == Cost::kTime) return point.total;
  const double bytes = double(point.diskBytes);
  return {bytes, bytes, bytes};
}

}  // namespace

bool isTie(const Interval& a, const Interval& b) { return a.p5 <= b.p95 && b.p5 <= a.p95; }

std::vector<std::string> paretoFront(const std::vector<ReportPoint>& points, const std::string& renderer, Cost cost) {
  std::vector<PricedPoint> candidates;
  for (const ReportPoint& point : points) {
    const Interval spent = costOf(point, cost);
    if (point.renderer != renderer || std::isnan(point.errors.psnr) || !(spent.median > 0)) continue;
    candidates.push_back({&point, std::round(point.errors.psnr / kSameDecibels), spent});
  }
  // From the least error on, each that is surely cheaper than the last one kept. So no two of the front tie
  // in cost.
  std::stable_sort(candidates.begin(), candidates.end(), [](const PricedPoint& a, const PricedPoint& b) {
    return a.psnr != b.psnr ? a.psnr > b.psnr : a.cost.median < b.cost.median;
  });
  std::vector<std::string> front;
  const PricedPoint* last = nullptr;
  for (const PricedPoint& candidate : candidates) {
    if (last && !(candidate.cost.p95 < last->cost.p5)) continue;
    front.push_back(candidate.point->id);
    last = &candidate;
  }
  std::reverse(front.begin(), front.end());
  return front;
}

}  // namespace froth
