// froth verify: whether an asset is whole and consistent, and what it costs to draw.
#include <memory>

#include <fmt/format.h>

#include "baker/input/foam_input.h"
#include "baker/lod/cut.h"
#include "baker/verify/cost_estimate.h"
#include "baker/verify/scene_check.h"
#include "format/levels.h"
#include "format/read/asset_reader.h"
#include "measure/figures.h"
#include "tool/commands.h"
#include "tool/options.h"

namespace froth {
namespace {

void printReport(const std::filesystem::path& path, const ValidityReport& found, const CostEstimate& cost) {
  fmt::print("{}: good\n", path.string());
  fmt::print("checked           {} points and {} rays against brute force, all solid balls\n", found.pointsChecked,
             found.raysChecked);
  fmt::print("balls over a ray  mean {:.1f}, most {} ({} rays from {} eyes)\n", cost.meanBalls, cost.mostBalls,
             cost.rays, cost.eyes);
  fmt::print("graph             longest row {}; squared degrees of a chunk up to {}\n", cost.longestRow,
             cost.squaredDegrees);
}

void printLevelChecks(const AssetContents& contents) {
  if (contents.levels.empty()) return;
  fmt::print(
      "levels            {}, {} groups: both forms of each with the same neighbours outside; errors grow towards the "
      "floor; the finest scene, the floor and a mixture are whole foams\n",
      countLevels(contents.levels), contents.groups.size());
  fmt::print("borders           {}, each the same ball wherever it stands\n", contents.borderCount);
}

// Of level 0.
Result<CostEstimate> estimateFinest(const AssetContents& contents) {
  const Result<AssetContents> finest = contentsOfCut(contents, std::vector<uint8_t>(contents.groups.size(), 1));
  if (!finest) return finest.error();
  return estimateCost(*finest);
}

nlohmann::ordered_json asJson(const std::filesystem::path& path, const ValidityReport& found,
                              const CostEstimate& cost) {
  return {{"file", path.string()},
          {"checks", {{"cells", found.cells}, {"points", found.pointsChecked}, {"rays", found.raysChecked}}},
          {"cost",
           {{"eyes", cost.eyes},
            {"rays", cost.rays},
            {"meanBalls", cost.meanBalls},
            {"mostBalls", cost.mostBalls},
            {"longestRow", cost.longestRow},
            {"squaredDegrees", cost.squaredDegrees}}}};
}

Status runVerify(const std::filesystem::path& path, const FiguresOutput& output, const Progress& progress) {
  if (Status good = verifyAsset(path); !good) return asBadInput(good.error());
  const Result<AssetContents> contents = readAsset(path);
  if (!contents) return asBadInput(contents.error());
  const Result<ValidityReport> found = checkScene(*contents, progress);
  if (!found) return makeError(found.error().kind, "%s: %s", path.c_str(), found.error().message.c_str());
  const bool hasLevels = !contents->levels.empty();
  const Result<CostEstimate> cost = hasLevels ? estimateFinest(*contents) : estimateCost(*contents);
  if (!cost) return cost.error();
  if (output.wantsTable()) {
    printReport(path, *found, *cost);
    printLevelChecks(*contents);
  }
  nlohmann::ordered_json figures = asJson(path, *found, *cost);
  figures["checks"]["levels"] = hasLevels ? countLevels(contents->levels) : 0;
  figures["checks"]["groups"] = contents->groups.size();
  figures["checks"]["borders"] = contents->borderCount;
  return output.write(figures);
}

}  // namespace

void addVerifyCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand(
      "verify", "Check structure, hashes, index ranges, graph and solid balls of an asset, and estimate its cost");
  auto path = std::make_shared<std::filesystem::path>();
  auto output = std::make_shared<FiguresOutput>();
  command->add_option("ASSET", *path, "A .froth file")->required();
  addFiguresOption(*command, *output);
  command->callback([&tool, path, output] {
    tool.action = [&tool, path, output] { return runVerify(*path, *output, tool.progress.callback()); };
  });
}

}  // namespace froth
