#include "host/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace froth {
namespace {

template <class Vector>
Vector catmullRom(const Vector& before, const Vector& from, const Vector& to, const Vector& after, double t) {
  return 0.5 * ((2.0 * from) + t * (to - before) + t * t * (2.0 * before - 5.0 * from + 4.0 * to - after) +
                t * t * t * (3.0 * from - before - 3.0 * to + after));
}

glm::dvec4 asVector(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }
glm::dquat asRotation(const glm::dvec4& v) { return glm::normalize(glm::dquat(v.w, v.x, v.y, v.z)); }

}  // namespace

Pose poseFromMatrix(const double m[12], double tanHalfFovY) {
  // GLM's matrices are filled column by column.
  const glm::dmat3 rotation(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]);
  return {{m[3], m[7], m[11]}, glm::normalize(glm::quat_cast(rotation)), tanHalfFovY};
}

Pose poseOf(const FrothStoredCamera& camera) { return poseFromMatrix(camera.worldFromCamera, camera.tanHalfFovY); }

FrothCamera cameraOf(const Pose& pose, VkExtent2D extent) {
  FrothCamera camera{};
  for (int axis = 0; axis < 3; ++axis) camera.eye[axis] = pose.eye[axis];
  const glm::mat3 viewFromWorld(glm::transpose(glm::mat3_cast(pose.worldFromCamera)));
  std::copy_n(&viewFromWorld[0][0], 9, camera.viewFromWorld);

  // Our view axes (y down, z forward) are those of Vulkan's clip space, so no sign flips here.
  const double aspect = static_cast<double>(extent.width) / extent.height;
  camera.clipFromView[0] = static_cast<float>(1.0 / (pose.tanHalfFovY * aspect));
  camera.clipFromView[5] = static_cast<float>(1.0 / pose.tanHalfFovY);
  camera.clipFromView[11] = 1.0f;   // w = depth
  camera.clipFromView[14] = 0.01f;  // near plane, where device depth is 1
  camera.viewport = {0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
  return camera;
}

CameraPath::CameraPath(std::vector<Pose> keys) : keys_(std::move(keys)) {
  // q and -q are one rotation; take the sign nearer to the key before, so that the curve turns the short way.
  for (size_t i = 1; i < keys_.size(); ++i) {
    glm::dquat& rotation = keys_[i].worldFromCamera;
    if (glm::dot(rotation, keys_[i - 1].worldFromCamera) < 0) rotation = -rotation;
  }
}

Pose CameraPath::at(double share) const {
  const size_t last = keys_.size() - 1;
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(last);
  const size_t segment = std::min(static_cast<size_t>(place), last > 0 ? last - 1 : 0);
  const double t = place - static_cast<double>(segment);
  const Pose& before = keys_[segment > 0 ? segment - 1 : 0];
  const Pose& from = keys_[segment];
  const Pose& to = keys_[std::min(segment + 1, last)];
  const Pose& after = keys_[std::min(segment + 2, last)];

  Pose pose;
  pose.eye = catmullRom(before.eye, from.eye, to.eye, after.eye, t);
  pose.worldFromCamera = asRotation(catmullRom(asVector(before.worldFromCamera), asVector(from.worldFromCamera),
                                               asVector(to.worldFromCamera), asVector(after.worldFromCamera), t));
  pose.tanHalfFovY = glm::mix(from.tanHalfFovY, to.tanHalfFovY, t);
  return pose;
}

glm::dvec3 CameraPath::up() const {
  glm::dvec3 sum(0);
  for (const Pose& key : keys_) sum += key.worldFromCamera * glm::dvec3(0, -1, 0);
  const double length = glm::length(sum);
  return length > 1e-6 ? sum / length : glm::dvec3(0, -1, 0);  // keys that cancel each other have no common up
}

CameraPath orbitPath(const float boundsMin[3], const float boundsMax[3]) {
  const glm::dvec3 least(boundsMin[0], boundsMin[1], boundsMin[2]), most(boundsMax[0], boundsMax[1], boundsMax[2]);
  const glm::dvec3 middle = 0.5 * (least + most);
  constexpr double kTanHalfFov = 0.5;
  constexpr double kDistance = 2.24;  // 1 / sin(atan(kTanHalfFov)): the bounding sphere just fits into the image
  const double distance = kDistance * 0.5 * glm::length(most - least);

  constexpr int kKeys = 24;
  std::vector<Pose> keys;
  for (int i = 0; i <= kKeys; ++i) {
    const double angle = 2 * std::numbers::pi * i / kKeys;
    const glm::dvec3 forward(std::sin(angle), 0, std::cos(angle));
    const glm::dvec3 down(0, 1, 0);
    const glm::dmat3 axes(glm::cross(down, forward), down, forward);
    keys.push_back({middle - distance * forward, glm::quat_cast(axes), kTanHalfFov});
  }
  return CameraPath(std::move(keys));
}

}  // namespace froth
