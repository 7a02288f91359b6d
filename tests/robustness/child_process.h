// A program that runs beside the test: it can be limited, watched and sent signals.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace froth::test {

using Seconds = std::chrono::duration<double>;

// How a program ended.
struct ProgramEnd {
  int exitCode = -1;  // -1: it died of `signal`
  int signal = 0;
  std::string text;   // stdout and stderr
  Seconds cpuTime{};  // of all its threads
};

class ChildProcess {
 public:
  // Starts at once, in `folder`. `largestFile` [bytes]: the kernel refuses to let a file grow beyond it.
  ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& folder,
               std::optional<uint64_t> largestFile = {});
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();  // kills what was not waited for

  void send(int signal) const;
  ProgramEnd wait();  // once

 private:
  pid_t process_ = -1;
  int output_ = -1;
};

// Sees files appear in a folder.
class FolderWatch {
 public:
  explicit FolderWatch(const std::filesystem::path& folder);
  FolderWatch(const FolderWatch&) = delete;
  FolderWatch& operator=(const FolderWatch&) = delete;
  ~FolderWatch();

  // Until something was created in the folder or renamed into it; false after `limit`.
  bool waitForFile(Seconds limit) const;

 private:
  int descriptor_;
};

}  // namespace froth::test
