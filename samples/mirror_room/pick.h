// What a pixel shows: a place on the foam or on a mesh, found on the CPU.
#pragma once

#include <optional>
#include <string>

#include "froth/froth_query.h"
#include "samples/mirror_room/room_geometry.h"

namespace froth {

struct Pick {
  glm::dvec3 position, normal;
  double distance;
  std::optional<FrothRayHit> foam;  // the cell; none on a mesh
  std::string node;                 // of the mesh; empty on foam
};

// `pixel` from the upper left corner of an image of this size; (0.5, 0.5) is the middle of the first. None: nothing is
// there.
Result<std::optional<Pick>> pickAt(FrothContext* context, const Room& room, const RoomGeometry& meshes,
                                   const Pose& pose, VkExtent2D extent, const glm::dvec2& pixel);

std::string describe(const Pick& pick);  // one line

}  // namespace froth
