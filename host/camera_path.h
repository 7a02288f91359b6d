// Where the camera is: a pose, and a smooth path through key poses.
#pragma once

#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "froth/froth.h"

namespace froth {

// Camera axes x right, y down, z forward.
struct Pose {
  glm::dvec3 eye{0};  // [scene units]
  glm::dquat worldFromCamera{1, 0, 0, 0};
  double tanHalfFovY = 0.5;  // half-height of the image plane at depth 1
};

// `worldFromCamera`: 3 rows of 4, as in FrothStoredCamera and cameras.json.
Pose poseFromMatrix(const double worldFromCamera[12], double tanHalfFovY);
Pose poseOf(const FrothStoredCamera& camera);

// Centred principal point, square pixels, reversed depth with an infinite far plane.
FrothCamera cameraOf(const Pose& pose, VkExtent2D extent);

// A Catmull-Rom curve through the keys; passes through each of them.
class CameraPath {
 public:
  explicit CameraPath(std::vector<Pose> keys);  // at least one

  Pose at(double share) const;  // share of the path [0..1]; 0 and 1 are the first and last key
  size_t keyCount() const { return keys_.size(); }
  // The direction that the keys agree on as up: cameras are mostly held upright.
  glm::dvec3 up() const;

 private:
  std::vector<Pose> keys_;
};

// Once around a box, looking at its middle; -y is up, as in most captures.
CameraPath orbitPath(const float boundsMin[3], const float boundsMax[3]);

}  // namespace froth
