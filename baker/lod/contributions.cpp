#include "baker/lod/contributions.h"

#include <atomic>

#include "baker/lod/draw_segments.h"
#include "baker/lod/shrink_view.h"

namespace froth {
namespace {

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
  std::vector<uint64_t> sums(foam.cellCount, 0);
  for (size_t v = 0; v < views.size(); ++v) {
    if (!report(progress, "contributions", v, views.size())) return stoppedOnRequest("contributions");
    const View view = shrinkView(views[v], options.pixelsPerView);
    const ViewCells<float> cells = prepareShownCells(state, view, options.nearRatio, options.nearDepth);
    std::vector<uint64_t> seen(cells.cells.size(), 0);
    drawSegments(state, cells, view, [&](size_t, const PrimaryRay<float>&, const auto& composite) {
      composite([&](const RaySegment<float>& segment) {
        std::atomic_ref<uint64_t>(seen[segment.rank])
            .fetch_add(static_cast<uint64_t>(kShownFixedPoint * segment.weight), std::memory_order_relaxed);
      });
    });
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
