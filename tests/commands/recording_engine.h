// An engine that records frames of everything the runtime can do, and says to a CommandStream what it does to its own
// images.
#pragma once

#include <vector>

#include "froth/froth.h"
#include "froth/froth_composite.h"
#include "froth/froth_walk.h"
#include "host/host.h"
#include "tests/commands/command_stream.h"

namespace froth::test {

enum class CameraKind { kProjection, kParallel, kFisheye, kRayMap };

// What one frame draws besides colour.
struct FrameForm {
  CameraKind camera = CameraKind::kProjection;
  VkFormat colour = VK_FORMAT_R16G16B16A16_SFLOAT;
  bool isFull = false;   // all images, and a scene's depth
  bool isEmpty = false;  // no instance is in sight of its mask
};

class RecordingEngine {
 public:
  static constexpr VkExtent2D kExtent{72, 40};

  // Opens an asset and places it so many times. reserveCells: FrothViewInfo's; 1: the view may lack cells. hasLevels:
  // one whose chunks come and are drawn in the first frames, and a view that fades.
  RecordingEngine(uint32_t instanceCount, VkFormat compositeFormat, uint32_t reserveCells = 0, bool hasLevels = false);
  ~RecordingEngine();

  // Raster and walk by both eyes, composite, depth export, rays.
  void recordFrame(const FrameForm& form);

  void finish() { stream.complete(serial_); }  // waits for all frames

  CommandStream stream;

 private:
  FrothImage output(VkFormat format);
  FrothImage input(VkFormat format);
  FrothRenderInfo renderInfo(const FrameForm& form, uint32_t eye);
  void readOutputs(const FrothRenderInfo& info);
  void recordRays();
  void recordOver(const FrothRenderInfo& info, bool isProjection);
  void use(const FrothImage& image, VkPipelineStageFlags2 stage, VkAccessFlags2 access, bool isWrite);

  VkFormat compositeFormat_;
  FrothContext* context_ = nullptr;
  std::vector<uint8_t> bytes_;
  FrothAsset asset_{};
  std::vector<FrothInstance> instances_;
  FrothView view_{};
  uint64_t serial_ = 0;
  uint64_t images_ = 0;
};

}  // namespace froth::test
