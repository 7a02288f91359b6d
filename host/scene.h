// Froth's part of an engine: one context, one asset, one instance, one view.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "froth/froth_replace.h"
#include "froth/froth_stream.h"
#include "froth/froth_walk.h"
#include "host/camera_path.h"
#include "host/host.h"
#include "host/http_reader.h"
#include "host/method.h"

namespace froth {

struct SceneUses {
  bool isQueried = false;  // CPU queries answer
  FrothRayPreparation prepareRays = FROTH_PREPARE_NOTHING;
};

class Scene {
 public:
  // Starts to open the asset, a file or a URL; `context` comes with the engine's device, without callbacks.
  static Result<std::unique_ptr<Scene>> create(FrothContextInfo context, const std::string& asset,
                                               const SceneUses& uses = {});
  ~Scene();  // the device is done with every frame

  // (Re)makes the view for images of this size, and with keepsHits for those of FrothViewInfo::keepsHits too; the
  // device is done with every frame.
  Status setExtent(VkExtent2D extent, bool keepsHits = false);

  // The start of each frame: loads what there is to load, grows what was too small, records the uploads.
  Status beginFrame(VkCommandBuffer commands, uint64_t serial, uint64_t completedSerial);
  // Records the images of `info`; size and near limits are filled in. Nothing is drawn before the asset is ready.
  Status draw(VkCommandBuffer commands, Method method, FrothRenderInfo info);

  // Once the asset is ready: another file takes its place, which is drawn until that file is loaded (froth_replace.h).
  Status replace(const std::string& path);
  Result<FrothReplacementStatus> replacement() const;

  bool isReady() const { return asset_.state == FROTH_ASSET_READY; }
  const FrothAssetStatus& assetStatus() const { return asset_; }
  const FrothFrameStatus& frameStatus() const { return frame_; }
  Result<FrothViewStatus> viewStatus() const;  // of the newest complete frame

  // Levels of detail of the asset; 1: it has none. 0 before it is ready.
  uint32_t levelCount() const { return levelCount_; }
  Result<std::vector<FrothChunk>> chunks() const;
  Result<FrothStreamStatus> streamStatus() const;

  // The path to fly: the given keys, else those stored in the asset, else its start view alone, for cells far off may
  // make its bounds much larger than what its cameras saw; else an orbit around the bounds. Only when ready.
  Result<CameraPath> path(std::vector<Pose> keys) const;

  // Where the foam stands in the world; the asset's own place until then. `asset` is filled in.
  Status place(FrothInstanceInfo placement);
  // For calls that the scene does not wrap.
  FrothContext* context() const { return context_; }
  Status check(FrothResult result, const char* call) const;  // an error with Froth's newest message

 private:
  Scene() = default;
  Status open(const std::string& asset);
  FrothAssetInfo assetInfo() const;  // without bytes
  Status countLevels();

  SceneUses uses_;
  FrothContext* context_ = nullptr;
  std::unique_ptr<HttpReader> http_;  // of a URL
  FrothAsset assetHandle_{};
  FrothInstance instance_{};
  FrothView view_{};
  VkExtent2D extent_{};
  FrothAssetStatus asset_{};
  FrothFrameStatus frame_{};
  uint32_t levelCount_ = 0;
  std::string lastMessage_;
};

// Host::submit() waits, so the frame before is always complete.
using RecordFrame = std::function<Status(VkCommandBuffer, uint64_t serial)>;
Status submitFrame(Host& host, Scene& scene, const RecordFrame& record);
Status waitUntilReady(Host& host, Scene& scene);
// For files, which should show the whole foam: a frame that overflowed is drawn again, as beginFrame() made room.
Status submitWholeFrame(Host& host, Scene& scene, const RecordFrame& record);

}  // namespace froth
