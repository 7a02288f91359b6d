// Froth's part: context, asset, instance, view. Knows nothing of Qt.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "froth/froth.h"
#include "host/camera_path.h"

namespace froth {

class FoamScene {
 public:
  // Starts to load the asset. `info`: without callbacks.
  static Result<std::unique_ptr<FoamScene>> create(FrothContextInfo info, const std::string& asset);
  ~FoamScene();  // the device is idle
  FoamScene(const FoamScene&) = delete;
  FoamScene& operator=(const FoamScene&) = delete;

  // Between frames; frames in flight may still use what it replaces.
  Status makeRoomFor(VkExtent2D extent);

  // Once per frame, in this order. `turn`: around the foam [radians].
  Status beginFrame(VkCommandBuffer commands, uint64_t serial, uint64_t completedSerial);
  // Clears the image until the asset is loaded. Gives whether the foam is all there, as far as is known.
  Result<bool> draw(VkCommandBuffer commands, const FrothImage& colour, double turn);

 private:
  FoamScene() = default;
  Status open(const std::string& asset);
  Pose poseAt(double turn) const;
  Status check(FrothResult result, const char* call) const;

  FrothContext* context_ = nullptr;
  FrothAsset assetHandle_{};
  FrothInstance instance_{};
  FrothView view_{};
  VkExtent2D viewExtent_{};
  FrothAssetStatus asset_{};
  std::string lastMessage_;
};

}  // namespace froth
