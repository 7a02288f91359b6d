// The picture of a frame: raster, walk, or how they differ.
#pragma once

#include <memory>

#include "host/compute_pass.h"
#include "host/scene.h"

namespace froth {

enum class Picture { kRaster, kWalk, kDifference };

const char* nameOf(Picture picture);

// Owns the images. One set serves all frames in flight: a frame's barriers make it wait until the one before
// has read them.
class Painter {
 public:
  explicit Painter(Host& host) : host_(host) {}
  ~Painter();  // the device is done with every frame
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  // (Re)makes the images, and the scene's view to fit; the device is done with every frame.
  Status setExtent(Scene& scene, VkExtent2D extent);

  // Leaves result() in layout GENERAL for transfer reads at `readStage`.
  Status record(VkCommandBuffer commands, Scene& scene, Picture picture, const Pose& pose,
                VkPipelineStageFlags2 readStage);
  const HostImage& result() const { return first_; }  // linear premultiplied colour, RGBA16F

 private:
  void destroyImages();
  Status recordDifference(VkCommandBuffer commands, Scene& scene, const Pose& pose, VkPipelineStageFlags2 readStage);

  Host& host_;
  HostImage first_, second_;  // the second holds the walk while the two are compared
  std::unique_ptr<ComputePass> difference_;
};

}  // namespace froth
