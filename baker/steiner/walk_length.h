// How many cells rays cross on their way, and how long that takes: the walk of shaders/walk.comp on the CPU,
// in float, with the transmittance of plain faces and no colours. Steiner cells are there to make these
// numbers smaller.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "foam/cell_graph.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

// The cells of a walk; all spans [cells].
struct WalkCells {
  std::span<const glm::vec3> sites;  // [scene units]
  std::span<const float> radii;      // [scene units, > 0]
  std::span<const float> densities;  // [1 / scene unit, >= 0]
  std::span<const glm::vec4> faces;  // face normal and its mean height [scene units]; empty: all of a ball is solid
};

// The faces of a foam's cells: normals, and displacement as the mean of a cell's detail heights.
std::vector<glm::vec4> meanFaces(const Foam& foam);

// A ray and what it does not meet: live cells within `nearRatio` radii of its origin, or less deep than
// `nearDepth` along `forward` (docs/FOAM.md "Near cells"). 0 switches a limit off.
struct WalkRay {
  glm::vec3 origin, direction, forward;  // directions of unit length
  float nearRatio = 0, nearDepth = 0;
};

// Rays through the pixels of views on a grid of about `raysPerView` cells, jittered by `seed`; view after
// view in blocks that lie close together. A view's own near limits win over the given ones.
std::vector<WalkRay> raysOfViews(std::span<const View> views, uint32_t raysPerView, double nearRatio, double nearDepth,
                                 uint64_t seed);

struct WalkLength {
  uint64_t rays = 0;
  uint64_t steps = 0;       // cells crossed, until transmittance falls below 1e-3 or the ray leaves the foam
  uint64_t neighbours = 0;  // looked at on the way
  double seconds = 0;       // processor time of the walks alone, without the search for first cells

  double meanSteps() const { return rays > 0 ? static_cast<double>(steps) / rays : 0; }
};

// `graph` is that of the regular triangulation of the same cells. Counts are the same on any number of
// threads.
WalkLength measureWalkLength(const WalkCells& cells, const CellGraph& graph, std::span<const WalkRay> rays);

}  // namespace froth
