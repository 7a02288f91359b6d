// Draws the room's meshes: depth, and what lighting needs of a surface.
#pragma once

#include <memory>

#include "host/host.h"
#include "samples/mirror_room/room_file.h"

namespace froth {

// A camera of any projection.
struct MeshCamera {
  glm::dmat4 clipFromRelative{1};  // of points relative to the origin below
  glm::dvec3 origin{0};
  const MirrorPlane* visible = nullptr;  // what is behind it is left out; null: nothing is
};

struct MeshTarget {
  VkImageView depth = VK_NULL_HANDLE;    // D32_SFLOAT in DEPTH_ATTACHMENT_OPTIMAL
  VkImageView surface = VK_NULL_HANDLE;  // R16G16B16A16_SFLOAT in COLOR_ATTACHMENT_OPTIMAL; null: depth alone
  VkExtent2D extent{};
};

class MeshPass {
 public:
  // Reversed depth and surfaces, or the forward depth of a shadow map.
  enum class Kind { kSurface, kShadow };
  static Result<std::unique_ptr<MeshPass>> create(Host& host, const Room& room);
  ~MeshPass();  // the device is done with it
  MeshPass(const MeshPass&) = delete;
  MeshPass& operator=(const MeshPass&) = delete;

  // Clears the target and draws all parts, where the nodes of `room` are now.
  void record(VkCommandBuffer commands, Kind kind, const Room& room, const MeshCamera& camera,
              const MeshTarget& target) const;

 private:
  explicit MeshPass(Host& host) : host_(host) {}
  Status uploadMeshes(const Room& room);
  Status createLayout();
  Status createPipeline(Kind kind, VkPipeline& pipeline);
  void beginRendering(VkCommandBuffer commands, Kind kind, const MeshTarget& target) const;

  Host& host_;
  HostBuffer vertices_, indices_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline surfaces_ = VK_NULL_HANDLE, shadows_ = VK_NULL_HANDLE;
};

}  // namespace froth
