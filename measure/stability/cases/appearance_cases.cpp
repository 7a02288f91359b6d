// Displacements, detail sites and colours at their limits.
#include <cmath>

#include <fmt/format.h>

#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

StiffCase changed(const std::string& name, const std::string& what, const std::string& analysis,
                  void (*change)(Foam& foam, size_t detail)) {
  Foam foam = foamOfCells(cloud(32, 61));
  for (size_t detail = 0; detail < foam.detailSites.size(); ++detail) change(foam, detail);
  return {name, what, analysis, std::move(foam), outsideViews()};
}

StiffCase displaced() {
  return changed("appearance/displacement", "displacements of 3, -3 and 100 radii, also within one face",
                 "Heights are blended where the ray meets the undisplaced face: the steeper they are, the more an "
                 "error of that point "
                 "moves the displaced one.",
                 [](Foam& foam, size_t detail) {
                   const float heights[] = {3, -3, 0.1f, 100};
                   foam.detailHeights[detail] = heights[(detail + detail / 7) % 4];
                 });
}

StiffCase inOnePoint() {
  return changed("appearance/one_point", "all detail sites of a face in one point",
                 "All weights are equal: colour and height are plain means.", [](Foam& foam, size_t detail) {
                   foam.detailSites[detail] = {0.25f, -0.125f};
                 });
}

StiffCase underflowing() {
  return changed(
      "appearance/underflow", "detail sites 1.8 to 3 radii away: sums of weights around and below the floor of 1e-20",
      "Below the floor a colour fades as exp(-10 x^2), whose relative error is 20 x eps: small beside the colour.",
      [](Foam& foam, size_t detail) {
        const float away = 1.8f + 0.4f * static_cast<float>(detail / 4 % 4);
        foam.detailSites[detail] = {detail % 2 == 0 ? away : -away, detail % 4 < 2 ? away : -away};
      });
}

StiffCase withTemperature(const std::string& name, float temperature, const std::string& analysis) {
  Foam foam = foamOfCells(cloud(32, 62));
  for (glm::vec3& axis : foam.lobeAxes) axis = glm::normalize(axis) * temperature;
  return {name, fmt::format("lobes of temperature {}", temperature), analysis, std::move(foam), outsideViews()};
}

StiffCase withColours(const std::string& name, const std::string& what, const std::string& analysis, float scale) {
  Foam foam = foamOfCells(cloud(32, 63));
  for (size_t lobe = 0; lobe < foam.lobeColours.size(); ++lobe) {
    foam.lobeColours[lobe] *= lobe / 16 % 2 == 0 ? scale : 1.0f;
  }
  return {name, what, analysis, std::move(foam), outsideViews()};
}

}  // namespace

std::vector<StiffCase> appearanceCases() {
  return {
      displaced(),
      inOnePoint(),
      underflowing(),
      withTemperature("appearance/temperature_0", 0, "Lobes without an axis weigh the same from everywhere."),
      withTemperature("appearance/temperature_1e-6", 1e-6f, "Weights differ by 1e-6: nearly plain means."),
      withTemperature(
          "appearance/temperature_1e4", 1e4f,
          "One lobe wins within 1e-4 of a border, where its share turns with 1e4 times the error of the direction."),
      withColours("appearance/bright", "colours up to 50,000", "Errors are relative to the colour.", 1e5f),
      withColours("appearance/beyond_half", "colours up to 5e6, beyond half precision",
                  "A detail site's colour ends at 65504, the largest half, in all renderers.", 1e7f)};
}

}  // namespace froth
