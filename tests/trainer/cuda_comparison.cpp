#include "tests/trainer/cuda_comparison.h"

#include <algorithm>
#include <cmath>

#include "trainer/cpu/cpu_step.h"

namespace froth {
namespace {

// `start`: what both began with; empty: 0. `unit`: of differences; 0: the RMS of the CPU's.
Difference compare(const std::vector<float>& cpu, const std::vector<float>& gpu, const std::vector<float>& start,
                   double unit) {
  double squares = 0, differences = 0;
  for (size_t i = 0; i < cpu.size(); ++i) {
    const double expected = double{cpu[i]} - (start.empty() ? 0 : start[i]), off = double{gpu[i]} - cpu[i];
    squares += expected * expected;
    differences += off * off;
  }
  const double count = static_cast<double>(std::max<size_t>(cpu.size(), 1)), rms = std::sqrt(squares / count);
  Difference difference;
  difference.scale = rms;
  difference.rootMeanSquare = std::sqrt(differences / count) / (unit > 0 ? unit : std::max(rms, 1e-30));
  for (size_t i = 0; i < cpu.size(); ++i) {
    const double expected = double{cpu[i]} - (start.empty() ? 0 : start[i]);
    const bool isNear = std::abs(double{gpu[i]} - cpu[i]) <= 0.01 * (std::abs(expected) + rms);
    difference.partFarOff += isNear ? 0 : 1 / count;
  }
  return difference;
}

std::vector<float> numbersOf(const std::vector<glm::vec4>& pixels) {
  const float* first = &pixels[0].x;
  return {first, first + 4 * pixels.size()};
}

// Adam's step with its tables in other numbers, which `tables` keep; without tables no cell waits.
template <class Real>
AdamStep<Real> convertAdam(const AdamStep<float>& adam, std::array<std::vector<Real>, kParameterCount>& tables) {
  AdamStep<Real> converted{};
  converted.step = adam.step;
  converted.epsilon = adam.epsilon;
  converted.eyes = adam.eyes;
  for (size_t i = 0; i < kParameterCount; ++i) {
    converted.rates[i] = adam.rates[i];
    if (adam.drifts[i] != nullptr) tables[i].assign(adam.drifts[i], adam.drifts[i] + adam.step);
    converted.drifts[i] = tables[i].data();
  }
  return converted;
}

Status runOnGpu(FoamStorage<float>& foam, const StepCase& stepCase, const std::vector<glm::vec4>& gradients,
                const std::vector<glm::vec4>& wanted, std::vector<glm::vec4>& rendered, uint32_t& seenCount) {
  CudaStep step;
  if (Status started = step.start(); !started) return started;
  if (Status given = step.upload(foam); !given) return given;
  std::array<std::vector<float>, kParameterCount> tables;
  std::array<DeviceArray<float>, kParameterCount> sent;
  AdamStep<float> adam = convertAdam(stepCase.adam, tables);
  for (size_t i = 0; i < kParameterCount; ++i) {
    if (Status uploaded = sent[i].upload(tables[i], "drifts", step.stream()); !uploaded) return uploaded;
    adam.drifts[i] = sent[i].data();
  }
  for (bool isDone = false; !isDone;) {
    if (Status ran = step.activate(stepCase.leastSkin); !ran) return ran;
    if (Status ran = step.render(stepCase.view, stepCase.settings, adam); !ran) return ran;
    if (Status ran = step.uploadLoss(gradients, wanted); !ran) return ran;
    if (Status ran = step.differentiate(); !ran) return ran;
    if (Status ran = step.update(adam, stepCase.overlapWeight); !ran) return ran;
    const Result<bool> fits = step.settle();
    if (!fits) return fits.error();
    isDone = *fits;
  }
  seenCount = step.counters().seenCells;
  if (Status read = step.downloadImage(rendered); !read) return read;
  return step.download(foam);
}

// Cells that pixels of one show alone, which wait on the other; their values there become those of the CPU.
uint32_t alignCells(const FoamStorage<float>& cpu, FoamStorage<float>& gpu) {
  uint32_t count = 0;
  for (uint32_t cell = 0; cell < cpu.shape.cellCount; ++cell) {
    if (cpu.lastSteps[cell] == gpu.lastSteps[cell]) continue;
    ++count;
    for (size_t i = 0; i < kParameterCount; ++i) {
      const size_t width = widthOf(static_cast<Parameter>(i), cpu.shape);
      std::copy_n(cpu.values[i].begin() + static_cast<std::ptrdiff_t>(cell * width), width,
                  gpu.values[i].begin() + static_cast<std::ptrdiff_t>(cell * width));
    }
  }
  return count;
}

template <class To, class From>
std::vector<To> convert(const std::vector<From>& from) {
  return {from.begin(), from.end()};
}

// The first moments after the step in doubles, from the same numbers.
std::array<std::vector<float>, kParameterCount> differentiateInDouble(const FoamStorage<float>& foam,
                                                                      const StepCase& stepCase,
                                                                      const std::vector<glm::vec4>& gradients,
                                                                      const std::vector<glm::vec4>& wanted) {
  FoamStorage<double> storage;
  resizeStorage(storage, foam.shape);
  for (size_t i = 0; i < kParameterCount; ++i) {
    storage.values[i] = convert<double>(foam.values[i]);
    storage.firstMoments[i] = convert<double>(foam.firstMoments[i]);
    storage.secondMoments[i] = convert<double>(foam.secondMoments[i]);
  }
  storage.lastSteps = foam.lastSteps;
  const TrainingView<float>& view = stepCase.view;
  const TrainingView<double> wideView{view.width,     view.height,    view.fx,        view.fy,
                                      view.cx,        view.cy,        view.eye,       view.worldFromCamera,
                                      view.nearRatio, view.nearDepth, view.directions};
  const PixelSettings<float>& settings = stepCase.settings;
  std::array<std::vector<double>, kParameterCount> tables;
  const AdamStep<double> adam = convertAdam<double>(stepCase.adam, tables);
  CpuStep<double> step(storage);
  step.activate(stepCase.leastSkin);
  (void)step.render(wideView, {settings.sharpness, settings.cutoff, settings.normalWeight, settings.perPixel}, adam);
  step.differentiate(convert<glm::dvec4>(gradients), convert<glm::dvec4>(wanted));
  step.update(adam, stepCase.overlapWeight);
  std::array<std::vector<float>, kParameterCount> found;
  for (size_t i = 0; i < kParameterCount; ++i) found[i] = convert<float>(storage.firstMoments[i]);
  return found;
}

}  // namespace

std::vector<glm::vec4> plainGradients(uint32_t width, uint32_t height) {
  std::vector<glm::vec4> gradients(size_t{width} * height);
  for (size_t i = 0; i < gradients.size(); ++i) {
    const float x = static_cast<float>(i % width) / static_cast<float>(width);
    const float y = static_cast<float>(i / width) / static_cast<float>(height);
    gradients[i] = glm::vec4(std::sin(7 * x + 1), std::cos(9 * y), std::sin(8 * (x - y)), std::cos(6 * (x + y))) /
                   static_cast<float>(gradients.size());
  }
  return gradients;
}

std::vector<glm::vec4> plainWanted(size_t pixelCount) { return std::vector<glm::vec4>(pixelCount, {0.4, 0.5, 0.6, 1}); }

Result<StepComparison> compareStep(const FoamStorage<float>& foam, const StepCase& stepCase) {
  FoamStorage<float> onCpu = foam, onGpu = foam;
  const std::vector<glm::vec4> gradients = plainGradients(stepCase.view.width, stepCase.view.height);
  const std::vector<glm::vec4> wanted = plainWanted(gradients.size());
  StepComparison comparison;
  std::vector<glm::vec4> shown;
  if (Status ran = runOnGpu(onGpu, stepCase, gradients, wanted, shown, comparison.seenOnGpu); !ran) return ran.error();
  CpuStep<float> step(onCpu);
  step.activate(stepCase.leastSkin);
  const std::vector<glm::vec4> expected = step.render(stepCase.view, stepCase.settings, stepCase.adam);
  step.differentiate(gradients, wanted);
  step.update(stepCase.adam, stepCase.overlapWeight);
  comparison.seenOnCpu = step.seen().count;
  comparison.shownByOne = alignCells(onCpu, onGpu);
  comparison.image = compare(numbersOf(expected), numbersOf(shown), {}, 1);
  const auto inDouble = differentiateInDouble(foam, stepCase, gradients, wanted);
  for (size_t i = 0; i < kParameterCount; ++i) {
    comparison.roundings[i] = compare(inDouble[i], onCpu.firstMoments[i], foam.firstMoments[i], 0);
    comparison.gradients[i] = compare(onCpu.firstMoments[i], onGpu.firstMoments[i], foam.firstMoments[i], 0);
    comparison.values[i] = compare(onCpu.values[i], onGpu.values[i], foam.values[i], 0);
  }
  comparison.contributions = compare(onCpu.contributions, onGpu.contributions, foam.contributions, 0);
  comparison.errors = compare(onCpu.errors, onGpu.errors, foam.errors, 0);
  return comparison;
}

}  // namespace froth
