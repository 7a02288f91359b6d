#include "baker/cells/snap_cells.h"

#include <numeric>

namespace froth {

BakeCells snapCells(const Foam& foam, const Quantization& lattices) {
  BakeCells cells;
  cells.sites.resize(foam.cellCount);
  cells.radii.resize(foam.cellCount);
  cells.densities.resize(foam.cellCount);
  cells.sources.resize(foam.cellCount);
  cells.isUnseen.assign(foam.cellCount, 0);
  std::iota(cells.sources.begin(), cells.sources.end(), 0u);
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    // Always a float: beyond 2^24 steps from the world's origin floats are coarser than the grid, and lie on it
    // already.
    for (int axis = 0; axis < 3; ++axis) {
      cells.sites[cell][axis] = static_cast<float>(snapToStep(double{foam.sites[cell][axis]}, lattices.positionStep));
    }
    cells.radii[cell] = roundMantissa(foam.radii[cell], lattices.radiusBits);
    cells.densities[cell] = roundMantissa(foam.densities[cell], lattices.densityBits);
  }
  return cells;
}

SnappedFace snapFace(const glm::vec4& orientation, const Quantization& lattices) {
  SnappedFace face{orientation, faceFrame<double>(orientation), {}, lattices.normalBits > 0};
  if (face.isTurned) {
    face.orientation = orientationOfNormal(normalIndices(face.from.normal, lattices.normalBits), lattices.normalBits);
  }
  face.to = faceFrame<double>(face.orientation);
  return face;
}

glm::vec2 snapDetailSite(const SnappedFace& face, glm::vec2 detailSite, float step) {
  if (face.isTurned) {
    const glm::dvec3 offset = double{detailSite.x} * face.from.tangent + double{detailSite.y} * face.from.bitangent;
    detailSite = glm::vec2(glm::dot(offset, face.to.tangent), glm::dot(offset, face.to.bitangent));
  }
  return {snapToStep(detailSite.x, step), snapToStep(detailSite.y, step)};
}

}  // namespace froth
