// A foam in training: raw parameters, what Adam knows of them, and which cells overlap. Plain structs of pointers, in
// host or device memory, so that the CPU and CUDA run one text. Whoever executes steps owns the arrays.
//
// Lengths are those of the normalised scene (docs/TRAINING.md). Real is float; tests run the same code in double.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "foam/checkpoint/parameters.h"
#include "trainer/step/host_device.h"

namespace froth {

struct FoamShape {
  uint32_t cellCount = 0;
  uint32_t detailCount = 0;  // K [1..32]
  uint32_t lobeCount = 0;    // M [1..32]
};

// Values of one parameter per cell. Rows of one tensor follow each other, as in a checkpoint.
FROTH_HD uint32_t widthOf(Parameter parameter, const FoamShape& shape) {
  switch (parameter) {
    case Parameter::kPoints:
      return 3;
    case Parameter::kDensity:
    case Parameter::kRadii:
      return 1;
    case Parameter::kOrientations:
      return 4;
    case Parameter::kDetailSites:
      return 2 * shape.detailCount;
    case Parameter::kDetailHeights:
      return shape.detailCount;
    case Parameter::kLobeAxes:
    case Parameter::kLobeColours:
      return 3 * shape.detailCount * shape.lobeCount;
  }
  return 0;
}

// One array per parameter: [cells * widthOf()].
template <class Real>
struct ParameterRows {
  Real* tensors[kParameterCount];

  FROTH_HD Real* row(Parameter parameter, const FoamShape& shape, uint32_t cell) const {
    return tensors[static_cast<size_t>(parameter)] + size_t{cell} * widthOf(parameter, shape);
  }
};

// Points and radii move in every step, for neighbours pull at them. All other parameters of a cell wait while no pixel
// shows it: lastSteps tells since when, and who reads them makes up for it (trained_cell.h).
template <class Real>
struct TrainedFoam {
  FoamShape shape;
  ParameterRows<Real> values, firstMoments, secondMoments;
  uint32_t* lastSteps;       // [cells] the last step (from 1) that waiting parameters stand at; 0: none yet
  glm::vec<4, Real>* balls;  // [cells] site and activated radius at the beginning of the step
  Real* contributions;       // [cells] means over steps, decaying (densification): what pixels show of the cell, ...
  Real* errors;              // [cells] ... and by how much its own colour misses theirs
};

// The Cech pairs with a skin (skin.h), in compressed rows, neighbours ascending. The pair at place e of row i, (i, j),
// stands in row j at place reverses[e].
struct NeighbourRows {
  const uint32_t* offsets;  // [cells + 1]
  const uint32_t* neighbours;
  const uint32_t* reverses;
};

}  // namespace froth
