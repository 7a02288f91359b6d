#include "trainer/loop/train_scene.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "foam/pick_foam.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/loop/cpu_executor.h"
#include "trainer/loop/evaluate.h"
#include "trainer/loop/state_file.h"
#include "trainer/loop/training_loop.h"
#include "trainer/photos/photo_order.h"
#include "trainer/start/match_points.h"
#include "trainer/start/start_foam.h"

namespace froth {
namespace {

constexpr float kFirstContribution = 1e-5f;  // the means begin there (design: training.md 6)

// All that decides on the bits of a run; a state goes on under the same alone.
std::string settingsText(const TrainOptions& options, const TrainingSet& set) {
  const Schedule& schedule = options.schedule;
  const View& view = set.training.front().view;
  return fmt::format("{} {} cells {} to {} rates {} K {} M {} seed {} photos {} of {} x {} near {}",
                     schedule.isRefinement ? "refinement, steps" : "steps", schedule.steps, schedule.startCells,
                     schedule.mostCells, static_cast<int>(schedule.preset), options.detailCount, options.lobeCount,
                     options.seed, set.training.size(), view.width, view.height, options.nearRatio);
}

Result<FoamStorage<float>> makeStart(const Capture& capture, const TrainingSet& set, const TrainOptions& options) {
  Foam foam;
  if (options.refined != nullptr) {
    foam = normalisedFoam(*options.refined, set.frame);
  } else {
    const StartScene scene{capture, set.frame, set.trainingViews, set.training, options.seed};
    Result<StartFoam> start =
        makeStartFoam(scene, {options.schedule.startCells, options.detailCount, options.lobeCount});
    if (!start) return start.error();
    foam = std::move(start->foam);
  }
  FoamStorage<float> storage = storeFoam<float>(foam);
  std::fill(storage.contributions.begin(), storage.contributions.end(), kFirstContribution);
  std::fill(storage.errors.begin(), storage.errors.end(), kFirstContribution);
  return storage;
}

Result<TrainingState> resumeState(const TrainOptions& options, const std::string& settings) {
  Result<TrainingState> state = readState(options.state);
  if (!state || state->settings == settings) return state;
  return makeError(ErrorKind::kUsage, "%s: of a run with other settings (%s; now %s); give the same, or begin anew",
                   options.state.c_str(), state->settings.c_str(), settings.c_str());
}

Status saveState(StepExecutor& executor, const TrainOptions& options, const std::string& settings, uint32_t done) {
  TrainingState state;
  state.stepsDone = done;
  state.settings = settings;
  if (Status read = executor.read(state.foam); !read) return read;
  if (Status written = writeState(options.state, state); !written) return written;
  return executor.beginAnew();
}

// Tells how far a run is, and how long its steps took.
class Meter {
 public:
  Meter(StepExecutor& executor, const TrainOptions& options, const std::vector<Photo>& tests)
      : executor_(executor), options_(options), tests_(tests) {}

  // The PSNR of each test photo.
  Result<std::vector<double>> measure(uint32_t done, DriftTables& drifts) {
    if (const Result<uint64_t> waited = executor_.droppedCount(); !waited) return waited.error();
    pause();
    Result<std::vector<double>> psnrs = executor_.psnrs(tests_, drifts.adamAt(done));
    if (psnrs && options_.whenMeasured) {
      const Status told = options_.whenMeasured({done, seconds_, executor_.cellCount(), meanPsnr(*psnrs)});
      if (!told) return told.error();
    }
    goOn();
    return psnrs;
  }
  void pause() { seconds_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
  void goOn() { begin_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;

  StepExecutor& executor_;
  const TrainOptions& options_;
  const std::vector<Photo>& tests_;
  Clock::time_point begin_ = Clock::now();
  double seconds_ = 0;
};

// Runs the steps that are left; measures and saves on the way, and saves when it is stopped.
Status runSteps(StepExecutor& executor, const TrainOptions& options, const LoopOptions& loop,
                const std::string& settings, Meter& meter, const Progress& progress) {
  uint32_t done = loop.firstStep;
  const auto afterStep = [&](uint32_t steps, DriftTables& drifts) -> Status {
    done = steps;
    const bool isLast = steps == options.schedule.steps;
    if (options.measureEvery != 0 && steps % options.measureEvery == 0 && !isLast) {
      if (const auto measured = meter.measure(steps, drifts); !measured) return measured.error();
    }
    if (options.state.empty() || steps % options.saveEvery != 0 || isLast) return {};
    meter.pause();
    const Status saved = saveState(executor, options, settings, steps);
    meter.goOn();
    return saved;
  };
  const Status ran = runLoop(executor, loop, afterStep, progress);
  const bool wasStopped = !ran && ran.error().kind == ErrorKind::kCancelled;
  if (options.state.empty() || !(ran || wasStopped)) return ran;
  if (Status saved = saveState(executor, options, settings, done); !saved) return saved;
  if (!wasStopped) return ran;
  return makeError(ErrorKind::kCancelled, "training stopped on request after %u of %u steps; %s goes on with --resume",
                   done, options.schedule.steps, options.state.c_str());
}

// A checkpoint has no cells without a radius.
Foam withoutVanished(const Foam& foam) {
  std::vector<uint32_t> cells;
  std::vector<uint64_t> details;
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    if (!(foam.radii[i] >= std::numeric_limits<float>::min())) continue;
    cells.push_back(i);
    for (uint32_t k = 0; k < foam.detailCount; ++k) details.push_back(uint64_t{i} * foam.detailCount + k);
  }
  return pickFoam(foam, {cells, details, foam.detailCount, foam.lobeCount});
}

Result<TrainResult> finishTraining(StepExecutor& executor, const TrainingSet& set, const LoopOptions& loop,
                                   Meter& meter) {
  DriftTables drifts(loop.schedule);
  Result<std::vector<double>> psnrs = meter.measure(loop.schedule.steps, drifts);
  if (!psnrs) return psnrs.error();
  FoamStorage<float> foam;
  if (Status read = executor.read(foam); !read) return read.error();
  const Result<uint64_t> dropped = executor.droppedCount();
  if (!dropped) return dropped.error();
  catchUpAll(foam, loop.schedule.steps, drifts);
  TrainResult result;
  result.testPsnrs = std::move(*psnrs);
  result.foam = sceneFoam(withoutVanished(activateFoam(foam)), set.frame);
  result.droppedCount = *dropped;
  result.firstStep = loop.firstStep;
  return result;
}

}  // namespace

Result<std::unique_ptr<StepExecutor>> makeCpuExecutor(FoamStorage<float> foam, std::vector<Photo> photos) {
  return std::unique_ptr<StepExecutor>(std::make_unique<CpuExecutor>(std::move(foam), std::move(photos)));
}

Result<TrainingSet> makeTrainingSet(Capture& capture, std::vector<Photo> photos, const TrainOptions& options) {
  const Result<PhotoSplit> split = splitPhotos(capture.views, options.testPeriod);
  if (!split) return split.error();
  TrainingSet set;
  set.trainingViews = split->training;
  for (const uint32_t i : split->training) set.training.push_back(std::move(photos[i]));
  for (const uint32_t i : split->test) {
    set.testNames.push_back(capture.views[i].view.name);
    set.testing.push_back(std::move(photos[i]));
  }
  set.matchedPoints = replaceFewPoints(capture, set.trainingViews, set.training, options.seed);
  set.frame = findSceneFrame(capture);
  for (std::vector<Photo>* part : {&set.training, &set.testing}) {
    for (Photo& photo : *part) {
      photo.view = normalised(photo.view, set.frame);
      if (!photo.view.nearRatio) photo.view.nearRatio = options.nearRatio;
    }
  }
  return set;
}

Result<TrainingSet> prepareTraining(Capture& capture, const TrainOptions& options, const Progress& progress) {
  if (const Result<PhotoSplit> split = splitPhotos(capture.views, options.testPeriod); !split) return split.error();
  Result<std::vector<Photo>> photos = readPhotos(capture.views, options.photos, progress);
  if (!photos) return photos.error();
  return makeTrainingSet(capture, std::move(*photos), options);
}

Result<TrainResult> trainScene(const Capture& capture, const TrainingSet& set, const TrainOptions& given,
                               const MakeExecutor& makeExecutor, const Progress& progress) {
  TrainOptions options = given;
  if (options.refined != nullptr) {
    options.schedule.isRefinement = true;
    options.schedule.startCells = options.refined->cellCount;
    options.detailCount = options.refined->detailCount;
    options.lobeCount = options.refined->lobeCount;
  }
  if (options.schedule.startCells == 0) options.schedule.startCells = std::max(options.schedule.mostCells / 4, 1u);
  if (options.schedule.startCells > options.schedule.mostCells) {
    return makeError(ErrorKind::kUsage,
                     "training: begins with %u cells, but may have %u; allow more, or begin with fewer",
                     options.schedule.startCells, options.schedule.mostCells);
  }
  const std::string settings = settingsText(options, set);
  LoopOptions loop;
  loop.schedule = options.schedule;
  loop.seed = options.seed;
  loop.photoCount = static_cast<uint32_t>(set.training.size());
  Result<FoamStorage<float>> foam = FoamStorage<float>{};
  if (options.isResumed) {
    Result<TrainingState> state = resumeState(options, settings);
    if (!state) return state.error();
    loop.firstStep = state->stepsDone;
    foam = std::move(state->foam);
  } else {
    foam = makeStart(capture, set, options);
    if (!foam) return foam.error();
  }
  Result<std::unique_ptr<StepExecutor>> executor = makeExecutor(std::move(*foam), set.training);
  if (!executor) return executor.error();
  Meter meter(**executor, options, set.testing);
  if (Status ran = runSteps(**executor, options, loop, settings, meter, progress); !ran) return ran.error();
  return finishTraining(**executor, set, loop, meter);
}

}  // namespace froth
