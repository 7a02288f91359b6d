// What the shaders are told of a frame: cameras, lights, materials, particles.
#pragma once

#include <span>

#include "samples/mirror_room/mesh_pass.h"
#include "samples/mirror_room/particles.h"
#include "samples/mirror_room/shaders/room_layout.h"

namespace froth {

// What one may choose of a frame's look.
struct RoomLook {
  double shadowCatching = 1;    // [0..1] how much of their shadow meshes cast on the foam
  double occlusionReach = 0.5;  // [metres] of the rays of ambient occlusion
  uint32_t rayStep = 1;         // [1 or 2] pixels from one that casts rays at meshes to the next
  bool hasBaseColours = false;  // reflections of the foam, without view dependence
};

struct RoomShot {
  const Room& room;  // nodes where they are in this frame
  Pose pose;
  std::span<const Particle> particles;
  RoomLook look;
};

// Parallel rays along the sun's, over all meshes.
struct SunCamera {
  explicit SunCamera(const Room& room);

  glm::dmat4 clipFromWorld{1};
  double extent = 0;  // edge of the square that it sees [metres]
};

MeshCamera cameraOf(const RoomShot& shot, VkExtent2D extent);
// The same camera behind the mirror: what a pixel of the mirror shows is at the same pixel.
MeshCamera mirroredCameraOf(const RoomShot& shot, VkExtent2D extent);

room::RoomFrame frameOf(const RoomShot& shot, const SunCamera& sun, uint32_t shadowMapEdge, VkExtent2D extent,
                        bool hasFoam);

}  // namespace froth
