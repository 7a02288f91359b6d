// What GpuRenderer holds: of gpu_renderer.cpp and gpu_rays.cpp alone.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "froth/froth_stream.h"
#include "froth/froth_walk.h"
#include "measure/gpu/gpu_renderer.h"

namespace froth {

struct GpuRenderer::State {
  ~State();

  Error error(FrothResult result, const char* call) const;
  Status check(FrothResult result, const char* call) const;

  Status createContext(const GpuDeviceOptions& options);
  Status closeAsset();
  Status openAsset(const AssetInput& input, const Progress& progress);
  Result<std::vector<FrothChunk>> chunks() const;
  Status place(const std::vector<FrothInstanceInfo>& placements);
  Status setExtent(VkExtent2D wanted, bool wantsAllChannels);
  // Uploads the view's ray map, if it has one.
  Status setRayMap(const View& wanted);
  // Uploads where the scene ends the view's rays, if it does.
  Status setSceneDepth(const View& wanted, const GpuRenderOptions& drawing);
  void destroyImages();

  // Records frothUpdate and the uploads, then what `record` adds, if it is given.
  Status submitFrame(const std::function<Status(VkCommandBuffer)>& record = {});
  Result<FrothViewStatus> drawAndAsk(const FrothRenderInfo& info, Method method);
  Result<bool> isSettled() const;  // what the view wants of levels is drawn
  Status checkSilence(uint32_t indexViolations);
  Result<RenderedImages> readImages(bool readsNormal);
  // One frame of rays from `eye`; `buffer` holds them, and the hits behind them.
  Status recordRays(const glm::dvec3& eye, const RayOptions& wanted, const HostBuffer& buffer, uint32_t count,
                    VkCommandBuffer commands);
  Result<std::vector<FrothGpuHit>> castAndRead(const glm::dvec3& eye, const RayOptions& wanted,
                                               const std::vector<FrothGpuRay>& asked);
  Result<GpuFrame> drawAndRead(const View& wanted, const GpuRenderOptions& drawing, bool wantsAllChannels);

  GpuDeviceOptions options;
  std::unique_ptr<Host> host;
  FrothContext* context = nullptr;
  FrothAsset asset{};
  std::vector<FrothInstance> instances;
  bool hasAsset = false, hasLevels = false;
  FrothView view{};
  VkExtent2D extent{};
  HostImage colour, distance, normal, rays, sceneDepth;
  std::shared_ptr<const RayMap> uploadedRays;  // what `rays` holds
  std::string lastMessage;
};

}  // namespace froth
