// Which values each knob is turned to, and what law its error should follow.
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "baker/bake/lattices.h"
#include "measure/sweep/config.h"

namespace froth {
namespace {

using Numbers = std::vector<double>;

Knob knobOf(const char* name, const char* meaning, const char* unit, const Numbers& numbers,
            const std::function<void(ReportConfig&, double)>& apply) {
  Knob knob;
  knob.sweep.knob = name;
  knob.sweep.meaning = meaning;
  knob.sweep.unit = unit;
  for (double number : numbers) {
    knob.values.push_back(
        {fmt::format("{:g}", number), number, [apply, number](ReportConfig& config) { apply(config, number); }});
  }
  return knob;
}

Knob logarithmic(Knob knob) {
  knob.sweep.isLogarithmic = true;
  return knob;
}

// A lattice of steps 2^-bits around the exact asset. The mean absolute error falls with the first power of the step:
// smooth parts change in proportion to it, and edges move by it, so that as many pixels change wholly.
Knob convergence(Knob knob) {
  knob.sweep.knob += ", all else exact";
  knob.sweep.isBits = true;
  knob.sweep.expectedOrder = 1;
  knob.isConvergence = true;
  return knob;
}

using Bits = uint32_t BakeKnobs::*;

Knob bitsOf(const char* name, const char* meaning, Bits member, const Numbers& numbers) {
  return knobOf(name, meaning, "bits", numbers,
                [member](ReportConfig& config, double bits) { config.knobs.*member = static_cast<uint32_t>(bits); });
}

struct Lattice {
  const char* name;
  const char* meaning;
  Bits member;
  Numbers around, refined;  // around the default; all else exact
  const char* attribute;
  std::function<double(double bits, const Foam&)> mostError;
};

double halfStep(double bits) { return 0.5 * std::exp2(-bits); }

// A site lies within half a step of its place along each axis.
double mostErrorOfSites(double bits, const Foam& foam) {
  BakeKnobs knobs;
  knobs.positionBits = static_cast<uint32_t>(bits);
  return std::sqrt(3.0) * 0.5 * makeLattices(foam, knobs).positionStep;
}

// Half a step along both axes of the octahedron's square, which spans 2 of 2^bits - 2 steps, moves a point of a side by
// sqrt(6) of it, and a side's middle is 1 / sqrt(3) from the centre.
double mostErrorOfNormals(double bits, const Foam&) { return std::sqrt(18.0) * 0.5 / (std::exp2(bits - 1) - 1); }

double mostErrorOfNumbers(double bits, const Foam&) { return halfStep(bits); }

double mostErrorOfDetailSites(double bits, const Foam&) { return std::sqrt(2.0) * halfStep(bits); }

std::vector<Lattice> lattices() {
  return {
      {"positionBits",
       "Positions, of the scene's largest extent",
       &BakeKnobs::positionBits,
       {12, 15, 18, 21},
       {10, 12, 14, 16, 18, 20},
       "sites",
       mostErrorOfSites},
      {"radiusBits",
       "Mantissa of radii",
       &BakeKnobs::radiusBits,
       {7, 9, 11, 14},
       {4, 6, 8, 10, 12, 14},
       "radii",
       mostErrorOfNumbers},
      {"densityBits",
       "Mantissa of densities",
       &BakeKnobs::densityBits,
       {2, 4, 7},
       {1, 2, 4, 6, 8, 10},
       "densities",
       mostErrorOfNumbers},
      {"frameBits",
       "Octahedral normals, per axis",
       &BakeKnobs::frameBits,
       {8, 10, 12},
       {6, 8, 10, 12, 14},
       "normals",
       mostErrorOfNormals},
      {"detailSiteBits",
       "Detail sites, below one radius",
       &BakeKnobs::detailSiteBits,
       {6, 8, 10},
       {3, 5, 7, 9, 11},
       "detail sites",
       mostErrorOfDetailSites},
      {"heightBits",
       "Heights, below one radius",
       &BakeKnobs::heightBits,
       {5, 7, 9},
       {3, 5, 7, 9, 11},
       "detail heights",
       mostErrorOfNumbers},
  };
}

Knob presetKnob() {
  Knob knob;
  knob.sweep.knob = "preset";
  knob.sweep.meaning = "Named sets of all encoding knobs";
  double index = 0;
  for (const char* name : {"small", "default", "high", "exact"}) {
    knob.values.push_back({name, index++, [name](ReportConfig& config) { config.knobs = *presetKnobs(name); }});
  }
  return knob;
}

Knob steinerKnob() {
  Knob knob;
  knob.sweep.knob = "steiner";
  knob.sweep.meaning = "Cells in empty space that shorten walks";
  knob.method = Method::kWalk;
  knob.values = {{"off", 0, [](ReportConfig& config) { config.steiner = false; }},
                 {"on", 1, [](ReportConfig& config) { config.steiner = true; }}};
  return knob;
}

Knob walkGraphKnob() {
  Knob knob;
  knob.sweep.knob = "walkGraph";
  knob.sweep.meaning = "Neighbours that only walks need";
  knob.values = {{"off", 0, [](ReportConfig& config) { config.walkGraph = config.steiner = false; }},
                 {"on", 1, [](ReportConfig& config) { config.walkGraph = true; }}};
  return knob;
}

std::vector<Knob> colourKnobs() {
  std::vector<Knob> knobs;
  knobs.push_back(logarithmic(knobOf(
      "errorBound", "RMS error that a lobe must take away to be kept", "display-coded", {0.01, 0.014, 0.02, 0.03},
      [](ReportConfig& c, double v) { c.knobs.appearance.errorBound = static_cast<float>(v); })));
  knobs.push_back(knobOf("lobes", "Most lobes kept per detail site", "", {0, 2, 4, 8},
                         [](ReportConfig& c, double v) { c.knobs.appearance.lobeLimit = static_cast<uint32_t>(v); }));
  knobs.push_back(knobOf("colourBits", "Lattice of colours, 2^-bits", "bits", {4, 5, 6}, [](ReportConfig& c, double v) {
    c.knobs.appearance.colourStep = static_cast<float>(std::exp2(-v));
  }));
  knobs.push_back(
      knobOf("codebook", "Entries of the codebook of lobe axes", "", {0, 2048, 8192},
             [](ReportConfig& c, double v) { c.knobs.appearance.codebookSize = static_cast<uint32_t>(v); }));
  knobs.push_back(knobOf("lobeAxisStep", "Lattice of lobe axes", "", {0, 0.25, 0.5},
                         [](ReportConfig& c, double v) { c.knobs.appearance.lobeAxisStep = static_cast<float>(v); }));
  return knobs;
}

Knob cutoffKnob(Method method) {
  Knob knob = logarithmic(knobOf("cutoff", "A ray ends below this transmittance", "",
                                 {1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1},
                                 [](ReportConfig& c, double v) { c.cutoff = static_cast<float>(v); }));
  knob.method = method;
  return knob;
}

}  // namespace

std::vector<Knob> encodingKnobs() {
  std::vector<Knob> knobs{presetKnob()};
  for (const Lattice& lattice : lattices()) {
    knobs.push_back(bitsOf(lattice.name, lattice.meaning, lattice.member, lattice.around));
  }
  for (Knob& knob : colourKnobs()) knobs.push_back(std::move(knob));
  knobs.push_back(knobOf("detailSites", "Detail sites kept per cell, those with the largest shares of its face", "",
                         {1, 2, 4}, [](ReportConfig& c, double v) { c.detailsKept = static_cast<uint32_t>(v); }));
  knobs.push_back(steinerKnob());
  knobs.push_back(walkGraphKnob());
  for (const Lattice& lattice : lattices()) {
    Knob knob = convergence(bitsOf(lattice.name, lattice.meaning, lattice.member, lattice.refined));
    knob.attribute = lattice.attribute;
    knob.mostError = lattice.mostError;
    knobs.push_back(std::move(knob));
  }
  return knobs;
}

std::vector<Knob> drawingKnobs(bool walks) {
  std::vector<Knob> knobs{cutoffKnob(Method::kRaster)};
  // No more than the cut-off of a ray's colour is lost, and only of rays that reach it: first power.
  const auto refined = [](Method method) {
    Knob knob = cutoffKnob(method);
    knob.sweep.knob += ", all else exact";
    knob.sweep.expectedOrder = 1;
    knob.isConvergence = true;
    return knob;
  };
  knobs.push_back(refined(Method::kRaster));
  knobs.push_back(knobOf("layers", "1: a colour per cell; 2: detail; 3: view dependence", "", {1, 2, 3},
                         [](ReportConfig& c, double v) { c.layers = static_cast<uint32_t>(v); }));
  knobs.push_back(
      logarithmic(knobOf("pixelSize", "Pixels of the output per pixel drawn, along a side; bilinear between", "pixels",
                         {1, 1.5, 2, 3, 4}, [](ReportConfig& c, double v) { c.pixelSize = v; })));
  if (!walks) return knobs;
  knobs.push_back(cutoffKnob(Method::kWalk));
  knobs.push_back(refined(Method::kWalk));
  Knob steps = logarithmic(knobOf("maxSteps", "Steps after which a walk ends", "steps", {8, 16, 32, 64, 128, 256},
                                  [](ReportConfig& c, double v) { c.maxSteps = static_cast<uint32_t>(v); }));
  steps.method = Method::kWalk;
  knobs.push_back(steps);
  return knobs;
}

std::vector<Knob> levelKnobs(uint64_t floorBytes, uint64_t wholeBytes) {
  constexpr double kMega = 1e6;
  Knob detail = logarithmic(knobOf("detail", "Levels of detail: errors may be 1 / detail pixels large", "",
                                   {1.0 / 64, 1.0 / 32, 1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 1, 2, 4},
                                   [](ReportConfig& c, double v) { c.streaming.detail = static_cast<float>(v); }));
  detail.values.push_back({"all cells", 8, [](ReportConfig& c) { c.streaming.detail = kAllCells; }});
  Numbers budgets;
  const double floor = static_cast<double>(floorBytes) / kMega, whole = static_cast<double>(wholeBytes) / kMega;
  for (const double share : {1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 1.0}) {
    budgets.push_back(std::ceil((floor + share * (whole - floor)) * 100) / 100);
  }
  Knob budget = logarithmic(
      knobOf("budget", "Levels of detail: device memory for all of Froth; what the views want most comes first", "MB",
             budgets, [](ReportConfig& c, double v) { c.streaming.budget = static_cast<uint64_t>(v * kMega); }));
  budget.values.push_back({"no limit", 2 * budgets.back(), [](ReportConfig& c) { c.streaming.budget = 0; }});
  return {detail, budget};
}

}  // namespace froth
