#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "measure/report/report.h"
#include "measure/report/text.h"

namespace froth {
namespace {

constexpr size_t kLeastPoints = 3;  // a line through two is no evidence
// Measured slopes this far from the derived one, relative to it, are still it: the range of a sweep is a few
// powers of two and its images are finite.
constexpr double kSlopeTolerance = 0.25;
// Below this share of the derived slope, y does not follow x at all.
constexpr double kFlatShare = 0.1;

struct Line {
  double slope = 0, atOne = 0;
};

Line leastSquares(const std::vector<size_t>& which, const std::vector<double>& x, const std::vector<double>& y) {
  double meanX = 0, meanY = 0, xx = 0, xy = 0;
  for (size_t i : which) {
    meanX += std::log(x[i]) / double(which.size());
    meanY += std::log(y[i]) / double(which.size());
  }
  for (size_t i : which) {
    const double dx = std::log(x[i]) - meanX;
    xx += dx * dx;
    xy += dx * (std::log(y[i]) - meanY);
  }
  const double slope = xy / xx;
  return {slope, std::exp(meanY - slope * meanX)};
}

void sortByX(std::vector<double>& x, std::vector<double>& y) {
  std::vector<size_t> order(x.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return x[a] < x[b]; });
  const std::vector<double> oldX = x, oldY = y;
  for (size_t i = 0; i < order.size(); ++i) {
    x[i] = oldX[order[i]];
    y[i] = oldY[order[i]];
  }
}

bool hasSpread(const std::vector<size_t>& which, const std::vector<double>& x) {
  return which.size() >= kLeastPoints && x[which.back()] > x[which.front()];
}

void setLine(Slope& slope, const std::vector<size_t>& which) {
  const Line line = leastSquares(which, slope.x, slope.y);
  slope.measured = line.slope;
  slope.atOne = line.atOne;
  slope.fitted = uint32_t(which.size());
}

bool isAsDerived(const Slope& slope) {
  return std::abs(slope.measured - slope.expected) <= kSlopeTolerance * std::abs(slope.expected);
}

// At least two points share the least y: what sets it is not x, and the law can be read from the others
// alone.
void judgeAboveFloor(Slope& slope, const std::vector<size_t>& above) {
  if (above.size() >= 2 && slope.x[above.back()] > slope.x[above.front()]) setLine(slope, above);
  slope.note = fmt::format("levels off at {}", shortNumber(slope.floor));
  if (above.size() < kLeastPoints) {
    slope.note += fmt::format("; {} of {} points lie above", above.size(), slope.x.size());
  } else if (isAsDerived(slope)) {
    slope.verdict = kVerdictFloor;
  } else {
    slope.verdict = kVerdictOtherOrder;
    slope.note +=
        fmt::format(", and falls to it with the power {:.2f} where {:g} is derived", slope.measured, slope.expected);
  }
}

}  // namespace

Slope fitSlope(const std::string& what, double expected, std::vector<double> x, std::vector<double> y,
               double floorFactor) {
  Slope slope;
  slope.what = what;
  slope.expected = expected;
  const size_t count = std::min(x.size(), y.size());
  x.resize(count);
  y.resize(count);
  sortByX(x, y);
  slope.x = std::move(x);
  slope.y = std::move(y);

  std::vector<size_t> usable, above;  // those with logarithms, and those above the floor
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!(slope.x[i] > 0) || !(slope.y[i] > 0) || !std::isfinite(slope.x[i]) || !std::isfinite(slope.y[i])) continue;
    usable.push_back(i);
    least = std::min(least, slope.y[i]);
    most = std::max(most, slope.y[i]);
  }
  for (size_t i : usable) {
    if (slope.y[i] > floorFactor * least) above.push_back(i);
  }

  slope.verdict = kVerdictTooFew;
  if (!hasSpread(usable, slope.x)) {
    slope.note = fmt::format("{} of {} points have a logarithm; {} are needed", usable.size(), count, kLeastPoints);
    return slope;
  }
  // What the law would make of the range of x: less than the floor's width shows nothing.
  const double derivedRatio = std::pow(slope.x[usable.back()] / slope.x[usable.front()], std::abs(expected));
  if (derivedRatio < floorFactor * floorFactor) {
    setLine(slope, usable);
    slope.note = fmt::format("x spans too little: derived to change by a factor of {} only", shortNumber(derivedRatio));
    return slope;
  }

  setLine(slope, usable);
  if (most <= floorFactor * least || slope.measured * expected <= kFlatShare * expected * expected) {
    slope.verdict = kVerdictDoesNotFall;
    slope.note = fmt::format("between {} and {} over the whole range", shortNumber(least), shortNumber(most));
    return slope;
  }
  if (isAsDerived(slope)) {  // down to the last point: no floor in sight
    slope.verdict = kVerdictAsDerived;
    return slope;
  }
  if (usable.size() - above.size() >= 2) {
    slope.floor = least;
    judgeAboveFloor(slope, above);
    return slope;
  }
  slope.verdict = kVerdictOtherOrder;
  slope.note = fmt::format("changes with the power {:.2f} where {:g} is derived", slope.measured, expected);
  return slope;
}

const Setting& placeOnSweep(const Sweep& sweep, const ReportPoint& point) {
  const auto found = std::find_if(point.settings.begin(), point.settings.end(),
                                  [&](const Setting& setting) { return setting.knob == sweep.knob; });
  return found == point.settings.end() ? sweep.base : *found;
}

Slope fitConvergence(const std::vector<ReportPoint>& points, const Sweep& sweep, const std::string& renderer) {
  std::vector<double> steps, errors;
  for (const ReportPoint& point : points) {
    const bool isOfSweep = std::find(sweep.points.begin(), sweep.points.end(), point.id) != sweep.points.end();
    if (point.renderer != renderer || !isOfSweep) continue;
    const double number = placeOnSweep(sweep, point).number;
    steps.push_back(sweep.isBits ? std::exp2(-number) : number);
    errors.push_back(point.errors.meanError);
  }
  return fitSlope(renderer + ": mean error over " + (sweep.isBits ? "step of " : "") + sweep.knob, sweep.expectedOrder,
                  std::move(steps), std::move(errors));
}

}  // namespace froth
