// Answers of the caller's reader when assets, contexts and devices end; and what is drawn.
#include "jobs_fixture.h"
#include "reader_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(Reader, AnswersEachRequestOnce) {
  const FrothAsset asset = open(large_);
  runFrame();
  const uint64_t head = archive_.pending[0].number;
  EXPECT_EQ(frothCompleteRead(context_, head + 1, FROTH_OK), FROTH_ERROR_HANDLE);
  EXPECT_THAT(lastText(), HasSubstr("request " + std::to_string(head + 1)));
  EXPECT_EQ(frothCompleteRead(context_, 0, FROTH_OK), FROTH_ERROR_HANDLE);
  EXPECT_EQ(frothCompleteRead(context_, head, FROTH_PENDING), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothCompleteRead(nullptr, head, FROTH_OK), FROTH_ERROR_ARGUMENT);
  archive_.answerAll();
  EXPECT_EQ(frothCompleteRead(context_, head, FROTH_ERROR_FILE), FROTH_ERROR_HANDLE) << "before it is taken";
  load(asset);
  EXPECT_EQ(frothCompleteRead(context_, head, FROTH_ERROR_FILE), FROTH_ERROR_HANDLE) << "and after";
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
}

TEST_F(Reader, MayAnswerWhenItsAssetIsClosed) {
  const FrothAsset asset = open(large_);
  runFrame();
  archive_.answerAll();
  runFrame();
  archive_.answer(1);  // not taken yet
  const size_t pending = archive_.pending.size();
  EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  EXPECT_EQ(archive_.cancelled.size(), pending);
  runFrame();
  EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_PENDING);
  EXPECT_EQ(archive_.cancelled.size(), pending) << "cancelled once";
  archive_.answerAll();  // writes the bytes: the sanitizer sees whether the memory is there
  EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
}

TEST_F(Reader, KeepsAContextThatEndsPendingUntilItHasAnswered) {
  const FrothAsset asset = open(large_);
  runFrame();
  EXPECT_EQ(frothDestroyContext(context_, 0), FROTH_PENDING);
  EXPECT_THAT(archive_.cancelled, IsEmpty()) << "a frame is in flight: nothing changes";
  EXPECT_EQ(frothDestroyContext(context_, serial_), FROTH_PENDING);
  EXPECT_EQ(archive_.cancelled.size(), 1u);
  archive_.answerAll(FROTH_ERROR_STATE);
  expectFailure(asset, FROTH_ERROR_FILE);  // the engine went on after all
  EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
}

TEST_F(Reader, MayAnswerWithinCancel) {
  archive_.answersWithinCancel = true;
  open(large_);
  runFrame();
  archive_.answersWithinCancel = false;
  archive_.answerAll();
  runFrame();
  archive_.answersWithinCancel = true;
  EXPECT_GT(archive_.pending.size(), 4u);
  EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK) << "at once";
  context_ = nullptr;
}

TEST_F(Reader, WithoutCancelEnds) {
  archive_.bytes = small_;
  FrothReader reader = archive_.reader();
  reader.structSize = offsetof(FrothReader, cancel);  // an older header that ends before `cancel`
  reader.name = nullptr;
  openReader(reader);
  runFrame();
  EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_PENDING);
  EXPECT_THAT(archive_.cancelled, IsEmpty());
  archive_.answerAll(FROTH_ERROR_FILE);
  runFrame();
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_EQ(messages_[0].object, "asset of a reader");
}

// The job that opens the head has ended, and no frame has taken its result.
TEST_F(Reader, IsAskedAgainWhenALossMeetsTheHead) {
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  HeldJobs jobs;
  FrothContextInfo info = nullContextInfo();
  info.runJob = HeldJobs::hold;
  info.jobUser = &jobs;
  createContext(info);
  const FrothAsset asset = open(large_);
  runFrame();
  archive_.answerAll();
  runFrame();
  ASSERT_EQ(jobs.held.size(), 1u);
  jobs.runFirst();
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  ASSERT_EQ(frothRestoreDevice(context_, &info), FROTH_OK);
  for (int frame = 0; frame < 100 && statusOf(asset).state == FROTH_ASSET_OPENING; ++frame) {
    runFrame();
    archive_.answerAll();
    jobs.runAll();
  }
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY) << lastText();
  EXPECT_EQ(archive_.asked[1].offset, 0u);
}

// With a device, jobs and pictures.
class ReaderOnDevice : public Jobs {
 protected:
  FrothAsset open() {
    const FrothReader reader = archive_.reader();
    const FrothAssetInfo info = infoOf(reader);
    FrothAsset asset{};
    EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK) << lastText();
    return asset;
  }

  Archive archive_{context_, bytes_};
};

TEST_F(ReaderOnDevice, ShowsWhatBytesShowWhateverTheOrderOfAnswersAndJobs) {
  const std::vector<float> expected = drawWithoutJobs();
  EXPECT_NE(expected, std::vector<float>(expected.size()));
  createWith(HeldJobs::hold, &jobs_);
  const FrothAsset asset = open();
  createInstance(asset);
  const FrothView view = createView(kJobsExtent);
  for (int frame = 0; frame < 100 && statusOf(asset).state == FROTH_ASSET_OPENING; ++frame) {
    runFrame();
    if (!archive_.pending.empty()) archive_.answer(archive_.pending.size() - 1);
    if (!jobs_.held.empty()) jobs_.runLast();
  }
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_EQ(draw(view), expected);
  EXPECT_EQ(messages_.size(), 0u);
}

TEST_F(ReaderOnDevice, IsAskedAgainForANewDevice) {
  const std::vector<float> expected = drawWithoutJobs();
  createWith(nullptr, nullptr);
  const FrothAsset asset = open();
  createInstance(asset);
  const FrothView view = createView(kJobsExtent);
  const auto replaceDevice = [&] {
    ASSERT_EQ(vkDeviceWaitIdle(host_->device), VK_SUCCESS);
    ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
    FrothContextInfo again = host_->contextInfo();
    again.onMessage = logMessage;
    again.messageUser = &messages_;
    ASSERT_EQ(frothRestoreDevice(context_, &again), FROTH_OK) << lastText();
  };
  const auto load = [&] {
    for (int frame = 0; frame < 100 && statusOf(asset).state == FROTH_ASSET_OPENING; ++frame) {
      runFrame();
      archive_.answerAll();
    }
    runFrame();
    EXPECT_EQ(draw(view), expected);
  };
  runFrame();
  archive_.answerAll();
  runFrame();
  ASSERT_FALSE(archive_.pending.empty());
  const size_t before = archive_.asked.size();
  replaceDevice();  // while it reads
  EXPECT_FALSE(archive_.cancelled.empty());
  load();
  EXPECT_GT(archive_.asked.size(), before);
  const size_t loaded = archive_.asked.size();
  replaceDevice();  // when it is READY
  load();
  EXPECT_GT(archive_.asked.size(), loaded);
  EXPECT_THAT(messages_, IsEmpty());
}

}  // namespace
}  // namespace froth
