#include "baker/lod/front_image.h"

#include <cmath>
#include <limits>

#include "baker/lod/detail_sharpness.h"
#include "reference/render/reference_state.h"

namespace froth {
namespace {

constexpr float kFrontCutoff = 1e-3f;  // of the runtime

FrontImage drawView(const ReferenceRenderer::State& state, std::span<const uint32_t> owners, const View& view,
                    const FrontOptions& options) {
  ReferenceOptions reference;
  reference.nearRatio = view.nearRatio.value_or(options.nearRatio);
  reference.nearDepth = view.nearDepth.value_or(options.nearDepth);
  const ViewCells<float> cells = prepareViewCells<float>(state.foam, state.cechPairs, state.visible, view, reference);
  std::vector<uint32_t> ownerOfRank(cells.cells.size(), kNoOwner);
  for (uint32_t cell = 0; cell < state.foam.cellCount; ++cell) {
    if (cells.rankOf[cell] != ViewCells<float>::kNotDrawn) ownerOfRank[cells.rankOf[cell]] = owners[cell];
  }
  const RaySettings<float> settings{kFrontCutoff, -std::numeric_limits<float>::infinity(),
                                    static_cast<float>(kTrainedSharpness)};
  const size_t pixels = size_t{view.width} * view.height;
  FrontImage image{std::vector<glm::vec3>(pixels, glm::vec3(0)), std::vector<uint32_t>(pixels, kNoOwner),
                   std::vector<float>(pixels, 0.0f)};
  const ViewRays rays(view);
  const Status drawn = renderRows(view.height, {}, [&](uint32_t y) {
    std::vector<BallHit<float>> hits;
    for (uint32_t x = 0; x < view.width; ++x) {
      const std::optional<ViewRay> exact = rays.ofPixel(x, y);
      if (!exact) continue;
      const PrimaryRay<float> primary{exact->offset, exact->direction};
      gatherHits(state.tree, cells, eyeOf(view) + exact->offset, primary, INFINITY, hits);
      const size_t pixel = size_t{y} * view.width + x;
      float most = 0;
      const auto keepStrongest = [&](const RaySegment<float>& segment) {
        if (segment.weight <= most) return;
        most = segment.weight;
        image.owners[pixel] = ownerOfRank[segment.rank];
        image.distances[pixel] = glm::length(cells.cells[segment.rank].centre - primary.offset);
      };
      image.colours[pixel] = compositeHits(cells, primary, settings, hits, keepStrongest).colour;
    }
  });
  static_cast<void>(drawn);  // without progress nothing asks it to stop
  return image;
}

}  // namespace

Result<std::vector<FrontImage>> drawFront(const Foam& foam, std::span<const uint32_t> owners,
                                          std::span<const View> views, const FrontOptions& options,
                                          const Progress& progress) {
  const ReferenceRenderer renderer(foam, progress);
  if (renderer.state().cechPairs.offsets.empty()) return stoppedOnRequest("level errors");
  std::vector<FrontImage> images;
  for (const View& view : views) {
    if (!report(progress, "level errors", images.size(), views.size())) return stoppedOnRequest("level errors");
    images.push_back(drawView(renderer.state(), owners, view, options));
  }
  return images;
}

}  // namespace froth
