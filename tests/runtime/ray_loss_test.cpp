// Rays on the GPU over a device that goes.
#include "froth/froth_walk.h"
#include "runtime/device/device.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

class RayLoss : public RuntimeGpuTest {
 protected:
  void SetUp() override {
    RuntimeGpuTest::SetUp();
    useNewDevice();
    createContext(info());
  }

  // Destroys the device before.
  void useNewDevice() {
    Result<std::unique_ptr<Host>> host = Host::create({.device = "", .useValidation = true});
    ASSERT_TRUE(host) << host.error().message;
    ownHost_ = std::move(*host);
    host_ = ownHost_.get();
  }

  FrothContextInfo info() {
    FrothContextInfo info = host_->contextInfo();
    info.walkShaders = 1;
    info.countWork = 1;
    info.onMessage = logMessage;
    info.messageUser = &messages_;
    return info;
  }

  // Along z, side by side, through the sample.
  std::vector<FrothGpuHit> cast() {
    constexpr uint32_t kAlong = 12, kCount = kAlong * kAlong;
    Result<Device> made = Device::create(vkGetInstanceProcAddr, host_->instance, host_->physicalDevice, host_->device);
    Device& device = *made;
    constexpr VkDeviceSize kRaysSize = kCount * sizeof(FrothGpuRay), kHitsSize = kCount * sizeof(FrothGpuHit);
    Result<GpuBuffer> buffer =
        device.createBuffer(MemoryUse::kViewsHost, BufferKind::kReadback, kRaysSize + kHitsSize, "rays and hits");
    std::vector<FrothGpuRay> rays(kCount);
    for (uint32_t i = 0; i < kCount; ++i) {
      rays[i].origin[0] = 0.2f * static_cast<float>(i % kAlong) - 1.1f;
      rays[i].origin[1] = 0.2f * static_cast<float>(i / kAlong) - 1.1f;
      rays[i].origin[2] = -4;
      rays[i].direction[2] = 1;
    }
    std::memcpy(buffer->mapped, rays.data(), kRaysSize);
    auto walkInfo = makeStruct<FrothWalkInfo>();
    walkInfo.eye[2] = 1e6;  // where the sample lies
    EXPECT_EQ(update(++serial_), FROTH_OK) << lastText();
    EXPECT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
      EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK);
      VkDescriptorSet set = VK_NULL_HANDLE;
      EXPECT_EQ(frothRecordWalkSet(context_, commands, &walkInfo, &set), FROTH_OK) << lastText();
      EXPECT_EQ(frothRecordRays(context_, commands, buffer->address, buffer->address + kRaysSize, kCount,
                                FROTH_RAY_TRANSMITTANCE),
                FROTH_OK);
      device.table.recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                       VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                                       VK_ACCESS_2_HOST_READ_BIT);
      return Status();
    }));
    std::vector<FrothGpuHit> hits(kCount);
    std::memcpy(hits.data(), static_cast<const char*>(buffer->mapped) + kRaysSize, kHitsSize);
    device.destroyBuffer(*buffer);
    return hits;
  }

  void runUpload() {
    ASSERT_EQ(update(++serial_), FROTH_OK) << lastText();
    ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
      EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK);
      return Status();
    }));
  }

  static void expectSame(const std::vector<FrothGpuHit>& hits, const std::vector<FrothGpuHit>& expected) {
    size_t met = 0;
    for (size_t i = 0; i < hits.size(); ++i) {
      EXPECT_EQ(hits[i].transmittance, expected[i].transmittance) << i;
      EXPECT_EQ(hits[i].distance, expected[i].distance) << i;
      EXPECT_EQ(hits[i].cell, expected[i].cell) << i;
      EXPECT_EQ(hits[i].steps, expected[i].steps) << i << ": where the walk begins";
      met += expected[i].transmittance < 0.5f;
    }
    EXPECT_GT(met, hits.size() / 8);
  }

  uint64_t serial_ = 0;

 private:
  std::unique_ptr<Host> ownHost_;
};

// The table of entries went with the device, and no frame of the new one has filled it yet.
TEST_F(RayLoss, OfTheDeviceIsFollowedByTheSameHits) {
  const std::vector<uint8_t> bytes = encodeSample({.cellsPerChunk = 30});
  auto assetInfo = makeStruct<FrothAssetInfo>();
  assetInfo.data = bytes.data();
  assetInfo.dataSize = bytes.size();
  assetInfo.bytesStay = 1;
  FrothAsset asset{};
  ASSERT_EQ(frothOpenAsset(context_, &assetInfo, &asset), FROTH_OK);
  const FrothInstance instance = createInstance(asset);
  runUpload();
  const std::vector<FrothGpuHit> before = cast();
  expectSame(cast(), before);
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  useNewDevice();
  const FrothContextInfo restored = info();
  ASSERT_EQ(frothRestoreDevice(context_, &restored), FROTH_OK) << lastText();
  runUpload();
  expectSame(cast(), before);
  ASSERT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
}

}  // namespace
}  // namespace froth
