// The same checkpoint and options give the same bytes, on any number of threads and again the next time.
#include "tests/robustness/bake_fixture.h"

namespace froth::test {
namespace {

class SameBytes : public BakeTest, public testing::WithParamInterface<const char*> {
 protected:
  SameBytes() : BakeTest("600") {}

  // In several chunks, which threads work on at once.
  std::string bake(const char* threads) const {
    const ProgramEnd end =
        ChildProcess(bakeCommand({"--preset", GetParam(), "--chunk-cells", "200", "--threads", threads}), folder_)
            .wait();
    EXPECT_EQ(end.exitCode, 0) << end.text;
    return assetBytes();
  }
};

TEST_P(SameBytes, OnAnyNumberOfThreadsAndInASecondRun) {
  const std::string bytes = bake("1");
  for (const char* threads : {"1", "2", "8"}) EXPECT_TRUE(bake(threads) == bytes) << threads << " threads";
}

INSTANTIATE_TEST_SUITE_P(OfPreset, SameBytes, testing::Values("exact", "default"),
                         [](const auto& preset) { return std::string(preset.param); });

}  // namespace
}  // namespace froth::test
