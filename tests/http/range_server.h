// An HTTP server on this machine that answers ranges, and fails as its paths say: range_server.py.
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/surroundings.h"

namespace froth::test {

class RangeServer {
 public:
  // port() is 0: there is no Python.
  explicit RangeServer(const std::filesystem::path& folder) {
    std::array<int, 2> toServer{}, fromServer{};
    if (pipe2(toServer.data(), O_CLOEXEC) != 0 || pipe2(fromServer.data(), O_CLOEXEC) != 0) return;
    const std::string script = (sourceFolder() / "tests/http/range_server.py").string();
    process_ = fork();
    if (process_ == 0) {
      dup2(toServer[0], STDIN_FILENO);
      dup2(fromServer[1], STDOUT_FILENO);
      execlp("python3", "python3", "-B", script.c_str(), folder.c_str(), nullptr);
      _exit(1);
    }
    close(toServer[0]);
    close(fromServer[1]);
    input_ = toServer[1];
    FILE* const output = fdopen(fromServer[0], "r");
    if (std::fscanf(output, "%d", &port_) != 1) port_ = 0;
    std::fclose(output);
  }
  ~RangeServer() {
    if (input_ < 0) return;
    close(input_);  // which ends it
    waitpid(process_, nullptr, 0);
  }
  RangeServer(const RangeServer&) = delete;
  RangeServer& operator=(const RangeServer&) = delete;

  int port() const { return port_; }
  // fault: the first part of a path, see range_server.py.
  std::string url(const std::string& fault, const std::string& file) const {
    return "http://127.0.0.1:" + std::to_string(port_) + "/" + fault + "/" + file;
  }

 private:
  int input_ = -1, port_ = 0;
  pid_t process_ = -1;
};

}  // namespace froth::test
