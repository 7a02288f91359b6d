#include "samples/flythrough/foam_follower.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>

namespace froth {

Result<std::unique_ptr<FoamFollower>> FoamFollower::create(std::filesystem::path foam, std::string baker) {
  std::unique_ptr<FoamFollower> follower(new FoamFollower(std::move(foam), std::move(baker)));
  std::error_code error;
  std::string folder = (std::filesystem::temp_directory_path(error) / "froth_follow_XXXXXX").string();
  if (error || !mkdtemp(folder.data())) {
    return makeError(ErrorKind::kIo, "%s: cannot be made: %s; set TMPDIR to a folder that you may write to",
                     folder.c_str(), error ? error.message().c_str() : std::strerror(errno));
  }
  follower->folder_ = folder;
  follower->asset_ = follower->folder_ / "foam.froth";
  follower->log_ = follower->folder_ / "bake.log";
  return follower;
}

FoamFollower::~FoamFollower() {
  if (isBaking()) {
    kill(child_, SIGTERM);
    waitpid(child_, nullptr, 0);
  }
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

// What is quick to bake: values as they are, no graph for walks, no measurement.
Status FoamFollower::begin() {
  std::vector<std::string> words{baker_,     "bake",  foam_.string(), "-o",           asset_.string(),
                                 "--preset", "exact", "--no-walk",    "--no-measure", "--quiet"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int failed = posix_spawnp(&child_, baker_.c_str(), &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed == 0) return {};
  child_ = 0;
  return makeError(ErrorKind::kUsage, "%s: cannot be run: %s; name froth with --baker", baker_.c_str(),
                   std::strerror(failed));
}

FoamFollower::News FoamFollower::end(int status) {
  child_ = 0;
  fault_.clear();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return News::kBaked;
  std::ifstream log(log_);
  fault_.assign(std::istreambuf_iterator<char>(log), {});
  while (fault_.ends_with('\n')) fault_.pop_back();
  if (fault_.empty()) fault_ = baker_ + " bake: ended without a word";
  return News::kFailed;
}

Result<FoamFollower::News> FoamFollower::poll() {
  if (isBaking()) {
    int status = 0;
    return waitpid(child_, &status, WNOHANG) == child_ ? end(status) : News::kNone;
  }
  struct stat found {};
  if (stat(foam_.c_str(), &found) != 0) return News::kNone;  // not written yet
  const FileState now{found.st_ino, found.st_mtim.tv_sec, found.st_mtim.tv_nsec};
  if (now == begun_) return News::kNone;
  begun_ = now;
  if (Status began = begin(); !began) return began.error();
  return News::kNone;
}

Status FoamFollower::waitForAsset() {
  constexpr std::chrono::milliseconds kBetweenLooks{20};
  while (true) {
    const Result<News> news = poll();
    if (!news) return news.error();
    if (*news == News::kBaked) return {};
    if (*news == News::kFailed) std::fprintf(stderr, "%s\n", fault_.c_str());
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

}  // namespace froth
