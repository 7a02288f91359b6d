#include "tests/robustness/bake_fixture.h"

#include <algorithm>
#include <cstdlib>
#include <thread>

namespace froth::test {

BakeTest::BakeTest(const std::string& cells) {
  frothWell({"synth", "random", "--cells", cells, "-o", kCheckpoint, "--quiet"});
  const ProgramEnd end = ChildProcess(bakeCommand(), folder_).wait();
  EXPECT_EQ(end.exitCode, 0) << end.text;
  newBytes_ = assetBytes();
  frothWell({"bake", kCheckpoint, "--preset", "exact", "-o", kAsset, "--near-ratio", "3", "--quiet"});
  oldBytes_ = assetBytes();
  EXPECT_NE(oldBytes_, newBytes_);
}

std::vector<std::string> BakeTest::bakeCommand(const std::vector<std::string>& more) {
  std::vector<std::string> command{FROTH_TOOL, "bake", kCheckpoint, "-o", kAsset, "--quiet"};
  if (std::ranges::count(more, "--preset") == 0) command.insert(command.end(), {"--preset", "exact"});
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

void BakeTest::expectNothingLeft() const {
  EXPECT_EQ(filesInFolder(), (std::vector<std::string>{kCheckpoint, kAsset}));
}

int BakeTest::countFrom(const char* variable, int usual) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : usual;
}

void sleepFor(Seconds time) { std::this_thread::sleep_for(time); }

Seconds since(std::chrono::steady_clock::time_point start) { return std::chrono::steady_clock::now() - start; }

}  // namespace froth::test
