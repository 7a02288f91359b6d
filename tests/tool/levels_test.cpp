// What `froth info` and `froth verify` say of an asset with levels of detail.
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

class LevelsCommand : public ToolTest {
 protected:
  std::string asset() const { return sourceFolder() / "tests/format/golden/version_3_0.froth"; }
};

TEST_F(LevelsCommand, InfoShowsEachLevelAndTheFloor) {
  const nlohmann::json info = frothJson({"info", asset()});
  const nlohmann::json& levels = info["levels"]["levels"];
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[0]["chunks"], 8);
  EXPECT_EQ(levels[0]["cells"], info["cells"]) << "the cells of an asset are those of level 0";
  EXPECT_EQ(levels[0]["groups"], 4);
  EXPECT_EQ(levels[1]["groups"], 2);
  EXPECT_EQ(levels[1]["errorRange"][0], 0.02);
  EXPECT_EQ(levels[2]["groups"], 0);
  EXPECT_EQ(info["levels"]["floor"]["chunks"], 2);
  EXPECT_EQ(info["levels"]["floor"]["bytes"], levels[2]["bytes"]);
  uint64_t bytes = 0;
  for (const nlohmann::json& level : levels) bytes += level["bytes"].get<uint64_t>();
  EXPECT_EQ(bytes, info["sections"]["all"]["bytes"]);
  EXPECT_NE(frothWell({"info", asset()}).find("floor             2 chunks"), std::string::npos);
}

TEST_F(LevelsCommand, VerifySaysWhatItChecked) {
  const nlohmann::json checks = frothJson({"verify", asset()})["checks"];
  EXPECT_EQ(checks["levels"], 3);
  EXPECT_EQ(checks["groups"], 6);
  EXPECT_GT(checks["borders"], 0);
  EXPECT_NE(frothWell({"verify", asset()}).find("levels            3, 6 groups: both forms of each"),
            std::string::npos);
}

TEST_F(LevelsCommand, InfoSaysNothingOfLevelsWhereThereAreNone) {
  makeRandomFoam("50");
  EXPECT_TRUE(frothJson({"info", "random.froth"})["levels"].is_null());
  EXPECT_EQ(frothWell({"info", "random.froth"}).find("floor"), std::string::npos);
}

}  // namespace
}  // namespace froth::test
