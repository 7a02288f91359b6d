// A device goes, another comes: handles stay, the picture comes back bit for bit.
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class DeviceLoss : public RuntimeGpuTest {
 protected:
  void SetUp() override {
    RuntimeGpuTest::SetUp();
    useNewDevice();
    createContext(infoOf(*host_));
  }

  // Destroys the device before.
  void useNewDevice() {
    Result<std::unique_ptr<Host>> host = Host::create({.device = "", .useValidation = true});
    ASSERT_TRUE(host) << host.error().message;
    ownHost_ = std::move(*host);
    host_ = ownHost_.get();
  }

  FrothContextInfo infoOf(const Host& host) {
    FrothContextInfo info = host.contextInfo();
    info.onMessage = logMessage;
    info.messageUser = &messages_;
    return info;
  }

  // What an engine does: Froth lets go, then the device goes.
  void loseDevice() {
    ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
    EXPECT_THAT(host_->validationMessages(), ::testing::IsEmpty());
    useNewDevice();
  }

  void restoreDevice() {
    const FrothContextInfo info = infoOf(*host_);
    ASSERT_EQ(frothRestoreDevice(context_, &info), FROTH_OK) << lastText();
  }

  FrothAsset openLastingBytes(const std::vector<uint8_t>& bytes) {
    auto info = makeStruct<FrothAssetInfo>();
    info.data = bytes.data();
    info.dataSize = bytes.size();
    info.bytesStay = 1;
    FrothAsset asset{};
    EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK) << lastText();
    return asset;
  }

  // The serials of a new host begin anew; the context's go on.
  void runFrame(const std::function<void(VkCommandBuffer)>& record = {}) {
    ASSERT_EQ(update(++serial_), FROTH_OK) << lastText();
    ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
      EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK) << lastText();
      if (record) record(commands);
      return Status();
    }));
  }

  std::vector<float> draw(FrothView view, decltype(frothRecordRaster)* method) {
    Result<HostImage> image = host_->createImage(VK_FORMAT_R32G32B32A32_SFLOAT, {48, 48});
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = makeCamera(48, 48);
    info.camera.eye[2] = 1e6 - 1;  // where the sample lies
    info.colour = host_->describe(*image);
    runFrame(
        [&](VkCommandBuffer commands) { EXPECT_EQ(method(context_, view, commands, &info), FROTH_OK) << lastText(); });
    const Result<std::vector<float>> texels = host_->readImage(*image);
    host_->destroyImage(*image);
    return *texels;
  }

  uint64_t serial_ = 0;

 private:
  std::unique_ptr<Host> ownHost_;
};

TEST_F(DeviceLoss, IsSurvivedByHandlesAndTheImageAfterwardsIsTheSame) {
  const std::vector<uint8_t> bytes = encodeSample();
  for (const bool isFile : {true, false}) {
    const FrothAsset asset = isFile ? openPath(writeFile("scene.froth", bytes)) : openLastingBytes(bytes);
    const FrothInstance instance = createInstance(asset);
    const FrothView view = createView({48, 48});
    runFrame();
    ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
    const uint64_t deviceBytes = statusOf(asset).deviceBytes;
    const std::vector<float> raster = draw(view, frothRecordRaster), walk = draw(view, frothRecordWalk);
    EXPECT_NE(raster, std::vector<float>(raster.size()));

    loseDevice();
    EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
    restoreDevice();
    runFrame();
    EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
    EXPECT_EQ(statusOf(asset).deviceBytes, deviceBytes) << "not twice";
    EXPECT_EQ(draw(view, frothRecordRaster), raster);
    EXPECT_EQ(draw(view, frothRecordWalk), walk);
    EXPECT_THAT(messages_, ::testing::IsEmpty());
    ASSERT_EQ(frothDestroyView(context_, view), FROTH_OK);
    ASSERT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
    ASSERT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  }
}

TEST_F(DeviceLoss, LeavesObjectsToBeMadeAndDestroyedAndRefusesFrames) {
  const FrothView old = createView({48, 48});
  runFrame();
  loseDevice();
  EXPECT_EQ(update(++serial_), FROTH_ERROR_DEVICE);
  EXPECT_THAT(lastText(), HasSubstr("call frothRestoreDevice"));
  EXPECT_EQ(frothRecordUpload(context_, nullptr), FROTH_ERROR_DEVICE);
  const auto info = makeStruct<FrothRenderInfo>();
  EXPECT_EQ(frothRecordRaster(context_, old, nullptr, &info), FROTH_ERROR_DEVICE);
  EXPECT_EQ(frothDestroyView(context_, old), FROTH_OK);
  const std::vector<uint8_t> bytes = encodeSample();
  const FrothInstance instance = createInstance(openLastingBytes(bytes));
  const FrothView view = createView({48, 48});
  auto report = makeStruct<FrothMemoryReport>();
  EXPECT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
  EXPECT_EQ(report.deviceBytes, 0u);
  EXPECT_EQ(frothDeviceLost(context_), FROTH_OK) << "twice is once";
  restoreDevice();
  runFrame();
  const std::vector<float> image = draw(view, frothRecordRaster);
  EXPECT_NE(image, std::vector<float>(image.size()));
  EXPECT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
}

TEST_F(DeviceLoss, FailsAnAssetWhoseBytesAreGone) {
  const FrothAsset asset = openBytes(encodeSample());  // without bytesStay
  runFrame();
  loseDevice();
  restoreDevice();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED);
  EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("bytesStay"));
  runFrame();
  EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
}

TEST_F(DeviceLoss, ForgetsTheFramesInFlight) {
  auto frame = makeStruct<FrothFrame>();
  for (frame.serial = 1; frame.serial <= 2; ++frame.serial) {
    ASSERT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK);
  }
  EXPECT_EQ(frothDestroyContext(context_, 1), FROTH_PENDING);
  loseDevice();
  restoreDevice();
  EXPECT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK) << "two are in flight no more";
  EXPECT_EQ(frothDropFrame(context_, 1), FROTH_ERROR_STATE);
}

TEST_F(DeviceLoss, IsRestoredOnlyFromALossAndOnTheSameKindOfContext) {
  FrothContextInfo info = infoOf(*host_);
  EXPECT_EQ(frothRestoreDevice(context_, &info), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("call frothDeviceLost first"));
  loseDevice();
  info = infoOf(*host_);
  info.device = VK_NULL_HANDLE;
  EXPECT_EQ(frothRestoreDevice(context_, &info), FROTH_ERROR_ARGUMENT);
  info = infoOf(*host_);
  info.queueFamily = 99;
  EXPECT_EQ(frothRestoreDevice(context_, &info), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(update(1), FROTH_ERROR_DEVICE) << "still lost";
  restoreDevice();
  EXPECT_EQ(update(1), FROTH_OK);
}

TEST_F(DeviceLoss, OnANullContextLosesNothing) {
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  createContext();
  const FrothAsset asset = openBytes(encodeSample());
  ASSERT_EQ(update(1), FROTH_OK);
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  FrothContextInfo info = nullContextInfo();
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  ASSERT_EQ(frothRestoreDevice(context_, &info), FROTH_OK);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
}

TEST_F(DeviceLoss, AnEndWithFramesInFlightIsPending) {
  auto frame = makeStruct<FrothFrame>();
  frame.serial = 5;
  ASSERT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK);
  frame.serial = 6;
  ASSERT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK);
  EXPECT_EQ(frothDestroyContext(context_, 4), FROTH_PENDING);
  EXPECT_EQ(frothDestroyContext(context_, 5), FROTH_PENDING);
  EXPECT_EQ(frothDropFrame(context_, 6), FROTH_OK) << "the context stayed as it was";
  EXPECT_EQ(frothDestroyContext(context_, 5), FROTH_OK);
  context_ = nullptr;
}

}  // namespace
}  // namespace froth
