// The picture of a frame: raster, walk, how they differ, or the levels of detail that it shows.
#pragma once

#include <memory>

#include "froth/froth_quality.h"
#include "host/compute_pass.h"
#include "host/scene.h"

namespace froth {

enum class Picture { kRaster, kWalk, kDifference, kLevels };

const char* nameOf(Picture picture);

// Owns the images. One set serves all frames in flight: a frame's barriers make it wait until the one before
// has read them.
class Painter {
 public:
  explicit Painter(Host& host) : host_(host) {}
  ~Painter();  // the device is done with every frame
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  // (Re)makes the images, and the scene's view to fit; the device is done with every frame. For kLevels it
  // is called once more when the scene is ready.
  Status setExtent(Scene& scene, VkExtent2D extent);

  // What raster and walk draw from now on: the upper left part of the images, to this cut-off.
  void setQuality(const FrothQuality& quality);

  // Leaves result() in layout GENERAL for transfer reads at `readStage`. Nothing is drawn before the scene is ready.
  Status record(VkCommandBuffer commands, Scene& scene, Picture picture, const Pose& pose,
                VkPipelineStageFlags2 readStage);
  // Linear premultiplied colour, RGBA16F; its extent is that of the part that was drawn.
  const HostImage& result() const { return shown_; }

 private:
  void destroyImages();
  Status recordPart(VkCommandBuffer commands, Scene& scene, Method method, const Pose& pose,
                    VkPipelineStageFlags2 readStage);
  Status makeLevels(const Scene& scene);
  Status recordDifference(VkCommandBuffer commands, Scene& scene, const Pose& pose);
  Status recordLevels(VkCommandBuffer commands, Scene& scene, const Pose& pose);

  Host& host_;
  HostImage first_, second_;  // the second holds the walk while the two are compared
  HostImage shown_;           // of first_
  HostImage ids_;             // of kLevels, as the next two, since it was first shown
  HostBuffer chunkColours_;
  std::unique_ptr<ComputePass> levels_;
  float scale_ = 1, cutoff_ = 0;
  std::unique_ptr<ComputePass> difference_;
};

}  // namespace froth
