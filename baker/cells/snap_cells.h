// Snaps a foam to the lattices of its asset, before anything is built on its numbers.
#pragma once

#include "baker/cells/cells.h"
#include "foam/foam.h"
#include "format/quantization.h"

namespace froth {

// All cells of the foam.
BakeCells snapCells(const Foam& foam, const Quantization& lattices);

// A snapped face: frame of the cell and its detail sites in that frame.
struct SnappedFace {
  glm::vec4 orientation;
  FaceFrame<double> from, to;  // frames before and after
  bool isTurned;               // whether they can differ
};
SnappedFace snapFace(const glm::vec4& orientation, const Quantization& lattices);

// A detail site (u, v) [radii] of the old frame, in the new one and on the lattice of `step`.
glm::vec2 snapDetailSite(const SnappedFace& face, glm::vec2 detailSite, float step);

}  // namespace froth
