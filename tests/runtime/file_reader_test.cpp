// The reader over files that Froth has for engines without I/O of their own.
#include <algorithm>
#include <cerrno>
#include <utility>

#include "froth/froth_files.h"
#include "froth/froth_pool.h"
#include "jobs_fixture.h"
#include "reader_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr size_t kBefore = 1000, kBehind = 500;  // [bytes] of a pack, around the asset

class FileReader : public Reader {
 protected:
  void SetUp() override {
    Reader::SetUp();
    std::vector<uint8_t> pack(kBefore + large_.size() + kBehind, 1);
    std::ranges::copy(large_, pack.begin() + kBefore);
    path_ = writeFile("scenes.pack", pack);
  }

  void TearDown() override {
    frothDestroyContext(context_, UINT64_MAX);
    context_ = nullptr;
    frothCloseFile(file_);
    Reader::TearDown();
    frothDestroyJobPool(pool_);
  }

  FrothFileInfo packed() const {
    auto info = makeStruct<FrothFileInfo>();
    info.path = path_.c_str();
    info.offset = kBefore;
    info.size = large_.size();
    return info;
  }

  FrothAsset openFile(const FrothFileInfo& info) {
    EXPECT_EQ(frothOpenFile(context_, &info, &file_), FROTH_OK);
    return openReader(*frothGetFileReader(file_));
  }

  FrothResult resultOf(const FrothFileInfo& info) {
    FrothFile* file = file_;
    errno = -1;
    const FrothResult result = frothOpenFile(context_, &info, &file);
    EXPECT_EQ(file, nullptr);
    return result;
  }

  std::string path_;
  FrothFile* file_ = nullptr;
  FrothJobPool* pool_ = nullptr;
};

TEST_F(FileReader, ReadsAPartOfAFileOnThreads) {
  ASSERT_EQ(frothCreateJobPool(2, &pool_), FROTH_OK);
  FrothFileInfo info = packed();
  info.runJob = frothRunInPool;
  info.jobUser = pool_;
  const FrothAsset asset = openFile(info);
  while (stateOf(asset) == FROTH_ASSET_OPENING) runFrame();
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
  EXPECT_EQ(statusOf(asset).chunkCount, 4u);
}

TEST_F(FileReader, WithoutThreadsReadsWithinTheFrame) {
  const FrothAsset asset = openFile(packed());
  int frames = 0;
  for (; stateOf(asset) == FROTH_ASSET_OPENING; ++frames) runFrame();
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
  EXPECT_LE(frames, 2) << "as bytes, and one frame more";
}

TEST_F(FileReader, ReadsUpToTheEndWhereNoSizeIsGiven) {
  path_ = writeFile("scene.froth", large_);
  auto info = makeStruct<FrothFileInfo>();
  info.structSize = offsetof(FrothFileInfo, offset);  // an older header that ends with the path
  info.path = path_.c_str();
  info.offset = 17;
  const FrothAsset asset = openFile(info);
  load(asset);
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText();
}

TEST_F(FileReader, AnswersAtOnceWhatIsCancelledBeforeItBegins) {
  HeldJobs jobs;
  FrothFileInfo info = packed();
  info.runJob = HeldJobs::hold;
  info.jobUser = &jobs;
  const FrothAsset asset = openFile(info);
  runFrame();
  jobs.runAll();
  runFrame();
  ASSERT_GT(jobs.held.size(), 4u) << "chunks are read ahead";
  EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK) << "no read is left";
  context_ = nullptr;
  frothCloseFile(std::exchange(file_, nullptr));
  jobs.runAll();  // the sanitizer sees whether they touch what is gone
}

TEST_F(FileReader, AnswersAllWhenItIsClosed) {
  HeldJobs jobs;
  FrothFileInfo info = packed();
  info.runJob = HeldJobs::hold;
  info.jobUser = &jobs;
  EXPECT_EQ(frothOpenFile(context_, &info, &file_), FROTH_OK);
  FrothReader reader = *frothGetFileReader(file_);
  reader.cancel = nullptr;
  openReader(reader);
  runFrame();
  EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_PENDING);
  frothCloseFile(std::exchange(file_, nullptr));
  EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
  jobs.runAll();
}

TEST_F(FileReader, OfAFileThatBecameShorterFailsTheAsset) {
  const FrothAsset asset = openFile(packed());
  std::filesystem::resize_file(path_, kBefore + 100);
  load(asset);
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_FAILED);
  EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_FILE);
  EXPECT_THAT(lastText(), HasSubstr("at byte 0: the reader answered FROTH_ERROR_FILE"));
}

TEST_F(FileReader, TellsWhatIsWrongWithAPath) {
  FrothFileInfo info = packed();
  const std::string none = path_ + ".none", here = folder().string();
  info.path = none.c_str();
  EXPECT_EQ(resultOf(info), FROTH_ERROR_FILE);
  EXPECT_EQ(errno, ENOENT);
  info.path = here.c_str();
  EXPECT_EQ(resultOf(info), FROTH_ERROR_FILE);
  EXPECT_EQ(errno, 0);
  info = packed();
  info.size += kBehind + 1;
  EXPECT_EQ(resultOf(info), FROTH_ERROR_ARGUMENT);
  info.size = 0;
  info.offset += large_.size() + kBehind;
  EXPECT_EQ(resultOf(info), FROTH_ERROR_ARGUMENT);
  info = packed();
  info.structSize = 0;
  EXPECT_EQ(resultOf(info), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(messages_, IsEmpty());
}

}  // namespace
}  // namespace froth
