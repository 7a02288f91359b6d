#include "samples/mirror_room/pick.h"

#include <cmath>
#include <cstdio>

namespace froth {

Result<std::optional<Pick>> pickAt(FrothContext* context, const Room& room, const RoomGeometry& meshes,
                                   const Pose& pose, VkExtent2D extent, const glm::dvec2& pixel) {
  const double perPixel = 2 * pose.tanHalfFovY / extent.height;
  const glm::dvec3 inView(perPixel * (pixel.x - 0.5 * extent.width), perPixel * (pixel.y - 0.5 * extent.height), 1);
  const glm::dvec3 direction = pose.worldFromCamera * glm::normalize(inView);
  const std::optional<MeshHit> mesh = meshes.cast(pose.eye, direction, 0, INFINITY);

  FrothRay ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = pose.eye[axis];
    ray.direction[axis] = direction[axis];
  }
  ray.tMax = mesh ? mesh->distance : 0;  // 0: no end
  FrothCastInfo cast{};
  cast.structSize = sizeof(cast);
  cast.closestOnly = 1;
  FrothRayHit hit{};
  const FrothResult result = frothCastRays(context, &cast, &ray, &hit, 1);
  if (result < FROTH_OK) return makeError(ErrorKind::kUnsupported, "frothCastRays gives %s", frothResultName(result));
  if (std::isfinite(hit.distance)) {
    const glm::dvec3 position(hit.position[0], hit.position[1], hit.position[2]);
    return std::optional(Pick{position, {hit.normal[0], hit.normal[1], hit.normal[2]}, hit.distance, hit, {}});
  }
  if (!mesh) return std::optional<Pick>();
  return std::optional(
      Pick{pose.eye + mesh->distance * direction, mesh->normal, mesh->distance, {}, room.nodes[mesh->node].name});
}

std::string describe(const Pick& pick) {
  char what[64], where[160];
  if (pick.foam) {
    std::snprintf(what, sizeof(what), "foam, chunk %u cell %u", pick.foam->chunk, pick.foam->cell);
  } else {
    std::snprintf(what, sizeof(what), "mesh '%s'", pick.node.c_str());
  }
  std::snprintf(where, sizeof(where), "%s at (%.3f, %.3f, %.3f), normal (%.3f, %.3f, %.3f), distance %.3f", what,
                pick.position.x, pick.position.y, pick.position.z, pick.normal.x, pick.normal.y, pick.normal.z,
                pick.distance);
  return where;
}

}  // namespace froth
