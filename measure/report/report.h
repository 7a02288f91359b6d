// What `froth report` has measured of one scene: the input of report.html, report.json and report.csv.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/image/image.h"
#include "base/result.h"

namespace froth {

// Of one image, or the mean over views (worst: the largest over views). Colours display-coded.
struct ErrorFigures {
  double psnr = 0;  // [dB]; +inf: equal. The mean over views is of the squares, not of the decibels
  double ssim = 0;
  double flip = 0;       // mean FLIP [0..1]
  double meanError = 0;  // mean absolute difference: falls with the first power of a step, at edges too
  double maxError = 0;
  double overOneStep = 0;    // share of pixels with a channel off by more than 1/255
  double distanceError = 0;  // median |distance - reference| where both have one [scene units]
};

struct ViewErrors {
  uint32_t view = 0;  // in cameras.json
  ErrorFigures errors;
  uint32_t worstX = 0, worstY = 0;  // the pixel with the largest difference
};

// Milliseconds of a frame, mean over the views; from repeated cycles over them.
struct Interval {
  double median = 0, p5 = 0, p95 = 0;
};
struct PassTimes {
  std::string pass;
  Interval time;  // [ms]
};

// One knob turned away from the default.
struct Setting {
  std::string knob;   // "positionBits"
  std::string value;  // as text: "14", "off"
  double number = 0;  // as a number for axes; the index among the knob's values where it is none
};

// One configuration that was measured.
struct ReportPoint {
  std::string id;                 // "raster positionBits=14": stable, so that an interrupted run can go on
  std::string renderer;           // "raster", "walk", or "cpu"
  std::vector<Setting> settings;  // away from the default; empty: the default itself
  ErrorFigures errors;            // against the double reference of the unquantized foam
  std::optional<ErrorFigures> photoErrors;
  std::optional<ErrorFigures> wholeErrors;  // of an asset with levels of detail: against all of its finest cells
  std::vector<ViewErrors> views;
  Interval total;                 // [ms]
  std::vector<PassTimes> passes;  // empty with --cpu
  uint64_t diskBytes = 0;
  uint64_t residentBytes = 0;  // asset and view on the GPU
  // Most of a view: of the chunks that are drawn, and of the view itself; and cells that can be seen.
  uint64_t drawnBytes = 0, viewBytes = 0, drawnCells = 0;
  double bakeSeconds = 0;  // 0: no bake of its own
};

// A knob, alone, around the default.
struct Sweep {
  std::string knob, meaning;  // "cutoff": "A ray ends below this transmittance"
  std::string unit;           // of Setting::number
  bool isLogarithmic = false;
  // Convergence: the mean error falls as step^order, with step = number, or 2^-number for bits; 0: no such law.
  double expectedOrder = 0;
  bool isBits = false;
  Setting base;  // the knob's place in points whose settings do not name it: the default, where it is among the points
  std::vector<std::string> points;  // ids, by growing number
};

// log-log slope by least squares over the points above the floor.
struct Slope {
  std::string what;  // "raster: mean error over cutoff": y over x
  double expected = 0, measured = 0;
  std::string verdict;       // one of the kVerdict... below
  std::string note;          // names the floor or what is suspected
  std::vector<double> x, y;  // all points, in the order of x
  uint32_t fitted = 0;       // how many of them the slope is of
  double atOne = 0;          // the line: y = atOne x^measured; 0: none could be fitted
  double floor = 0;          // y where it levels off; 0: it does not
};

inline constexpr const char* kVerdictAsDerived = "as derived";
inline constexpr const char* kVerdictFloor = "floor";  // as derived, down to a level that it keeps
inline constexpr const char* kVerdictDoesNotFall = "does not fall";
inline constexpr const char* kVerdictOtherOrder = "other order";  // it falls, by another power
inline constexpr const char* kVerdictTooFew = "too few points";
inline constexpr const char* kVerdictOverBound = "over its bound";  // of the right order, and too large

// Something that the scene does not need, or does not use.
struct FeatureCost {
  std::string feature;  // "displacement"
  bool isUsed = false;  // by this scene as it is
  std::string variant;  // what was measured against: "heights of 2^-20 radii put in", "heights taken out"
  int64_t diskBytes = 0, residentBytes = 0;                   // what the feature costs: with minus without
  Interval rasterWithout, rasterWith, walkWithout, walkWith;  // [ms]
  double psnr = 0;                                            // of taking it out, where it is used
};

// Rays of a kind (measure/bench/ray_bench.h) in the default's asset.
struct RayCost {
  std::string rays;                      // "mirrored, base colours"
  std::string prepared;                  // for them: "nothing", "visibility", "radiance"
  Interval time;                         // [ms] of a view
  uint64_t count = 0;                    // of all views
  uint64_t residentBytes = 0;            // the asset, with what is prepared
  std::optional<double> psnr, maxError;  // of base colours, against the same rays with those that are seen
};

// A picture for report.html.
struct ReportImage {
  std::string title, caption;
  std::vector<uint8_t> png;
};

struct Report {
  std::string scene, input, credit;  // credit: of photos and foam; shown at the foot
  std::string device, driver, version, command;
  uint32_t width = 0, height = 0, frames = 0;
  uint64_t seed = 1;            // of the search, and of the order in each round
  std::vector<uint32_t> views;  // in cameras.json
  uint32_t cells = 0, detailCount = 0, lobeCount = 0;
  bool isLinearTime = true;         // times from GPU timestamps; false: seconds of the CPU renderer
  std::vector<ReportPoint> points;  // the first is the default
  std::vector<Sweep> sweeps;
  std::vector<std::string> frontOverTime, frontOverBytes;  // ids, from cheap to dear
  std::string chosen;                                      // id that the report picks, and why
  std::string choice;
  std::vector<Slope> slopes;
  std::vector<FeatureCost> features;
  std::vector<RayCost> rays;        // by what is prepared; empty: the asset is not walked
  std::vector<ReportImage> images;  // empty with --no-images
  std::vector<std::string> notes;   // what was not measured, and why
};

// What is cheapest in bytes of those whose mean error over the views, against all cells, is small enough.
struct LevelNeed {
  double psnr = 0;                     // [dB] asked for
  const ReportPoint* point = nullptr;  // null: none is good enough
};
std::vector<const ReportPoint*> levelPoints(const Report& report);  // where `detail` or `budget` alone is turned
std::vector<LevelNeed> levelNeeds(const Report& report);            // empty: the asset has no levels

// Images left out. Infinity and NaN, which JSON does not know, are the texts "inf", "-inf" and "nan".
nlohmann::ordered_json reportAsJson(const Report& report);
nlohmann::ordered_json pointAsJson(const ReportPoint& point);
Result<ReportPoint> pointFromJson(const nlohmann::ordered_json& json);  // of `froth report --resume`
std::string reportAsCsv(const Report& report);                          // a row per point
// One self-contained file: no script, font or picture from elsewhere.
std::string reportAsHtml(const Report& report);

// The FLIP map of a view with a frame around its worst pixel, and what is in the frame, enlarged: reference, image,
// difference. Display-coded images of one size.
Result<std::vector<ReportImage>> picturesOfError(const std::string& title, const Image& reference, const Image& test,
                                                 uint32_t worstX, uint32_t worstY);

// Whether noise alone can explain the difference: the intervals overlap.
bool isTie(const Interval& a, const Interval& b);

// Ids of the points that no other beats in both error and cost, from cheap to dear; of ties in cost the one with less
// error.
enum class Cost { kTime, kDiskBytes };
std::vector<std::string> paretoFront(const std::vector<ReportPoint>& points, const std::string& renderer, Cost cost);

// The order in which a round times configurations: shuffled, but with those of a group, which share an asset, one after
// the other. A function of the arguments alone.
std::vector<size_t> orderOfRound(const std::vector<std::string>& groups, uint64_t seed, uint32_t round);

// Where a point stands on a sweep's knob.
const Setting& placeOnSweep(const Sweep& sweep, const ReportPoint& point);

// Fits the slope of y over x in log-log. Points whose y is within `floorFactor` of the smallest y are the floor and
// left out.
inline constexpr double kFloorFactor = 2;
Slope fitSlope(const std::string& what, double expected, std::vector<double> x, std::vector<double> y,
               double floorFactor = kFloorFactor);

// fitSlope of a sweep's mean errors over its steps, for one renderer.
Slope fitConvergence(const std::vector<ReportPoint>& points, const Sweep& sweep, const std::string& renderer);

}  // namespace froth
