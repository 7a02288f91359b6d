#include "samples/flythrough/painter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/vulkan_check.h"

namespace froth {
namespace {

#include "difference.comp.h"  // kDifferenceShader, made from difference.comp

FrothRenderInfo renderInfo(const Pose& pose, const FrothImage& colour) {
  FrothRenderInfo info{};
  info.camera = cameraOf(pose, colour.extent);
  info.colour = colour;
  return info;
}

}  // namespace

const char* nameOf(Picture picture) {
  switch (picture) {
    case Picture::kRaster:
      return infoOf(Method::kRaster).name;
    case Picture::kWalk:
      return infoOf(Method::kWalk).name;
    case Picture::kDifference:
      break;
  }
  return "difference";
}

Painter::~Painter() { destroyImages(); }

void Painter::destroyImages() {
  difference_.reset();
  for (HostImage* image : {&first_, &second_}) host_.destroyImage(*image);
}

Status Painter::setExtent(Scene& scene, VkExtent2D extent) {
  destroyImages();
  for (HostImage* image : {&first_, &second_}) {
    Result<HostImage> made = host_.createImage(VK_FORMAT_R16G16B16A16_SFLOAT, extent);
    if (!made) return made.error();
    *image = *made;
  }
  const PassResource images[] = {storageImage(first_), storageImage(second_)};
  Result<std::unique_ptr<ComputePass>> difference = ComputePass::create(host_, kDifferenceShader, images);
  if (!difference) return difference.error();
  difference_ = std::move(*difference);
  shown_ = first_;
  return scene.setExtent(extent);
}

void Painter::setQuality(const FrothQuality& quality) {
  scale_ = quality.scale;
  cutoff_ = quality.cutoff;
}

Status Painter::record(VkCommandBuffer commands, Scene& scene, Picture picture, const Pose& pose,
                       VkPipelineStageFlags2 readStage) {
  shown_ = first_;
  if (picture == Picture::kDifference) return recordDifference(commands, scene, pose, readStage);
  const auto partOf = [&](uint32_t length) {
    return static_cast<uint32_t>(std::lround(scale_ * static_cast<float>(length)));
  };
  shown_.extent = {std::max(partOf(first_.extent.width), 1u), std::max(partOf(first_.extent.height), 1u)};
  FrothImage target = host_.describe(shown_);
  target.stageOut = readStage;
  target.accessOut = VK_ACCESS_2_TRANSFER_READ_BIT;
  FrothRenderInfo info = renderInfo(pose, target);
  info.cutoff = cutoff_;
  return scene.draw(commands, picture == Picture::kWalk ? Method::kWalk : Method::kRaster, info);
}

Status Painter::recordDifference(VkCommandBuffer commands, Scene& scene, const Pose& pose,
                                 VkPipelineStageFlags2 readStage) {
  FrothImage raster = host_.describe(first_), walk = host_.describe(second_);
  raster.stageOut = walk.stageOut = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  raster.accessOut = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  walk.accessOut = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
  if (Status drawn = scene.draw(commands, Method::kRaster, renderInfo(pose, raster)); !drawn) return drawn;
  if (Status drawn = scene.draw(commands, Method::kWalk, renderInfo(pose, walk)); !drawn) return drawn;
  difference_->record(commands, first_.extent);
  imageBarrier(commands, first_.image,
               {VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
               {VK_IMAGE_LAYOUT_GENERAL, readStage, VK_ACCESS_2_TRANSFER_READ_BIT});
  return {};
}

}  // namespace froth
