// The passes of a step, one file each: they put kernels into the stream, and return whether that went well.
#pragma once

#include <cuda_runtime_api.h>

#include "base/result.h"
#include "trainer/cuda/device_array.h"
#include "trainer/cuda/kept_views.h"
#include "trainer/cuda/step_arrays.h"
#include "trainer/step/adam.h"
#include "trainer/step/cell_change.h"
#include "trainer/step/pixel_passes.h"
#include "trainer/step/training_view.h"

namespace froth {

// What CUB's sorts and sums need besides their arrays; grows as they ask.
using Scratch = DeviceArray<unsigned char>;

// hasPairs: whether StepArrays::pairs are of these cells, so that their slacks count.
Status activateCells(const StepArrays& arrays, bool hasPairs, cudaStream_t stream);

// What pairs are found with, and where they go. Blocks are of 32 cells.
struct PairLists {
  glm::vec4* enlarged;                        // [cells] balls with their skins
  glm::vec3* boxes;                           // [blocks * 2] around the blocks: lower and upper corners
  uint32_t *offsets, *neighbours, *reverses;  // NeighbourRows
};
FROTH_HD uint32_t blocksOfCells(size_t cells) { return static_cast<uint32_t>((cells + 31) / 32); }
// Writes the offsets; then the others have their sizes. leastSkin: skinOf().
Status countPairs(const StepArrays& arrays, const PairLists& lists, float leastSkin, Scratch& scratch,
                  cudaStream_t stream);
Status listPairs(const StepArrays& arrays, const PairLists& lists, cudaStream_t stream);
// overlaps: [cells] countOverlaps(), by the pairs that were listed last.
Status countCellOverlaps(const StepArrays& arrays, uint32_t* overlaps, cudaStream_t stream);

// Which cells the view sees, and in how many tiles.
Status cullCells(const StepArrays& arrays, const TrainingView<float>& view, cudaStream_t stream);
// Ranks, and where each rank's planes and entries begin.
Status rankCells(const StepArrays& arrays, Scratch& scratch, cudaStream_t stream);
// Cells and planes, then details, as seen from the eye; their sums become 0. Parameters are those before the step
// `adam`.
Status prepareCells(const StepArrays& arrays, const TrainingView<float>& view, const AdamStep<float>& adam,
                    cudaStream_t stream);
Status prepareDetails(const StepArrays& arrays, const AdamStep<float>& adam, cudaStream_t stream);
Status binTiles(const StepArrays& arrays, const TrainingView<float>& view, Scratch& scratch, cudaStream_t stream);
Status renderTiles(const StepArrays& arrays, const TrainingView<float>& view, const PixelSettings<float>& settings,
                   cudaStream_t stream);
Status differentiateTiles(const StepArrays& arrays, const TrainingView<float>& view,
                          const PixelSettings<float>& settings, cudaStream_t stream);
// StepArrays::fixedSums become `sums`, for differentiateTiles().
Status takeFixedSums(const StepArrays& arrays, float perPixel, cudaStream_t stream);
// Of cells that pixels show, all but their balls.
Status updateShownCells(const StepArrays& arrays, const AdamStep<float>& adam, cudaStream_t stream);
// Of all cells.
Status updateBalls(const StepArrays& arrays, const AdamStep<float>& adam, float overlapWeight, cudaStream_t stream);

// In place of both, in a step of several views: after differentiateTiles() of each, what it asks goes to `kept`.
Status keepGradients(const StepArrays& arrays, const AdamStep<float>& adam, float overlapWeight, const KeptView& kept,
                     cudaStream_t stream);
// Then all take the mean of what was kept, in this order. countsBad: whether StepCounters::droppedCount counts.
Status updateShownByViews(const StepArrays& arrays, const AdamStep<float>& adam, const KeptViews& kept, bool countsBad,
                          cudaStream_t stream);
Status updateBallsByViews(const StepArrays& arrays, const AdamStep<float>& adam, const KeptViews& kept, bool countsBad,
                          cudaStream_t stream);

// A photo in device memory.
struct ImageTarget {
  uint32_t width = 0, height = 0;
  const uint8_t* rgba = nullptr;     // [height * width * 4] premultiplied
  const uint8_t* counted = nullptr;  // [height * width] 0: ignored; null: all count
};

struct LossTerms {
  float perPixel = 0;    // 1 / pixels
  float similarity = 0;  // what dSSIM of a pixel and channel counts: - weight / (3 pixels)
  float sparsity = 0;    // weight / pixels
};

// Writes PixelArrays::gradients and wanted. fields: [9 * pixels], for its own use.
Status differentiateLoss(const PixelArrays<float>& pixels, glm::vec4* wanted, const ImageTarget& target,
                         const LossTerms& terms, float* fields, cudaStream_t stream);

// Counts values of all parameters in their means (foldIntoMean). count: of steps that are in them then.
Status averageValues(const TrainedFoam<float>& foam, const ParameterRows<float>& means, uint32_t count,
                     cudaStream_t stream);

// Row i of `to` becomes row sources[i] of `from`. T: float, uint32_t.
template <class T>
Status gatherRows(const T* from, T* to, const uint32_t* sources, uint32_t cellCount, uint32_t width,
                  cudaStream_t stream);
// changes: [cells] CellPlan::changes, on the cells that were gathered.
Status changeCells(const StepArrays& arrays, const CellChange* changes, cudaStream_t stream);

}  // namespace froth
