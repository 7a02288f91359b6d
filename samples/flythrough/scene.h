// Froth's part of an engine: one context, one asset, one instance, one view.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "samples/flythrough/camera_path.h"
#include "samples/host/host.h"

namespace froth {

enum class Method { kRaster, kWalk };

class Scene {
 public:
  // Starts to open the asset; `context` comes with the engine's device, without callbacks.
  static Result<std::unique_ptr<Scene>> create(FrothContextInfo context, const std::string& assetPath);
  ~Scene();  // the device is done with every frame

  // (Re)makes the view for images of this size; the device is done with every frame.
  Status setExtent(VkExtent2D extent);

  // The start of each frame: loads what there is to load, grows what was too small, records the uploads.
  Status beginFrame(VkCommandBuffer commands, uint64_t serial, uint64_t completedSerial);
  // Records linear premultiplied colour of the whole image. Nothing is drawn before the asset is ready.
  Status draw(VkCommandBuffer commands, Method method, const Pose& pose, const FrothImage& colour);

  bool isReady() const { return asset_.state == FROTH_ASSET_READY; }
  const FrothAssetStatus& assetStatus() const { return asset_; }
  const FrothFrameStatus& frameStatus() const { return frame_; }
  Result<FrothViewStatus> viewStatus() const;  // of the newest complete frame

  // The path to fly: the given keys, else those stored in the asset, else an orbit. Only when ready.
  Result<CameraPath> path(std::vector<Pose> keys) const;

 private:
  Scene() = default;
  Status check(FrothResult result, const char* call) const;

  FrothContext* context_ = nullptr;
  FrothAsset assetHandle_{};
  FrothInstance instance_{};
  FrothView view_{};
  VkExtent2D extent_{};
  FrothAssetStatus asset_{};
  FrothFrameStatus frame_{};
  std::string lastMessage_;
};

}  // namespace froth
