#include "tests/robustness/child_process.h"

#include <csignal>
#include <cstdio>

#include <fcntl.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace froth::test {
namespace {

Seconds secondsOf(const timeval& time) {
  return Seconds(static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec));
}

[[noreturn]] void becomeProgram(const std::vector<std::string>& command, const std::filesystem::path& folder,
                                std::optional<uint64_t> largestFile, int output) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const rlimit size{largestFile.value_or(RLIM_INFINITY), RLIM_INFINITY}, noCore{0, 0};
  const bool isReady = ::chdir(folder.c_str()) == 0 && ::dup2(output, STDOUT_FILENO) >= 0 &&
                       ::dup2(output, STDERR_FILENO) >= 0 && ::setrlimit(RLIMIT_CORE, &noCore) == 0 &&
                       (!largestFile || ::setrlimit(RLIMIT_FSIZE, &size) == 0);
  if (isReady) ::execv(arguments[0], arguments.data());
  std::perror("child of the test");
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& folder,
                           std::optional<uint64_t> largestFile) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;
  process_ = ::fork();
  if (process_ == 0) becomeProgram(command, folder, largestFile, ends[1]);
  ::close(ends[1]);
  output_ = ends[0];
}

ChildProcess::~ChildProcess() {
  if (process_ < 0) return;
  send(SIGKILL);
  wait();
}

void ChildProcess::send(int signal) const {
  if (process_ > 0) ::kill(process_, signal);
}

ProgramEnd ChildProcess::wait() {
  ProgramEnd end;
  char buffer[4096];
  for (ssize_t size; (size = ::read(output_, buffer, sizeof buffer)) > 0;) {
    end.text.append(buffer, static_cast<size_t>(size));
  }
  ::close(output_);
  int status = 0;
  rusage usage{};
  ::wait4(process_, &status, 0, &usage);
  process_ = -1;
  end.cpuTime = secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime);
  if (WIFEXITED(status)) end.exitCode = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

FolderWatch::FolderWatch(const std::filesystem::path& folder) : descriptor_(::inotify_init1(IN_CLOEXEC)) {
  ::inotify_add_watch(descriptor_, folder.c_str(), IN_CREATE | IN_MOVED_TO);
}

FolderWatch::~FolderWatch() { ::close(descriptor_); }

bool FolderWatch::waitForFile(Seconds limit) const {
  pollfd event{descriptor_, POLLIN, 0};
  return ::poll(&event, 1, static_cast<int>(1000 * limit.count())) > 0;
}

}  // namespace froth::test
