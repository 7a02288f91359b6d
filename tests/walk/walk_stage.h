// Rays on the GPU through the runtime's public calls, with validation, index checks and counts.
#pragma once

#include <functional>
#include <list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/image/image.h"
#include "format/asset_contents.h"
#include "froth/froth_query.h"
#include "froth/froth_walk.h"
#include "host/host.h"
#include "reference/camera/camera.h"
#include "runtime/device/device.h"

namespace froth::test {

// What the tests' rays are relative to, unless they say otherwise.
FrothWalkInfo walkInfo(const glm::dvec3& eye = glm::dvec3(0));

FrothGpuRay gpuRay(const glm::vec3& origin, const glm::vec3& direction, float tMin = 0, float tMax = 0);

// From places in a box to others in it.
std::vector<FrothGpuRay> raysThrough(const glm::dvec3& low, const glm::dvec3& high, size_t count = 2000,
                                     uint64_t seed = 7);

// The ray of each pixel of a pinhole view, from its eye: the point to which rays are relative.
std::vector<FrothGpuRay> cameraRays(const View& view);
glm::dvec3 eyeOf(const View& view);

// Premultiplied colour and opacity of hits, pixel by pixel.
Image imageOf(const std::vector<FrothGpuHit>& hits, const View& view);

// All values of FrothRayPreparation, for tests with a parameter.
inline auto preparations() {
  return testing::Values(FROTH_PREPARE_NOTHING, FROTH_PREPARE_VISIBILITY, FROTH_PREPARE_RADIANCE);
}
std::string nameOfPreparation(const testing::TestParamInfo<FrothRayPreparation>& info);

// Assets and instances of the one context that these tests share: its pipelines take long to make. Any failing call,
// validation message or index violation fails the test.
class WalkStage {
 public:
  WalkStage();
  ~WalkStage();

  // READY, kept for queries. layers: as FrothAssetInfo's
  FrothAsset open(const AssetContents& contents, FrothRayPreparation prepared = FROTH_PREPARE_NOTHING,
                  uint32_t layers = 0);
  FrothInstance place(FrothAsset asset, FrothInstanceInfo placement = {});
  void move(FrothInstance instance, FrothAsset asset, FrothInstanceInfo placement);

  // One frame: update, upload, walk set, and what `record` adds with it.
  void frame(const FrothWalkInfo& info, const std::function<void(VkCommandBuffer, VkDescriptorSet)>& record,
             FrothResult expected = FROTH_OK);
  std::vector<FrothGpuHit> cast(const std::vector<FrothGpuRay>& rays, FrothRayKind kind,
                                const FrothWalkInfo& info = walkInfo());
  // Rays relative to `eye`.
  std::vector<FrothRayHit> castOnHost(const std::vector<FrothGpuRay>& rays, FrothCastInfo info,
                                      const glm::dvec3& eye = glm::dvec3(0)) const;
  Image rasterize(const View& view);  // premultiplied linear colour and opacity
  FrothWalkStatus status();           // of the newest frame

  FrothContext* context() const { return context_; }
  Device& device() { return device_; }

 private:
  FrothContext* context_;
  Device device_;
  std::vector<FrothInstance> instances_;
  std::vector<FrothAsset> assets_;
  std::list<std::vector<uint8_t>> bytes_;
};

}  // namespace froth::test
