#include "runtime_fixture.h"

namespace froth {
namespace {

class RecordCallOnDevice : public RuntimeGpuTest {
 protected:
  void SetUp() override {
    RuntimeGpuTest::SetUp();
    FrothContextInfo info = host_->contextInfo();
    info.checkIndices = 1;
    createContext(info);
    Result<HostImage> image = host_->createImage(VK_FORMAT_R16G16B16A16_SFLOAT, {16, 16});
    ASSERT_TRUE(image) << image.error().message;
    image_ = *image;
    view_ = createView({16, 16});
  }

  void TearDown() override {
    host_->destroyImage(image_);
    RuntimeGpuTest::TearDown();
  }

  FrothRenderInfo renderInfo() const {
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = makeCamera(16, 16);
    info.colour = host_->describe(image_);
    return info;
  }

  // A frame that draws; returns what the call said.
  FrothResult drawFrame(uint64_t uploadBytes = 0) {
    const FrothRenderInfo info = renderInfo();
    FrothResult result = FROTH_RESULT_MAX;
    runFrame(uploadBytes,
             [&](VkCommandBuffer commands) { result = frothRecordRaster(context_, view_, commands, &info); });
    return result;
  }

  HostImage image_;
  FrothView view_{};
};

TEST_F(RecordCallOnDevice, ClearsTheImageWhileTheAssetIsNotReadyAndSaysSo) {
  const FrothAsset asset = openBytes(encodeSample());
  createInstance(asset);
  EXPECT_EQ(drawFrame(100), FROTH_INCOMPLETE);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
  const Result<std::vector<float>> texels = host_->readImage(image_);
  ASSERT_TRUE(texels) << texels.error().message;
  EXPECT_THAT(*texels, ::testing::Each(0.0f));

  EXPECT_EQ(drawFrame(), FROTH_OK) << "the rest is uploaded and drawn in the same frame";
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  auto status = makeStruct<FrothViewStatus>();
  EXPECT_EQ(drawFrame(), FROTH_OK);
  ASSERT_EQ(frothGetViewStatus(context_, view_, &status), FROTH_OK);
  EXPECT_EQ(status.bits & FROTH_VIEW_NOT_READY, 0u);
  EXPECT_EQ(status.indexViolations, 0u);
}

TEST_F(RecordCallOnDevice, KeepsTheBitOfAnIncompleteFrameInItsStatus) {
  createInstance(openBytes(encodeSample()));
  EXPECT_EQ(drawFrame(100), FROTH_INCOMPLETE);
  const uint64_t incompleteSerial = host_->nextSerial() - 1;
  runFrame(100);
  auto status = makeStruct<FrothViewStatus>();
  ASSERT_EQ(frothGetViewStatus(context_, view_, &status), FROTH_OK);
  EXPECT_EQ(status.serial, incompleteSerial);
  EXPECT_EQ(status.bits, static_cast<uint32_t>(FROTH_VIEW_NOT_READY));
}

TEST_F(RecordCallOnDevice, LeavesOutAnInstanceThatCameAfterTheUpdate) {
  const FrothAsset asset = openBytes(encodeSample());
  runFrame();
  ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  const FrothRenderInfo info = renderInfo();
  FrothResult result = FROTH_RESULT_MAX;
  runFrame(0, [&](VkCommandBuffer commands) {
    createInstance(asset);
    result = frothRecordRaster(context_, view_, commands, &info);
  });
  EXPECT_EQ(result, FROTH_INCOMPLETE);
  EXPECT_EQ(drawFrame(), FROTH_OK);
}

TEST_F(RecordCallOnDevice, DrawsAViewOnceInAFrame) {
  const FrothRenderInfo info = renderInfo();
  runFrame(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(frothRecordRaster(context_, view_, commands, &info), FROTH_OK);
    EXPECT_EQ(frothRecordRaster(context_, view_, commands, &info), FROTH_ERROR_STATE);
    EXPECT_EQ(frothRecordWalk(context_, view_, commands, &info), FROTH_OK);
    EXPECT_EQ(frothRecordRaster(context_, view_, nullptr, &info), FROTH_ERROR_STATE);
  });
}

TEST_F(RecordCallOnDevice, OfADroppedFrameIsNeverReadBack) {
  createInstance(openBytes(encodeSample()));
  EXPECT_EQ(drawFrame(), FROTH_OK);
  const uint64_t drawnSerial = host_->nextSerial() - 1;
  const uint64_t droppedSerial = host_->nextSerial();
  const FrothRenderInfo info = renderInfo();
  ASSERT_EQ(update(droppedSerial), FROTH_OK);
  const Status status = host_->submit([&](VkCommandBuffer commands, uint64_t) -> Status {
    EXPECT_EQ(frothRecordRaster(context_, view_, commands, &info), FROTH_OK);
    return makeError(ErrorKind::kCancelled, "dropped");
  });
  ASSERT_FALSE(status);
  ASSERT_EQ(frothDropFrame(context_, droppedSerial), FROTH_OK);
  runFrame();
  runFrame();
  auto viewStatus = makeStruct<FrothViewStatus>();
  ASSERT_EQ(frothGetViewStatus(context_, view_, &viewStatus), FROTH_OK);
  EXPECT_EQ(viewStatus.serial, drawnSerial);
}

// Clears of whole buffers, as the driver sees them.
struct CountedClears {
  static inline uint32_t count = 0;
  static inline PFN_vkCmdFillBuffer fillBuffer = nullptr;

  static VKAPI_ATTR void VKAPI_CALL fill(VkCommandBuffer commands, VkBuffer buffer, VkDeviceSize offset,
                                         VkDeviceSize size, uint32_t data) {
    count += size == VK_WHOLE_SIZE;
    fillBuffer(commands, buffer, offset, size, data);
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    const PFN_vkVoidFunction real = vkGetDeviceProcAddr(device, name);
    if (std::strcmp(name, "vkCmdFillBuffer") != 0) return real;
    fillBuffer = reinterpret_cast<PFN_vkCmdFillBuffer>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(fill);
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    return vkGetInstanceProcAddr(instance, name);
  }
};

// Where a walk starts is what the last one left in a buffer. The first one clears it; a dropped frame did not.
TEST_F(RecordCallOnDevice, AWalkAfterADroppedFirstOneClearsItsStart) {
  frothDestroyContext(context_, UINT64_MAX);
  FrothContextInfo contextInfo = host_->contextInfo();
  contextInfo.getInstanceProcAddr = CountedClears::getInstanceProcAddr;
  createContext(contextInfo);
  view_ = createView({16, 16});
  createInstance(openBytes(encodeSample()));
  runFrame();
  const FrothRenderInfo info = renderInfo();
  CountedClears::count = 0;
  const uint64_t droppedSerial = host_->nextSerial();
  ASSERT_EQ(update(droppedSerial), FROTH_OK);
  const Status status = host_->submit([&](VkCommandBuffer commands, uint64_t) -> Status {
    EXPECT_EQ(frothRecordWalk(context_, view_, commands, &info), FROTH_OK);
    return makeError(ErrorKind::kCancelled, "dropped");
  });
  ASSERT_FALSE(status);
  ASSERT_EQ(frothDropFrame(context_, droppedSerial), FROTH_OK);
  for (int frame = 0; frame < 2; ++frame) {
    runFrame(0,
             [&](VkCommandBuffer commands) { EXPECT_EQ(frothRecordWalk(context_, view_, commands, &info), FROTH_OK); });
    EXPECT_EQ(CountedClears::count, 2u) << "of the dropped frame, and of the first one that is not";
  }
}

TEST_F(RecordCallOnDevice, AFrameDroppedAmongOthersLeavesTheirCountsAlone) {
  frothDestroyContext(context_, UINT64_MAX);
  FrothContextInfo contextInfo = host_->contextInfo();
  contextInfo.framesInFlight = 3;
  createContext(contextInfo);
  view_ = createView({16, 16});
  const FrothRenderInfo info = renderInfo();
  const auto beginFrame = [&](uint64_t serial, uint64_t completedSerial) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = serial;
    frame.completedSerial = completedSerial;
    ASSERT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK) << lastText();
  };
  const auto record = [&] {
    const Status status = host_->submit([&](VkCommandBuffer commands, uint64_t) {
      EXPECT_EQ(frothRecordRaster(context_, view_, commands, &info), FROTH_OK) << lastText();
      return Status();
    });
    ASSERT_TRUE(status) << status.error().message;
  };
  for (const uint64_t serial : {1, 2, 3}) {
    beginFrame(serial, 0);
    record();
  }
  ASSERT_EQ(frothDropFrame(context_, 2), FROTH_OK);
  beginFrame(4, 0);  // frame 1 is still in flight: frame 4 must not take its place
  record();
  beginFrame(5, 1);
  auto status = makeStruct<FrothViewStatus>();
  ASSERT_EQ(frothGetViewStatus(context_, view_, &status), FROTH_OK);
  EXPECT_EQ(status.serial, 1u);
}

TEST_F(RecordCallOnDevice, SurvivesClosingAndDestroyingWhatTheFrameUses) {
  const FrothAsset asset = openBytes(encodeSample());
  const FrothInstance instance = createInstance(asset);
  runFrame();
  const FrothRenderInfo info = renderInfo();
  runFrame(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(frothRecordRaster(context_, view_, commands, &info), FROTH_OK);
    EXPECT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
    EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
    EXPECT_EQ(frothDestroyView(context_, view_), FROTH_OK);
  });
  auto frame = makeStruct<FrothFrame>();
  frame.serial = host_->nextSerial();
  frame.completedSerial = frame.serial - 1;
  auto status = makeStruct<FrothFrameStatus>();
  ASSERT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK);
  EXPECT_EQ(status.deviceBytes, 0u) << "all memory is back once the frame is complete";
}

// The engine's own mistake, told as the engine's: its image, within the label of Froth's call.
TEST_F(RecordCallOnDevice, AWrongEntryLayoutIsNamedWithTheImageAndTheCall) {
  FrothRenderInfo info = renderInfo();
  info.colour.layoutIn = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  runFrame(0, [&](VkCommandBuffer commands) {
    const FrothRenderInfo good = renderInfo();
    EXPECT_EQ(frothRecordRaster(context_, view_, commands, &good), FROTH_OK);  // leaves the image in GENERAL
    EXPECT_EQ(frothRecordWalk(context_, view_, commands, &info), FROTH_OK);
  });
  const std::vector<std::string> messages = host_->validationMessages();
  ASSERT_FALSE(messages.empty());
  char image[32];
  std::snprintf(image, sizeof(image), "%#llx", reinterpret_cast<unsigned long long>(image_.image));
  EXPECT_THAT(messages[0], ::testing::HasSubstr("[froth walk]"));
  EXPECT_THAT(messages[0], ::testing::HasSubstr(image));
  host_->forgetValidationMessages();
}

TEST_F(RecordCallOnDevice, ShowsFourteenInstancesAndTellsOfMore) {
  const FrothAsset asset = openBytes(encodeSample());
  for (int i = 0; i < 14; ++i) createInstance(asset);
  runFrame();
  EXPECT_EQ(drawFrame(), FROTH_OK) << lastText();
  createInstance(asset);
  EXPECT_EQ(drawFrame(), FROTH_INCOMPLETE);
  auto status = makeStruct<FrothViewStatus>();
  runFrame();
  ASSERT_EQ(frothGetViewStatus(context_, view_, &status), FROTH_OK);
  EXPECT_EQ(status.bits, static_cast<uint32_t>(FROTH_VIEW_INSTANCE_LIMIT));
}

TEST_F(RecordCallOnDevice, ShowsTheInstancesThatShareABitWithTheView) {
  const FrothAsset asset = openBytes(encodeSample());
  auto hidden = makeStruct<FrothInstanceInfo>();
  hidden.asset = asset;
  hidden.mask = 2;
  FrothInstance instance{};
  ASSERT_EQ(frothCreateInstance(context_, &hidden, &instance), FROTH_OK);
  runFrame();
  const auto countVisible = [&](uint32_t mask) {
    FrothRenderInfo info = renderInfo();
    info.mask = mask;
    runFrame(
        0, [&](VkCommandBuffer commands) { EXPECT_EQ(frothRecordRaster(context_, view_, commands, &info), FROTH_OK); });
    runFrame();
    auto status = makeStruct<FrothViewStatus>();
    EXPECT_EQ(frothGetViewStatus(context_, view_, &status), FROTH_OK);
    return status.visibleCells;
  };
  const uint32_t visible = countVisible(0);
  EXPECT_GT(visible, 0u);
  EXPECT_EQ(countVisible(6), visible);
  EXPECT_EQ(countVisible(1), 0u);
}

}  // namespace
}  // namespace froth
