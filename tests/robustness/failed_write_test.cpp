// Where an asset cannot be written, the old one stays, nothing else is left, and the message says why and
// what to do.
#include <cerrno>
#include <cstring>

#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include "tests/robustness/bake_fixture.h"

namespace froth::test {
namespace {

class FailedWrite : public BakeTest {
 protected:
  ~FailedWrite() override {
    if (!mounted_.empty()) ::umount(mounted_.c_str());
  }

  // `asset`, relative to the folder, is what the bake was to write.
  void expectFailure(const ProgramEnd& end, const std::string& asset, const std::string& cause) const {
    EXPECT_EQ(end.exitCode, 1) << "signal " << end.signal << ": " << end.text;
    EXPECT_NE(end.text.find("froth: " + asset + ": "), std::string::npos) << end.text;
    EXPECT_NE(end.text.find(cause), std::string::npos) << end.text;
    EXPECT_NE(end.text.find("; "), std::string::npos) << "no remedy: " << end.text;
  }

  // A file system of its own in <folder>/disk, with the old asset in it.
  bool mountDisk(size_t bytes) {
    const std::filesystem::path disk = folder_ / "disk";
    std::filesystem::create_directory(disk);
    const std::string options = "size=" + std::to_string(bytes);
    const bool isAlone = ::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0;
    if (!isAlone || ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", disk.c_str(), "tmpfs", 0, options.c_str()) != 0) {
      return false;
    }
    mounted_ = disk;
    writeBytes(disk / kAsset, oldBytes_);
    return true;
  }

  ProgramEnd bakeToDisk() const {
    return ChildProcess(
               {FROTH_TOOL, "bake", kCheckpoint, "--preset", "exact", "-o", "disk/" + std::string(kAsset), "--quiet"},
               folder_)
        .wait();
  }

  void expectOldAssetAloneOnDisk() const {
    EXPECT_EQ(readBytes(folder_ / "disk" / kAsset), oldBytes_);
    EXPECT_EQ(filesInFolder(), (std::vector<std::string>{"disk", "disk/" + std::string(kAsset), kCheckpoint, kAsset}));
  }

  std::filesystem::path mounted_;
};

TEST_F(FailedWrite, AFileThatMayNotGrowIsToldAndTheOldAssetStays) {
  for (const double part : {0.0, 0.01, 0.5, 0.9, 1.0}) {
    const auto limit = static_cast<uint64_t>(part * static_cast<double>(newBytes_.size() - 1));
    const ProgramEnd end = ChildProcess(bakeCommand(), folder_, limit).wait();
    expectFailure(end, kAsset, std::strerror(EFBIG));
    EXPECT_EQ(assetBytes(), oldBytes_);
    expectNothingLeft();
  }
}

TEST_F(FailedWrite, AFullDiskIsToldAndTheOldAssetStays) {
  const size_t page = static_cast<size_t>(::sysconf(_SC_PAGESIZE));
  const size_t old = (oldBytes_.size() / page + 1) * page;
  for (const double part : {0.0, 0.3, 0.9}) {
    const auto space = static_cast<size_t>(part * static_cast<double>(newBytes_.size()));
    if (!mountDisk(old + page + space)) GTEST_SKIP() << "no right to mount a small disk: " << std::strerror(errno);
    expectFailure(bakeToDisk(), "disk/" + std::string(kAsset), std::strerror(ENOSPC));
    expectOldAssetAloneOnDisk();
    ::umount(mounted_.c_str());
    mounted_.clear();
  }
}

TEST_F(FailedWrite, AReadOnlyDiskIsTold) {
  if (!mountDisk(4 * oldBytes_.size()) ||
      ::mount(nullptr, mounted_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) != 0) {
    GTEST_SKIP() << "no right to mount a small disk: " << std::strerror(errno);
  }
  expectFailure(bakeToDisk(), "disk/" + std::string(kAsset), std::strerror(EROFS));
  expectOldAssetAloneOnDisk();
}

TEST_F(FailedWrite, AReadOnlyFolderIsTold) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write to any folder";
  using std::filesystem::perms;
  std::filesystem::permissions(folder_, perms::owner_read | perms::owner_exec);
  expectFailure(ChildProcess(bakeCommand(), folder_).wait(), kAsset, std::strerror(EACCES));
  std::filesystem::permissions(folder_, perms::owner_all);
  EXPECT_EQ(assetBytes(), oldBytes_);
  expectNothingLeft();
}

TEST_F(FailedWrite, AFolderUnderTheAssetsNameStays) {
  std::filesystem::remove(folder_ / kAsset);
  std::filesystem::create_directory(folder_ / kAsset);
  expectFailure(ChildProcess(bakeCommand(), folder_).wait(), kAsset, "directory");
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / kAsset));
  expectNothingLeft();
}

}  // namespace
}  // namespace froth::test
