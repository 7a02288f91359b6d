#include "trainer/loop/train_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "foam/pick_foam.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/loop/cpu_executor.h"
#include "trainer/loop/evaluate.h"
#include "trainer/loop/state_file.h"
#include "trainer/loop/training_loop.h"
#include "trainer/photos/exposure.h"
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
  const std::string length =
      schedule.seconds > 0 ? fmt::format("seconds {}", schedule.seconds) : fmt::format("steps {}", schedule.steps);
  const std::string photosPerStep =
      schedule.photosPerStep > 1 ? fmt::format(" of {} photos", schedule.photosPerStep) : "";
  return fmt::format("{}{}{} cells {} to {} rates {} K {} M {} seed {} photos {} of {} x {} near {}{}",
                     schedule.isRefinement ? "refinement, " : "", length, photosPerStep, schedule.startCells,
                     schedule.mostCells, static_cast<int>(schedule.preset), options.detailCount, options.lobeCount,
                     options.seed, set.training.size(), view.width, view.height, options.nearRatio,
                     options.evensExposure ? " even exposure" : "");
}

Result<FoamStorage<float>> makeStart(const Capture& capture, const TrainingSet& set, const TrainOptions& options) {
  Foam foam;
  if (options.refined != nullptr) {
    foam = normalisedFoam(*options.refined, set.frame);
  } else {
    const StartScene scene{capture, set.frame, set.trainingViews, set.training, options.seed, set.eyes};
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

Status checkSettings(const TrainOptions& options, const TrainingState& state, const std::string& settings) {
  if (state.settings == settings) return {};
  return makeError(ErrorKind::kUsage, "%s: of a run with other settings (%s; now %s); give the same, or begin anew",
                   options.state.c_str(), state.settings.c_str(), settings.c_str());
}

Status saveState(StepExecutor& executor, const TrainOptions& options, const std::string& settings, const Pace& pace) {
  TrainingState state;
  state.seconds = pace.seconds();
  state.settings = settings;
  state.photosPerStep = pace.schedule().photosPerStep;
  if (Status read = executor.read(state.foam); !read) return read;
  if (Status written = writeState(options.state, state); !written) return written;
  return executor.beginAnew();
}

// The PSNR of each test photo; tells how far the run is.
Result<std::vector<double>> measure(StepExecutor& executor, const TrainOptions& options,
                                    const std::vector<Photo>& tests, Pace& pace, DriftTables& drifts) {
  if (const Result<uint64_t> waited = executor.droppedCount(); !waited) return waited.error();
  pace.pause();
  const uint32_t done = pace.stepsDone();
  const AdamStep<float> adam = drifts.adamAt(done);
  Result<std::vector<double>> psnrs = photoPsnrs(executor, tests, tests.size(), adam);
  if (psnrs && options.whenMeasured) {
    const auto showTest = [&](size_t test, std::vector<glm::vec4>& image) {
      return executor.show(tests[test].view, adam, image);
    };
    const Status told =
        options.whenMeasured({done, pace.schedule().photosPerStep, pace.positionAt(done), pace.seconds().back(),
                              executor.cellCount(), meanPsnr(*psnrs), *psnrs, showTest});
    if (!told) return told.error();
  }
  pace.goOn();
  return psnrs;
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

// In the scene's units, as it stands after the steps that are done.
Result<Foam> readFoam(StepExecutor& executor, const SceneFrame& frame, const Pace& pace, DriftTables& drifts) {
  FoamStorage<float> foam;
  if (Status read = executor.read(foam); !read) return read.error();
  catchUpAll(foam, pace.stepsDone(), drifts);
  return sceneFoam(withoutVanished(activateFoam(foam)), frame);
}

Status showFoam(StepExecutor& executor, const TrainOptions& options, const SceneFrame& frame, Pace& pace,
                DriftTables& drifts) {
  pace.pause();
  const Result<Foam> foam = readFoam(executor, frame, pace, drifts);
  if (!foam) return foam.error();
  const Status shown = options.whenShown(*foam);
  pace.goOn();
  return shown;
}

bool isMeasured(const TrainOptions& options, const Pace& pace) {
  const uint32_t done = pace.stepsDone();
  if (options.measureEvery != 0 && done % options.measureEvery == 0) return true;
  // A multiple of a position such as 3 / 20 rounds to a little less than a whole number.
  const auto timesAt = [&](uint32_t step) { return std::floor(options.measureTimes * pace.positionAt(step) + 1e-9); };
  return timesAt(done) > timesAt(done - 1);
}

// Runs the steps that are left; measures, shows and saves on the way, and saves when it is stopped.
Status runSteps(StepExecutor& executor, const TrainOptions& options, const TrainingSet& set, Pace& pace,
                const LoopOptions& loop, const std::string& settings, const Progress& progress) {
  const auto afterStep = [&](uint32_t done, DriftTables& drifts) -> Status {
    if (pace.isOver()) return {};
    if (isMeasured(options, pace)) {
      const auto measured = measure(executor, options, set.testing, pace, drifts);
      if (!measured) return measured.error();
    }
    if (options.showEvery != 0 && done % options.showEvery == 0) {
      if (Status shown = showFoam(executor, options, set.frame, pace, drifts); !shown) return shown;
    }
    if (options.state.empty() || done % options.saveEvery != 0) return {};
    pace.pause();
    const Status saved = saveState(executor, options, settings, pace);
    pace.goOn();
    return saved;
  };
  const Status ran = runLoop(executor, pace, loop, afterStep, progress);
  const bool wasStopped = !ran && ran.error().kind == ErrorKind::kCancelled;
  if (options.state.empty() || !(ran || wasStopped)) return ran;
  if (Status saved = saveState(executor, options, settings, pace); !saved) return saved;
  if (!wasStopped) return ran;
  return makeError(ErrorKind::kCancelled, "training stopped on request after %u steps; %s goes on with --resume",
                   pace.stepsDone(), options.state.c_str());
}

Result<TrainResult> finishTraining(StepExecutor& executor, const TrainOptions& options, const TrainingSet& set,
                                   Pace& pace) {
  // Not before: what a run saves and shows on the way are the values that its next steps go on from.
  if (Status taken = executor.takeMeans(); !taken) return taken.error();
  DriftTables drifts(pace, set.eyes);
  Result<std::vector<double>> psnrs = measure(executor, options, set.testing, pace, drifts);
  if (!psnrs) return psnrs.error();
  const size_t count = std::min(set.testing.size(), set.training.size());
  const Result<std::vector<double>> trained =
      photoPsnrs(executor, set.training, count, drifts.adamAt(pace.stepsDone()));
  if (!trained) return trained.error();
  Result<Foam> foam = readFoam(executor, set.frame, pace, drifts);
  if (!foam) return foam.error();
  const Result<uint64_t> dropped = executor.droppedCount();
  if (!dropped) return dropped.error();
  TrainResult result;
  result.testPsnrs = std::move(*psnrs);
  result.trainedPsnr = meanPsnr(*trained);
  result.foam = std::move(*foam);
  result.droppedCount = *dropped;
  result.stepsDone = pace.stepsDone();
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
  set.eyes = findEyes(capture, set.frame);
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
  if (options.evensExposure) {
    if (Status even = evenExposures(capture, *photos); !even) return even.error();
  }
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
  Result<TrainingState> state = TrainingState{};
  if (options.isResumed) {
    state = readState(options.state);
    if (!state) return state.error();
    options.photosPerStep = state->photosPerStep;
  }
  options.schedule = spreadSchedule(options.schedule, options.photosPerStep);
  const std::string settings = settingsText(options, set);
  if (options.isResumed) {
    if (Status same = checkSettings(options, *state, settings); !same) return same.error();
  } else {
    Result<FoamStorage<float>> start = makeStart(capture, set, options);
    if (!start) return start.error();
    state->foam = std::move(*start);
  }
  Result<std::unique_ptr<StepExecutor>> executor = makeExecutor(std::move(state->foam), set.training);
  if (!executor) return executor.error();
  Pace pace(options.schedule, options.clock, std::move(state->seconds));
  const uint32_t firstStep = pace.stepsDone();
  const LoopOptions loop{options.seed, static_cast<uint32_t>(set.training.size()), set.eyes};
  const Status ran = runSteps(**executor, options, set, pace, loop, settings, progress);
  if (!ran) return ran.error();
  Result<TrainResult> result = finishTraining(**executor, options, set, pace);
  if (result) result->firstStep = firstStep;
  return result;
}

}  // namespace froth
