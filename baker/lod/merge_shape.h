// The shape of a merged cell: site, radius, face. Internal to baker/lod.
#pragma once

#include <array>

#include <glm/glm.hpp>

#include "baker/lod/solid_samples.h"
#include "foam/foam.h"

namespace froth {

// One of the two cells that become one.
struct MergePart {
  uint32_t cell = 0;
  glm::dvec3 offset{0};  // of its site from the pair's origin, the first site
  double weight = 0;     // share of what both show; the two sum to 1
  CellSamples samples;
};
using MergeParts = std::array<MergePart, 2>;

struct MergedShape {
  glm::dvec3 site{0};  // from the pair's origin [scene units]
  double radius = 0;
  double opticalVolume = 0;  // density times solid volume of both [scene units squared]
  FaceFrame<double> frame;
};

// keepsPlain: the merged face is plain, so the site lies on the mean of both faces.
MergedShape mergeShape(const Foam& cells, const MergeParts& parts, bool keepsPlain);

}  // namespace froth
