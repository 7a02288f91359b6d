// What a view sees of a foam, ray by ray, by the float reference: what contributions and the errors of levels measure.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "baker/lod/detail_sharpness.h"
#include "reference/camera/view_rays.h"
#include "reference/render/reference_state.h"

namespace froth {

// nearRatio, nearDepth: where the view does not say.
inline ViewCells<float> prepareShownCells(const ReferenceRenderer::State& state, const View& view, double nearRatio,
                                          double nearDepth) {
  ReferenceOptions options;
  options.nearRatio = view.nearRatio.value_or(nearRatio);
  options.nearDepth = view.nearDepth.value_or(nearDepth);
  return prepareViewCells<float>(state.foam, state.cechPairs, state.visible, view, options);
}

// Calls drawPixel(pixel, ray, composite) for each pixel that has a ray; composite(onSegment) calls onSegment for each
// RaySegment of it, front to back, and returns what the pixel shows. Rows are drawn by several threads.
template <class DrawPixel>
void drawSegments(const ReferenceRenderer::State& state, const ViewCells<float>& cells, const View& view,
                  const DrawPixel& drawPixel) {
  constexpr float kCutoff = 1e-3f;  // of the runtime
  const RaySettings<float> settings{kCutoff, -std::numeric_limits<float>::infinity(),
                                    static_cast<float>(kTrainedSharpness)};
  const ViewRays rays(view);
  const Status drawn = renderRows(view.height, {}, [&](uint32_t y) {
    std::vector<BallHit<float>> hits;
    for (uint32_t x = 0; x < view.width; ++x) {
      const std::optional<ViewRay> exact = rays.ofPixel(x, y);
      if (!exact) continue;
      const PrimaryRay<float> ray{exact->offset, exact->direction};
      gatherHits(state.tree, cells, eyeOf(view) + exact->offset, ray, INFINITY, hits);
      const auto composite = [&](const auto& onSegment) {
        return compositeHits(cells, ray, settings, hits, onSegment);
      };
      drawPixel(size_t{y} * view.width + x, ray, composite);
    }
  });
  static_cast<void>(drawn);  // without progress nothing asks it to stop
}

}  // namespace froth
