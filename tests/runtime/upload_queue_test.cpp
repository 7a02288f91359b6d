// Uploads on a queue of their own. Where the device has no family for them, as lavapipe, they are submissions of their
// own on the one queue.
#include <array>
#include <optional>

#include "one_cell_chunks.h"
#include "runtime_fixture.h"
#include "timeline_queue.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class UploadQueue : public RuntimeGpuTest {
 protected:
  void SetUp() override {
    host_ = hostOfSeveralQueues();
    ASSERT_NE(host_, nullptr);
    uploads_.emplace(*host_, host_->uploadQueue);
    frames_.emplace(*host_, HostQueue{host_->queue, host_->queueFamily});
    Result<HostImage> image = host_->createImage(VK_FORMAT_R32G32B32A32_SFLOAT, {48, 48});
    ASSERT_TRUE(image) << image.error().message;
    image_ = *image;
  }

  void TearDown() override {
    frames_.reset();
    uploads_.reset();
    host_->destroyImage(image_);
    RuntimeGpuTest::TearDown();
  }

  FrothContextInfo contextInfo() const {
    FrothContextInfo info = host_->contextInfo();
    info.checkIndices = 1;
    info.hasUploadQueue = 1;
    info.uploadQueueFamily = host_->uploadQueue.family;
    return info;
  }

  // The newest complete uploads are those that the caller says, whatever the GPU has done.
  FrothFrame nextFrame(uint64_t completedUploads) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = ++serial_;
    frame.completedSerial = serial_ - 1;
    frame.uploadSerial = uploads_->nextValue();
    frame.completedUploadSerial = completedUploads;
    return frame;
  }

  FrothFrameStatus beginFrame(uint64_t completedUploads, uint64_t uploadBytes = 0) {
    EXPECT_TRUE(frames_->waitForAll());
    FrothFrame frame = nextFrame(completedUploads);
    frame.uploadBytes = uploadBytes;
    auto status = makeStruct<FrothFrameStatus>();
    EXPECT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK) << lastText();
    return status;
  }

  void recordUpload(VkCommandBuffer commands) {
    EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK) << lastText();
  }
  void submitUploads() {
    uploads_->submit({}, [this](VkCommandBuffer commands) { recordUpload(commands); });
  }

  FrothResult record(VkCommandBuffer commands, FrothView view, decltype(frothRecordRaster)* method) {
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = makeCamera(48, 48);
    info.camera.eye[2] = 1e6 - 1;  // where the sample lies
    info.colour = host_->describe(image_);
    return method(context_, view, commands, &info);
  }

  // Draws into image_.
  FrothResult submitFrame(const FrothFrameStatus& status, FrothView view,
                          decltype(frothRecordRaster)* method = frothRecordRaster) {
    FrothResult result = FROTH_RESULT_MAX;
    frames_->submit({uploads_->reached(status.waitUploadSerial, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT)},
                    [&](VkCommandBuffer commands) { result = record(commands, view, method); });
    return result;
  }
  void submitEmptyFrame() {
    frames_->submit({}, [](VkCommandBuffer) {});
  }

  std::vector<float> texels() {
    EXPECT_TRUE(frames_->waitForAll());
    const Result<std::vector<float>> read = host_->readImage(image_);
    EXPECT_TRUE(read) << read.error().message;
    return *read;
  }

  // Of an asset that stands alone, by a context of one queue: by raster and by walk.
  std::array<std::vector<float>, 2> drawOnOneQueue(const std::vector<uint8_t>& bytes) {
    createContext(host_->contextInfo());
    createInstance(openBytes(bytes));
    const FrothView view = createView({48, 48});
    runFrame();
    std::array<std::vector<float>, 2> drawn;
    for (const bool isWalk : {false, true}) {
      const auto method = isWalk ? frothRecordWalk : frothRecordRaster;
      runFrame(0, [&](VkCommandBuffer commands) { EXPECT_EQ(record(commands, view, method), FROTH_OK) << lastText(); });
      drawn[isWalk] = texels();
    }
    EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
    context_ = nullptr;
    return drawn;
  }

  // Uploads in pieces, draws in every frame; returns the number of frames until the asset is READY.
  int drawUntilReady(FrothAsset asset, FrothView view, uint64_t uploadBytes = 0) {
    int frames = 0;
    while (statusOf(asset).state == FROTH_ASSET_OPENING && frames < 500) {
      ++frames;
      const FrothFrameStatus status = beginFrame(uploads_->completedValue(), uploadBytes);
      if (status.uploadBytesQueued > 0) submitUploads();
      const bool isReady = statusOf(asset).state == FROTH_ASSET_READY;
      EXPECT_EQ(submitFrame(status, view), isReady ? FROTH_OK : FROTH_INCOMPLETE) << lastText();
    }
    EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
    return frames;
  }

  std::optional<TimelineQueue> uploads_, frames_;
  HostImage image_;
  uint64_t serial_ = 10;  // of the newest frame: no number of an upload
};

TEST_F(UploadQueue, DrawsTheImagesOfOneQueueBitForBit) {
  const std::vector<uint8_t> bytes =
      encodeSample({.chunkCount = 3, .cellsPerChunk = 12, .localBits = 16, .detailCount = 3});
  const auto [raster, walk] = drawOnOneQueue(bytes);
  EXPECT_NE(raster, std::vector<float>(raster.size()));
  createContext(contextInfo());
  const FrothAsset asset = openBytes(bytes);
  createInstance(asset);
  const FrothView view = createView({48, 48});
  EXPECT_GT(drawUntilReady(asset, view, 611), 10);
  EXPECT_EQ(texels(), raster);
  EXPECT_EQ(submitFrame(beginFrame(uploads_->completedValue()), view, frothRecordWalk), FROTH_OK);
  EXPECT_EQ(texels(), walk);
}

TEST_F(UploadQueue, MakesAnAssetReadyByTheUploadsThatAreToldToBeComplete) {
  createContext(contextInfo());
  const FrothAsset asset = openBytes(encodeSample());
  createInstance(asset);
  const FrothView view = createView({48, 48});
  FrothFrameStatus status = beginFrame(0);
  EXPECT_EQ(status.waitUploadSerial, 0u);
  submitUploads();
  EXPECT_EQ(submitFrame(status, view), FROTH_INCOMPLETE) << "recorded, but not complete";
  EXPECT_THAT(texels(), ::testing::Each(0.0f));

  ASSERT_TRUE(uploads_->waitForAll());
  status = beginFrame(0);  // says nothing of it
  EXPECT_EQ(status.uploadBytesQueued, 0u);
  EXPECT_EQ(status.assetsOpening, 1u);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
  EXPECT_EQ(submitFrame(status, view), FROTH_INCOMPLETE);

  status = beginFrame(1);
  EXPECT_EQ(status.waitUploadSerial, 1u);
  EXPECT_EQ(status.assetsOpening, 0u);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(submitFrame(status, view), FROTH_OK);
}

TEST_F(UploadQueue, RecordsADroppedUploadAgainAndKeepsThatOfADroppedFrame) {
  const std::vector<uint8_t> bytes = encodeSample();
  const std::vector<float> expected = drawOnOneQueue(bytes)[0];
  createContext(contextInfo());
  const FrothAsset asset = openBytes(bytes);
  createInstance(asset);
  const FrothView view = createView({48, 48});
  serial_ = 0;
  uploads_->submit({}, [](VkCommandBuffer) {});  // so that frame 2 has upload 2
  const uint64_t all = beginFrame(0, 300).uploadBytesQueued;
  uploads_->record([this](VkCommandBuffer commands) { recordUpload(commands); });
  ASSERT_EQ(frothDropUpload(context_, 2), FROTH_OK) << lastText();
  submitEmptyFrame();

  EXPECT_EQ(beginFrame(0, 300).uploadBytesQueued, all) << "what was dropped waits again";
  submitUploads();  // with the number of the dropped one
  ASSERT_EQ(serial_, 2u);
  ASSERT_EQ(frothDropFrame(context_, serial_), FROTH_OK);
  EXPECT_EQ(beginFrame(0, 300).uploadBytesQueued, all - 300) << "the upload was submitted";
  submitEmptyFrame();
  drawUntilReady(asset, view);
  EXPECT_EQ(texels(), expected);
}

TEST_F(UploadQueue, FillsStagingMemoryAgainOnceUploadsAreComplete) {
  FrothContextInfo info = contextInfo();
  info.stagingBytes = 65536;
  createContext(info);
  const FrothAsset asset = openBytes(encodeSample({.chunkCount = 12, .cellsPerChunk = 36, .localBits = 16}));
  const uint64_t all = beginFrame(0).uploadBytesQueued;
  ASSERT_GT(all, 2 * info.stagingBytes);
  submitUploads();
  submitEmptyFrame();
  EXPECT_EQ(beginFrame(0).uploadBytesQueued, all - info.stagingBytes);
  submitUploads();  // nothing: the memory is in use
  submitEmptyFrame();
  EXPECT_EQ(beginFrame(0).uploadBytesQueued, all - info.stagingBytes);
  submitEmptyFrame();
  ASSERT_TRUE(uploads_->waitForAll());
  EXPECT_EQ(beginFrame(1).uploadBytesQueued, all - info.stagingBytes);
  submitUploads();
  submitEmptyFrame();
  EXPECT_EQ(beginFrame(1).uploadBytesQueued, all - 2 * info.stagingBytes);
  submitEmptyFrame();
  while (statusOf(asset).state == FROTH_ASSET_OPENING && serial_ < 100) {
    ASSERT_TRUE(uploads_->waitForAll());
    beginFrame(uploads_->completedValue());
    submitUploads();
    submitEmptyFrame();
  }
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
}

TEST_F(UploadQueue, OfAClosedAssetKeepsItsMemoryUntilItIsCompleteOrDropped) {
  createContext(contextInfo());
  for (const bool isDropped : {false, true}) {
    const FrothAsset asset = openBytes(encodeSample());
    const uint64_t serial = uploads_->nextValue();
    const uint64_t held = beginFrame(serial - 1).deviceBytes;
    EXPECT_GT(held, 0u);
    const VkCommandBuffer commands = uploads_->record([this](VkCommandBuffer buffer) { recordUpload(buffer); });
    if (!isDropped) uploads_->submit(commands, {});
    submitEmptyFrame();
    ASSERT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
    if (isDropped) {
      ASSERT_EQ(frothDropUpload(context_, serial), FROTH_OK) << lastText();
    } else {
      EXPECT_EQ(beginFrame(serial - 1).deviceBytes, held) << "no frame uses it, but the upload does";
      submitEmptyFrame();
      ASSERT_TRUE(uploads_->waitForAll());
    }
    EXPECT_EQ(beginFrame(isDropped ? serial - 1 : serial).deviceBytes, 0u);
    submitEmptyFrame();
  }
}

TEST_F(UploadQueue, OfAnAssetThatFailsKeepsItsMemoryUntilItIsComplete) {
  createContext(contextInfo());
  std::vector<uint8_t> bytes = *encodeAsset(makeOneCellChunks(300));  // more chunks than one frame decodes
  bytes.back() ^= 1;
  const FrothAsset asset = openBytes(bytes);
  EXPECT_GT(beginFrame(0).deviceBytes, 0u);
  ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
  submitUploads();
  submitEmptyFrame();
  EXPECT_GT(beginFrame(0).deviceBytes, 0u);
  ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED);
  submitEmptyFrame();
  EXPECT_GT(beginFrame(0).deviceBytes, 0u) << "no frame uses it, but the upload does";
  submitEmptyFrame();
  ASSERT_TRUE(uploads_->waitForAll());
  EXPECT_EQ(beginFrame(1).deviceBytes, 0u);
}

TEST_F(UploadQueue, UnderWayAtTheEndIsPending) {
  createContext(contextInfo());
  openBytes(encodeSample());
  beginFrame(0);
  submitUploads();
  submitEmptyFrame();
  ASSERT_EQ(frothDestroyContext(context_, serial_), FROTH_PENDING);
  ASSERT_TRUE(uploads_->waitForAll());
  beginFrame(1);
  submitEmptyFrame();
  ASSERT_TRUE(frames_->waitForAll());
  EXPECT_EQ(frothDestroyContext(context_, serial_), FROTH_OK);
  context_ = nullptr;
}

TEST_F(UploadQueue, UnderWayInALostDeviceIsForgotten) {
  const std::string path = writeFile("scene.froth", encodeSample());
  createContext(contextInfo());
  const FrothAsset asset = openPath(path);
  const FrothAsset closed = openPath(path);
  createInstance(asset);
  const FrothView view = createView({48, 48});
  beginFrame(0);
  submitUploads();
  ASSERT_EQ(frothCloseAsset(context_, closed), FROTH_OK);
  ASSERT_EQ(frothDropFrame(context_, serial_), FROTH_OK);
  ASSERT_TRUE(uploads_->waitForAll());  // this device is not lost: it must not use what goes
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  auto report = makeStruct<FrothMemoryReport>();
  ASSERT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
  EXPECT_EQ(report.deviceBytes, 0u);
  FrothContextInfo info = contextInfo();
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  ASSERT_EQ(frothRestoreDevice(context_, &info), FROTH_OK) << lastText();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
  drawUntilReady(asset, view);
  EXPECT_NE(texels(), std::vector<float>(size_t{4} * 48 * 48));
}

// A semaphore that the CPU signals holds uploads back.
TEST_F(UploadQueue, HeldBackDelaysNoFrame) {
  if (host_->uploadQueue.family == host_->queueFamily) GTEST_SKIP() << "one queue does its work in order";
  createContext(contextInfo());
  const FrothAsset first = openBytes(encodeSample());
  createInstance(first);
  const FrothView view = createView({48, 48});
  drawUntilReady(first, view);
  const std::vector<float> expected = texels();

  TimelineQueue gate(*host_, host_->uploadQueue);  // nothing is submitted to it
  const FrothAsset second = openBytes(encodeSample());
  FrothFrameStatus status = beginFrame(uploads_->completedValue());
  uploads_->submit({gate.reached(1, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)},
                   [this](VkCommandBuffer commands) { recordUpload(commands); });
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(submitFrame(status, view), FROTH_OK);
    EXPECT_TRUE(frames_->waitForAll());
    status = beginFrame(uploads_->completedValue());
  }
  EXPECT_EQ(statusOf(second).state, FROTH_ASSET_OPENING);
  gate.signal(1);
  ASSERT_TRUE(uploads_->waitForAll());
  submitEmptyFrame();
  beginFrame(uploads_->completedValue());
  submitEmptyFrame();
  EXPECT_EQ(statusOf(second).state, FROTH_ASSET_READY);
  EXPECT_EQ(texels(), expected);
}

TEST_F(UploadQueue, TakesSerialsThatGrow) {
  createContext(contextInfo());
  openBytes(encodeSample());
  FrothFrame frame = nextFrame(0);
  const auto fails = [&](uint64_t uploadSerial, uint64_t completedUploadSerial) {
    frame.uploadSerial = uploadSerial;
    frame.completedUploadSerial = completedUploadSerial;
    return frothUpdate(context_, &frame, nullptr);
  };
  EXPECT_EQ(fails(0, 0), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("uploadSerial: 0, and uploads were recorded for 0; must be above it, and above 0"));
  EXPECT_EQ(fails(1, 1), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("completedUploadSerial: 1, with uploadSerial 1, after 0"));
  serial_ = 0;
  beginFrame(0, 100);
  EXPECT_EQ(frothDropUpload(context_, 0), FROTH_ERROR_STATE);
  EXPECT_EQ(frothDropUpload(context_, 2), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("uploadSerial: 2; only what lies above the last completedUploadSerial, 0"));
  submitUploads();
  submitEmptyFrame();
  ASSERT_TRUE(uploads_->waitForAll());
  frame = nextFrame(0);
  EXPECT_EQ(fails(1, 0), FROTH_ERROR_STATE) << "that one was submitted";
  EXPECT_THAT(lastText(), HasSubstr("uploadSerial: 1, and uploads were recorded for 1"));
  --serial_;
  beginFrame(1);
  submitEmptyFrame();
  frame = nextFrame(1);
  EXPECT_EQ(fails(2, 0), FROTH_ERROR_STATE) << "what was complete cannot become incomplete";
  EXPECT_EQ(frothDropUpload(context_, 1), FROTH_ERROR_STATE) << "complete";
}

TEST_F(UploadQueue, IsNamedAtTheContextAlone) {
  createContext(host_->contextInfo());
  FrothFrame frame = nextFrame(0);
  EXPECT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("uploadSerial: 1, completedUploadSerial: 0; uploads of this context stand in its"));
  EXPECT_EQ(frothDropUpload(context_, 1), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("call frothDropFrame"));

  FrothContextInfo info = contextInfo();
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  FrothContext* refused = nullptr;
  info.uploadQueueFamily = 77;
  EXPECT_EQ(frothCreateContext(&info, &refused), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("uploadQueueFamily: 77; those that can copy are 0"));
  info.hasUploadQueue = 0;
  EXPECT_EQ(frothCreateContext(&info, &refused), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("uploadQueueFamily: 77, and hasUploadQueue is 0"));
}

TEST_F(UploadQueue, OfANullContextMakesAssetsReadyAtOnce) {
  FrothContextInfo info = nullContextInfo();
  info.hasUploadQueue = 1;
  info.uploadQueueFamily = 3;
  createContext(info);
  const FrothAsset asset = openBytes(encodeSample());
  beginFrame(0);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
}

}  // namespace
}  // namespace froth
