// One pixel: what its backward pass carries through the cells that its ray met, back to front.
#pragma once

#include <cmath>
#include <cstdint>

#include "shaders/foam/compositing.h"
#include "shaders/foam/compositing_gradient.h"
#include "trainer/step/pixels.h"
#include "trainer/step/ray_cell_gradient.h"

namespace froth {

template <class Real>
struct PixelSettings {
  Real sharpness = 10;       // of detail sites
  Real cutoff = Real(1e-3);  // a ray ends when its transmittance falls below
  Real normalWeight = 0;     // of the normal loss, by pixel: lambda / pixels
  Real perPixel = 0;         // 1 / pixels
};

// What the backward pass of a pixel carries from cell to cell.
template <class Real>
struct PixelAdjoint {
  Real logTransmittance;     // behind the cell that comes next
  Real behind;               // foam::opticalDepthGradient
  glm::vec<3, Real> seed;    // dL/drgb
  glm::vec<4, Real> wanted;  // PixelArrays::wanted
};

// The seeds of one segment, and its weight T alpha; moves the adjoint to before the cell.
template <class Real>
FROTH_HD SegmentSeeds<Real> seedSegment(const SeenCell<Real>& cell, const Segment<Real>& segment,
                                        const PixelSettings<Real>& settings, PixelAdjoint<Real>& adjoint,
                                        Real& weight) {
  const Real opticalDepth = cell.density * (segment.far - segment.near);
  const Real transmittance = std::exp(adjoint.logTransmittance);
  adjoint.logTransmittance += opticalDepth;
  weight = std::exp(adjoint.logTransmittance) * foam::opacity(opticalDepth);
  const Real facing = segment.facing > 0 ? segment.facing : 0;
  const Real shown = glm::dot(adjoint.seed, segment.colour) + settings.normalWeight * facing * facing;
  SegmentSeeds<Real> seeds;
  seeds.opticalDepth = foam::opticalDepthGradient(transmittance, weight, shown, adjoint.behind);
  seeds.colour = weight * adjoint.seed;
  seeds.facing = weight * settings.normalWeight * 2 * facing;
  return seeds;
}

template <class Real>
FROTH_HD PixelAdjoint<Real> beginAdjoint(const PixelArrays<Real>& pixels, size_t pixel) {
  const glm::vec<4, Real> gradient = pixels.gradients[pixel];
  const Real logTransmittance = pixels.logTransmittances[pixel];
  return {logTransmittance, gradient.w * std::exp(logTransmittance), glm::vec<3, Real>(gradient), pixels.wanted[pixel]};
}

// A sink for one thread that owns the sums it adds to.
template <class Real>
struct PlainSink {
  DetailSums<Real>* details;

  FROTH_HD void addColour(uint32_t k, const glm::vec<2, Real>& place, const glm::vec<3, Real>& colour) {
    details[k].place += place;
    details[k].colour += colour;
  }
  FROTH_HD void addHeight(uint32_t k, const glm::vec<2, Real>& place, Real height) {
    details[k].place += place;
    details[k].height += height;
  }
};

}  // namespace froth
