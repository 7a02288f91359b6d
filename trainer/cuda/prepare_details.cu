// Detail sites of the seen cells as the eye sees them, by a warp per cell, and zeros for what their rays will add up.
// Bound: bytes, per detail site of M lobes 24 M + 12, of cells that wait three times as many.
#include "trainer/cuda/lobe_lanes.h"
#include "trainer/cuda/passes.h"

namespace froth {
namespace {

__global__ void prepareDetailsKernel(StepArrays arrays, AdamStep<float> adam) {
  __shared__ float stages[kBlock / kWarp][kStageNumbers];
  const uint32_t rank = globalThread() / kWarp;
  if (rank >= arrays.counters->seenCells) return;
  const FoamShape& shape = arrays.foam.shape;
  const SeenCell<float> seen = arrays.seen.cells[rank];
  const TrainedCell<float> trained(arrays.foam, adam, seen.cell);
  for (uint32_t first = 0; first < shape.detailCount; first += LobeRound::detailsAtATime(shape)) {
    const LobeRound round(shape, first, stages[threadIdx.x / kWarp]);
    SeenDetail<float> detail{};
    if (round.hasDetail) detail = placeDetail(trained, seen, round.detail);
    LaneNumbers axes(trained, Parameter::kLobeAxes, round, !trained.wait.isNone);
    LaneNumbers colours(trained, Parameter::kLobeColours, round, !trained.wait.isNone);
    axes.catchUp();
    colours.catchUp();
    const glm::vec3 axis = numbersOfLobe(round, axes.values()), colour = numbersOfLobe(round, colours.values());
    const float share = shareOfLobe(round, foam::lobeExponent(axis, directionOfDetail(seen, detail.place)));
    const glm::vec3 blend = sumOfLanes(round.hasLobe ? share * colour : glm::vec3(0), round.lanes);
    detail.colour = foam::lobeColour(glm::vec3(0), 1.0f, blend);
    if (!round.isFirst) continue;
    const size_t place = size_t{rank} * shape.detailCount + round.detail;
    arrays.seen.details[place] = detail;
    arrays.sums.details[place] = {};
  }
}

}  // namespace

Status prepareDetails(const StepArrays& arrays, const AdamStep<float>& adam, cudaStream_t stream) {
  prepareDetailsKernel<<<blocksFor(size_t{arrays.foam.shape.cellCount} * kWarp), kBlock, 0, stream>>>(arrays, adam);
  return checkLaunch("prepareDetails");
}

}  // namespace froth
