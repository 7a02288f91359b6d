#include "measure/sweep/slopes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace froth {
namespace {

constexpr uint32_t kMaxCells = 500'000;  // of the most copies, unless the foam alone has more
constexpr uint32_t kMaxCopies = 16;
constexpr uint32_t kOutsideViews = 4;
// What a half float loses of a colour below one: detail sites are kept in halves between the passes
// (shaders/shade_details.comp).
constexpr double kHalfRounding = 0x1p-12;
constexpr double kMoreThanNoise = 1.05;
constexpr double kFixedCost = 1;  // fitSlope's factor: no floor is cut off

// What a ray loses at a cut-off is at most that much of a colour, which seldom is above two; a slope alone would not
// see a cut-off that is off by a factor. Edges that rounding moves are in the images of every cut-off, the first and
// smallest too.
void checkCutoffs(PointList& points, const Sweep& sweep, Slope& slope) {
  constexpr double kLargestColour = 2;
  const double rounding = points.at(sweep.points.front()).point.errors.maxError + 2 * kHalfRounding;
  for (const std::string& id : sweep.points) {
    const ReportPoint& point = points.at(id).point;
    const double cutoff = placeOnSweep(sweep, point).number;
    if (point.errors.maxError <= rounding + kLargestColour * cutoff) continue;
    slope.verdict = kVerdictOverBound;
    slope.note = fmt::format("a largest error of {:.3g} at a cut-off of {:g}", point.errors.maxError, cutoff);
    return;
  }
}

// A lattice that is coarser than asked for has the right slope; what tells it is the largest error of the values that
// the bake stored.
Status checkLattice(const Bench& bench, const Foam& foam, const Knob& knob, PointList& points, const Sweep& sweep,
                    Slope& slope) {
  constexpr double kFloatRounding = 0x1p-8;  // of the bound: floats near a tie may go either way
  for (const std::string& id : sweep.points) {
    const PlannedPoint& planned = points.at(id);
    const Result<BakeRecord> record = bench.bakes.recordOf(planned.config);
    if (!record) return record.error();
    const auto found = record->largestErrors.find(knob.attribute);
    const double bits = placeOnSweep(sweep, planned.point).number;
    const double most = knob.mostError(bits, foam);
    if (found != record->largestErrors.end() && found->second <= most * (1 + kFloatRounding)) continue;
    const double error = found == record->largestErrors.end() ? NAN : found->second;
    slope.verdict = kVerdictOverBound;
    slope.note =
        fmt::format("{} off by {:.3g} at {:g} bits, where half a step is {:.3g}", knob.attribute, error, bits, most);
    return {};
  }
  return {};
}

// Views from a ring around the box, at 1.65 times half of its longest side from its middle: half of a foam of copies is
// in view.
std::vector<View> viewsFromOutside(const Foam& foam, const View& like) {
  glm::dvec3 low(foam.sites[0]), high(foam.sites[0]);
  for (const glm::vec3& site : foam.sites) {
    low = glm::min(low, glm::dvec3(site));
    high = glm::max(high, glm::dvec3(site));
  }
  const glm::dvec3 middle = 0.5 * (low + high), size = high - low;
  const double distance = 1.65 * 0.5 * std::max({size.x, size.y, size.z});
  std::vector<View> views;
  for (uint32_t i = 0; i < kOutsideViews; ++i) {
    const double angle = (i + 0.5) * 2 * std::numbers::pi / kOutsideViews;
    const glm::dvec3 forward(std::cos(angle), 0, std::sin(angle)), right(forward.z, 0, -forward.x), down(0, 1, 0);
    const glm::dvec3 eye = middle - distance * forward;
    View view = like;
    view.lens = {};
    view.fx = view.fy = 0.9 * like.width;
    view.cx = 0.5 * like.width;
    view.cy = 0.5 * like.height;
    view.nearRatio = view.nearDepth = 0;
    for (int row = 0; row < 3; ++row) {
      const double values[4] = {right[row], down[row], forward[row], eye[row]};
      std::copy(values, values + 4, view.worldFromCamera.begin() + 4 * row);
    }
    views.push_back(view);
  }
  return views;
}

Slope timeSlope(const std::string& what, const std::vector<double>& x, const std::vector<double>& y) {
  Slope slope = fitSlope(what, 1, x, y, kFixedCost);
  if (slope.verdict != kVerdictTooFew) {
    slope.verdict = slope.measured <= 1.15 ? kVerdictAsDerived : kVerdictOtherOrder;
    slope.note = slope.measured <= 1.15 ? "at most in proportion; below it by what does not grow along"
                                        : "grows faster than in proportion";
  }
  for (size_t i = 0; i + 1 < slope.y.size(); ++i) {
    if (slope.y[i] > kMoreThanNoise * slope.y[i + 1]) {
      slope.note += fmt::format("; {:.3g} takes longer than {:.3g}", slope.x[i], slope.x[i + 1]);
    }
  }
  return slope;
}

}  // namespace

Result<std::vector<Slope>> errorSlopes(const Bench& bench, const Foam& foam, const std::vector<Knob>& knobs,
                                       const std::vector<Sweep>& sweeps, PointList& points) {
  std::vector<ReportPoint> measured;
  for (const PlannedPoint& planned : points.all()) measured.push_back(planned.point);
  std::vector<Slope> slopes;
  for (size_t i = 0; i < sweeps.size(); ++i) {
    const Sweep& sweep = sweeps[i];
    if (sweep.expectedOrder == 0) continue;
    const std::string renderer = points.at(sweep.points.front()).point.renderer;
    Slope slope = fitConvergence(measured, sweep, renderer);
    if (renderer != "cpu" && slope.floor > 0 && slope.floor < kHalfRounding) {
      slope.note += "; half-float colours of detail sites between the passes";
    }
    if (sweep.knob.starts_with("cutoff")) checkCutoffs(points, sweep, slope);
    if (knobs[i].mostError) {
      if (Status checked = checkLattice(bench, foam, knobs[i], points, sweep, slope); !checked) return checked.error();
    }
    slopes.push_back(std::move(slope));
  }
  return slopes;
}

namespace {

Status addPixelSlopes(const Bench& bench, std::vector<Slope>& slopes, const Progress& progress) {
  for (const MethodInfo& info : kMethods) {
    if (info.method == Method::kWalk && !bench.walks) continue;
    std::vector<Draw> draws;
    std::vector<double> pixels, times;
    for (const double pixelSize : {4.0, 2.0, 1.0, 0.5}) {
      ReportConfig config = defaultConfig();
      config.method = info.method;
      config.pixelSize = pixelSize;
      draws.push_back(drawOf(bench, config));
      pixels.push_back(double{1} * draws.back().views[0].width * draws.back().views[0].height);
    }
    const Result<std::vector<DrawTimes>> measured = bench.renderer.time(draws, bench.rounds, progress);
    if (!measured) return measured.error();
    for (const DrawTimes& one : *measured) times.push_back(one.total.median);
    slopes.push_back(timeSlope(fmt::format("{}: ms over pixels", info.name), pixels, times));
  }
  return {};
}

// Bakes one after the other: together they would slow each other down.
Status addCellSlopes(const Bench& bench, const FoamInput& input, std::vector<Slope>& slopes, const Progress& progress) {
  std::vector<Draw> draws;
  std::vector<double> cells, times, bakes;
  for (uint32_t copies = 1; copies <= kMaxCopies && (copies == 1 || copies * input.foam.cellCount <= kMaxCells);
       copies *= 2) {
    ReportConfig config = defaultConfig();
    config.knobs = exactConfig().knobs;  // compressed colours only add what grows with the cells
    config.copies = copies;
    config.hasCameras = false;
    if (Status done = bench.bakes.bake({&config, 1}, progress); !done) return done;
    const Result<BakeRecord> record = bench.bakes.recordOf(config);
    if (!record) return record.error();
    Draw draw = drawOf(bench, config);
    const Result<FoamInput> baked = loadFoam(draw.asset, {}, 1);
    if (!baked) return baked.error();
    cells.push_back(baked->foam.cellCount);
    bakes.push_back(record->seconds);
    draw.views = viewsFromOutside(baked->foam, bench.views[0].view);
    draws.push_back(std::move(draw));
  }
  const Result<std::vector<DrawTimes>> measured = bench.renderer.time(draws, bench.rounds, progress);
  if (!measured) return measured.error();
  for (const DrawTimes& one : *measured) times.push_back(one.total.median);
  slopes.push_back(timeSlope("raster: ms over cells", cells, times));
  slopes.push_back(timeSlope("bake: s over cells", cells, bakes));
  return {};
}

}  // namespace

Result<std::vector<Slope>> timeSlopes(const Bench& bench, const FoamInput& input, bool hasFoam,
                                      const Progress& progress) {
  std::vector<Slope> slopes;
  if (Status added = addPixelSlopes(bench, slopes, progress); !added) return added.error();
  if (!hasFoam) return slopes;
  if (Status added = addCellSlopes(bench, input, slopes, progress); !added) return added.error();
  return slopes;
}

}  // namespace froth
