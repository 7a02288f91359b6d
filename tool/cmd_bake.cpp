// froth bake: a trained foam becomes an asset.
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include "baker/bake/asset_sink.h"
#include "baker/bake/bake.h"
#include "base/output_file.h"
#include "base/text.h"
#include "foam/checkpoint/checkpoint.h"
#include "format/read/asset_reader.h"
#include "measure/figures.h"
#include "reference/capture/view_selection.h"
#include "tool/bake_flags.h"
#include "tool/bake_jobs.h"
#include "tool/commands.h"
#include "tool/options.h"
#include "tool/statistics.h"

namespace froth {
namespace {

struct BakeCommandOptions {
  BakeJob given;
  BakeFlags flags;
  FiguresOutput figures;
  bool isForced = false;

  WriteProtected isProtected() const { return isForced ? WriteProtected::kReplace : WriteProtected::kRefuse; }
};

// Times the stages that lie around the bake itself.
class StageClock {
 public:
  StageReport stop(std::string stage, uint64_t items) {
    const auto now = std::chrono::steady_clock::now();
    StageReport report{std::move(stage), std::chrono::duration<double>(now - start_).count(), items, peakBytes()};
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
    list.push_back(
        {{"stage", stage.stage}, {"seconds", stage.seconds}, {"items", stage.items}, {"peakBytes", stage.peakBytes}});
  }
  return list;
}

void printLeftOut(const std::vector<LeftOut>& leftOut) {
  for (const LeftOut& entry : leftOut) fmt::print("left out          {}: {} bytes\n", entry.what, entry.savedBytes);
}

void printChecks(const BakeResult& baked) {
  if (baked.walkLengthBefore > 0) {
    fmt::print("walk length       {:.2f} cells per ray, {:.2f} without Steiner cells\n", baked.walkLengthAfter,
               baked.walkLengthBefore);
  }
  fmt::print("checked           {} points and {} rays against brute force: no fault\n", baked.validity.pointsChecked,
             baked.validity.raysChecked);
}

double shareOf(uint64_t part, uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

void printLevels(const std::vector<LevelReport>& levels) {
  for (size_t level = 0; level < levels.size(); ++level) {
    const LevelReport& made = levels[level];
    fmt::print(
        "level {:<11} {} live cells in {} groups, {} get coarser: {:.1f} % locked, {} merges, {} undone, {} "
        "reviews\n",
        level, made.live, made.groups + made.failed, made.groups, 100 * shareOf(made.locked, made.live), made.merges,
        made.undone, made.reviews);
  }
}

nlohmann::ordered_json levelsAsJson(const std::vector<LevelReport>& levels) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LevelReport& made : levels) {
    list.push_back({{"live", made.live},
                    {"locked", made.locked},
                    {"groups", made.groups},
                    {"failedGroups", made.failed},
                    {"merges", made.merges},
                    {"undoneMerges", made.undone},
                    {"reviews", made.reviews}});
  }
  return list;
}

nlohmann::ordered_json leftOutAsJson(const std::vector<LeftOut>& leftOut) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LeftOut& entry : leftOut) list.push_back({{"what", entry.what}, {"savedBytes", entry.savedBytes}});
  return list;
}

nlohmann::ordered_json checksAsJson(const BakeResult& baked) {
  return {{"cells", baked.validity.cells},           {"walkPairs", baked.validity.walkPairs},
          {"alphaPairs", baked.validity.alphaPairs}, {"points", baked.validity.pointsChecked},
          {"rays", baked.validity.raysChecked},      {"faults", baked.validity.faults}};
}

// Prints what was baked, and gives it as JSON.
Result<nlohmann::ordered_json> reportBake(const BakeJob& job, const BakeResult& baked, uint64_t bytes,
                                          bool wantsTable) {
  const Result<AssetReader> written = AssetReader::open(job.output);
  if (!written) return written.error();
  if (wantsTable) {
    printStages(baked.stages);
    printStatistics(baked.contents);
    printChecks(baked);
    printLevels(baked.levels);
    printLeftOut(baked.leftOut);
    printSections(*written);
    fmt::print("{}: {} bytes\n", job.output.string(), bytes);
  }
  return nlohmann::ordered_json{{"input", job.input.string()},
                                {"output", job.output.string()},
                                {"bytes", bytes},
                                {"stages", stagesAsJson(baked.stages)},
                                {"statistics", statisticsAsJson(baked.contents)},
                                {"walkLength", {{"without", baked.walkLengthBefore}, {"with", baked.walkLengthAfter}}},
                                {"checks", checksAsJson(baked)},
                                {"levels", levelsAsJson(baked.levels)},
                                {"leftOut", leftOutAsJson(baked.leftOut)},
                                {"sections", sectionsAsJson(*written)}};
}

Result<nlohmann::ordered_json> runJob(const BakeJob& job, const BakeCommandOptions& options, const Progress& progress) {
  if (Status writable = checkWritable(job.output, options.isProtected()); !writable) return writable.error();
  StageClock clock;
  Result<CameraSet> cameras = CameraSet{};
  if (!job.cameras.empty()) {
    cameras = readViews(job.cameras);
    if (!cameras) return cameras.error();
  }
  Result<Foam> foam = importCheckpoint(job.input, progress);
  if (!foam) return foam.error();
  const StageReport import = clock.stop("import", foam->cellCount);

  Result<BakeOptions> bake = options.flags.options(foam->cellCount);
  if (!bake) return bake.error();
  if (!job.cameras.empty()) bake->cameras = &*cameras;
  bake->source = printable(job.input.filename().string());  // a file name need not be UTF-8
  AssetFileSink file(job.output, options.isProtected());
  Result<BakeResult> baked = bakeFoam(*foam, *bake, file.sink(), progress);
  if (!baked) return baked.error();
  *foam = {};
  baked->stages.insert(baked->stages.begin(), import);
  clock.stop("bake", 0);

  if (!report(progress, "write", 0, 1)) return stoppedError();
  const Result<uint64_t> bytes = file.finish(baked->contents);
  if (!bytes) return bytes.error();
  baked->stages.push_back(clock.stop("write", *bytes));
  return reportBake(job, *baked, *bytes, options.figures.wantsTable());
}

// One that fails stops none of the others; the first one's error is returned.
Status runJobs(const std::vector<BakeJob>& jobs, const BakeCommandOptions& options, Tool& tool) {
  nlohmann::ordered_json done = nlohmann::ordered_json::array();
  std::optional<Error> first;
  size_t failed = 0;
  for (const BakeJob& job : jobs) {
    Result<nlohmann::ordered_json> figures = runJob(job, options, tool.progress.callback());
    tool.progress.finishLine();
    if (figures) {
      done.push_back(std::move(*figures));
      continue;
    }
    if (figures.error().kind == ErrorKind::kCancelled) return figures.error();
    std::fprintf(stderr, "froth: %s\n", printable(figures.error().message).c_str());
    if (!first) first = figures.error();
    ++failed;
  }
  if (const Status written = options.figures.write(done); !written) return written;
  if (!first) return {};
  return makeError(first->kind, "%zu of %zu bakes failed, as told above", failed, jobs.size());
}

Status runBake(const BakeCommandOptions& options, Tool& tool) {
  const Result<std::vector<BakeJob>> jobs = findBakeJobs(options.given);
  if (!jobs) return jobs.error();
  std::optional<tbb::global_control> threads;
  if (options.flags.threads() > 0) {
    threads.emplace(tbb::global_control::max_allowed_parallelism, options.flags.threads());
  }
  const bool isFolder = jobs->front().input != options.given.input;
  if (isFolder) return runJobs(*jobs, options, tool);
  const Result<nlohmann::ordered_json> figures = runJob(jobs->front(), options, tool.progress.callback());
  if (!figures) return figures.error();
  return options.figures.write(*figures);
}

}  // namespace

void addBakeCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("bake", "Bake a checkpoint into a .froth asset");
  auto options = std::make_shared<BakeCommandOptions>();
  command->add_option("INPUT", options->given.input, "A checkpoint (model.pt), or a folder of checkpoints")->required();
  command->add_option("-o,--output", options->given.output, "The .froth file to write; of a folder the folder")
      ->required();
  options->flags.addTo(*command);
  command->add_option("--cameras", options->given.cameras,
                      "Views that weigh errors, start view and flight path to store: cameras.json, a COLMAP folder or "
                      "transforms.json");
  command->add_flag("--force", options->isForced, "Replace a write-protected file; it stays so");
  addFiguresOption(*command, options->figures);
  command->callback([&tool, options] { tool.action = [&tool, options] { return runBake(*options, tool); }; });
}

}  // namespace froth
