// Several foams in one image. Along a ray each gives disjoint intervals of constant density and colour; they are merged
// by distance, and where some overlap their densities add and each colour counts by its share of the density.
#pragma once

#include <span>

#include <glm/gtc/quaternion.hpp>

#include "reference/render/reference.h"

namespace froth {

// World from foam: scale, then rotation, then position.
struct PlacedFoam {
  const ReferenceRenderer* renderer = nullptr;  // of the foam; not owned
  glm::dvec3 position{0};
  glm::dquat rotation{1, 0, 0, 0};  // unit length
  double scale = 1;
};

// In double precision, whatever `options` say; its lengths are in world units, its near tests apply to each foam. A ray
// that is cut off ends where its transmittance is `cutoff`, also within a cell. Fails as
// ReferenceRenderer::render does.
Result<RenderedImages> renderMerged(std::span<const PlacedFoam> foams, const View& view,
                                    const ReferenceOptions& options, const Progress& progress = {});

}  // namespace froth
