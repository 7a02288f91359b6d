// Adam by the mean of what several views ask. Nothing here depends on the order of threads: GPUs that have the same
// foam and the same views end with the same bits. Bound: bytes, as update_cells.cu, and for each view 44 per cell and
// 24 per detail site of those it shows.
#include "trainer/cuda/lobe_lanes.h"
#include "trainer/cuda/passes.h"

namespace froth {
namespace {

__device__ bool isVoid(const KeptViews& kept) {
  bool isAny = false;
  for (uint32_t i = 0; i < kept.count; ++i) isAny |= kept.headers[i]->isVoid != 0;
  return isAny;
}

// As updateDetailByViews() does with the lobes, of all detail sites of a round. prepared: the cell from the origin.
__device__ void updateLobesByViews(const TrainedCell<float>& trained, const SeenCell<float>& prepared,
                                   const LobeRound& round, const KeptViews& kept, uint32_t& bad) {
  LaneNumbers axes(trained, Parameter::kLobeAxes, round, true), colours(trained, Parameter::kLobeColours, round, true);
  axes.catchUp();
  colours.catchUp();
  const glm::vec3 axis = numbersOfLobe(round, axes.values()), colour = numbersOfLobe(round, colours.values());
  SeenDetail<float> detail{};
  if (round.hasDetail) detail = placeDetail(trained, prepared, round.detail);
  LobeGradient<float> mean;
  for (uint32_t i = 0; i < kept.count; ++i) {
    const ViewGradients<float>& view = kept.gradients[i];
    if (!isShown(view.cells[trained.cell].sums)) continue;
    SeenCell<float> seen = prepared;
    seen.centre -= view.eye;
    LobeSeeds<float> seeds{directionOfDetail(seen, detail.place), {}, {}};
    const float share = shareOfLobe(round, foam::lobeExponent(axis, seeds.direction));
    const glm::vec3 blend = sumOfLanes(round.hasLobe ? share * colour : glm::vec3(0), round.lanes);
    if (!round.hasLobe) continue;
    seeds.blend = foam::lobeColour(glm::vec3(0), 1.0f, blend) - 0.5f;
    seeds.seed = view.details[size_t{trained.cell} * trained.foam.shape.detailCount + round.detail].colour;
    const LobeGradient<float> gradient = differentiateLobe(axis, colour, share, seeds);
    mean.axis += gradient.axis / float(kept.count);
    mean.colour += gradient.colour / float(kept.count);
  }
  __syncwarp();
  axes.update(round, numbersOfLane(round, mean.axis), bad);
  colours.update(round, numbersOfLane(round, mean.colour), bad);
}

__global__ __launch_bounds__(kBlock, kMinBlocks) void updateShownByViewsKernel(StepArrays arrays, AdamStep<float> adam,
                                                                               const __grid_constant__ KeptViews kept,
                                                                               bool countsBad) {
  __shared__ float stages[kBlock / kWarp][kStageNumbers];
  const uint32_t cell = globalThread() / kWarp;
  const FoamShape& shape = arrays.foam.shape;
  if (cell >= shape.cellCount || isVoid(kept)) return;
  const CellSums<float> mean = meanOfCell(kept.gradients, kept.count, cell);
  if (!isShown(mean)) return;
  const TrainedCell<float> trained(arrays.foam, adam, cell);
  SeenCell<float> prepared;
  prepareCell(trained, glm::vec3(0), prepared);
  uint32_t bad = 0;
  for (uint32_t first = 0; first < shape.detailCount; first += LobeRound::detailsAtATime(shape)) {
    const LobeRound round(shape, first, stages[threadIdx.x / kWarp]);
    updateLobesByViews(trained, prepared, round, kept, bad);
    if (round.isFirst) {
      updatePlace(trained, round.detail, meanOfDetail(kept.gradients, kept.count, shape, cell, round.detail), bad);
    }
    __syncwarp();
  }
  if (laneOfWarp() == 0) updateShownCell(trained, mean, bad);
  if (countsBad) countBad(arrays, bad);
}

__global__ void updateBallsByViewsKernel(StepArrays arrays, AdamStep<float> adam,
                                         const __grid_constant__ KeptViews kept, bool countsBad) {
  const uint32_t cell = globalThread();
  if (cell >= arrays.foam.shape.cellCount || isVoid(kept)) return;
  uint32_t bad = 0;
  updateBallByViews(arrays.foam, adam, kept.gradients, kept.count, cell, bad);
  if (countsBad) countBad(arrays, bad);
}

}  // namespace

Status updateShownByViews(const StepArrays& arrays, const AdamStep<float>& adam, const KeptViews& kept, bool countsBad,
                          cudaStream_t stream) {
  const size_t threads = size_t{arrays.foam.shape.cellCount} * kWarp;
  updateShownByViewsKernel<<<blocksFor(threads), kBlock, 0, stream>>>(arrays, adam, kept, countsBad);
  return checkLaunch("updateShownByViews");
}

Status updateBallsByViews(const StepArrays& arrays, const AdamStep<float>& adam, const KeptViews& kept, bool countsBad,
                          cudaStream_t stream) {
  const size_t threads = arrays.foam.shape.cellCount;
  updateBallsByViewsKernel<<<blocksFor(threads), kBlock, 0, stream>>>(arrays, adam, kept, countsBad);
  return checkLaunch("updateBallsByViews");
}

}  // namespace froth
