// The room with its foam, ball and motes, and their time: what windows and headless runs have in common.
#pragma once

#include <memory>
#include <optional>

#include "samples/mirror_room/ball.h"
#include "samples/mirror_room/options.h"
#include "samples/mirror_room/room_renderer.h"

namespace froth {

// Where the room wants a foam; fitted by its bounds. The field `asset` is left out.
FrothInstanceInfo placementOf(const FrothAssetStatus& asset, const Room& room);

class RoomStage {
 public:
  // Reads the room and starts to open the asset.
  static Result<std::unique_ptr<RoomStage>> create(Host& host, const MirrorRoomOptions& options);

  Status placeFoam();              // on its stand; once, when the scene is ready
  Status advance(double seconds);  // ball and particles
  void dropBall() { ball_->drop(); }
  void mark(const glm::dvec3& place) { marked_ = place; }  // with a red mote

  // Records one frame, after Scene::beginFrame(); RoomRenderer::record().
  Status record(VkCommandBuffer commands, const Pose& pose, uint64_t serial, VkPipelineStageFlags2 readStage);

  const Room& room() const { return room_; }
  const RoomGeometry& meshes() const { return *meshes_; }
  const Ball& ball() const { return *ball_; }
  std::vector<Particle> particles() const;
  const FrothInstanceInfo& placement() const { return placement_; }
  Scene& scene() { return *scene_; }
  RoomRenderer& renderer() { return *renderer_; }
  RoomLook& look() { return look_; }

 private:
  RoomStage() = default;

  Room room_;
  RoomLook look_;
  bool hasParticles_ = true;
  std::optional<glm::dvec3> marked_;
  double seconds_ = 0;
  FrothInstanceInfo placement_{};
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<RoomGeometry> meshes_;  // without the ball
  std::unique_ptr<Ball> ball_;
  std::unique_ptr<RoomRenderer> renderer_;
};

HostOptions hostOptionsOf(const MirrorRoomOptions& options);

}  // namespace froth
