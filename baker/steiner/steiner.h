// Steiner cells: cells of zero density that fill empty space, so that walks take fewer and better-shaped
// steps (docs/FOAM.md "Steiner cells"; Govindarajan et al., "Power Foam" (2026)). They never change an image: no
// Steiner ball meets a real one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/progress.h"
#include "base/result.h"
#include "format/quantization.h"
#include "reference/camera/camera.h"

namespace froth {

struct SteinerOptions {
  uint64_t seed = 1;
  const CameraSet* cameras =
      nullptr;  // rays by which cells are chosen; null: random rays between surfaces and from free space
  double nearRatio = 4, nearDepth = 0;  // the asset's defaults: what a primary ray does not meet
  double positionStep = 0;              // cells lie on the asset's lattices (format/quantization.h)
  uint32_t radiusBits = 23;
};

struct SteinerCells {
  std::vector<glm::vec3> sites;  // [cells] [scene units]
  std::vector<float> radii;      // [cells] [scene units, > 0]
  double walkLengthBefore = 0;   // mean steps per ray over the rays by which they were chosen
  double walkLengthAfter = 0;
};

// `sites` and `radii` are those that the asset will hold (already on its lattices), `densities` tell what is
// empty. The same input and options give the same cells on any number of threads. Fails with kCancelled.
Result<SteinerCells> placeSteinerCells(std::span<const glm::vec3> sites, std::span<const float> radii,
                                       std::span<const float> densities, const SteinerOptions& options,
                                       const Progress& progress = {});

}  // namespace froth
