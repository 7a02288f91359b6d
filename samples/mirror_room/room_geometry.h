// The room's triangles in the world, for the CPU: what a ray or a ball meets of them.
#pragma once

#include <optional>
#include <vector>

#include "samples/mirror_room/room_file.h"

namespace froth {

struct RoomTriangle {
  glm::dvec3 corners[3];
  glm::dvec3 normals[3];
  uint32_t part;
};

struct MeshHit {
  double distance;    // in lengths of the direction
  glm::dvec3 normal;  // unit, between those of the corners
  uint32_t material, node;
};

class RoomGeometry {
 public:
  // `room` outlives it. Without the node `skipped`.
  RoomGeometry(const Room& room, std::optional<uint32_t> skipped = {});

  std::optional<MeshHit> cast(const glm::dvec3& origin, const glm::dvec3& direction, double tMin, double tMax) const;
  // Nearest point within `reach`.
  std::optional<glm::dvec3> nearest(const glm::dvec3& point, double reach) const;

 private:
  struct Group {  // of one part: a sphere around it
    glm::dvec3 centre;
    double radius;
    size_t first, last;
  };

  const Room& room_;
  std::vector<RoomTriangle> triangles_;
  std::vector<Group> groups_;
};

}  // namespace froth
