// Runs a built program as a shell would, in a folder of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "reference/camera/camera.h"

namespace froth::test {

struct ProgramRun {
  int exitCode = -1;  // -1: it died of a signal
  std::string out, err;
};

// Arguments reach the program as they are. Runs in `folder`.
ProgramRun runProgram(const std::string& program, const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder);

std::string readBytes(const std::filesystem::path& path);
void writeBytes(const std::filesystem::path& path, const std::string& bytes);

// A view of the synthetic foam "random", from outside.
View viewOfRandomFoam(uint32_t width, uint32_t height);

// An empty folder that goes with the test; runs `froth` in it.
class ToolTest : public testing::Test {
 protected:
  ToolTest();
  ~ToolTest() override;

  ProgramRun froth(const std::vector<std::string>& arguments) const;
  // Expects exit code 0, and gives stdout.
  std::string frothWell(const std::vector<std::string>& arguments) const;
  nlohmann::json frothJson(std::vector<std::string> arguments) const;

  // random.pt, random.froth and cameras.json with `views` views.
  void makeRandomFoam(const std::string& cells, size_t views = 1) const;
  std::vector<std::string> filesInFolder() const;  // sorted names
  bool hasDevice() const;

  std::filesystem::path folder_;
};

}  // namespace froth::test
