// A camera that flies where the user steers.
#pragma once

#include "host/camera_path.h"

namespace froth {

struct FlyInput {
  glm::dvec3 move{0};  // in camera axes, each -1..1
  glm::dvec2 turn{0};  // [radians] to the right and downwards
  double seconds = 0;  // since the last step
};

class FlyCamera {
 public:
  // `up` stays up however one turns. `speed` in scene units per second.
  FlyCamera(const Pose& start, const glm::dvec3& up, double speed) : pose_(start), up_(up), speed_(speed) {}

  void step(const FlyInput& input);
  void jumpTo(const Pose& pose) { pose_ = pose; }
  void scaleSpeed(double factor) { speed_ *= factor; }
  const Pose& pose() const { return pose_; }

 private:
  Pose pose_;
  glm::dvec3 up_;
  double speed_;
};

}  // namespace froth
