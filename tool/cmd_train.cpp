// froth train: photos become a foam.
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/output_file.h"
#include "foam/checkpoint/checkpoint.h"
#include "reference/capture/capture.h"
#include "tool/commands.h"
#include "tool/options.h"
#include "tool/train_presets.h"
#include "tool/training_log.h"
#include "tool/training_page.h"
#ifdef FROTH_HAS_CUDA
#include "trainer/cuda/multi_gpu_executor.h"
#endif
#include "trainer/loop/evaluate.h"
#include "trainer/loop/train_scene.h"

namespace froth {
namespace {

constexpr uint32_t kMeasuredByDefault = 20;  // times in a run

struct TrainCommandOptions {
  std::filesystem::path scene, output, log, page, refined;
  std::string preset = trainPresets().front().name;
  std::optional<uint32_t> steps, cells, startCells, measureEvery;  // go before the preset's
  double minutes = 0;                                              // 0: by steps
  TrainOptions train;
  bool isPremultiplied = false, isOutdoor = false;
  std::string device;  // cpu, cuda; empty: cuda where there is one
  uint32_t gpus = 1;
  bool isDeterministic = false;
  FiguresOutput figures;
};

Result<MakeExecutor> chooseExecutor(const std::string& device, uint32_t gpus,
                                    [[maybe_unused]] bool isDeterministic) {  // a CPU always is
  if (gpus > 1 && device == "cpu") return makeError(ErrorKind::kUsage, "--gpus %u: GPUs need --device cuda", gpus);
#ifdef FROTH_HAS_CUDA
  if (gpus > 1) {
    if (Status fit = MultiGpuExecutor::check(gpus); !fit) return fit.error();
    return MakeExecutor([gpus, isDeterministic](const FoamStorage<float>& foam, std::vector<Photo> photos) {
      return MultiGpuExecutor::make(gpus, foam, std::move(photos), isDeterministic);
    });
  }
  if (device == "cuda" || (device.empty() && hasCudaDevice())) {
    return MakeExecutor([isDeterministic](const FoamStorage<float>& foam, std::vector<Photo> photos) {
      return CudaExecutor::make(foam, std::move(photos), isDeterministic);
    });
  }
#endif
  if (device != "cuda" && gpus == 1) return MakeExecutor(makeCpuExecutor);
  return makeError(ErrorKind::kUsage, "%s: this froth is built without CUDA; train on the CPU, or build it with nvcc",
                   gpus > 1 ? "several GPUs" : "--device cuda");
}

Status reportTraining(const TrainCommandOptions& options, const TrainingSet& set, const TrainResult& result,
                      double seconds) {
  nlohmann::ordered_json tests = nlohmann::ordered_json::array();
  for (size_t i = 0; i < result.testPsnrs.size(); ++i) {
    tests.push_back({{"view", set.testNames[i]}, {"psnr", result.testPsnrs[i]}});
  }
  if (options.figures.wantsTable()) {
    fmt::print("{}: {} cells from {} photos, {} steps in {:.1f} s\n", options.output.string(), result.foam.cellCount,
               set.training.size(), result.stepsDone - result.firstStep, seconds);
    if (!result.testPsnrs.empty()) {
      fmt::print("PSNR of {} test photos: {:.2f} dB; of as many that trained: {:.2f} dB\n", result.testPsnrs.size(),
                 meanPsnr(result.testPsnrs), result.trainedPsnr);
    }
    if (set.matchedPoints > 0) {
      fmt::print("The capture has few points or none: began with {} that its photos show alike\n", set.matchedPoints);
    }
    if (result.droppedCount > 0) {
      fmt::print("{} contributions to gradients were no finite numbers, and were dropped\n", result.droppedCount);
    }
  }
  return options.figures.write({{"output", options.output.string()},
                                {"cells", result.foam.cellCount},
                                {"photos", set.training.size()},
                                {"matchedPoints", set.matchedPoints},
                                {"firstStep", result.firstStep},
                                {"steps", result.stepsDone},
                                {"seconds", seconds},
                                {"droppedContributions", result.droppedCount},
                                {"psnr", meanPsnr(result.testPsnrs)},
                                {"trainedPsnr", result.trainedPsnr},
                                {"tests", tests}});
}

// What the preset sets for a capture of which so many photos train, and what options set in its place; `refined`: null,
// or the foam to go on from.
void setSchedule(TrainCommandOptions& options, const Capture& capture, size_t photos, const Foam* refined) {
  const TrainPreset& preset = trainPreset(options.preset);
  TrainOptions& train = options.train;
  Schedule& schedule = train.schedule;
  schedule.steps = options.steps.value_or(stepsFor(preset, photos));
  schedule.seconds = 60 * options.minutes;
  const uint32_t cells = refined != nullptr ? refined->cellCount : cellsFor(preset, capture.points.size());
  schedule.mostCells = options.cells.value_or(cells);
  schedule.startCells = options.startCells.value_or(options.cells ? 0 : preset.startCells);
  schedule.preset = options.isOutdoor ? RatePreset::kOutdoor : RatePreset::kIndoor;
  train.measureEvery = options.measureEvery.value_or(0);
  train.measureTimes = options.measureEvery ? 0 : kMeasuredByDefault;
  train.refined = refined;
  train.photosPerStep = options.gpus;
}

// Fails before the long work where its results could not be written.
Status openOutputs(const TrainCommandOptions& options, TrainingLog& log) {
  if (Status writable = checkWritable(options.output); !writable) return writable;
  if (!options.page.empty()) {
    if (Status writable = checkWritable(options.page); !writable) return writable;
  }
  return options.log.empty() ? Status{} : log.open(options.log, options.train.isResumed);
}

void printMoment(const TrainingMoment& moment, const Schedule& schedule) {
  const uint32_t allSteps = spreadSchedule(schedule, moment.photosPerStep).steps;
  const std::string steps = schedule.seconds > 0 ? "" : fmt::format(" of {}", allSteps);
  const std::string seconds = schedule.seconds > 0 ? fmt::format(" of {:.1f}", schedule.seconds) : "";
  fmt::print("{}{} steps: {:.2f} dB, {} cells, {:.1f}{} s\n", moment.stepsDone, steps, moment.psnr, moment.cells,
             moment.seconds, seconds);
  std::fflush(stdout);
}

Status runTrain(TrainCommandOptions options, ProgressPrinter& printer) {
  const Progress progress = printer.callback();
  TrainingLog log;
  if (Status opened = openOutputs(options, log); !opened) return opened;
  std::optional<Foam> refined;
  if (!options.refined.empty()) {
    Result<Foam> foam = importCheckpoint(options.refined, progress);
    if (!foam) return foam.error();
    refined = std::move(*foam);
  }
  options.train.state = options.output;
  options.train.state.replace_extension(".state.bin");
  options.train.photos.alpha = options.isPremultiplied ? AlphaForm::kPremultiplied : AlphaForm::kStraight;
  const Result<MakeExecutor> makeExecutor = chooseExecutor(options.device, options.gpus, options.isDeterministic);
  if (!makeExecutor) return makeExecutor.error();
  Result<Capture> capture = readCapture(options.scene);
  if (!capture) return capture.error();
  options.train.photos.isMaskAlpha |= trainPreset(options.preset).isMaskAlpha;
  const Result<TrainingSet> set = prepareTraining(*capture, options.train, progress);
  if (!set) return set.error();
  setSchedule(options, *capture, set->training.size(), refined ? &*refined : nullptr);
  TrainingPage page(options.page, options.output.string());
  options.train.whenMeasured = [&](const TrainingMoment& moment) -> Status {
    if (options.figures.wantsTable()) {
      printer.finishLine();
      printMoment(moment, options.train.schedule);
    }
    if (!options.log.empty()) {
      if (Status written = log.write(moment); !written) return written;
    }
    return options.page.empty() ? Status{} : page.write(moment, *set);
  };
  options.train.whenShown = [&](const Foam& foam) { return exportCheckpoint(options.output, foam); };
  const auto begin = std::chrono::steady_clock::now();
  const Result<TrainResult> result = trainScene(*capture, *set, options.train, *makeExecutor, progress);
  if (!result) return result.error();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (Status written = exportCheckpoint(options.output, result->foam, progress); !written) return written;
  return reportTraining(options, *set, *result, seconds);
}

std::vector<std::string> presetNames() {
  std::vector<std::string> names;
  for (const TrainPreset& preset : trainPresets()) names.push_back(preset.name);
  return names;
}

}  // namespace

void addTrainCommand(CLI::App& program, Tool& tool) {
  auto options = std::make_shared<TrainCommandOptions>();
  CLI::App& command = *program.add_subcommand("train", "Photos become a foam (model.pt), which `froth bake` takes");
  command.add_option("scene", options->scene, "A folder with a COLMAP model or transforms.json")->required();
  command.add_option("-o,--output", options->output, "The foam; its state, to go on from, stands beside it")
      ->required();
  command.add_option("--preset", options->preset, "Steps and cells; options below go before what it sets")
      ->check(CLI::IsMember(presetNames()))
      ->capture_default_str();
  command.add_option("--cells", options->cells, "At most so many cells")->check(countBetween(1, 1u << 30));
  command
      .add_option("--start-cells", options->startCells, "Cells to begin with; where --cells is given, a quarter of it")
      ->check(countBetween(1, 1u << 30));
  CLI::Option* steps = command.add_option("--steps", options->steps, "Steps of one photo each; --gpus takes fewer")
                           ->check(countBetween(1, 10000000));
  CLI::Option* minutes =
      command
          .add_option("--minutes", options->minutes,
                      "As many steps as take so long, in place of --steps: rates, sizes and cells follow the time")
          ->check(numberBetween(1e-3, 1e6))
          ->excludes(steps);
  command.add_option("--refine", options->refined, "Goes on from this foam, with its K and M, at low rates");
  command.add_option("--detail-sites", options->train.detailCount, "Per cell")->check(countBetween(1, 32));
  command.add_option("--lobes", options->train.lobeCount, "Per detail site")->check(countBetween(1, 32));
  command.add_option("--downscale", options->train.photos.downscale, "Divides the sides of photos")
      ->check(numberBetween(1, 64));
  command
      .add_option("--test-every", options->train.testPeriod, "Each so many-th photo tests and does not train; 0: none")
      ->check(countBetween(0, 1000000));
  command
      .add_option("--measure-every", options->measureEvery,
                  "Steps between two looks at the test photos; 0: at the end alone; default: 20 looks in a run")
      ->check(countBetween(0, 10000000));
  command.add_option("--log", options->log, "What each look found, as lines of JSON");
  command.add_option("--page", options->page, "What the looks found, as a page (HTML): curves, and test photos");
  command
      .add_option(
          "--show-every", options->train.showEvery,
          "Steps between two foams on the way, in the place of the last; `froth_flythrough --follow` shows them")
      ->check(countBetween(1, 10000000));
  command.add_option("--seed", options->train.seed, "Of all random choices");
  command.add_option("--save-every", options->train.saveEvery, "Steps between two saved states")
      ->check(countBetween(1, 10000000));
  command.add_option("--device", options->device, "cpu or cuda; default: cuda where there is a GPU for it")
      ->check(CLI::IsMember({"cpu", "cuda"}));
  command
      .add_option(
          "--gpus", options->gpus,
          "GPUs of this machine, by NCCL: steps of so many photos, so many times fewer, at rates times its root")
      ->check(countBetween(1, kMostPhotosPerStep));
  command
      .add_flag("--deterministic", options->isDeterministic,
                "On GPUs too the same photos, options and seed give the same bits; takes longer")
      ->excludes(minutes);
  command.add_flag("--outdoor", options->isOutdoor, "Rates for scenes whose cameras stand far apart");
  command.add_flag("--premultiplied", options->isPremultiplied, "Alpha of photos is premultiplied");
  command.add_flag("--mask-as-alpha", options->train.photos.isMaskAlpha, "Masks cut the object out");
  command.add_flag("--even-exposure", options->train.evensExposure,
                   "Photos, test photos too, as if taken with one exposure, by the points that several show");
  command.add_flag("--resume", options->train.isResumed, "Goes on from the state that a stopped run left");
  addFiguresOption(command, options->figures);
  command.callback([options, &tool] { tool.action = [options, &tool] { return runTrain(*options, tool.progress); }; });
}

}  // namespace froth
