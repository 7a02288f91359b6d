#include "baker/lod/contributions.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "baker/lod/detail_sharpness.h"
#include "baker/lod/shrink_view.h"
#include "reference/render/reference_state.h"

namespace froth {
namespace {

constexpr float kShownCutoff = 1e-3f;        // of the runtime
constexpr float kShownFixedPoint = 0x1p28f;  // sums are integers: their order does not matter

}  // namespace

Result<std::vector<double>> measureContributions(const Foam& foam, std::span<const View> views,
                                                 const ContributionOptions& options, const Progress& progress) {
  Foam plain = foam;  // colours are not asked for
  plain.lobeCount = 0;
  plain.lobeAxes.clear();
  plain.lobeColours.clear();
  plain.lobeOffsets.clear();
  const ReferenceRenderer renderer(plain, progress);
  const ReferenceRenderer::State& state = renderer.state();
  if (state.cechPairs.offsets.empty()) return stoppedOnRequest("contributions");
  const RaySettings<float> settings{kShownCutoff, -std::numeric_limits<float>::infinity(),
                                    static_cast<float>(kTrainedSharpness)};
  std::vector<uint64_t> sums(foam.cellCount, 0);
  for (size_t v = 0; v < views.size(); ++v) {
    if (!report(progress, "contributions", v, views.size())) return stoppedOnRequest("contributions");
    const View view = shrinkView(views[v], options.pixelsPerView);
    ReferenceOptions reference;
    reference.nearRatio = view.nearRatio.value_or(options.nearRatio);
    reference.nearDepth = view.nearDepth.value_or(options.nearDepth);
    const ViewCells<float> cells = prepareViewCells<float>(plain, state.cechPairs, state.visible, view, reference);
    std::vector<uint64_t> seen(cells.cells.size(), 0);
    const ViewRays rays(view);
    const Status drawn = renderRows(view.height, {}, [&](uint32_t y) {
      std::vector<BallHit<float>> hits;
      for (uint32_t x = 0; x < view.width; ++x) {
        const std::optional<ViewRay> exact = rays.ofPixel(x, y);
        if (!exact) continue;
        const PrimaryRay<float> primary{exact->offset, exact->direction};
        gatherHits(state.tree, cells, eyeOf(view) + exact->offset, primary, INFINITY, hits);
        compositeHits(cells, primary, settings, hits, [&](const RaySegment<float>& segment) {
          std::atomic_ref<uint64_t>(seen[segment.rank])
              .fetch_add(static_cast<uint64_t>(kShownFixedPoint * segment.weight), std::memory_order_relaxed);
        });
      }
    });
    if (!drawn) return drawn.error();
    for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
      if (cells.rankOf[cell] != ViewCells<float>::kNotDrawn) sums[cell] += seen[cells.rankOf[cell]];
    }
  }
  std::vector<double> contributions(foam.cellCount);
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    contributions[cell] = double(sums[cell]) / double{kShownFixedPoint};
  }
  return contributions;
}

}  // namespace froth
