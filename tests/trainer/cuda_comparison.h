// The same step on the CPU and on the GPU, and how far apart they end.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/result.h"
#include "trainer/cuda/cuda_step.h"

namespace froth {

struct StepCase {
  TrainingView<float> view;
  PixelSettings<float> settings;
  AdamStep<float> adam;  // with pointers to host memory
  float overlapWeight = 0, leastSkin = 1e-3f;
};

// A gradient image with some structure, that depends on the pixel alone: rounding of what is shown leaves it.
std::vector<glm::vec4> plainGradients(uint32_t width, uint32_t height);
std::vector<glm::vec4> plainWanted(size_t pixelCount);

// Differences of one array, relative to the root of the mean square of the CPU's.
struct Difference {
  double rootMeanSquare = 0;
  double scale = 0;       // the root of the mean square of the CPU's
  double partFarOff = 0;  // of the entries: farther off than a hundredth of their own size and of the RMS together
};

struct StepComparison {
  Difference image;                                   // not relative: values are in 0..1
  std::array<Difference, kParameterCount> gradients;  // by how much the step moved the first moments
  std::array<Difference, kParameterCount> values;     // by how much the step moved them
  // Gradients on the CPU in floats against doubles. Rays that graze a ball, a plane or a face divide by little, so
  // those of small balls far away are mostly rounding, on the GPU as well.
  std::array<Difference, kParameterCount> roundings;
  Difference contributions, errors;
  uint32_t seenOnCpu = 0, seenOnGpu = 0;
  uint32_t shownByOne = 0;  // cells that pixels of one show, and of the other do not; without part in `values`
};

// Takes one step from `foam` on both.
Result<StepComparison> compareStep(const FoamStorage<float>& foam, const StepCase& stepCase);

}  // namespace froth
