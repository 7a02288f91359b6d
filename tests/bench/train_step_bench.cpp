// froth_bench_train_step FOAM CAMERAS [options]: what a step of training costs on a GPU, by pass, as lines of JSON.
//
// First it takes one step on the CPU and on the GPU, and prints how far apart they end. Then it takes steps in turn
// through the views of CAMERAS, with a rate of 0, so that all rounds do the same work. Cells wait as in training, but
// drift by next to nothing.
#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "foam/checkpoint/checkpoint.h"
#include "tests/bench/bench_calls.h"
#include "tests/trainer/cuda_comparison.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/view_exchange.h"

namespace froth {
namespace {

constexpr uint32_t kMostSteps = 1u << 20;

struct Options {
  std::string foam, cameras;
  int rounds = 10;
  bool comparesFirst = true;
};

StepCase caseOf(const View& view) {
  StepCase stepCase;
  stepCase.view = trainingView<float>(view);
  stepCase.view.nearRatio = 4;
  stepCase.settings.perPixel = 1.0f / (static_cast<float>(view.width) * static_cast<float>(view.height));
  stepCase.settings.normalWeight = 0.1f * stepCase.settings.perPixel;
  stepCase.overlapWeight = 1e-4f;
  std::fill(std::begin(stepCase.adam.rates), std::end(stepCase.adam.rates), 1e-3f);
  return stepCase;
}

void printDifference(const std::string& name, const Difference& difference) {
  fmt::print("{{\"differs\": \"{}\", \"rms\": {:.3g}, \"part_far_off\": {:.3g}}}\n", name, difference.rootMeanSquare,
             difference.partFarOff);
}

void compareWithCpu(const FoamStorage<float>& foam, const View& view) {
  const StepComparison found = take(compareStep(foam, caseOf(view)));
  fmt::print("{{\"seen_on_cpu\": {}, \"seen_on_gpu\": {}}}\n", found.seenOnCpu, found.seenOnGpu);
  printDifference("image", found.image);
  for (size_t i = 0; i < kParameterCount; ++i) {
    printDifference(fmt::format("gradient of {}", kParameterKeys[i]), found.gradients[i]);
    printDifference(fmt::format("gradient of {}, CPU in floats and doubles", kParameterKeys[i]), found.roundings[i]);
    printDifference(fmt::format("step of {}", kParameterKeys[i]), found.values[i]);
  }
  printDifference("contributions", found.contributions);
  printDifference("errors", found.errors);
}

void takeStep(CudaStep& step, const StepCase& stepCase) {
  check(step.activate(stepCase.leastSkin));
  check(step.render(stepCase.view, stepCase.settings, stepCase.adam));
  check(step.differentiate());
  check(step.update(stepCase.adam, stepCase.overlapWeight));
}

void timePasses(const FoamStorage<float>& foam, const std::vector<View>& views, int rounds) {
  CudaStep step;
  check(step.start());
  check(step.upload(foam));
  DeviceArray<float> drifts;  // of all parameters
  check(drifts.upload(std::vector<float>(kMostSteps, 1e-30f), "drifts", step.stream()));
  AdamStep<float> adam{};  // rates of 0
  std::fill(std::begin(adam.drifts), std::end(adam.drifts), drifts.data());
  std::vector<StepCase> cases;
  for (const View& view : views) {
    StepCase stepCase = caseOf(view);
    stepCase.adam = adam;
    do {
      check(step.activate(stepCase.leastSkin));
      check(step.render(stepCase.view, stepCase.settings, stepCase.adam));
      check(step.uploadLoss(plainGradients(view.width, view.height), plainWanted(size_t{view.width} * view.height)));
      takeStep(step, stepCase);
    } while (!take(step.settle()));
    fmt::print("{{\"view\": \"{}\", \"seen\": {}, \"entries\": {}}}\n", view.name, step.counters().seenCells,
               step.counters().tileEntries);
    cases.push_back(stepCase);
  }
  PassClock clock;
  step.setClock(&clock);
  for (int round = 0; round < rounds; ++round) {
    for (StepCase& stepCase : cases) {
      clock.mark(nullptr, step.stream());
      stepCase.adam.step = ++adam.step;
      require(adam.step < kMostSteps, "too many steps; give fewer --rounds");
      takeStep(step, stepCase);
    }
  }
  float sum = 0;
  for (const PassTime& time : clock.times(rounds * static_cast<int>(cases.size()))) {
    fmt::print("{{\"pass\": \"{}\", \"ms\": {:.4f}}}\n", time.name, time.milliseconds);
    sum += time.milliseconds;
  }
  fmt::print("{{\"pass\": \"all\", \"ms\": {:.4f}, \"gpu_megabytes\": {:.1f}}}\n", sum,
             static_cast<double>(step.byteCount()) / 1e6);
}

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  froth::Options options;
  CLI::App app{"What a step of training costs on a GPU, by pass."};
  app.add_option("foam", options.foam, "a model.pt")->required();
  app.add_option("cameras", options.cameras, "a cameras.json")->required();
  app.add_option("--rounds", options.rounds, "steps per view that are timed");
  app.add_flag("--compare,!--no-compare", options.comparesFirst, "take one step on the CPU too");
  CLI11_PARSE(app, argc, argv);
  const froth::FoamStorage<float> foam = froth::storeFoam<float>(froth::take(froth::importCheckpoint(options.foam)));
  const froth::CameraSet cameras = froth::take(froth::readCameras(options.cameras));
  if (options.comparesFirst) froth::compareWithCpu(foam, cameras.views.front());
  froth::timePasses(foam, cameras.views, options.rounds);
  return 0;
}
