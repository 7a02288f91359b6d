// A foam as seen from one eye, or along one direction: what all rays of a view share, computed once per cell and view.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "foam/cell_graph.h"
#include "foam/foam.h"
#include "reference/camera/view_rays.h"
#include "reference/render/reference.h"

namespace froth {

// All positions are relative to the eye: double(p) - eye, and only then rounded to Real.
template <class Real>
struct ViewCell {
  glm::vec<3, Real> centre;
  Real radius, inverseRadius;
  Real density;
  FaceFrame<Real> frame;
  // relative, of the distances at which a ray enters and leaves: ReferenceOptions::rounding
  Real nearError = 0, farError = 0;
  uint64_t planesBegin, planesEnd;  // in ViewCells::planes
};

// Radical plane towards a neighbour; shaders/foam/cell.h has its meaning.
template <class Real>
struct ViewPlane {
  glm::vec<3, Real> toNeighbour;
  Real clearance;
};

template <class Real>
struct ViewDetail {
  glm::vec<2, Real> place;   // (u, v) [radii]
  Real height;               // [scene units]
  glm::vec<3, Real> colour;  // as seen from the eye, display-coded
};

template <class Real>
struct ViewCells {
  static constexpr uint32_t kNotDrawn = UINT32_MAX;

  std::vector<ViewCell<Real>> cells;  // by rank: front to back for every ray through the eye
  std::vector<uint32_t> rankOf;       // [foam cells] place in `cells`, or kNotDrawn
  std::vector<ViewPlane<Real>> planes;
  std::vector<ViewDetail<Real>> details;  // [cells * detailCount]
  uint32_t detailCount = 0;

  std::span<const ViewDetail<Real>> detailsOf(uint32_t rank) const {
    return {&details[size_t{rank} * detailCount], detailCount};
  }
  std::span<const ViewPlane<Real>> planesOf(const ViewCell<Real>& cell) const {
    return std::span(planes).subspan(cell.planesBegin, cell.planesEnd - cell.planesBegin);
  }
};

// Cells that can show: of coincident sites only the one with the largest radius, then the lowest index,
// exists; cells without density only cut.
std::vector<uint32_t> findVisibleCells(const Foam& foam);

// Draws those of `candidates` that pass the near tests, which are not applied to an orthographic view; `nearDepth` not
// to lenses that look behind themselves either. Every Cech neighbour cuts, drawn or not.
template <class Real>
ViewCells<Real> prepareViewCells(const Foam& foam, const CellGraph& cechPairs, std::span<const uint32_t> candidates,
                                 const View& view, const ReferenceOptions& options);

}  // namespace froth
