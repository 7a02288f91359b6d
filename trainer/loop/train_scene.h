// From a capture to a trained foam: all that `froth train` does.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "trainer/loop/pace.h"
#include "trainer/loop/step_executor.h"
#include "trainer/photos/photos.h"
#include "trainer/start/scene_frame.h"

namespace froth {

// How far a run is.
struct TrainingMoment {
  uint32_t stepsDone = 0;
  uint32_t photosPerStep = 1;
  double position = 0;  // [0..1] in its schedule; 1: at the end
  double seconds = 0;   // of its steps; reading, saving and measuring do not count
  uint32_t cells = 0;
  double psnr = 0;                // [dB] mean of the test photos; 0 without any
  std::vector<double> testPsnrs;  // [dB] by TrainingSet::testing
  // What the foam shows in the view of a test photo: colour over black, transmittance. For `whenMeasured` alone.
  std::function<Status(size_t test, std::vector<glm::vec4>& image)> showTest;
};
using WhenMeasured = std::function<Status(const TrainingMoment&)>;

struct TrainOptions {
  // In steps of one photo. startCells 0: a quarter of mostCells; of a refinement: as many as the foam has.
  Schedule schedule;
  // [1..kMostPhotosPerStep] spreadSchedule(). A run that goes on keeps its own.
  uint32_t photosPerStep = 1;
  uint32_t detailCount = 8;  // K [1..32]
  uint32_t lobeCount = 8;    // M [1..32]
  uint64_t seed = 1;
  uint32_t testPeriod = 8;  // every so many-th photo tests; 0: none, unless the capture says
  PhotoOptions photos;
  bool evensExposure = false;   // trainer/photos/exposure.h; of test photos too
  double nearRatio = 4;         // docs/FOAM.md "Near cells"; cells so near to a camera are not seen by it
  std::filesystem::path state;  // where the state is saved; empty: nowhere
  uint32_t saveEvery = 1000;    // [steps, >= 1]
  bool isResumed = false;       // go on from `state`
  uint32_t measureEvery = 0;    // [steps] between two calls of `whenMeasured`; 0: none on the way
  uint32_t measureTimes = 0;    // and so many calls, at equal shares of the schedule
  WhenMeasured whenMeasured;
  uint32_t showEvery = 0;                        // [steps] between two calls of `whenShown`; 0: never
  std::function<Status(const Foam&)> whenShown;  // gets the foam as it stands, in the scene's units
  // Goes on from this foam, in the scene's units, in place of a start; K and M are its own, and the schedule is one of
  // a refinement. It outlives the run.
  const Foam* refined = nullptr;
  SecondsClock clock = steadySeconds;
};

// What training works on.
struct TrainingSet {
  SceneFrame frame;                      // of the normalised scene
  Eyes eyes;                             // of the capture, in it
  std::vector<Photo> training, testing;  // views in the normalised scene
  std::vector<uint32_t> trainingViews;   // [training] of which view of the capture it is
  std::vector<std::string> testNames;
  uint32_t matchedPoints = 0;  // found in the photos, for the capture had few
};

struct TrainResult {
  Foam foam;                      // in the scene's units
  std::vector<double> testPsnrs;  // by TrainingSet::testing
  double trainedPsnr = 0;         // [dB] mean of as many photos that trained; 0 without test photos
  uint64_t droppedCount = 0;      // contributions that were no finite numbers
  uint32_t firstStep = 0;         // > 0: a run that went on
  uint32_t stepsDone = 0;
};

// Makes the executor of a run: the CPU's, or a GPU's.
using MakeExecutor = std::function<Result<std::unique_ptr<StepExecutor>>(FoamStorage<float>, std::vector<Photo>)>;
Result<std::unique_ptr<StepExecutor>> makeCpuExecutor(FoamStorage<float> foam, std::vector<Photo> photos);

// Splits photos, which are in the order of the capture's views, and normalises their views. A capture of few points
// gets those that are found in its training photos (trainer/start/match_points.h).
Result<TrainingSet> makeTrainingSet(Capture& capture, std::vector<Photo> photos, const TrainOptions& options);

// Reads photos and makes a set of them.
Result<TrainingSet> prepareTraining(Capture& capture, const TrainOptions& options, const Progress& progress);

// Trains, saves the state every saveEvery steps and when `progress` asks to stop, and measures the test photos.
Result<TrainResult> trainScene(const Capture& capture, const TrainingSet& set, const TrainOptions& options,
                               const MakeExecutor& makeExecutor, const Progress& progress = {});

}  // namespace froth
