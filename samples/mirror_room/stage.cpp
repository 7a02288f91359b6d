#include "samples/mirror_room/stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace froth {

HostOptions hostOptionsOf(const MirrorRoomOptions& options) {
  HostOptions host{options.device, options.validate};
  host.useGraphics = true;
  return host;
}

Result<std::unique_ptr<RoomStage>> RoomStage::create(Host& host, const MirrorRoomOptions& options) {
  std::unique_ptr<RoomStage> stage(new RoomStage());
  Result<Room> room = readRoom(options.room);
  if (!room) return room.error();
  stage->room_ = std::move(*room);
  stage->look_ = options.look;
  stage->hasParticles_ = options.hasParticles;
  stage->meshes_ = std::make_unique<RoomGeometry>(stage->room_, stage->room_.ball);
  stage->ball_ = std::make_unique<Ball>(stage->room_);

  FrothContextInfo context = host.contextInfo();
  context.framesInFlight = kFramesInFlight;
  context.walkShaders = 1;
  Result<std::unique_ptr<Scene>> scene = Scene::create(context, options.asset, {true, options.prepareRays});
  if (!scene) return scene.error();
  stage->scene_ = std::move(*scene);
  Result<std::unique_ptr<RoomRenderer>> renderer =
      RoomRenderer::create(host, stage->room_, *stage->scene_, options.prepareRays);
  if (!renderer) return renderer.error();
  stage->renderer_ = std::move(*renderer);
  return stage;
}

FrothInstanceInfo placementOf(const FrothAssetStatus& asset, const Room& room) {
  const RoomNode& stand = room.foam;
  glm::dvec3 low(INFINITY), high(-INFINITY);  // of the turned bounds
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = corner >> axis & 1 ? asset.boundsMax[axis] : asset.boundsMin[axis];
    }
    low = glm::min(low, stand.rotation * point);
    high = glm::max(high, stand.rotation * point);
  }
  const glm::dvec3 size = high - low;
  const float scale = room.isFoamFitted ? static_cast<float>(stand.scale / std::max({size.x, size.y, size.z})) : 1.0f;
  const glm::dvec3 middle = 0.5 * (low + high);
  const glm::dvec3 foot = room.isFoamFitted ? glm::dvec3(middle.x, low.y, middle.z) : glm::dvec3(0);
  const glm::dvec3 position = stand.position - double{scale} * foot;
  FrothInstanceInfo placement{};
  for (int axis = 0; axis < 3; ++axis) placement.position[axis] = position[axis];
  const glm::quat rotation(stand.rotation);
  placement.rotation[0] = rotation.x;
  placement.rotation[1] = rotation.y;
  placement.rotation[2] = rotation.z;
  placement.rotation[3] = rotation.w;
  placement.scale = scale;
  return placement;
}

Status RoomStage::placeFoam() {
  if (!scene_->assetStatus().hasWalkGraph) {
    return makeError(ErrorKind::kBadInput,
                     "the asset has no walk graph, without which the room sees it nowhere but "
                     "directly; bake it without --no-walk");
  }
  placement_ = placementOf(scene_->assetStatus(), room_);
  return scene_->place(placement_);
}

Status RoomStage::advance(double seconds) {
  seconds_ += seconds;
  if (Status stepped = ball_->step(scene_->context(), *meshes_, seconds); !stepped) return stepped;
  room_.nodes[room_.ball].position = ball_->position();
  return {};
}

std::vector<Particle> RoomStage::particles() const {
  std::vector<Particle> particles = hasParticles_ ? particlesAt(room_, seconds_) : std::vector<Particle>();
  constexpr double kMarkSize = 0.03;  // [metres]
  if (marked_) particles.push_back({*marked_, kMarkSize, {1, 0.02f, 0.02f, 1}});
  return particles;
}

Status RoomStage::record(VkCommandBuffer commands, const Pose& pose, uint64_t serial, VkPipelineStageFlags2 readStage) {
  const std::vector<Particle> motes = particles();
  return renderer_->record(commands, *scene_, {room_, pose, motes, look_}, serial, readStage);
}

}  // namespace froth
