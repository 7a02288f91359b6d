// What rays from anywhere cost, of `froth bench --rays`: the rays of a view's pixels, and those that start where they
// were stopped.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/percentiles.h"
#include "base/progress.h"
#include "base/result.h"
#include "measure/gpu/gpu_renderer.h"
#include "reference/capture/view_selection.h"

namespace froth {

struct RayBenchOptions {
  float cutoff = 1e-3f;
  uint32_t frames = 20;  // of each kind and view
};

// Of display-coded premultiplied colours, against those of the same rays as they are seen.
struct ColourError {
  double squares = 0, largest = 0;
  uint64_t values = 0;

  double psnr() const;  // infinite where there is none
};

// Rays of a kind, over all views.
struct RayFigures {
  std::string kind;
  uint64_t rays = 0;                           // of all views
  std::vector<std::vector<double>> viewTimes;  // [ms] by view and frame
  FrothWalkStatus work{};                      // sums; of a device that counts
  std::optional<ColourError> error;            // of base colours
};

// The kinds in the order in which they are cast: transmittance, closest, radiance from the camera; radiance mirrored at
// every surface that the closest met; transmittance from there to a far light. Each radiance also in base colours.
Result<std::vector<RayFigures>> benchRays(GpuRenderer& renderer, const std::vector<SelectedView>& views,
                                          const RayBenchOptions& options, const Progress& progress);

Percentiles timesOf(const RayFigures& figures);  // [ms] of a view: means over the views

void printRays(const std::vector<RayFigures>& figures, bool isCounting);
nlohmann::ordered_json raysAsJson(const std::vector<RayFigures>& figures, bool isCounting);

}  // namespace froth
