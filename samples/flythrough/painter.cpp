#include "samples/flythrough/painter.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include <glm/gtc/packing.hpp>

#include "host/vulkan_check.h"
#include "samples/flythrough/level_colours.h"

namespace froth {
namespace {

#include "difference.comp.h"  // kDifferenceShader, made from difference.comp
#include "levels.comp.h"      // kLevelsShader

FrothRenderInfo renderInfo(const Pose& pose, const FrothImage& colour) {
  FrothRenderInfo info{};
  info.camera = cameraOf(pose, colour.extent);
  info.colour = colour;
  return info;
}

FrothImage describeForPass(const Host& host, const HostImage& image) {
  FrothImage described = host.describe(image);
  described.stageOut = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  described.accessOut = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  return described;
}

}  // namespace

const char* nameOf(Picture picture) {
  switch (picture) {
    case Picture::kRaster:
      return infoOf(Method::kRaster).name;
    case Picture::kWalk:
      return infoOf(Method::kWalk).name;
    case Picture::kLevels:
      return "levels";
    case Picture::kDifference:
      break;
  }
  return "difference";
}

Painter::~Painter() { destroyImages(); }

void Painter::destroyImages() {
  difference_.reset();
  levels_.reset();
  for (HostImage* image : {&first_, &second_, &ids_}) host_.destroyImage(*image);
  host_.destroyBuffer(chunkColours_);
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
  return scene.setExtent(extent, scene.levelCount() > 1);
}

Status Painter::makeLevels(const Scene& scene) {
  if (scene.levelCount() <= 1) {
    return makeError(ErrorKind::kUsage, "levels: the asset has none of detail; bake it with --lod, or show the raster");
  }
  Result<HostImage> ids = host_.createImage(VK_FORMAT_R32G32_UINT, first_.extent);
  if (!ids) return ids.error();
  ids_ = *ids;
  const Result<std::vector<FrothChunk>> chunks = scene.chunks();
  if (!chunks) return chunks.error();
  std::vector<uint32_t> block = {scene.assetStatus().cellBits};
  for (const FrothChunk& chunk : *chunks) {
    const LevelColour& colour = colourOfLevel(chunk.level);
    block.push_back(glm::packUnorm4x8({colour[0], colour[1], colour[2], 1}));
  }
  const size_t bytes = block.size() * sizeof(uint32_t);
  Result<HostBuffer> buffer = host_.createBuffer(bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  if (!buffer) return buffer.error();
  chunkColours_ = *buffer;
  std::memcpy(chunkColours_.mapped, block.data(), bytes);
  const PassResource resources[] = {storageImage(first_), storageImage(ids_), storageBuffer(chunkColours_.buffer)};
  Result<std::unique_ptr<ComputePass>> levels = ComputePass::create(host_, kLevelsShader, resources);
  if (!levels) return levels.error();
  levels_ = std::move(*levels);
  return {};
}

void Painter::setQuality(const FrothQuality& quality) {
  scale_ = quality.scale;
  cutoff_ = quality.cutoff;
}

Status Painter::record(VkCommandBuffer commands, Scene& scene, Picture picture, const Pose& pose,
                       VkPipelineStageFlags2 readStage) {
  shown_ = first_;
  const bool isByPass = scene.isReady() && (picture == Picture::kDifference || picture == Picture::kLevels);
  if (!isByPass) {
    return recordPart(commands, scene, picture == Picture::kWalk ? Method::kWalk : Method::kRaster, pose, readStage);
  }
  Status recorded =
      picture == Picture::kLevels ? recordLevels(commands, scene, pose) : recordDifference(commands, scene, pose);
  if (!recorded) return recorded;
  imageBarrier(commands, first_.image,
               {VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
               {VK_IMAGE_LAYOUT_GENERAL, readStage, VK_ACCESS_2_TRANSFER_READ_BIT});
  return {};
}

// As much of the image as the quality says.
Status Painter::recordPart(VkCommandBuffer commands, Scene& scene, Method method, const Pose& pose,
                           VkPipelineStageFlags2 readStage) {
  const auto partOf = [&](uint32_t length) {
    return static_cast<uint32_t>(std::lround(scale_ * static_cast<float>(length)));
  };
  shown_.extent = {std::max(partOf(first_.extent.width), 1u), std::max(partOf(first_.extent.height), 1u)};
  FrothImage target = host_.describe(shown_);
  target.stageOut = readStage;
  target.accessOut = VK_ACCESS_2_TRANSFER_READ_BIT;
  FrothRenderInfo info = renderInfo(pose, target);
  info.cutoff = cutoff_;
  return scene.draw(commands, method, info);
}

Status Painter::recordDifference(VkCommandBuffer commands, Scene& scene, const Pose& pose) {
  const FrothImage raster = describeForPass(host_, first_), walk = describeForPass(host_, second_);
  if (Status drawn = scene.draw(commands, Method::kRaster, renderInfo(pose, raster)); !drawn) return drawn;
  if (Status drawn = scene.draw(commands, Method::kWalk, renderInfo(pose, walk)); !drawn) return drawn;
  difference_->record(commands, first_.extent);
  return {};
}

Status Painter::recordLevels(VkCommandBuffer commands, Scene& scene, const Pose& pose) {
  if (!levels_) {
    if (Status made = makeLevels(scene); !made) return made;
  }
  FrothRenderInfo info = renderInfo(pose, describeForPass(host_, first_));
  info.id = describeForPass(host_, ids_);
  if (Status drawn = scene.draw(commands, Method::kRaster, info); !drawn) return drawn;
  levels_->record(commands, first_.extent);
  return {};
}

}  // namespace froth
