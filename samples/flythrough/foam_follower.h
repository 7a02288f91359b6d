// --follow: a foam that changes on disk, as training writes it, becomes assets.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <sys/types.h>

#include "base/result.h"

namespace froth {

// Watches the file of a foam, and bakes it with the program froth, a process beside this one. One bake at a time; what
// is written meanwhile is baked after it.
class FoamFollower {
 public:
  // baker: path of froth, or its name for PATH. The asset goes into a folder of its own, which ends with this object.
  static Result<std::unique_ptr<FoamFollower>> create(std::filesystem::path foam, std::string baker);
  FoamFollower(const FoamFollower&) = delete;
  FoamFollower& operator=(const FoamFollower&) = delete;
  ~FoamFollower();

  enum class News { kNone, kBaked, kFailed };
  // Waits for nothing. kBaked: asset() is another file than before. kFailed: fault() tells why, asset() stays; the next
  // foam is tried again. An error: the baker cannot be run.
  Result<News> poll();
  // Until a bake went well; what fails before is told on stderr.
  Status waitForAsset();

  const std::filesystem::path& asset() const { return asset_; }
  const std::string& fault() const { return fault_; }  // of the newest bake; empty: it went well
  bool isBaking() const { return child_ > 0; }

 private:
  struct FileState {  // of a file that is replaced, never written into
    uint64_t node = 0;
    int64_t seconds = 0, nanoseconds = 0;
    bool operator==(const FileState&) const = default;
  };
  FoamFollower(std::filesystem::path foam, std::string baker) : foam_(std::move(foam)), baker_(std::move(baker)) {}
  Status begin();
  News end(int status);

  std::filesystem::path foam_;
  std::string baker_;
  std::filesystem::path folder_, asset_, log_;
  FileState begun_;  // what is baked, or was last
  pid_t child_ = 0;
  std::string fault_;
};

}  // namespace froth
