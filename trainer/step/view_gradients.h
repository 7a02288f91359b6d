// A step of several photos. What each photo's view asks of the cells is kept by cell until all have asked; then Adam
// takes the mean, once.
//
// Kept are sums, not the gradients of lobes: those follow from the seed of a detail site and the eye of the view, and
// are found for all views where Adam takes them. So a view keeps 11 + 6 K numbers per cell, of K = M = 8 a seventh of
// all gradients, which is what GPUs send each other.
#pragma once

#include "trainer/step/cell_update.h"

namespace froth {

template <class Real>
struct KeptCell {
  CellSums<Real> sums;  // site and radius: also of its pairs, and of overlaps
  uint32_t isSeen = 0;  // 0: the view does not see the cell, and asks by overlaps alone
};

template <class Real>
struct ViewGradients {
  glm::vec<3, Real> eye;
  KeptCell<Real>* cells;      // [cells]
  DetailSums<Real>* details;  // [cells * K] differentiatePlace(), of the cells that some pixel of the view shows
};

// What a view asks of detail site k; adds what its direction asks of the cell to `cellSums`.
template <class Real>
FROTH_HD DetailSums<Real> differentiateDetail(const TrainedCell<Real>& trained, const SeenCell<Real>& seen,
                                              const SeenDetail<Real>& detail, uint32_t k, const DetailSums<Real>& sums,
                                              CellSums<Real>& cellSums) {
  const LobeSeeds<Real> seeds = seedLobes(seen, detail, sums);
  glm::vec<3, Real> directionSeed(0);
  visitLobes(lobesOfDetail(trained, Parameter::kLobeAxes, k), lobesOfDetail(trained, Parameter::kLobeColours, k),
             trained.foam.shape.lobeCount, seeds,
             [&](uint32_t, const LobeGradient<Real>& gradient) { directionSeed += gradient.direction; });
  return differentiatePlace(trained, seen, detail, k, sums, seeds, directionSeed, cellSums);
}

// What a view asks of a cell. sums: sumsOfCell(), with what its detail sites ask; ball: the whole gradient of its ball.
template <class Real>
FROTH_HD KeptCell<Real> keepCell(const CellSums<Real>* sums, const glm::vec<4, Real>& ball) {
  KeptCell<Real> asked;
  if (sums != nullptr) asked = {*sums, 1};
  asked.sums.site = glm::vec<3, Real>(ball);
  asked.sums.radius = ball.w;
  return asked;
}

template <class Real>
FROTH_HD CellSums<Real> meanOfCell(const ViewGradients<Real>* views, uint32_t viewCount, uint32_t cell) {
  CellSums<Real> sum;
  for (uint32_t i = 0; i < viewCount; ++i) sum += views[i].cells[cell].sums;
  return scaled(sum, 1 / Real(viewCount));
}

// By views that do not show the cell 0.
template <class Real>
FROTH_HD DetailSums<Real> meanOfDetail(const ViewGradients<Real>* views, uint32_t viewCount, const FoamShape& shape,
                                       uint32_t cell, uint32_t k) {
  DetailSums<Real> sum;
  for (uint32_t i = 0; i < viewCount; ++i) {
    if (isShown(views[i].cells[cell].sums)) sum += views[i].details[size_t{cell} * shape.detailCount + k];
  }
  return scaled(sum, 1 / Real(viewCount));
}

// All parameters of detail site k of a cell that some pixel of some view shows.
template <class Real>
FROTH_HD void updateDetailByViews(const TrainedCell<Real>& trained, const ViewGradients<Real>* views,
                                  uint32_t viewCount, uint32_t k, uint32_t& bad) {
  const FoamShape& shape = trained.foam.shape;
  const ParameterPart<Real> axes = lobesOfDetail(trained, Parameter::kLobeAxes, k);
  const ParameterPart<Real> colours = lobesOfDetail(trained, Parameter::kLobeColours, k);
  LobeGradient<Real> means[kMaxLobes];
  for (uint32_t i = 0; i < viewCount; ++i) {
    if (!isShown(views[i].cells[trained.cell].sums)) continue;
    SeenCell<Real> seen;
    prepareCell(trained, views[i].eye, seen);
    const SeenDetail<Real> detail = prepareDetail(trained, seen, k);
    const glm::vec<3, Real> seed = views[i].details[size_t{trained.cell} * shape.detailCount + k].colour;
    const LobeSeeds<Real> seeds{directionOfDetail(seen, detail.place), detail.colour - Real(0.5), seed};
    visitLobes(axes, colours, shape.lobeCount, seeds, [&](uint32_t m, const LobeGradient<Real>& gradient) {
      means[m / 3].axis += gradient.axis / Real(viewCount);
      means[m / 3].colour += gradient.colour / Real(viewCount);
    });
  }
  for (uint32_t m = 0; m < shape.lobeCount; ++m) updateLobe(axes, colours, 3 * m, means[m], bad);
  updatePlace(trained, k, meanOfDetail(views, viewCount, shape, trained.cell, k), bad);
}

// Its ball, and the means that densification goes by.
template <class Real>
FROTH_HD void updateBallByViews(const TrainedFoam<Real>& foam, const AdamStep<Real>& adam,
                                const ViewGradients<Real>* views, uint32_t viewCount, uint32_t cell, uint32_t& bad) {
  const CellSums<Real> mean = meanOfCell(views, viewCount, cell);
  updateBall(foam, adam, cell, gradientOfOwnSums(&mean), bad);
  for (uint32_t i = 0; i < viewCount; ++i) {
    const KeptCell<Real>& asked = views[i].cells[cell];
    updateMeans(foam, cell, asked.isSeen != 0 ? &asked.sums : nullptr);
  }
}

}  // namespace froth
