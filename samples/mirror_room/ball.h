// A ball that falls, and bounces off foam and meshes.
#pragma once

#include "froth/froth_query.h"
#include "samples/mirror_room/room_geometry.h"

namespace froth {

class Ball {
 public:
  // Starts at rest where the room has its ball.
  explicit Ball(const Room& room);

  void drop();  // from where it started

  // Goes on by so many seconds, in small steps, asking Froth on the CPU what it touches. `meshes` are without the ball
  // itself.
  Status step(FrothContext* context, const RoomGeometry& meshes, double seconds);

  const glm::dvec3& position() const { return position_; }
  const glm::dvec3& velocity() const { return velocity_; }
  double radius() const { return radius_; }
  double deepest() const { return deepest_; }      // how far it ever was inside of the foam [metres]
  uint32_t contacts() const { return contacts_; }  // steps in which it touched the foam

 private:
  Status meetFoam(FrothContext* context);
  void meetMeshes(const RoomGeometry& meshes);
  void bounce(const glm::dvec3& normal, double depth);

  glm::dvec3 start_, position_, velocity_{0};
  double radius_;
  double pending_ = 0;  // [s] not yet a whole step
  double deepest_ = 0;
  uint32_t contacts_ = 0;
};

}  // namespace froth
