// A folder with a checkpoint and the asset of an earlier bake, for tests that disturb the next one.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "tests/robustness/child_process.h"
#include "tests/tool/program_runner.h"

namespace froth::test {

class BakeTest : public ToolTest {
 protected:
  static constexpr const char* kCheckpoint = "foam.pt";
  static constexpr const char* kAsset = "out.froth";

  // Makes the checkpoint, and what a bake must find and what it must write: oldBytes_ and newBytes_.
  explicit BakeTest(const std::string& cells = "3000");

  // A bake that writes newBytes_; `more` options follow.
  static std::vector<std::string> bakeCommand(const std::vector<std::string>& more = {});
  void putOldAsset() const { writeBytes(folder_ / kAsset, oldBytes_); }
  std::string assetBytes() const { return readBytes(folder_ / kAsset); }
  // The folder holds checkpoint and asset and nothing else.
  void expectNothingLeft() const;

  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  // From the environment, for longer runs by hand.
  static int countFrom(const char* variable, int usual);

  std::string oldBytes_, newBytes_;

 private:
  std::mt19937 random_{1};
};

void sleepFor(Seconds time);
Seconds since(std::chrono::steady_clock::time_point start);

}  // namespace froth::test
