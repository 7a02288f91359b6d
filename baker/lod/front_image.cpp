#include "baker/lod/front_image.h"

#include "baker/lod/draw_segments.h"

namespace froth {
namespace {

FrontImage drawView(const ReferenceRenderer::State& state, std::span<const uint32_t> owners, const View& view,
                    const FrontOptions& options) {
  const ViewCells<float> cells = prepareShownCells(state, view, options.nearRatio, options.nearDepth);
  std::vector<uint32_t> ownerOfRank(cells.cells.size(), kNoOwner);
  for (uint32_t cell = 0; cell < state.foam.cellCount; ++cell) {
    if (cells.rankOf[cell] != ViewCells<float>::kNotDrawn) ownerOfRank[cells.rankOf[cell]] = owners[cell];
  }
  const size_t pixels = size_t{view.width} * view.height;
  FrontImage image{std::vector<glm::vec3>(pixels, glm::vec3(0)), std::vector<uint32_t>(pixels, kNoOwner),
                   std::vector<float>(pixels, 0.0f)};
  drawSegments(state, cells, view, [&](size_t pixel, const PrimaryRay<float>& ray, const auto& composite) {
    float most = 0;
    const auto keepStrongest = [&](const RaySegment<float>& segment) {
      if (segment.weight <= most) return;
      most = segment.weight;
      image.owners[pixel] = ownerOfRank[segment.rank];
      image.distances[pixel] = glm::length(cells.cells[segment.rank].centre - ray.offset);
    };
    image.colours[pixel] = composite(keepStrongest).colour;
  });
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
