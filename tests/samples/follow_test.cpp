// froth_flythrough --follow: a foam that changes on disk is baked and shown.
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>

#include "samples/flythrough/foam_follower.h"
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using testing::HasSubstr;
using News = FoamFollower::News;

class Follow : public ToolTest {
 protected:
  // Called as froth is: bake FOAM -o ASSET.
  std::string writeBaker(const std::string& lines) const {
    const std::filesystem::path baker = folder_ / "baker.sh";
    writeBytes(baker, "#!/bin/sh\n" + lines);
    std::filesystem::permissions(baker, std::filesystem::perms::owner_all);
    return baker.string();
  }
  // As training does.
  void replaceFoam(const std::string& bytes) const {
    writeBytes(folder_ / "next.pt", bytes);
    std::filesystem::rename(folder_ / "next.pt", folder_ / "foam.pt");
  }
  std::unique_ptr<FoamFollower> follow(const std::string& baker) const {
    Result<std::unique_ptr<FoamFollower>> follower = FoamFollower::create(folder_ / "foam.pt", baker);
    EXPECT_TRUE(follower);
    return std::move(*follower);
  }
};

// Within 10 seconds; kNone: none came.
News nextNews(FoamFollower& follower) {
  for (int i = 0; i < 1000; ++i) {
    const Result<News> news = follower.poll();
    EXPECT_TRUE(news);
    if (!news || *news != News::kNone) return news ? *news : News::kNone;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return News::kNone;
}

TEST_F(Follow, BakesEachFoamThatIsWritten) {
  const auto follower = follow(writeBaker("cp \"$2\" \"$4\"\n"));
  EXPECT_EQ(*follower->poll(), News::kNone);
  EXPECT_FALSE(follower->isBaking());  // no foam is there yet
  for (const char* foam : {"first", "second"}) {
    replaceFoam(foam);
    EXPECT_EQ(*follower->poll(), News::kNone);
    EXPECT_TRUE(follower->isBaking());
    EXPECT_EQ(nextNews(*follower), News::kBaked);
    EXPECT_EQ(readBytes(follower->asset()), foam);
    EXPECT_EQ(*follower->poll(), News::kNone);
    EXPECT_FALSE(follower->isBaking());  // the same foam is not baked twice
  }
}

TEST_F(Follow, ABakeThatFailsLeavesTheLastAssetAndTellsWhy) {
  const auto follower =
      follow(writeBaker("if grep -q bad \"$2\"; then echo \"$2: no foam\" >&2; exit 3; fi\n"
                        "cp \"$2\" \"$4\"\n"));
  replaceFoam("good");
  EXPECT_EQ(nextNews(*follower), News::kBaked);
  replaceFoam("bad");
  EXPECT_EQ(nextNews(*follower), News::kFailed);
  EXPECT_EQ(follower->fault(), (folder_ / "foam.pt").string() + ": no foam");
  EXPECT_EQ(readBytes(follower->asset()), "good");
  replaceFoam("better");
  EXPECT_EQ(nextNews(*follower), News::kBaked);
  EXPECT_EQ(follower->fault(), "");
  EXPECT_EQ(readBytes(follower->asset()), "better");
}

TEST_F(Follow, WithoutABakerFails) {
  const auto follower = follow((folder_ / "none").string());
  replaceFoam("foam");
  const Result<News> news = follower->poll();
  ASSERT_FALSE(news);
  EXPECT_THAT(news.error().message, HasSubstr("--baker"));
}

TEST_F(Follow, EndsItsBakeAndLeavesNothingBehind) {
  auto follower = follow(writeBaker("exec sleep 60\n"));
  replaceFoam("foam");
  EXPECT_EQ(*follower->poll(), News::kNone);
  EXPECT_TRUE(follower->isBaking());
  const std::filesystem::path folder = follower->asset().parent_path();
  EXPECT_TRUE(std::filesystem::exists(folder));
  const auto begin = std::chrono::steady_clock::now();
  follower.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
  EXPECT_FALSE(std::filesystem::exists(folder));
}

// The second foam is written as soon as the first is baked.
TEST_F(Follow, HeadlessShowsAFrameOfEachFoam) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  makeRandomFoam("120", 3);
  std::filesystem::rename(folder_ / "random.pt", folder_ / "foam.pt");
  frothWell({"synth", "random", "--cells", "200", "--seed", "7", "-o", "second.pt"});
  frothWell({"render", "second.pt", "--cameras", "cameras.json", "--view", "2", "--renderer", "reference", "--size",
             "96x64", "-o", "second.png"});
  const std::string baker =
      writeBaker("'" FROTH_TOOL "' \"$@\" || exit\nif test -f second.pt; then mv second.pt foam.pt; fi\n");
  const auto fly = [&](const std::string& frames) {
    return runProgram(
        FROTH_FLYTHROUGH,
        {"--follow", "foam.pt", "--baker", baker, "--headless", "--validate", "--size", "96x64", "--cameras",
         "cameras.json", "--frames", frames, "-o", "frames", "--compare", "second.png", "--min-psnr", "40"},
        folder_);
  };
  const ProgramRun both = fly("2");
  EXPECT_EQ(both.exitCode, 0) << both.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "frames/frame_0001.png"));
}

TEST_F(Follow, NeedsAnAssetOrAFoam) {
  const ProgramRun neither = runProgram(FROTH_FLYTHROUGH, {}, folder_);
  EXPECT_EQ(neither.exitCode, 2);
  EXPECT_THAT(neither.err, HasSubstr("--follow"));
  EXPECT_EQ(runProgram(FROTH_FLYTHROUGH, {"a.froth", "--follow", "foam.pt"}, folder_).exitCode, 2);
}

}  // namespace
}  // namespace froth::test
