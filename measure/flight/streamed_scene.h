// Assets with levels on a simulated disk, seen by one view: an engine's loop in which time is counted in frames.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/image/image.h"
#include "base/result.h"
#include "froth/froth.h"
#include "froth/froth_stream.h"
#include "host/host.h"
#include "measure/flight/frame_jobs.h"
#include "measure/flight/simulated_disk.h"
#include "measure/gpu/gpu_renderer.h"

namespace froth {

constexpr uint32_t kJobThreads = 2;
constexpr uint32_t kMostCopies = 14;  // instances that a view shows (froth.h)

struct SceneOptions {
  std::filesystem::path asset;
  // The file is opened so often, as assets of their own. The first stands as it is, the others on a grid around it, the
  // nearest places first.
  uint32_t copies = 1;
  uint64_t budget = 0;  // [bytes] FrothContextInfo::deviceBudget
  float detail = 1;     // FrothStreamInfo::detail
  uint64_t mostCells = 0;
  uint32_t fadeFrames = 0, reserveCells = 0;  // FrothViewInfo
  double frameSeconds = 1.0 / 60;
  VkExtent2D extent{1920, 1080};
  DiskOptions disk;
  GpuRenderOptions render;
};

// The same on a fast disk with all cells of level 0, whatever they take, without fades.
SceneOptions allCellsOf(const SceneOptions& options);

struct FlownFrame {
  double updateMs = 0;  // [ms] frothUpdate, on the clock
  // [ms] by pass, once a further frame is drawn; empty: the device tells no times. A fade has most passes twice.
  std::vector<FrothPassTime> passes;
  double gpuMs = 0;        // [ms] sum of passes
  bool isReady = false;    // the floors are there
  bool isFading = false;   // drew two cuts, once a further frame is drawn and the device tells times
  bool isWhole = false;    // there was room for all cells, as far as is known when a further frame is drawn
  bool isLimited = false;  // maxEntries or maxSteps ended lists or walks; known then, too
  FrothStreamStatus stream{};
  uint64_t deviceBytes = 0;  // of the context
};

struct FlownImage {
  Image colour, alpha;
};

class StreamedScene {
 public:
  static Result<std::unique_ptr<StreamedScene>> create(Host& host, const SceneOptions& options);
  ~StreamedScene();

  // The next frame, of a view of the scene's extent.
  Status draw(const View& view);
  // Draws until what is wanted from there is drawn.
  Status settle(const View& view);
  const std::vector<FlownFrame>& frames() const { return frames_; }  // all that were drawn
  Result<FlownImage> readImage();                                    // of the newest frame

  uint64_t bytesRead() const { return disk_.bytesRead(); }
  FrothAssetStatus assetStatus() const { return statusOf(assets_.front()); }  // of the first copy
  // Ascending; of the newest frame. Chunks of the second copy follow those of the first.
  Result<std::vector<uint32_t>> drawnChunks() const;

 private:
  StreamedScene(Host& host, SimulatedDisk disk, const SceneOptions& options)
      : host_(host), disk_(std::move(disk)), options_(options), jobs_(kJobThreads) {}
  Status begin();
  Status openAssets();
  Status placeCopies(bool& arePlaced);
  Status placeCopy(size_t copy);
  FrothAssetStatus statusOf(FrothAsset asset) const;
  Status check(FrothResult result, const char* call) const;
  Status record(const View& view, VkCommandBuffer commands, uint64_t serial, FlownFrame& frame);
  Status completeFrameBefore();

  Host& host_;
  SimulatedDisk disk_;
  SceneOptions options_;
  FrameJobs jobs_;
  FrothContext* context_ = nullptr;
  std::vector<FrothAsset> assets_;  // [copies]
  size_t placed_ = 0;               // of them have an instance
  FrothView view_{};
  HostImage image_;
  std::vector<FlownFrame> frames_;
  std::string lastMessage_;
};

}  // namespace froth
