// Views as steps see them.
#pragma once

#include <vector>

#include "reference/camera/view_rays.h"
#include "trainer/step/training_view.h"

namespace froth {

// Pose, intrinsics and near limits of a view; `directions` is for lenses that are no pinholes.
template <class Real>
TrainingView<Real> trainingView(const View& view) {
  TrainingView<Real> training;
  training.width = view.width;
  training.height = view.height;
  training.fx = Real(view.fx);
  training.fy = Real(view.fy);
  training.cx = Real(view.cx);
  training.cy = Real(view.cy);
  training.eye = glm::vec<3, Real>(eyeOf(view));
  const std::array<double, 12>& m = view.worldFromCamera;
  for (int column = 0; column < 3; ++column) {
    training.worldFromCamera[column] = glm::normalize(glm::vec<3, Real>(m[column], m[4 + column], m[8 + column]));
  }
  training.nearRatio = Real(view.nearRatio.value_or(0));
  training.nearDepth = Real(view.nearDepth.value_or(0));
  return training;
}

// TrainingView::directions of a view; empty for a pinhole.
std::vector<float> lensDirections(const View& view);

}  // namespace froth
