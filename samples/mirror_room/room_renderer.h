// A frame of the room: meshes, foam among them, and light between the two.
#pragma once

#include <memory>

#include "host/compute_pass.h"
#include "host/gpu_timer.h"
#include "host/scene.h"
#include "samples/mirror_room/room_frame.h"

namespace froth {

// All of the frame's size, but for the shadow map.
struct RoomImages {
  HostImage depth, surface;                  // of the meshes, from the camera
  HostImage mirroredDepth, mirroredSurface;  // and from behind the mirror
  HostImage shadowMap;
  HostImage foamColour, foamDistance, foamNormal;
  HostImage sunlight, surround, reflection, result;  // room_layout.h
};

// One set of images serves all frames in flight: a frame's barriers make it wait until the one before has read them.
class RoomRenderer {
 public:
  // The scene's context was made with walkShaders. `room` may change its nodes' places later on.
  static Result<std::unique_ptr<RoomRenderer>> create(Host& host, const Room& room, const Scene& scene,
                                                      FrothRayPreparation prepared);
  ~RoomRenderer();  // the device is done with every frame
  RoomRenderer(const RoomRenderer&) = delete;
  RoomRenderer& operator=(const RoomRenderer&) = delete;

  // (Re)makes the images, and the scene's view to fit; the device is done with every frame.
  Status setExtent(Scene& scene, VkExtent2D extent);

  // After Scene::beginFrame(). Leaves result() in layout GENERAL for transfer reads at `readStage`.
  Status record(VkCommandBuffer commands, Scene& scene, const RoomShot& shot, uint64_t serial,
                VkPipelineStageFlags2 readStage);

  const RoomImages& images() const { return images_; }
  const HostImage& result() const { return images_.result; }  // linear light, RGBA16F
  GpuTimer::Times times(uint64_t completedSerial) const { return timer_->read(completedSerial); }

 private:
  struct Passes {
    std::unique_ptr<ComputePass> sun, surround, reflect, fillBetween, foreground, light;
  };

  RoomRenderer(Host& host, const Room& room) : host_(host), sun_(room) {}
  void destroyImages();
  Status createImages(VkExtent2D extent);
  Status createPasses();
  void recordFrame(VkCommandBuffer commands, const room::RoomFrame& frame) const;
  void recordMeshes(VkCommandBuffer commands, const RoomShot& shot) const;
  Status recordFoam(VkCommandBuffer commands, Scene& scene, const RoomShot& shot) const;
  void recordRays(VkCommandBuffer commands, VkDescriptorSet walkSet, uint32_t step) const;
  void recordLight(VkCommandBuffer commands, VkDescriptorSet walkSet, uint32_t rayStep,
                   VkPipelineStageFlags2 readStage) const;

  Host& host_;
  SunCamera sun_;
  std::unique_ptr<MeshPass> meshes_;
  std::unique_ptr<GpuTimer> timer_;
  HostBuffer frame_;
  VkDescriptorSetLayout walkLayout_ = VK_NULL_HANDLE;  // Froth's
  FrothRayPreparation prepared_ = FROTH_PREPARE_NOTHING;
  RoomImages images_;
  Passes passes_;
};

}  // namespace froth
