// Assets that load in jobs of the caller: FrothContextInfo::runJob, froth_pool.h.
#include "froth/froth_pool.h"
#include "jobs_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

TEST_F(Jobs, LoadWhatFramesThenShowInAnyOrderOfChunks) {
  const std::vector<float> expected = drawWithoutJobs();
  createWith(HeldJobs::hold, &jobs_);
  const FrothAsset asset = openBytes(bytes_);
  createInstance(asset);
  const FrothView view = createView(kJobsExtent);
  for (int frame = 0; frame < 3; ++frame) runFrame();  // nothing runs: nothing happens
  EXPECT_EQ(jobs_.held.size(), 1u);
  EXPECT_EQ(statusOf(asset).chunkCount, 0u);
  jobs_.runFirst();
  runFrame();
  EXPECT_GT(statusOf(asset).chunkCount, 2u);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
  while (!jobs_.held.empty()) {
    ASSERT_LE(jobs_.held.size(), 5u);  // FrothContextInfo::mostJobs, and one of memory
    jobs_.runLast();
    runFrame();
  }
  runFrame();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(draw(view), expected);
  EXPECT_EQ(messages_.size(), 0u);
}

TEST_F(Jobs, OfAClosedAssetOrADestroyedContextDoNothing) {
  createWith(HeldJobs::hold, &jobs_);
  std::vector<uint8_t> bytes = bytes_;
  auto info = makeStruct<FrothAssetInfo>();
  info.data = bytes.data();
  info.dataSize = bytes.size();
  FrothAsset asset{};
  ASSERT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK);
  runFrame();
  jobs_.runFirst();
  runFrame();  // takes the head, gives chunks
  EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  bytes.clear();
  bytes.shrink_to_fit();  // the sanitizer sees whoever reads them
  const size_t left = jobs_.held.size();
  EXPECT_GT(left, 0u);
  openBytes(bytes_);
  runFrame();
  EXPECT_GT(jobs_.held.size(), left);
  frothDestroyContext(context_, UINT64_MAX);
  context_ = nullptr;
  jobs_.runAll();
}

TEST_F(Jobs, AreThereAgainForANewDevice) {
  createWith(HeldJobs::hold, &jobs_);
  auto info = makeStruct<FrothAssetInfo>();
  info.data = bytes_.data();
  info.dataSize = bytes_.size();
  info.bytesStay = 1;
  FrothAsset asset{};
  ASSERT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK);
  runFrame();
  jobs_.runFirst();
  runFrame();
  ASSERT_EQ(vkDeviceWaitIdle(host_->device), VK_SUCCESS);
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  FrothContextInfo again = host_->contextInfo();
  again.onMessage = logMessage;
  again.messageUser = &messages_;
  again.runJob = HeldJobs::hold;
  again.jobUser = &jobs_;
  ASSERT_EQ(frothRestoreDevice(context_, &again), FROTH_OK) << lastText();
  for (int frame = 0; frame < 100 && statusOf(asset).state != FROTH_ASSET_READY; ++frame) {
    jobs_.runAll();
    runFrame();
  }
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
}

TEST_F(Jobs, OfADamagedAssetSendOneMessageInAFrame) {
  createWith(HeldJobs::hold, &jobs_);
  std::vector<uint8_t> damaged = bytes_;
  damaged[damaged.size() / 2] ^= 0x10;
  const FrothAsset asset = openBytes(damaged);
  for (int frame = 0; frame < 100 && statusOf(asset).state == FROTH_ASSET_OPENING; ++frame) {
    const size_t before = messages_.size();
    jobs_.runAll();
    EXPECT_EQ(messages_.size(), before);
    runFrame();
  }
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED);
  EXPECT_EQ(messages_.size(), 1u);
  EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_FILE);
}

TEST_F(Jobs, RunInAPoolWhileFramesGoOn) {
  const std::vector<float> expected = drawWithoutJobs();
  FrothJobPool* pool = nullptr;
  ASSERT_EQ(frothCreateJobPool(2, &pool), FROTH_OK);
  createWith(frothRunInPool, pool);
  const FrothAsset asset = openBytes(bytes_);
  createInstance(asset);
  const FrothView view = createView(kJobsExtent);
  for (FrothResult result = FROTH_INCOMPLETE; result != FROTH_OK;) {
    const std::vector<float> shown = drawAnyway(view, result);
    EXPECT_EQ(shown, result == FROTH_OK ? expected : std::vector<float>(expected.size()));
    ASSERT_NE(statusOf(asset).state, FROTH_ASSET_FAILED) << lastText();
  }
  EXPECT_EQ(pipelinesMadeHere, 0);
  openBytes(bytes_);
  runFrame();
  frothDestroyContext(context_, UINT64_MAX);  // while jobs run
  context_ = nullptr;
  frothDestroyJobPool(pool);
}

TEST_F(Jobs, PoolsRefuseSenselessNumbers) {
  FrothJobPool* pool = nullptr;
  EXPECT_EQ(frothCreateJobPool(65, &pool), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(pool, nullptr);
  EXPECT_EQ(frothCreateJobPool(0, nullptr), FROTH_ERROR_ARGUMENT);
  frothDestroyJobPool(nullptr);
  FrothContextInfo info = host_->contextInfo();
  info.mostJobs = 65;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("mostJobs: 65"));
}

TEST_F(Jobs, WithoutThreadsATimeLimitStillLoadsAJobInEachFrame) {
  createWith(nullptr, nullptr);
  const FrothAsset asset = openBytes(bytes_);
  int frames = 0;
  for (; frames < 1000 && statusOf(asset).state == FROTH_ASSET_OPENING; ++frames) {
    ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t serial) {
      auto frame = makeStruct<FrothFrame>();
      frame.serial = serial;
      frame.completedSerial = serial - 1;
      frame.loadMicroseconds = 1;
      EXPECT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK);
      EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK);
      return Status();
    }));
  }
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_GT(frames, 2);  // 4 MiB of work at once would be one frame
}

}  // namespace
}  // namespace froth
