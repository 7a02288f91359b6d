// froth train: from photos on disk to a foam that bakes.
#include <sstream>

#include <fmt/format.h>

#include "tests/tool/shots_fixture.h"
#include "tool/train_presets.h"

namespace froth::test {
namespace {

class Train : public ShotsTest {};

TEST_F(Train, MakesAFoamThatBakesAndGoesOnFromItsState) {
  makeShots();
  const nlohmann::json figures = frothJson(trainCommand());
  EXPECT_EQ(figures["photos"], 5);
  EXPECT_EQ(figures["tests"].size(), 1u);
  EXPECT_GT(figures["psnr"].get<double>(), 5);
  EXPECT_GT(figures["trainedPsnr"].get<double>(), 5);
  EXPECT_EQ(figures["droppedContributions"], 0);
  EXPECT_EQ(frothJson({"info", "trained.pt"})["cells"], figures["cells"]);
  frothWell({"bake", "trained.pt", "-o", "trained.froth"});

  const nlohmann::json drawn = frothJson({"evaluate", "trained.froth", "shots", "-o", "drawn"});
  ASSERT_EQ(drawn["views"].size(), 1u);
  EXPECT_NEAR(drawn["mean"]["psnr"].get<double>(), figures["psnr"].get<double>(), 0.3);
  EXPECT_EQ(drawn["views"][0]["psnr"], drawn["mean"]["psnr"]);
  const nlohmann::json again = frothJson({"compare", "drawn/shot_0.png", "shots/shot_0.png"});
  EXPECT_NEAR(again["psnr"].get<double>(), drawn["mean"]["psnr"].get<double>(), 0.01);
  EXPECT_NEAR(again["ssim"].get<double>(), drawn["mean"]["ssim"].get<double>(), 1e-3);

  const std::string first = readBytes(folder_ / "trained.pt");
  std::vector<std::string> resume = trainCommand();
  resume.push_back("--resume");
  EXPECT_EQ(frothJson(resume)["firstStep"], 30);
  EXPECT_EQ(readBytes(folder_ / "trained.pt"), first);
}

TEST_F(Train, LogsWhatItMeasuresAndRefines) {
  makeShots();
  std::vector<std::string> logged = trainCommand();
  logged.insert(logged.end(), {"--log", "log.jsonl", "--page", "page.html", "--measure-every", "10"});
  const nlohmann::json figures = frothJson(logged);
  std::istringstream lines(readBytes(folder_ / "log.jsonl"));
  std::vector<nlohmann::json> moments;
  for (std::string line; std::getline(lines, line);) moments.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(moments.size(), 3u);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(moments[i]["steps"], 10 * (i + 1));
  EXPECT_EQ(moments[2]["psnr"], figures["psnr"]);
  EXPECT_EQ(moments[2]["cells"], figures["cells"]);
  const std::string page = readBytes(folder_ / "page.html");
  EXPECT_NE(page.find("30 steps in"), std::string::npos);
  EXPECT_NE(page.find("<b>shot_0.png</b> " + fmt::format("{:.2f} dB", figures["psnr"].get<double>())),
            std::string::npos);

  const nlohmann::json refined =
      frothJson({"train", "shots", "-o", "refined.pt", "--refine", "trained.pt", "--steps", "10"});
  EXPECT_EQ(refined["cells"], figures["cells"]);
  EXPECT_GT(refined["psnr"].get<double>(), figures["psnr"].get<double>() - 0.3);
  EXPECT_EQ(froth({"train", "shots", "-o", "b.pt", "--refine", "shots/transforms.json"}).exitCode, 3);
  EXPECT_EQ(froth({"train", "shots", "-o", "b.pt", "--log", "none/log.jsonl"}).exitCode, 1);
  EXPECT_EQ(froth({"train", "shots", "-o", "b.pt", "--page", "none/page.html"}).exitCode, 1);
}

TEST(TrainPresets, GiveTwoCellsForEachPointWithinBounds) {
  const TrainPreset& preset = trainPreset("default");
  EXPECT_EQ(cellsFor(preset, 0), 40000u);
  EXPECT_EQ(cellsFor(preset, 30000), 60000u);
  EXPECT_EQ(cellsFor(preset, size_t{1} << 40), 120000u);
  EXPECT_EQ(cellsFor(trainPreset("object"), 30000), 50000u);
}

TEST(TrainPresets, GiveEightyStepsForEachPhotoWithinBounds) {
  const TrainPreset& preset = trainPreset("default");
  EXPECT_EQ(stepsFor(preset, 84), 12000u);
  EXPECT_EQ(stepsFor(preset, 256), 20480u);
  EXPECT_EQ(stepsFor(preset, 1000), 30000u);
  EXPECT_EQ(stepsFor(trainPreset("fast"), 1000), 5000u);
}

TEST_F(Train, FitsIntoMinutes) {
  makeShots();
  std::vector<std::string> timed{"train", "shots",          "-o", "timed.pt", "--cells", "200",       "--lobes",
                                 "1",     "--detail-sites", "1",  "--device", "cpu",     "--minutes", "0.01"};
  const nlohmann::json figures = frothJson(timed);
  EXPECT_GT(figures["steps"], 0);
  EXPECT_EQ(frothJson({"info", "timed.pt"})["cells"], figures["cells"]);
  timed.insert(timed.end(), {"--steps", "30"});
  EXPECT_EQ(froth(timed).exitCode, 2);
}

TEST_F(Train, SaysWhatIsWrong) {
  EXPECT_EQ(froth({"train", "none", "-o", "a.pt"}).exitCode, 3);
  makeShots();
  std::vector<std::string> resume = trainCommand();
  resume.push_back("--resume");
  const ProgramRun stateless = froth(resume);
  EXPECT_EQ(stateless.exitCode, 3);
  EXPECT_NE(stateless.err.find("trained.state.bin"), std::string::npos) << stateless.err;
  for (const ProgramRun& uneven : {froth({"train", "shots", "-o", "a.pt", "--even-exposure"}),
                                   froth({"evaluate", "trained.pt", "shots", "--even-exposure"})}) {
    EXPECT_EQ(uneven.exitCode, 3);
    EXPECT_NE(uneven.err.find("of 0 points"), std::string::npos) << uneven.err;  // transforms.json has none
  }
  for (const std::string gpus : {"2", "16"}) {
    std::vector<std::string> spread{"train", "shots", "-o", "a.pt", "--gpus", gpus};
    if (gpus == "2") spread.insert(spread.end(), {"--device", "cpu"});
    const ProgramRun lacking = froth(spread);  // no machine of ours has 16
    EXPECT_NE(lacking.exitCode, 0);
    EXPECT_NE(lacking.err.find("GPU"), std::string::npos) << lacking.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.pt"));
  }
  std::vector<std::string> many = trainCommand();
  many.insert(many.end(), {"--start-cells", "300"});
  const ProgramRun shrinking = froth(many);
  EXPECT_EQ(shrinking.exitCode, 2);
  EXPECT_NE(shrinking.err.find("300"), std::string::npos) << shrinking.err;
}

}  // namespace
}  // namespace froth::test
