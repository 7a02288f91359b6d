// The passes of a step, one file each: they put kernels into the stream, and return whether that went well.
#pragma once

#include <cuda_runtime_api.h>

#include "base/result.h"
#include "trainer/cuda/device_array.h"
#include "trainer/cuda/step_arrays.h"
#include "trainer/step/adam.h"
#include "trainer/step/pixel_passes.h"
#include "trainer/step/training_view.h"

namespace froth {

// What CUB's sorts and sums need besides their arrays; grows as they ask.
using Scratch = DeviceArray<unsigned char>;

Status activateCells(const StepArrays& arrays, cudaStream_t stream);
// Which cells the view sees, and in how many tiles.
Status cullCells(const StepArrays& arrays, const TrainingView<float>& view, cudaStream_t stream);
// Ranks, and where each rank's planes and entries begin.
Status rankCells(const StepArrays& arrays, Scratch& scratch, cudaStream_t stream);
Status catchUpCells(const StepArrays& arrays, const AdamStep<float>& adam, cudaStream_t stream);
// Cells, planes and details as seen from the eye; their sums become 0.
Status prepareCells(const StepArrays& arrays, const TrainingView<float>& view, cudaStream_t stream);
Status binTiles(const StepArrays& arrays, const TrainingView<float>& view, Scratch& scratch, cudaStream_t stream);
Status renderTiles(const StepArrays& arrays, const TrainingView<float>& view, const RaySettings<float>& settings,
                   cudaStream_t stream);
Status differentiateTiles(const StepArrays& arrays, const TrainingView<float>& view, const RaySettings<float>& settings,
                          cudaStream_t stream);
Status updateCells(const StepArrays& arrays, const AdamStep<float>& adam, float overlapWeight, cudaStream_t stream);

}  // namespace froth
