// Movement in double, by closed forms: what motion and reactive are compared with.
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "tests/render/render_harness.h"

namespace froth::test {

constexpr uint32_t kMotionWidth = 120, kMotionHeight = 90;

struct Pose {
  glm::dvec3 position{0};
  glm::dquat rotation{1, 0, 0, 0};
  double scale = 1;
};

FrothInstanceInfo infoOf(const Pose& pose);
glm::dvec3 toWorld(const Pose& pose, const glm::dvec3& point);
glm::dvec3 toAsset(const Pose& pose, const glm::dvec3& point);

View lensView(LensKind kind, const glm::dvec3& eye = {0.6, -0.5, 0.3}, const glm::dvec3& target = {0.05, 0.1, 3});

// Where a view shows a point, or what lies in a direction; the models as they were published.
glm::dvec2 pixelOf(const View& view, const glm::dvec3& place, bool isDirection);

// A camera, and an instance, in a frame and the one before.
struct Moved {
  View now, before;
  Pose poseNow{}, poseBefore{};
};

FrothRenderInfo infoOf(const Moved& moved);

constexpr LensKind kMotionLenses[] = {LensKind::kPinhole,          LensKind::kOrthographic,
                                      LensKind::kFisheye,          LensKind::kKannalaBrandt,
                                      LensKind::kRadialTangential, LensKind::kEquirectangular};

const Pose kTurned{{0.1, -0.05, 0.2}, glm::normalize(glm::dquat(0.98, 0.1, -0.05, 0.12)), 1.0625};

}  // namespace froth::test
