// What becomes of a cell when others come and go (trainer/loop/cell_plan.h).
#pragma once

#include "shaders/foam/activations.h"
#include "trainer/step/trained_foam.h"

namespace froth {

struct CellChange {
  glm::vec3 shift{0};      // of its site
  float meanFactor = 1;    // of the means that densification goes by
  float radiusFactor = 1;  // its density takes the inverse: a ray through the centre keeps its optical depth
};

// What is activated as 0 stays: no raw value is its inverse.
FROTH_HD void scaleActivated(float& raw, float factor) {
  const float scaled = factor * foam::softplus(raw);
  if (scaled > 0) raw = foam::softplusInverse(scaled);
}

// Its ball is not activated again.
FROTH_HD void changeCell(const TrainedFoam<float>& foam, uint32_t cell, const CellChange& change) {
  float* site = foam.values.row(Parameter::kPoints, foam.shape, cell);
  for (int c = 0; c < 3; ++c) site[c] += change.shift[c];
  foam.contributions[cell] *= change.meanFactor;
  foam.errors[cell] *= change.meanFactor;
  if (change.radiusFactor == 1) return;
  scaleActivated(*foam.values.row(Parameter::kRadii, foam.shape, cell), change.radiusFactor);
  scaleActivated(*foam.values.row(Parameter::kDensity, foam.shape, cell), 1 / change.radiusFactor);
}

}  // namespace froth
