#include "samples/mirror_room/ball.h"

#include <algorithm>
#include <cmath>

namespace froth {
namespace {

constexpr double kStep = 1.0 / 480;    // [s]
constexpr double kGravity = 9.81;      // [m/s^2]
constexpr double kRestitution = 0.55;  // of the speed along the normal
constexpr double kFriction = 4;        // [1/s] of the speed across it
constexpr double kRestSpeed = 0.15;    // [m/s] below which it no longer bounces

}  // namespace

Ball::Ball(const Room& room)
    : start_(room.nodes[room.ball].position), position_(start_), radius_(room.nodes[room.ball].scale) {}

void Ball::drop() {
  position_ = start_;
  velocity_ = glm::dvec3(0);
}

Status Ball::step(FrothContext* context, const RoomGeometry& meshes, double seconds) {
  for (pending_ += seconds; pending_ >= kStep; pending_ -= kStep) {
    velocity_.y -= kGravity * kStep;
    position_ += kStep * velocity_;
    if (Status met = meetFoam(context); !met) return met;
    meetMeshes(meshes);
  }
  return {};
}

Status Ball::meetFoam(FrothContext* context) {
  FrothSphere sphere{};
  sphere.structSize = sizeof(sphere);
  for (int axis = 0; axis < 3; ++axis) sphere.centre[axis] = position_[axis];
  sphere.radius = radius_;
  FrothContact contact{};
  contact.structSize = sizeof(contact);
  const FrothResult result = frothOverlapSphere(context, &sphere, &contact);
  if (result < FROTH_OK) {
    return makeError(ErrorKind::kUnsupported, "frothOverlapSphere gives %s", frothResultName(result));
  }
  if (!contact.isTouching) return {};
  ++contacts_;
  deepest_ = std::max(deepest_, contact.depth);
  bounce({contact.normal[0], contact.normal[1], contact.normal[2]}, contact.depth);
  return {};
}

void Ball::meetMeshes(const RoomGeometry& meshes) {
  const std::optional<glm::dvec3> nearest = meshes.nearest(position_, radius_);
  if (!nearest || *nearest == position_) return;
  const glm::dvec3 away = position_ - *nearest;
  bounce(glm::normalize(away), radius_ - glm::length(away));
}

void Ball::bounce(const glm::dvec3& normal, double depth) {
  position_ += depth * normal;
  const double speed = glm::dot(velocity_, normal);
  if (speed >= 0) return;
  const glm::dvec3 along = velocity_ - speed * normal;
  velocity_ = std::exp(-kFriction * kStep) * along - (speed < -kRestSpeed ? kRestitution * speed : 0.0) * normal;
}

}  // namespace froth
