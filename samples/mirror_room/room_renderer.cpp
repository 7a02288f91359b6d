#include "samples/mirror_room/room_renderer.h"

#include <utility>

#include "froth/froth_walk.h"
#include "host/vulkan_check.h"

namespace froth {
namespace {

#include "fill_between.comp.h"  // kFillBetweenShader
#include "foreground.comp.h"    // kForegroundShader
#include "light_room.comp.h"    // kLightRoomShader
#include "reflect.comp.h"       // kReflectShader
#include "sun.comp.h"           // kSunShader
#include "surround.comp.h"      // kSurroundShader

constexpr uint32_t kShadowMapEdge = 2048;

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr ImageUse kNew{VK_IMAGE_LAYOUT_UNDEFINED, kCompute, VK_ACCESS_2_NONE};  // after the reads of the frame before
constexpr ImageUse kDepthTarget{
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr ImageUse kColourTarget{VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                 VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                 VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr ImageUse kSampled{VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kCompute, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
constexpr ImageUse kWritten{VK_IMAGE_LAYOUT_GENERAL, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr ImageUse kLoaded{VK_IMAGE_LAYOUT_GENERAL, kCompute, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
constexpr ImageUse kLoadedAndWritten{VK_IMAGE_LAYOUT_GENERAL, kCompute, kLoaded.access | kWritten.access};

// An image that Froth writes and the room's passes sample.
FrothImage foamOutput(const Host& host, const HostImage& image) {
  FrothImage described = host.describe(image);
  described.layoutOut = kSampled.layout;
  described.stageOut = kSampled.stage;
  described.accessOut = kSampled.access;
  return described;
}

}  // namespace

Result<std::unique_ptr<RoomRenderer>> RoomRenderer::create(Host& host, const Room& room, const Scene& scene,
                                                           FrothRayPreparation prepared) {
  if (room.materials.size() > room::kMostMaterials) {
    return makeError(ErrorKind::kBadInput, "the room has %zu materials; use no more than %u", room.materials.size(),
                     room::kMostMaterials);
  }
  std::unique_ptr<RoomRenderer> renderer(new RoomRenderer(host, room));
  renderer->prepared_ = prepared;
  Result<std::unique_ptr<MeshPass>> meshes = MeshPass::create(host, room);
  if (!meshes) return meshes.error();
  renderer->meshes_ = std::move(*meshes);
  Result<std::unique_ptr<GpuTimer>> timer = GpuTimer::create(host);
  if (!timer) return timer.error();
  renderer->timer_ = std::move(*timer);
  Result<HostBuffer> frame =
      host.createBuffer(sizeof(room::RoomFrame), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  if (!frame) return frame.error();
  renderer->frame_ = *frame;
  const Status asked =
      scene.check(frothGetWalkSetLayout(scene.context(), &renderer->walkLayout_), "frothGetWalkSetLayout");
  if (!asked) return asked.error();
  return renderer;
}

RoomRenderer::~RoomRenderer() {
  destroyImages();
  host_.destroyBuffer(frame_);
}

void RoomRenderer::destroyImages() {
  passes_ = {};
  for (HostImage* image : {&images_.depth, &images_.surface, &images_.mirroredDepth, &images_.mirroredSurface,
                           &images_.shadowMap, &images_.foamColour, &images_.foamDistance, &images_.foamNormal,
                           &images_.sunlight, &images_.surround, &images_.reflection, &images_.result}) {
    host_.destroyImage(*image);
  }
}

Status RoomRenderer::setExtent(Scene& scene, VkExtent2D extent) {
  destroyImages();
  if (Status made = createImages(extent); !made) return made;
  if (Status made = createPasses(); !made) return made;
  return scene.setExtent(extent);
}

Status RoomRenderer::createImages(VkExtent2D extent) {
  constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT, kHalves = VK_FORMAT_R16G16B16A16_SFLOAT;
  const struct {
    HostImage* image;
    VkFormat format;
    VkExtent2D extent;
  } wanted[] = {{&images_.depth, kDepth, extent},
                {&images_.surface, kHalves, extent},
                {&images_.mirroredDepth, kDepth, extent},
                {&images_.mirroredSurface, kHalves, extent},
                {&images_.shadowMap, kDepth, {kShadowMapEdge, kShadowMapEdge}},
                {&images_.foamColour, kHalves, extent},
                {&images_.foamDistance, VK_FORMAT_R32_SFLOAT, extent},
                {&images_.foamNormal, kHalves, extent},
                {&images_.sunlight, kHalves, extent},
                {&images_.surround, kHalves, extent},
                {&images_.reflection, kHalves, extent},
                {&images_.result, kHalves, extent}};
  for (const auto& [image, format, size] : wanted) {
    Result<HostImage> made = host_.createImage(format, size);
    if (!made) return made.error();
    *image = *made;
  }
  return {};
}

Status RoomRenderer::createPasses() {
  PassResource resources[room::kBindingResult + 1];
  resources[room::kBindingFrame] = uniformBuffer(frame_.buffer);
  resources[room::kBindingDepth] = sampledImage(images_.depth);
  resources[room::kBindingSurface] = sampledImage(images_.surface);
  resources[room::kBindingMirroredDepth] = sampledImage(images_.mirroredDepth);
  resources[room::kBindingMirroredSurface] = sampledImage(images_.mirroredSurface);
  resources[room::kBindingShadowMap] = sampledImage(images_.shadowMap);
  resources[room::kBindingFoamColour] = sampledImage(images_.foamColour);
  resources[room::kBindingFoamDistance] = sampledImage(images_.foamDistance);
  resources[room::kBindingFoamNormal] = sampledImage(images_.foamNormal);
  resources[room::kBindingSunlight] = storageImage(images_.sunlight);
  resources[room::kBindingSurround] = storageImage(images_.surround);
  resources[room::kBindingReflection] = storageImage(images_.reflection);
  resources[room::kBindingResult] = storageImage(images_.result);
  const struct {
    std::unique_ptr<ComputePass>* pass;
    std::span<const uint32_t> spirv;
  } wanted[] = {{&passes_.sun, kSunShader},
                {&passes_.surround, kSurroundShader},
                {&passes_.reflect, kReflectShader},
                {&passes_.fillBetween, kFillBetweenShader},
                {&passes_.foreground, kForegroundShader},
                {&passes_.light, kLightRoomShader}};
  const uint32_t constants[] = {prepared_};
  for (const auto& [pass, spirv] : wanted) {
    Result<std::unique_ptr<ComputePass>> made = ComputePass::create(host_, spirv, resources, walkLayout_, constants);
    if (!made) return made.error();
    *pass = std::move(*made);
  }
  return {};
}

Status RoomRenderer::record(VkCommandBuffer commands, Scene& scene, const RoomShot& shot, uint64_t serial,
                            VkPipelineStageFlags2 readStage) {
  timer_->begin(commands, serial);
  recordMeshes(commands, shot);
  if (Status drawn = recordFoam(commands, scene, shot); !drawn) return drawn;

  FrothWalkInfo walk{};
  walk.structSize = sizeof(walk);
  for (int axis = 0; axis < 3; ++axis) walk.eye[axis] = shot.pose.eye[axis];
  walk.stages = kCompute;
  VkDescriptorSet walkSet = VK_NULL_HANDLE;
  const FrothResult recorded = frothRecordWalkSet(scene.context(), commands, &walk, &walkSet);
  if (Status checked = scene.check(recorded, "frothRecordWalkSet"); !checked) return checked;
  timer_->mark(commands, "walk set");
  recordFrame(commands, frameOf(shot, sun_, kShadowMapEdge, images_.result.extent, recorded == FROTH_OK));
  recordLight(commands, walkSet, shot.look.rayStep, readStage);
  return {};
}

void RoomRenderer::recordFrame(VkCommandBuffer commands, const room::RoomFrame& frame) const {
  recordMemoryBarrier(commands, kCompute, VK_ACCESS_2_NONE, VK_PIPELINE_STAGE_2_COPY_BIT,
                      VK_ACCESS_2_TRANSFER_WRITE_BIT);
  vkCmdUpdateBuffer(commands, frame_.buffer, 0, sizeof(frame), &frame);
  recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, kCompute,
                      VK_ACCESS_2_UNIFORM_READ_BIT);
}

void RoomRenderer::recordMeshes(VkCommandBuffer commands, const RoomShot& shot) const {
  const VkExtent2D extent = images_.result.extent;
  constexpr VkImageAspectFlags kDepthAspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  for (const HostImage* depth : {&images_.shadowMap, &images_.depth, &images_.mirroredDepth}) {
    imageBarrier(commands, depth->image, kNew, kDepthTarget, kDepthAspect);
  }
  for (const HostImage* surface : {&images_.surface, &images_.mirroredSurface}) {
    imageBarrier(commands, surface->image, kNew, kColourTarget);
  }
  meshes_->record(commands, MeshPass::Kind::kShadow, shot.room, {sun_.clipFromWorld, glm::dvec3(0), nullptr},
                  {images_.shadowMap.view, VK_NULL_HANDLE, images_.shadowMap.extent});
  timer_->mark(commands, "shadow map");
  meshes_->record(commands, MeshPass::Kind::kSurface, shot.room, cameraOf(shot, extent),
                  {images_.depth.view, images_.surface.view, extent});
  timer_->mark(commands, "meshes");
  meshes_->record(commands, MeshPass::Kind::kSurface, shot.room, mirroredCameraOf(shot, extent),
                  {images_.mirroredDepth.view, images_.mirroredSurface.view, extent});
  for (const HostImage* depth : {&images_.shadowMap, &images_.depth, &images_.mirroredDepth}) {
    imageBarrier(commands, depth->image, kDepthTarget, kSampled, kDepthAspect);
  }
  for (const HostImage* surface : {&images_.surface, &images_.mirroredSurface}) {
    imageBarrier(commands, surface->image, kColourTarget, kSampled);
  }
  timer_->mark(commands, "mirrored meshes");
}

Status RoomRenderer::recordFoam(VkCommandBuffer commands, Scene& scene, const RoomShot& shot) const {
  FrothRenderInfo info{};
  info.camera = cameraOf(shot.pose, images_.result.extent);
  info.colour = foamOutput(host_, images_.foamColour);
  info.distance = foamOutput(host_, images_.foamDistance);
  info.normal = foamOutput(host_, images_.foamNormal);
  info.sceneDepth = foamOutput(host_, images_.depth);
  info.sceneDepth.layoutIn = kSampled.layout;
  info.sceneDepth.stageIn = kSampled.stage;
  info.sceneDepth.accessIn = kSampled.access;
  const Status drawn = scene.draw(commands, Method::kRaster, info);
  timer_->mark(commands, "foam");
  return drawn;
}

// Of sunlight, occlusion and reflections.
void RoomRenderer::recordRays(VkCommandBuffer commands, VkDescriptorSet walkSet, uint32_t step) const {
  const VkExtent2D extent = images_.result.extent;
  const VkExtent2D stepped{(extent.width + step - 1) / step, (extent.height + step - 1) / step};
  passes_.sun->record(commands, stepped, walkSet);
  timer_->mark(commands, "sun");
  passes_.surround->record(commands, stepped, walkSet);
  timer_->mark(commands, "surround");
  passes_.reflect->record(commands, stepped, walkSet);
  timer_->mark(commands, "reflection");
  if (step == 1) return;
  for (const HostImage* image : {&images_.sunlight, &images_.reflection}) {
    imageBarrier(commands, image->image, kWritten, kLoadedAndWritten);
  }
  passes_.fillBetween->record(commands, extent, walkSet);
  timer_->mark(commands, "fill between");
}

void RoomRenderer::recordLight(VkCommandBuffer commands, VkDescriptorSet walkSet, uint32_t rayStep,
                               VkPipelineStageFlags2 readStage) const {
  const VkExtent2D extent = images_.result.extent;
  for (const HostImage* image : {&images_.sunlight, &images_.surround, &images_.reflection}) {
    imageBarrier(commands, image->image, kNew, kWritten);
  }
  imageBarrier(commands, images_.result.image, {VK_IMAGE_LAYOUT_UNDEFINED, readStage, VK_ACCESS_2_NONE}, kWritten);
  recordRays(commands, walkSet, rayStep);
  passes_.foreground->record(commands, extent, walkSet);
  timer_->mark(commands, "foreground");
  for (const HostImage* image : {&images_.sunlight, &images_.surround, &images_.reflection}) {
    imageBarrier(commands, image->image, kWritten, kLoaded);
  }
  imageBarrier(commands, images_.result.image, kWritten, kLoadedAndWritten);
  passes_.light->record(commands, extent, walkSet);
  timer_->mark(commands, "light");
  imageBarrier(commands, images_.result.image, kWritten,
               {VK_IMAGE_LAYOUT_GENERAL, readStage, VK_ACCESS_2_TRANSFER_READ_BIT});
}

}  // namespace froth
