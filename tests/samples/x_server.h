// An X server without a screen, for programs with windows. xvfb-run, which would do it, now and then waits for ever for
// its server, or fails when it cleans up.
#pragma once

#include <csignal>
#include <cstdlib>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace froth::test {

// DISPLAY names it while it lives.
class XServer {
 public:
  XServer() {
    int ends[2];
    if (pipe(ends) != 0) return;
    process_ = fork();
    if (process_ == 0) {
      close(ends[0]);
      const std::string out = std::to_string(ends[1]);
      execlp("Xvfb", "Xvfb", "-displayfd", out.c_str(), "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-ac",
             static_cast<char*>(nullptr));
      _exit(127);
    }
    close(ends[1]);
    // It picks a free number and writes it once it listens; nothing if it ends before.
    std::string number;
    for (char digit = 0; read(ends[0], &digit, 1) == 1 && digit != '\n';) number += digit;
    close(ends[0]);
    isRunning_ = !number.empty();
    if (isRunning_) setenv("DISPLAY", (":" + number).c_str(), 1);
  }
  ~XServer() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
    unsetenv("DISPLAY");
  }
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  bool isRunning() const { return isRunning_; }

 private:
  pid_t process_ = -1;
  bool isRunning_ = false;
};

}  // namespace froth::test
