// What a checkpoint may hold that no foam can: each is written as one and imported.
#include <fmt/format.h>

#include <limits>

#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

constexpr uint32_t kDamaged = 5;  // the cell that is

StiffCase imported(const std::string& name, const std::string& what, const std::string& analysis, Foam foam) {
  StiffCase stiff{name, what, analysis, std::move(foam), outsideViews()};
  stiff.isImported = true;
  return stiff;
}

StiffCase withQuaternions(const std::string& name, const std::string& what, float length, const std::string& analysis) {
  Foam foam = foamOfCells(cloud(32, 81));
  for (size_t i = kDamaged; i < foam.orientations.size(); i += 5) foam.orientations[i] *= length;
  return imported(name, what, analysis, std::move(foam));
}

// The tensor by the name that it has in a checkpoint, and where its floats begin for a cell.
struct Tensor {
  const char* name;
  float* (*of)(Foam& foam, uint32_t cell);
};

const Tensor kTensors[] = {
    {"points", [](Foam& foam, uint32_t cell) { return &foam.sites[cell].y; }},
    {"radii", [](Foam& foam, uint32_t cell) { return &foam.radii[cell]; }},
    {"density", [](Foam& foam, uint32_t cell) { return &foam.densities[cell]; }},
    {"quaternions", [](Foam& foam, uint32_t cell) { return &foam.orientations[cell].z; }},
    {"texel_sites", [](Foam& foam, uint32_t cell) { return &foam.detailSites[cell * kCaseDetails + 1].y; }},
    {"texel_height", [](Foam& foam, uint32_t cell) { return &foam.detailHeights[cell * kCaseDetails + 2]; }},
    {"texel_sv_axis",
     [](Foam& foam, uint32_t cell) { return &foam.lobeAxes[(cell * kCaseDetails + 1) * kCaseLobes].x; }},
    {"texel_sv_rgb",
     [](Foam& foam, uint32_t cell) { return &foam.lobeColours[(cell * kCaseDetails + 3) * kCaseLobes].z; }},
};

StiffCase withValue(const Tensor& tensor, const std::string& kind, float value) {
  Foam foam = foamOfCells(cloud(32, 82));
  *tensor.of(foam, kDamaged) = value;
  StiffCase stiff =
      imported(fmt::format("input/{}_{}", tensor.name, kind), fmt::format("{} in tensor '{}'", kind, tensor.name),
               "It never comes to an image: the importer names tensor and cell.", std::move(foam));
  const std::string found =
      std::string(tensor.name) == "quaternions" && kind != "denormal" ? "the quaternion of cell 5" : "cell 5";
  stiff.refusal = fmt::format("tensor '{}': {} ", tensor.name, found);
  return stiff;
}

}  // namespace

std::vector<StiffCase> inputCases() {
  std::vector<StiffCase> cases = {
      withQuaternions("input/quaternion_0", "a fifth of the quaternions are 0", 0,
                      "No direction follows from it; the importer says which cell."),
      withQuaternions("input/quaternion_1e-20", "a fifth of the quaternions have the length 1e-20", 1e-20f,
                      "The importer normalises in double, where the square of 1e-20 is a number like any other.")};
  cases.front().refusal = "tensor 'quaternions': the quaternion of cell 5 has length 0";
  for (const Tensor& tensor : kTensors) {
    cases.push_back(withValue(tensor, "nan", std::numeric_limits<float>::quiet_NaN()));
    cases.push_back(withValue(tensor, "infinity", std::numeric_limits<float>::infinity()));
    cases.push_back(withValue(tensor, "denormal", 1e-40f));
    if (std::string(tensor.name) == "density") {
      // Its raw value is an ordinary number.
      cases.back().what = "a density that activates to a denormal number";
      cases.back().analysis = "It becomes 0: a density below the smallest normal number shows nothing at any size.";
      cases.back().refusal.clear();
    }
  }
  return cases;
}

}  // namespace froth
