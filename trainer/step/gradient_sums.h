// What the rays of a view add up for its cells, between the backward pass and the optimizer. By rank, details by
// rank * K + k, pairs by the place of their plane in SeenCells::planes.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "trainer/step/host_device.h"

namespace froth {

template <class Real>
struct CellSums {
  glm::vec<3, Real> site{0};
  Real radius = 0;
  glm::vec<3, Real> torque{0};  // in the face frame (shaders/foam/clip_face_gradient.h)
  Real density = 0;
  Real contribution = 0;  // sum over pixels of T alpha / pixels
  Real error = 0;         // sum over pixels of T alpha |own colour - photo|_1 / pixels
};

template <class Real>
struct DetailSums {
  glm::vec<2, Real> place{0};
  Real height = 0;  // by the height in scene units
  glm::vec<3, Real> colour{0};
};

// Whether some pixel shows the cell. Where none does all sums are 0: its parameters wait.
template <class Real>
FROTH_HD bool isShown(const CellSums<Real>& sums) {
  return sums.contribution > 0;
}

template <class Real>
FROTH_HD CellSums<Real>& operator+=(CellSums<Real>& sums, const CellSums<Real>& more) {
  sums.site += more.site;
  sums.radius += more.radius;
  sums.torque += more.torque;
  sums.density += more.density;
  sums.contribution += more.contribution;
  sums.error += more.error;
  return sums;
}

template <class Real>
FROTH_HD DetailSums<Real>& operator+=(DetailSums<Real>& sums, const DetailSums<Real>& more) {
  sums.place += more.place;
  sums.height += more.height;
  sums.colour += more.colour;
  return sums;
}

template <class Real>
FROTH_HD CellSums<Real> scaled(const CellSums<Real>& sums, Real factor) {
  return {factor * sums.site,    factor * sums.radius,       factor * sums.torque,
          factor * sums.density, factor * sums.contribution, factor * sums.error};
}

template <class Real>
FROTH_HD DetailSums<Real> scaled(const DetailSums<Real>& sums, Real factor) {
  return {factor * sums.place, factor * sums.height, factor * sums.colour};
}

template <class Real>
struct GradientSums {
  CellSums<Real>* cells;
  DetailSums<Real>* details;
  glm::vec<4, Real>* pairs;  // foam::planeGradient
  uint32_t* droppedCount;    // [1] contributions that were no finite numbers
};

}  // namespace froth
