#include "tests/walk/walk_stage.h"

#include <cstring>

#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "tests/query/query_fixture.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

FrothContext* createWalkContext(FrothContextInfo info) {
  info.onMessage = failOnMessage;
  info.checkIndices = 1;
  info.countWork = 1;
  info.walkShaders = 1;
  FrothContext* context = nullptr;
  check(frothCreateContext(&info, &context), "frothCreateContext");
  return context;
}

}  // namespace

std::string nameOfPreparation(const testing::TestParamInfo<FrothRayPreparation>& info) {
  constexpr const char* kNames[] = {"Nothing", "Visibility", "Radiance"};
  return kNames[info.param];
}

FrothWalkInfo walkInfo(const glm::dvec3& eye) {
  FrothWalkInfo info{};
  info.structSize = sizeof(info);
  for (int axis = 0; axis < 3; ++axis) info.eye[axis] = eye[axis];
  return info;
}

FrothGpuRay gpuRay(const glm::vec3& origin, const glm::vec3& direction, float tMin, float tMax) {
  FrothGpuRay ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = origin[axis];
    ray.direction[axis] = direction[axis];
  }
  ray.tMin = tMin;
  ray.tMax = tMax;
  return ray;
}

std::vector<FrothGpuRay> raysThrough(const glm::dvec3& low, const glm::dvec3& high, size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<FrothGpuRay> rays;
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 origin(random.inBox(low, high));
    rays.push_back(gpuRay(origin, glm::vec3(glm::normalize(random.inBox(low, high) - glm::dvec3(origin)))));
  }
  return rays;
}

glm::dvec3 eyeOf(const View& view) {
  return {view.worldFromCamera[3], view.worldFromCamera[7], view.worldFromCamera[11]};
}

std::vector<FrothGpuRay> cameraRays(const View& view) {
  std::vector<FrothGpuRay> rays;
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const double local[3] = {(x + 0.5 - view.cx) / view.fx, (y + 0.5 - view.cy) / view.fy, 1};
      glm::dvec3 direction(0);
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
          direction[row] += view.worldFromCamera[4 * row + column] * local[column];
        }
      }
      rays.push_back(gpuRay(glm::vec3(0), glm::vec3(glm::normalize(direction))));
    }
  }
  return rays;
}

Image imageOf(const std::vector<FrothGpuHit>& hits, const View& view) {
  Image image{view.width, view.height, 4, {}};
  for (const FrothGpuHit& hit : hits) {
    image.values.insert(image.values.end(), hit.colour, hit.colour + 3);
    image.values.push_back(1 - hit.transmittance);
  }
  return image;
}

WalkStage::WalkStage() {
  FrothContextInfo info = sharedContextInfo();
  static FrothContext* const context = createWalkContext(info);
  context_ = context;
  Result<Device> device = Device::create(info.getInstanceProcAddr, info.instance, info.physicalDevice, info.device);
  EXPECT_TRUE(device);
  device_ = *device;
}

WalkStage::~WalkStage() {
  for (const FrothInstance instance : instances_) {
    check(frothDestroyInstance(context_, instance), "frothDestroyInstance");
  }
  for (const FrothAsset asset : assets_) check(frothCloseAsset(context_, asset), "frothCloseAsset");
  frame(walkInfo(), [](VkCommandBuffer, VkDescriptorSet) {});
  static size_t reported = 0;
  const std::vector<std::string> messages = sharedHost().validationMessages();
  for (; reported < messages.size(); ++reported) ADD_FAILURE() << messages[reported];
}

FrothAsset WalkStage::open(const AssetContents& contents, FrothRayPreparation prepared, uint32_t layers) {
  Result<std::vector<uint8_t>> bytes = encodeAsset(contents);
  EXPECT_TRUE(bytes) << bytes.error().message;
  const std::vector<uint8_t>& kept = bytes_.emplace_back(std::move(*bytes));
  FrothAssetInfo info{};
  info.structSize = sizeof(info);
  info.data = kept.data();
  info.dataSize = kept.size();
  info.keepForQueries = 1;
  info.prepareRays = prepared;
  info.layers = layers;
  FrothAsset asset{};
  check(frothOpenAsset(context_, &info, &asset), "frothOpenAsset");
  assets_.push_back(asset);
  FrothAssetStatus status{};
  status.structSize = sizeof(status);
  do {
    frame(walkInfo(), [](VkCommandBuffer, VkDescriptorSet) {});
    check(frothGetAssetStatus(context_, asset, &status), "frothGetAssetStatus");
  } while (status.state == FROTH_ASSET_OPENING && !testing::Test::HasFailure());
  EXPECT_EQ(status.state, FROTH_ASSET_READY);
  return asset;
}

FrothInstance WalkStage::place(FrothAsset asset, FrothInstanceInfo placement) {
  placement.structSize = sizeof(placement);
  placement.asset = asset;
  FrothInstance instance{};
  check(frothCreateInstance(context_, &placement, &instance), "frothCreateInstance");
  instances_.push_back(instance);
  return instance;
}

void WalkStage::move(FrothInstance instance, FrothAsset asset, FrothInstanceInfo placement) {
  placement.structSize = sizeof(placement);
  placement.asset = asset;
  check(frothSetInstance(context_, instance, &placement), "frothSetInstance");
}

void WalkStage::frame(const FrothWalkInfo& info, const std::function<void(VkCommandBuffer, VkDescriptorSet)>& record,
                      FrothResult expected) {
  const Status submitted = sharedHost().submit([&](VkCommandBuffer commandBuffer, uint64_t serial) -> Status {
    const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
    check(frothUpdate(context_, &frame, nullptr), "frothUpdate");
    check(frothRecordUpload(context_, commandBuffer), "frothRecordUpload");
    VkDescriptorSet set = VK_NULL_HANDLE;
    EXPECT_EQ(frothRecordWalkSet(context_, commandBuffer, &info, &set), expected);
    record(commandBuffer, set);
    return {};
  });
  EXPECT_TRUE(submitted) << submitted.error().message;
}

std::vector<FrothGpuHit> WalkStage::cast(const std::vector<FrothGpuRay>& rays, FrothRayKind kind,
                                         const FrothWalkInfo& info) {
  const VkDeviceSize raysSize = rays.size() * sizeof(FrothGpuRay);
  Result<GpuBuffer> buffer = device_.createBuffer(MemoryUse::kViewsHost, BufferKind::kReadback,
                                                  raysSize + rays.size() * sizeof(FrothGpuHit), "rays and hits");
  EXPECT_TRUE(buffer) << buffer.error().message;
  std::memcpy(buffer->mapped, rays.data(), raysSize);
  frame(info, [&](VkCommandBuffer commandBuffer, VkDescriptorSet) {
    check(frothRecordRays(context_, commandBuffer, buffer->address, buffer->address + raysSize,
                          static_cast<uint32_t>(rays.size()), kind),
          "frothRecordRays");
    device_.table.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                      VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                                      VK_ACCESS_2_HOST_READ_BIT);
  });
  std::vector<FrothGpuHit> hits(rays.size());
  std::memcpy(hits.data(), static_cast<const char*>(buffer->mapped) + raysSize, hits.size() * sizeof(FrothGpuHit));
  device_.destroyBuffer(*buffer);
  return hits;
}

std::vector<FrothRayHit> WalkStage::castOnHost(const std::vector<FrothGpuRay>& rays, FrothCastInfo info,
                                               const glm::dvec3& eye) const {
  info.structSize = sizeof(info);
  std::vector<FrothRay> asked;
  for (const FrothGpuRay& ray : rays) {
    const float* o = ray.origin;
    const float* d = ray.direction;
    asked.push_back({{eye.x + o[0], eye.y + o[1], eye.z + o[2]}, {d[0], d[1], d[2]}, ray.tMin, ray.tMax});
  }
  std::vector<FrothRayHit> hits(rays.size());
  check(frothCastRays(context_, &info, asked.data(), hits.data(), static_cast<uint32_t>(hits.size())), "frothCastRays");
  return hits;
}

Image WalkStage::rasterize(const View& view) {
  const FrothViewInfo viewInfo{sizeof(FrothViewInfo), {view.width, view.height}, 0, 0, 0, 0, 0, {}, 0, 0};
  FrothView handle{};
  check(frothCreateView(context_, &viewInfo, &handle), "frothCreateView");
  Host& host = sharedHost();
  Result<HostImage> image = host.createImage(VK_FORMAT_R32G32B32A32_SFLOAT, {view.width, view.height});
  FrothRenderInfo info = infoOf(view);
  info.displayCoded = 0;
  info.colour = host.describe(*image);
  frame(walkInfo(), [&](VkCommandBuffer commandBuffer, VkDescriptorSet) {
    check(frothRecordRaster(context_, handle, commandBuffer, &info), "frothRecordRaster");
  });
  const Result<std::vector<float>> texels = host.readImage(*image);
  host.destroyImage(*image);
  check(frothDestroyView(context_, handle), "frothDestroyView");
  Image colour{view.width, view.height, 4, *texels};
  return colour;
}

FrothWalkStatus WalkStage::status() {
  frame(walkInfo(), [](VkCommandBuffer, VkDescriptorSet) {});
  FrothWalkStatus status{};
  status.structSize = sizeof(status);
  check(frothGetWalkStatus(context_, &status), "frothGetWalkStatus");
  EXPECT_EQ(status.indexViolations, 0u);
  return status;
}

}  // namespace froth::test
