#include "host/fly_camera.h"

#include <cmath>

namespace froth {

void FlyCamera::step(const FlyInput& input) {
  // To the right about the scene's up axis, so that the horizon stays level; downwards about the camera's own
  // x axis.
  const glm::dquat right = glm::angleAxis(-input.turn.x, up_);
  const glm::dquat down = glm::angleAxis(-input.turn.y, glm::dvec3(1, 0, 0));
  const glm::dquat turned = glm::normalize(right * pose_.worldFromCamera * down);
  // Straight up or down there is no horizon: keep a few degrees away.
  constexpr double kSteepest = 0.99;
  const glm::dvec3 forward = turned * glm::dvec3(0, 0, 1);
  const bool isSteep = std::abs(glm::dot(forward, up_)) > kSteepest;
  pose_.worldFromCamera = isSteep ? glm::normalize(right * pose_.worldFromCamera) : turned;
  pose_.eye += pose_.worldFromCamera * (input.move * (speed_ * input.seconds));
}

}  // namespace froth
