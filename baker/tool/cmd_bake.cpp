// froth bake: a trained foam becomes an asset.
#include <chrono>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>

#include "baker/bake/bake.h"
#include "baker/checkpoint/checkpoint.h"
#include "baker/tool/commands.h"
#include "baker/tool/figures.h"
#include "baker/tool/foam_input.h"
#include "baker/tool/option_checks.h"
#include "baker/tool/output_file.h"
#include "baker/tool/statistics.h"
#include "format/asset_writer.h"
#include "format/atomic_file.h"

namespace froth {
namespace {

struct BakeCommandOptions {
  std::filesystem::path input, output, cameras;
  BakeOptions bake;
  FiguresOutput figures;
};

// Times the stages that lie around the bake itself.
class StageClock {
 public:
  StageReport stop(std::string stage, uint64_t items) {
    const auto now = std::chrono::steady_clock::now();
    StageReport report{std::move(stage), std::chrono::duration<double>(now - start_).count(), items,
                       peakBytes()};
    start_ = now;
    return report;
  }

 private:
  static uint64_t peakBytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
  }

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void printStages(const std::vector<StageReport>& stages) {
  fmt::print("{:<22} {:>9} {:>12} {:>12}\n", "stage", "seconds", "items", "peak MiB");
  for (const StageReport& stage : stages) {
    fmt::print("{:<22} {:>9.3f} {:>12} {:>12.1f}\n", stage.stage, stage.seconds, stage.items,
               static_cast<double>(stage.peakBytes) / (1 << 20));
  }
}

nlohmann::ordered_json stagesAsJson(const std::vector<StageReport>& stages) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const StageReport& stage : stages) {
    list.push_back({{"stage", stage.stage},
                    {"seconds", stage.seconds},
                    {"items", stage.items},
                    {"peakBytes", stage.peakBytes}});
  }
  return list;
}

Status runBake(BakeCommandOptions& options, const Progress& progress) {
  StageClock clock;
  Result<CameraSet> cameras = CameraSet{};
  if (!options.cameras.empty()) {
    cameras = readCameras(options.cameras);
    if (!cameras) return cameras.error();
    options.bake.cameras = &*cameras;
  }
  Result<Foam> foam = importCheckpoint(options.input, progress);
  if (!foam) return foam.error();
  std::vector<StageReport> stages{clock.stop("import", foam->cellCount)};

  options.bake.source = options.input.filename().string();
  Result<BakeResult> baked = bakeFoam(*foam, options.bake, progress);
  if (!baked) return baked.error();
  *foam = {};  // encoding needs the room
  stages.insert(stages.end(), baked->stages.begin(), baked->stages.end());
  clock.stop("bake", 0);

  const Result<std::vector<uint8_t>> bytes = encodeAsset(baked->contents);
  if (!bytes) return bytes.error();
  stages.push_back(clock.stop("encode", bytes->size()));
  if (!report(progress, "write", 0, bytes->size())) return stoppedError();
  if (Status written = writeFileAtomically(options.output, *bytes); !written) return written;
  stages.push_back(clock.stop("write", bytes->size()));

  if (options.figures.wantsTable()) {
    printStages(stages);
    printStatistics(baked->contents);
    fmt::print("{}: {} bytes\n", options.output.string(), bytes->size());
  }
  return options.figures.write({{"input", options.input.string()},
                                {"output", options.output.string()},
                                {"bytes", bytes->size()},
                                {"stages", stagesAsJson(stages)},
                                {"statistics", statisticsAsJson(baked->contents)}});
}

Status checkAndRunBake(BakeCommandOptions& options, const Progress& progress) {
  if (!isAssetPath(options.output)) {
    return makeError(ErrorKind::kUsage, "-o %s: an asset's name ends in .froth", options.output.c_str());
  }
  if (isAssetPath(options.input)) {
    return makeError(ErrorKind::kUsage, "%s is an asset already; bake the checkpoint that it came from",
                     options.input.c_str());
  }
  if (Status writable = checkWritable(options.output); !writable) return writable;
  return runBake(options, progress);
}

}  // namespace

void addBakeCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("bake", "Bake a checkpoint into a .froth asset");
  auto options = std::make_shared<BakeCommandOptions>();
  command->add_option("INPUT", options->input, "A checkpoint (model.pt)")->required();
  command->add_option("-o,--output", options->output, "The .froth file to write")->required();
  command->add_option("--preset", options->bake.preset, "How exactly values are kept")
      ->capture_default_str()
      ->check(CLI::IsMember({"exact"}));
  const CLI::Validator limits = numberBetween(0, std::numeric_limits<float>::max());
  command
      ->add_option("--near-ratio", options->bake.nearRatio,
                   "Default: skip cells nearer than this many radii; 0: none")
      ->capture_default_str()
      ->check(limits);
  command
      ->add_option("--near-depth", options->bake.nearDepth,
                   "Default: skip cells nearer than this depth [scene units]; 0: none")
      ->capture_default_str()
      ->check(limits);
  command->add_option("--cameras", options->cameras, "Start view and flight path to store (cameras.json)");
  addFiguresOption(*command, options->figures);
  command->callback([&tool, options] {
    tool.action = [&tool, options] { return checkAndRunBake(*options, tool.progress.callback()); };
  });
}

}  // namespace froth
