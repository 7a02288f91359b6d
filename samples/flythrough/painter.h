// The picture of a frame: raster, walk, or how they differ.
#pragma once

#include <memory>

#include "froth/froth_quality.h"
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

  // What raster and walk draw from now on: the upper left part of the images, to this cut-off.
  void setQuality(const FrothQuality& quality);

  // Leaves result() in layout GENERAL for transfer reads at `readStage`.
  Status record(VkCommandBuffer commands, Scene& scene, Picture picture, const Pose& pose,
                VkPipelineStageFlags2 readStage);
  // Linear premultiplied colour, RGBA16F; its extent is that of the part that was drawn.
  const HostImage& result() const { return shown_; }

 private:
  void destroyImages();
  Status recordDifference(VkCommandBuffer commands, Scene& scene, const Pose& pose, VkPipelineStageFlags2 readStage);

  Host& host_;
  HostImage first_, second_;  // the second holds the walk while the two are compared
  HostImage shown_;           // of first_
  float scale_ = 1, cutoff_ = 0;
  std::unique_ptr<ComputePass> difference_;
};

}  // namespace froth
