// froth info: what a file holds.
#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "baker/input/foam_input.h"
#include "foam/checkpoint/checkpoint.h"
#include "format/read/asset_reader.h"
#include "froth/froth_estimate.h"
#include "host/make_struct.h"
#include "measure/figures.h"
#include "tool/commands.h"
#include "tool/options.h"
#include "tool/statistics.h"

namespace froth {
namespace {

uint64_t fileSize(const std::filesystem::path& path) {
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

// What the runtime will hold of the asset, and of a view with one instance of it.
Result<FrothMemoryEstimate> estimateMemory(const std::filesystem::path& path, VkExtent2D extent) {
  auto asset = makeStruct<FrothAssetInfo>();
  asset.path = path.c_str();
  auto view = makeStruct<FrothViewInfo>();
  view.maxExtent = extent;
  auto info = makeStruct<FrothEstimateInfo>();
  info.asset = &asset;
  info.view = &view;
  std::string message;
  info.messageUser = &message;
  info.onMessage = [](void* user, FrothSeverity, FrothResult, const char*, const char* text) {
    *static_cast<std::string*>(user) = text;
  };
  auto estimate = makeStruct<FrothMemoryEstimate>();
  if (frothEstimateMemory(&info, &estimate) == FROTH_OK) return estimate;
  return makeError(ErrorKind::kBadInput, "%s", message.c_str());
}

Status describeMemory(const std::filesystem::path& path, const FiguresOutput& output, nlohmann::ordered_json& figures) {
  constexpr VkExtent2D kExtent = {1920, 1080};
  const Result<FrothMemoryEstimate> memory = estimateMemory(path, kExtent);
  if (!memory) return memory.error();
  const uint64_t viewBytes = memory->viewBytes + memory->viewInstanceBytes;
  if (output.wantsTable()) {
    fmt::print("GPU memory        {} bytes of the asset, {} of a view of {} x {} pixels\n", memory->assetBytes,
               viewBytes, kExtent.width, kExtent.height);
  }
  figures["memory"] = {{"assetBytes", memory->assetBytes},
                       {"viewExtent", {kExtent.width, kExtent.height}},
                       {"viewBytes", viewBytes},
                       {"viewHostBytes", memory->viewInstanceHostBytes}};
  return {};
}

Status describeAsset(const std::filesystem::path& path, bool wantsMemory, const FiguresOutput& output) {
  const Result<AssetReader> reader = AssetReader::open(path);
  if (!reader) return asBadInput(reader.error());
  const AssetContents& manifest = reader->manifest();
  if (output.wantsTable()) {
    printStatistics(manifest);
    printLevels(*reader);
    printSections(*reader);
    fmt::print("file              {} bytes\n", fileSize(path));
  }
  nlohmann::ordered_json figures{{"file", path.string()}, {"kind", "asset"}, {"bytes", fileSize(path)}};
  figures.update(statisticsAsJson(manifest));
  figures["levels"] = levelsAsJson(*reader);
  figures["sections"] = sectionsAsJson(*reader);
  const Status status = wantsMemory ? describeMemory(path, output, figures) : Status();
  return status ? output.write(figures) : status;
}

struct Range {
  float least = 0, most = 0;
};

Range rangeOf(std::span<const float> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, *most};
}

Status describeCheckpoint(const std::filesystem::path& path, const FiguresOutput& output, const Progress& progress) {
  const Result<Foam> foam = importCheckpoint(path, progress);
  if (!foam) return foam.error();
  const Range radii = rangeOf(foam->radii), densities = rangeOf(foam->densities);
  glm::vec3 least = foam->sites.front(), most = foam->sites.front();
  for (const glm::vec3& site : foam->sites) {
    least = glm::min(least, site);
    most = glm::max(most, site);
  }
  if (output.wantsTable()) {
    fmt::print("cells             {}\n", foam->cellCount);
    fmt::print("detail sites      {} per cell, {} lobes each\n", foam->detailCount, foam->lobeCount);
    fmt::print("sites             ({}, {}, {}) to ({}, {}, {})\n", least.x, least.y, least.z, most.x, most.y, most.z);
    fmt::print("radii             {} to {}\n", radii.least, radii.most);
    fmt::print("densities         {} to {}\n", densities.least, densities.most);
    fmt::print("file              {} bytes\n", fileSize(path));
  }
  return output.write({{"file", path.string()},
                       {"kind", "checkpoint"},
                       {"bytes", fileSize(path)},
                       {"cells", foam->cellCount},
                       {"detailCount", foam->detailCount},
                       {"lobeCount", foam->lobeCount},
                       {"siteMin", {least.x, least.y, least.z}},
                       {"siteMax", {most.x, most.y, most.z}},
                       {"radiusRange", {radii.least, radii.most}},
                       {"densityRange", {densities.least, densities.most}}});
}

}  // namespace

void addInfoCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("info", "Describe a checkpoint or an asset");
  auto path = std::make_shared<std::filesystem::path>();
  auto output = std::make_shared<FiguresOutput>();
  auto wantsMemory = std::make_shared<bool>(false);
  command->add_option("INPUT", *path, "A checkpoint or a .froth file")->required();
  command->add_flag("--memory", *wantsMemory, "Of an asset: what it and a view take at run time; decodes all of it");
  addFiguresOption(*command, *output);
  command->callback([&tool, path, wantsMemory, output] {
    tool.action = [&tool, path, wantsMemory, output] {
      if (isAssetPath(*path)) return describeAsset(*path, *wantsMemory, *output);
      return describeCheckpoint(*path, *output, tool.progress.callback());
    };
  });
}

}  // namespace froth
