// Files on disk: what is refused, and that writing never harms what is there.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset_equality.h"
#include "base/atomic_file.h"
#include "file_surgery.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "sample_asset.h"

namespace froth {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

// A folder of its own for each test.
class FileIo : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("froth_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  size_t countFiles() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
  }

  fs::path folder_;
};

const std::vector<uint8_t> kOld = {1, 2, 3}, kNew = {4, 5, 6, 7};

template <class T>
std::string errorOf(const Result<T>& result) {
  return result ? "no error" : result.error().message;
}
std::string errorOf(const Status& status) { return status ? "no error" : status.error().message; }

TEST_F(FileIo, WritesANewFileAndReplacesAnOldOne) {
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "a", kOld)), "no error");
  EXPECT_EQ(*readFile(folder_ / "a"), kOld);
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "a", kNew)), "no error");
  EXPECT_EQ(*readFile(folder_ / "a"), kNew);
  EXPECT_EQ(countFiles(), 1u);
}

TEST_F(FileIo, WritesAndReadsAnEmptyFile) {
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "empty", {})), "no error");
  EXPECT_TRUE(readFile(folder_ / "empty")->empty());
  EXPECT_THAT(errorOf(AssetReader::open(folder_ / "empty")), HasSubstr("do not lie within the file's 0"));
}

TEST_F(FileIo, NamesAMissingFile) {
  EXPECT_THAT(errorOf(readFile(folder_ / "none")),
              AllOf(HasSubstr("none: cannot be opened"), HasSubstr("check the path")));
  EXPECT_THAT(errorOf(AssetReader::open(folder_ / "none")), HasSubstr("cannot be opened"));
}

TEST_F(FileIo, RefusesADirectoryAndAPipe) {
  EXPECT_THAT(errorOf(readFile(folder_)), HasSubstr("is a directory"));
  EXPECT_THAT(errorOf(readAsset(folder_)), HasSubstr("is a directory"));
  EXPECT_THAT(errorOf(verifyAsset(folder_)), HasSubstr("is a directory"));
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(errorOf(readFile(pipe)), HasSubstr("no regular file"));
  EXPECT_THAT(errorOf(writeFileAtomically(pipe, kNew)), HasSubstr("no regular file"));
}

TEST_F(FileIo, LeavesADirectoryOfThatNameAlone) {
  fs::create_directory(folder_ / "scene.froth");
  EXPECT_THAT(errorOf(writeFileAtomically(folder_ / "scene.froth", kNew)), HasSubstr("no regular file"));
  EXPECT_TRUE(fs::is_directory(folder_ / "scene.froth"));
  EXPECT_EQ(countFiles(), 1u);
}

TEST_F(FileIo, NamesAFolderThatDoesNotExist) {
  EXPECT_THAT(errorOf(writeFileAtomically(folder_ / "no" / "a", kNew)), HasSubstr("cannot be created"));
}

fs::perms permissionsOf(const fs::path& path) { return fs::status(path).permissions(); }

TEST_F(FileIo, KeepsTheRightsOfTheFileThatItReplaces) {
  for (const fs::perms rights : {fs::perms(0600), fs::perms(0664), fs::perms(0755)}) {
    ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "a", kOld)), "no error");
    fs::permissions(folder_ / "a", rights);
    ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "a", kNew)), "no error");
    EXPECT_EQ(permissionsOf(folder_ / "a"), rights);
    ASSERT_EQ(errorOf(writeAsset(folder_ / "a", makeSampleAsset())), "no error");
    EXPECT_EQ(permissionsOf(folder_ / "a"), rights);
  }
}

TEST_F(FileIo, LeavesAWriteProtectedFileAloneUnlessItIsForced) {
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "a", kOld)), "no error");
  fs::permissions(folder_ / "a", fs::perms(0444));
  EXPECT_THAT(errorOf(writeFileAtomically(folder_ / "a", kNew)), HasSubstr("a: is write-protected; make it writable"));
  EXPECT_THAT(errorOf(writeAsset(folder_ / "a", makeSampleAsset())), HasSubstr("is write-protected"));
  EXPECT_EQ(*readFile(folder_ / "a"), kOld);
  EXPECT_EQ(countFiles(), 1u);
  EXPECT_EQ(errorOf(AssetStreamWriter::create(folder_ / "a", makeSampleAsset(), WriteProtected::kReplace)), "no error");
}

TEST_F(FileIo, ReplacesTheFileThatALinkNames) {
  fs::create_directory(folder_ / "far");
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "far/real", kOld)), "no error");
  fs::create_symlink("second", folder_ / "first");
  fs::create_symlink("far/real", folder_ / "second");
  fs::create_symlink("far/later", folder_ / "dangling");
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "first", kNew)), "no error");
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "dangling", kNew)), "no error");
  EXPECT_TRUE(fs::is_symlink(folder_ / "first") && fs::is_symlink(folder_ / "second") &&
              fs::is_symlink(folder_ / "dangling"));
  EXPECT_EQ(*readFile(folder_ / "far/real"), kNew);
  EXPECT_EQ(*readFile(folder_ / "far/later"), kNew);
  EXPECT_EQ(countFiles(), 4u);
}

// Ends the process: 0 if writing failed as it should. Root may write everywhere, so it becomes somebody else.
[[noreturn]] void writeWhereNothingMayBe(const fs::path& path) {
  constexpr uid_t kNobody = 65534;
  if (::geteuid() == 0 && ::seteuid(kNobody) != 0) std::_Exit(2);
  const std::string errors[] = {errorOf(writeFileAtomically(path, kNew)), errorOf(writeAsset(path, makeSampleAsset()))};
  for (const std::string& error : errors) {
    if (error.find("cannot be created: Permission denied; check folder, rights") == std::string::npos) std::_Exit(1);
  }
  std::_Exit(0);
}

TEST_F(FileIo, LeavesTheOldFileInAFolderThatCannotBeWritten) {
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "a", kOld)), "no error");
  fs::permissions(folder_,
                  fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  EXPECT_EXIT(writeWhereNothingMayBe(folder_ / "a"), testing::ExitedWithCode(0), "");
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_EQ(*readFile(folder_ / "a"), kOld);
  EXPECT_EQ(countFiles(), 1u);
}

// A limit on the size of files stands in for a full disk. Ends the process: 0 if writing failed as it should.
[[noreturn]] void writeUnderSizeLimit(const fs::path& path) {
  constexpr rlim_t kLimit = 1 << 16;
  const rlimit limit{kLimit, kLimit};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);
  const Status status = writeFileAtomically(path, std::vector<uint8_t>(2 * kLimit, 7));
  std::_Exit(!status && status.error().kind == ErrorKind::kIo ? 0 : 1);
}

TEST_F(FileIo, LeavesTheOldFileAndNoOtherWhenWritingFailsHalfway) {
  ASSERT_EQ(errorOf(writeFileAtomically(folder_ / "a", kOld)), "no error");
  EXPECT_EXIT(writeUnderSizeLimit(folder_ / "a"), testing::ExitedWithCode(0), "");
  EXPECT_EQ(*readFile(folder_ / "a"), kOld);
  EXPECT_EQ(countFiles(), 1u);
}

TEST_F(FileIo, WritesNothingForContentsThatAreNoAsset) {
  AssetContents contents = makeSampleAsset();
  contents.chunks[0].radii[1] = -1;
  EXPECT_THAT(errorOf(writeAsset(folder_ / "a.froth", contents)), HasSubstr("cell 1 has radius -1"));
  contents = makeSampleAsset();
  contents.chunks[0].lobeAxes.pop_back();
  EXPECT_THAT(errorOf(writeAsset(folder_ / "a.froth", contents)), HasSubstr("lobe_axes: 15 entries instead of 16"));
  contents = makeSampleAsset();
  contents.chunks.clear();
  EXPECT_THAT(errorOf(writeAsset(folder_ / "a.froth", contents)), HasSubstr("number of chunks is 0"));
  EXPECT_EQ(countFiles(), 0u);
}

TEST_F(FileIo, ReadsChunksOfAnAssetOnSeveralThreads) {
  const AssetContents contents = makeSampleAsset({.chunkCount = 4, .cellsPerChunk = 60, .localBits = 6});
  ASSERT_EQ(errorOf(writeAsset(folder_ / "a.froth", contents)), "no error");
  Result<AssetReader> reader = AssetReader::open(folder_ / "a.froth");
  ASSERT_TRUE(reader) << reader.error().message;
  fs::remove(folder_ / "a.froth");  // the reader holds the file, not its name
  std::vector<ChunkContents> chunks(4);
  std::vector<std::thread> threads;
  for (uint32_t i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      if (Result<ChunkContents> chunk = reader->readChunk(i)) chunks[i] = std::move(*chunk);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (size_t i = 0; i < 4; ++i) expectSameArrays(chunks[i], contents.chunks[i]);
}

TEST_F(FileIo, ReadsWhatWasWritten) {
  const AssetContents contents = makeSampleAsset();
  ASSERT_EQ(errorOf(writeAsset(folder_ / "a.froth", contents)), "no error");
  Result<AssetContents> found = readAsset(folder_ / "a.froth");
  ASSERT_TRUE(found) << found.error().message;
  expectSameAsset(*found, contents);
  Result<AssetReader> reader = AssetReader::open(folder_ / "a.froth");
  EXPECT_THAT(errorOf(reader->readChunk(1)), HasSubstr("chunk 1 asked for, there are 1"));
}

}  // namespace
}  // namespace froth
