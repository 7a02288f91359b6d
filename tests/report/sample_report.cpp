#include "tests/report/sample_report.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "base/image/image.h"

namespace froth::test {
namespace {

constexpr int kViews = 13;

// A number of -1..1 that depends on its arguments alone.
double wobble(size_t a, size_t b) {
  uint64_t h = (a + 1) * 0x9E3779B97F4A7C15ull ^ (b + 1) * 0xC2B2AE3D27D4EB4Full;
  h ^= h >> 29;
  h *= 0xBF58476D1CE4E5B9ull;
  h ^= h >> 32;
  return double(h % 20001) / 10000 - 1;
}

Interval around(double value, double noise) { return {value, value * (1 - noise), value * (1 + 1.6 * noise)}; }

ErrorFigures errorsFrom(double meanError) {
  ErrorFigures errors;
  errors.psnr = -20 * std::log10(meanError * 3.2);
  errors.ssim = 1 - meanError * 2;
  errors.flip = std::min(1.0, meanError * 6);
  errors.meanError = meanError;
  errors.maxError = std::min(1.0, meanError * 70);
  errors.overOneStep = std::min(1.0, meanError * 30);
  errors.distanceError = meanError * 0.4;
  return errors;
}

struct Measured {
  double meanError, raster, walk, megabytes;
};

constexpr Measured kDefault{6.1e-4, 1.42, 4.9, 48.2};

ReportPoint makePoint(const std::string& renderer, std::vector<Setting> settings, const Measured& measured,
                      size_t seed) {
  ReportPoint point;
  point.renderer = renderer;
  point.id = renderer;
  for (const Setting& setting : settings) point.id += " " + setting.knob + "=" + setting.value;
  point.settings = std::move(settings);
  const double ms = (renderer == "walk" ? measured.walk : measured.raster) * (1 + 0.004 * wobble(seed, 1));
  point.errors = errorsFrom(measured.meanError * (renderer == "walk" ? 0.93 : 1));
  point.photoErrors = errorsFrom(std::hypot(0.02, measured.meanError));
  point.total = around(ms, 0.012 + 0.006 * std::abs(wobble(seed, 2)));
  const std::vector<std::pair<const char*, double>> passes =
      renderer == "walk" ? std::vector<std::pair<const char*, double>>{{"walk", 0.93}, {"tone", 0.05}}
                         : std::vector<std::pair<const char*, double>>{
                               {"cull", 0.06}, {"shade", 0.17}, {"sort", 0.15}, {"raster", 0.57}, {"tone", 0.03}};
  for (const auto& [pass, share] : passes) point.passes.push_back({pass, around(ms * share, 0.02)});
  point.diskBytes = uint64_t(measured.megabytes * 1e6);
  point.residentBytes = uint64_t(measured.megabytes * 1.9e6 + 44e6);
  point.bakeSeconds = measured.megabytes == kDefault.megabytes ? 0 : 21.5;
  for (uint32_t v = 0; v < kViews; ++v) {
    ViewErrors view{v * 4, errorsFrom(point.errors.meanError * (1 + 0.4 * wobble(v, 3))), 100 + v * 37, 220 + v * 13};
    point.views.push_back(view);
  }
  return point;
}

struct Knob {
  const char *name, *meaning, *unit;
  bool isLogarithmic, isBits;
  double order;
  const char* defaultValue;
  double defaultNumber;
  std::vector<std::pair<const char*, double>> values;  // without the default
  Measured (*measure)(double number);
};

Measured bits(double number, double floor, double defaultBits, double share) {
  Measured m = kDefault;
  m.meanError = std::hypot(floor, kDefault.meanError * 0.7 * std::exp2(defaultBits - number));
  m.megabytes = kDefault.megabytes + share * (number - defaultBits);
  return m;
}

std::vector<Knob> makeKnobs() {
  return {
      {"positionBits",
       "Bits of a site's coordinates within its chunk",
       "bits",
       false,
       true,
       1,
       "14",
       14,
       {{"8", 8}, {"10", 10}, {"12", 12}, {"16", 16}, {"18", 18}},
       [](double n) { return bits(n, 4.4e-4, 14, 0.9); }},
      {"radiusBits",
       "Bits of a radius, in steps of its logarithm",
       "bits",
       false,
       true,
       1,
       "14",
       14,
       {{"10", 10}, {"12", 12}, {"16", 16}},
       [](double n) { return bits(n, 5.5e-4, 14, 0.3); }},
      {"axisBits",
       "Bits of the codebook of lobe axes",
       "bits",
       false,
       true,
       1,
       "10",
       10,
       {{"6", 6}, {"8", 8}, {"12", 12}},
       [](double n) { return bits(n, 5.4e-4, 10, 1.3); }},
      {"colourBits",
       "Bits of a lobe's colour",
       "bits",
       false,
       true,
       1,
       "8",
       8,
       {{"5", 5}, {"6", 6}, {"7", 7}, {"10", 10}},
       [](double n) { return bits(n, 5e-4, 8, 2.2); }},
      {"cutoff",
       "A ray ends below this transmittance",
       "",
       true,
       false,
       1,
       "0.001",
       1e-3,
       {{"0", 0}, {"0.0001", 1e-4}, {"0.003", 3e-3}, {"0.01", 1e-2}, {"0.03", 3e-2}, {"0.1", 1e-1}},
       [](double n) {
         Measured m = kDefault;
         m.meanError = std::hypot(5.8e-4, 0.19 * n);
         const double speed = 1 - 0.07 * std::log10(std::max(n, 3e-5) / 1e-3);
         m.raster *= speed, m.walk *= speed;
         return m;
       }},
      {"lobes",
       "Lobes kept of each detail site",
       "",
       false,
       false,
       0,
       "8",
       8,
       {{"1", 1}, {"2", 2}, {"4", 4}},
       [](double n) {
         Measured m = kDefault;
         m.meanError += 6e-3 * std::pow((8 - n) / 7, 2);
         m.megabytes *= 0.3 + 0.7 * n / 8;
         m.raster *= 0.9 + 0.1 * n / 8;
         return m;
       }},
      {"lodError",
       "Level of detail: error of a merged cell on the screen",
       "pixels",
       true,
       false,
       0,
       "off",
       0,
       {{"0.5", 0.5}, {"1", 1}, {"2", 2}, {"4", 4}},
       [](double n) {
         Measured m = kDefault;
         m.meanError += 1.1e-3 * n;
         m.raster /= 1 + 0.3 * n, m.walk /= 1 + 0.25 * n;
         return m;
       }},
      {"stepLimit",
       "Cells that a ray may visit in the walk",
       "cells",
       true,
       false,
       0,
       "1024",
       1024,
       {{"64", 64}, {"128", 128}, {"256", 256}, {"512", 512}},
       [](double n) {
         Measured m = kDefault;
         m.meanError += 0.03 * std::exp(-n / 45);
         m.walk *= 1 - 0.3 * std::exp(-n / 80);
         return m;
       }},
      {"tileSize",
       "Side of a tile of the rasterizer",
       "pixels",
       true,
       false,
       0,
       "16",
       16,
       {{"8", 8}, {"32", 32}},
       [](double n) {
         Measured m = kDefault;
         m.raster *= n == 8 ? 1.14 : 1.006;
         return m;
       }},
      {"resolutionScale",
       "Pixels drawn for each pixel shown, along a side",
       "",
       false,
       false,
       0,
       "1",
       1,
       {{"0.5", 0.5}, {"0.71", 0.71}, {"1.41", 1.41}},
       [](double n) {
         Measured m = kDefault;
         m.meanError = n < 1 ? 0.012 * (1 - n) + 2e-3 : 4.1e-4;
         m.raster *= 0.35 + 0.65 * n * n, m.walk *= n * n;
         return m;
       }},
      {"steiner",
       "Cells of no density that shorten walks",
       "",
       false,
       false,
       0,
       "on",
       1,
       {{"off", 0}},
       [](double) {
         Measured m = kDefault;
         m.walk *= 1.31;
         m.megabytes *= 0.97;
         return m;
       }},
      {"shading",
       "Precision of shaded colours between passes",
       "",
       false,
       false,
       0,
       "half",
       0,
       {{"float", 1}},
       [](double) {
         Measured m = kDefault;
         m.raster *= 1.004;
         m.meanError *= 0.98;
         return m;
       }},
  };
}

void addSweeps(Report& report) {
  size_t seed = 10;
  for (const Knob& knob : makeKnobs()) {
    Sweep sweep{knob.name, knob.meaning, knob.unit, knob.isLogarithmic, knob.order, knob.isBits, {}, {}};
    sweep.base = {knob.name, knob.defaultValue, knob.defaultNumber};
    sweep.points = {"raster"};
    for (const auto& [value, number] : knob.values) {
      for (const std::string renderer : {"raster", "walk"}) {
        const bool isForOne =
            sweep.knob == "tileSize" ? renderer == "walk" : sweep.knob == "stepLimit" && renderer == "raster";
        const bool isSkipped = renderer == "walk" && (sweep.knob == "radiusBits" || sweep.knob == "axisBits" ||
                                                      sweep.knob == "lobes" || sweep.knob == "shading");
        if (isForOne || isSkipped) continue;
        report.points.push_back(makePoint(renderer, {{knob.name, value, number}}, knob.measure(number), ++seed));
        sweep.points.push_back(report.points.back().id);
      }
    }
    const auto isOfWalk = [](const std::string& id) { return id.starts_with("walk"); };
    const auto firstOfWalk = std::find_if(sweep.points.begin(), sweep.points.end(), isOfWalk);
    if (firstOfWalk != sweep.points.end()) sweep.points.push_back("walk");
    if (sweep.knob == "stepLimit") sweep.points.erase(sweep.points.begin());
    report.sweeps.push_back(sweep);
  }
}

void addJointPoints(Report& report) {
  const std::vector<std::pair<std::vector<Setting>, Measured>> joint{
      {{{"cutoff", "0.003", 3e-3}, {"colourBits", "7", 7}}, {9.4e-4, 1.31, 4.6, 46.1}},
      {{{"lodError", "1", 1}, {"cutoff", "0.01", 1e-2}}, {2.7e-3, 0.97, 3.3, 48.2}},
      {{{"lodError", "2", 2}, {"lobes", "4", 4}, {"cutoff", "0.01", 1e-2}}, {4.6e-3, 0.76, 2.8, 31.4}},
      {{{"positionBits", "16", 16}, {"colourBits", "10", 10}}, {4.2e-4, 1.43, 4.9, 54.4}},
      {{{"axisBits", "8", 8}, {"radiusBits", "12", 12}}, {1.3e-3, 1.42, 4.9, 44.9}}};
  size_t seed = 500;
  for (const auto& [settings, measured] : joint) {
    report.points.push_back(makePoint("raster", settings, measured, ++seed));
  }
}

void addSlopes(Report& report) {
  for (const Sweep& sweep : report.sweeps) {
    if (sweep.expectedOrder != 0) report.slopes.push_back(fitConvergence(report.points, sweep, "raster"));
  }
  report.slopes.push_back(
      fitSlope("raster: mean error over shading step", 1, {1e-4, 1e-3, 1e-2, 1e-1}, {6e-4, 6.1e-4, 5.9e-4, 6e-4}));
  report.slopes.push_back(fitSlope("raster: ms over cells", 1, {1e4, 1e5, 1e6, 1e7}, {0.05, 0.21, 1.9, 18.4}));
  report.slopes.push_back(fitSlope("walk: ms over pixels", 1, {6.4e4, 2.6e5, 1e6, 4.2e6}, {0.31, 1.22, 4.7, 18.9}));
}

void addFeatures(Report& report) {
  for (const auto& [prepared, factor, bytes] : {std::tuple("nothing", 1.0, 6'600'000), {"radiance", 0.5, 28'900'000}}) {
    report.rays.push_back({"camera, transmittance",
                           prepared,
                           around(7.5 * factor, 0.01),
                           2'070'000,
                           static_cast<uint64_t>(bytes),
                           {},
                           {}});
    report.rays.push_back({"mirrored, base colours", prepared, around(17 * factor, 0.01), 1'900'000,
                           static_cast<uint64_t>(bytes), 31.5, 0.7});
  }
  report.features = {{"displacement", true, "heights taken out", 2'100'000, 4'200'000, around(1.35, 0.01),
                      around(1.42, 0.01), around(4.6, 0.01), around(4.9, 0.01), 38.2},
                     {"walk section",
                      false,
                      "neighbours of the walk put in",
                      9'800'000,
                      12'100'000,
                      around(1.42, 0.012),
                      around(1.424, 0.012),
                      {},
                      {},
                      0},
                     {"lobes", true, "one colour a site", 31'000'000, 29'000'000, around(1.21, 0.01),
                      around(1.42, 0.01), around(4.8, 0.02), around(4.9, 0.02), 29.9}};
}

std::vector<ReportImage> makePictures() {
  Image reference{192, 128, 3, {}};
  for (uint32_t y = 0; y < reference.height; ++y) {
    for (uint32_t x = 0; x < reference.width; ++x) {
      for (uint32_t c = 0; c < 3; ++c) {
        reference.values.push_back(float(0.5 + 0.4 * std::sin(x * 0.11 + c) * std::cos(y * 0.08 * (c + 1))));
      }
    }
  }
  Image test = reference;
  for (size_t i = 0; i < test.values.size(); ++i) test.values[i] += float(0.004 * wobble(i, 7));
  for (uint32_t y = 70; y < 76; ++y) {
    for (uint32_t x = 130; x < 150; ++x) test.pixel(x, y)[0] += 0.06f;
  }
  test.pixel(140, 73)[0] += 0.12f;
  return *picturesOfError("Raster, view 16", reference, test, 140, 73);
}

}  // namespace

Report makeSampleReport() {
  Report report;
  report.scene = "sample <foam> & \"quotes\"";
  report.input = "scenes/sample/model.pt";
  report.credit = "Photos: nobody's; all figures of this page are made up by a test.";
  report.device = "No GPU at all";
  report.driver = "made up 1.2.3";
  report.version = "froth 1.0";
  report.command = "froth report scenes/sample/model.pt --cameras cameras.json -o report/";
  report.width = 1319;
  report.height = 989;
  report.frames = 60;
  for (uint32_t v = 0; v < kViews; ++v) report.views.push_back(v * 4);
  report.cells = 499'712;
  report.detailCount = report.lobeCount = 8;
  report.points.push_back(makePoint("raster", {}, kDefault, 1));
  report.points.push_back(makePoint("walk", {}, kDefault, 2));
  addSweeps(report);
  addJointPoints(report);
  for (const std::string renderer : {"raster", "walk"}) {
    for (const std::string& id : paretoFront(report.points, renderer, Cost::kTime)) report.frontOverTime.push_back(id);
  }
  report.frontOverBytes = paretoFront(report.points, "raster", Cost::kDiskBytes);
  report.chosen = "raster cutoff=0.003 colourBits=7";
  report.choice = "The fastest of the front that keeps the test PSNR within 0.05 dB and 100 bytes a cell.";
  addSlopes(report);
  addFeatures(report);
  report.images = makePictures();
  report.notes = {"The walk was measured on 9 of the 12 knobs: the others do not reach it.",
                  "Level of detail <off>: the scene has one level."};
  return report;
}

TrainingReport makeSampleTraining(double position) {
  TrainingReport report;
  report.title = "fox.pt";
  report.position = position;
  for (uint32_t i = 1; i <= 12; ++i) report.points.push_back({100 * i, 3.0 * i * i, 10000 + 900 * i, 27 - 9.0 / i});
  Image photo{1200, 800, 3, {}}, shown{1200, 800, 3, {}};
  for (size_t i = 0; i < size_t{1200} * 800; ++i) {
    const auto shade = static_cast<float>(i % 1200) / 1200;
    photo.values.insert(photo.values.end(), {shade, 0.5f, 0.2f});
    shown.values.insert(shown.values.end(), {shade, 0.4f, 0.2f});
  }
  report.pictures.push_back(*makePair("room/a.jpg", "21.50 dB", photo, shown));
  return report;
}

}  // namespace froth::test
