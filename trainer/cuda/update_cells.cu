// Sums become gradients, and Adam takes them in the same breath. Bound: bytes. A cell that pixels show, by a warp: per
// detail site of M lobes 144 M + 72 read and written; balls, by 8 lanes each: 100 per cell and 40 per pair.
#include "trainer/cuda/lobe_lanes.h"
#include "trainer/cuda/passes.h"
#include "trainer/step/cell_update.h"

namespace froth {
namespace {

constexpr uint32_t kLanesOfBall = 8;  // most balls have some ten pairs

// Each kernel is two: Adam takes the gradients at once (kKeeps false), or they are kept until all views of the step
// have theirs (trainer/step/view_gradients.h).

// As visitLobes(), of all detail sites of a round: each lane returns what its lobe asks of the direction.
template <bool kKeeps>
__device__ glm::vec3 differentiateLobes(const TrainedCell<float>& trained, const LobeRound& round,
                                        const LobeSeeds<float>& seeds, uint32_t& bad) {
  const bool hasMoments = !kKeeps || !trained.wait.isNone;
  LaneNumbers axes(trained, Parameter::kLobeAxes, round, hasMoments);
  LaneNumbers colours(trained, Parameter::kLobeColours, round, hasMoments);
  axes.catchUp();
  colours.catchUp();
  const glm::vec3 axis = numbersOfLobe(round, axes.values()), colour = numbersOfLobe(round, colours.values());
  const float share = shareOfLobe(round, foam::lobeExponent(axis, seeds.direction));
  LobeGradient<float> gradient;
  if (round.hasLobe) gradient = differentiateLobe(axis, colour, share, seeds);
  if constexpr (!kKeeps) {
    axes.update(round, numbersOfLane(round, gradient.axis), bad);
    colours.update(round, numbersOfLane(round, gradient.colour), bad);
  }
  return gradient.direction;
}

template <bool kKeeps>
__global__ __launch_bounds__(kBlock, kMinBlocks) void updateShownCellsKernel(StepArrays arrays, AdamStep<float> adam,
                                                                             DetailSums<float>* kept) {
  __shared__ float stages[kBlock / kWarp][kStageNumbers];
  const uint32_t rank = globalThread() / kWarp;
  if (rank >= arrays.counters->seenCells || isVoid(arrays) || !isShown(arrays.sums.cells[rank])) return;
  const FoamShape& shape = arrays.foam.shape;
  const SeenCell<float> seen = arrays.seen.cells[rank];
  const TrainedCell<float> trained(arrays.foam, adam, seen.cell);
  CellSums<float> asked;
  uint32_t bad = 0;
  for (uint32_t first = 0; first < shape.detailCount; first += LobeRound::detailsAtATime(shape)) {
    const LobeRound round(shape, first, stages[threadIdx.x / kWarp]);
    const size_t place = size_t{rank} * shape.detailCount + round.detail;
    SeenDetail<float> detail{};
    DetailSums<float> sums;
    if (round.hasDetail) {
      detail = arrays.seen.details[place];
      sums = arrays.sums.details[place];
    }
    const LobeSeeds<float> seeds = seedLobes(seen, detail, sums);
    const glm::vec3 directionSeed = sumOfLanes(differentiateLobes<kKeeps>(trained, round, seeds, bad), round.lanes);
    if (round.isFirst) {
      const DetailSums<float> gradient =
          differentiatePlace(trained, seen, detail, round.detail, sums, seeds, directionSeed, asked);
      if constexpr (kKeeps) {
        kept[size_t{seen.cell} * shape.detailCount + round.detail] = gradient;
      } else {
        updatePlace(trained, round.detail, gradient, bad);
      }
    }
    __syncwarp();
  }
  asked.site = sumOfLanes(asked.site, kWarp);
  asked.radius = sumOfLanes(asked.radius, kWarp);
  asked.torque = sumOfLanes(asked.torque, kWarp);
  if (laneOfWarp() == 0) {
    arrays.sums.cells[rank] += asked;
    if constexpr (!kKeeps) updateShownCell(trained, arrays.sums.cells[rank], bad);
  }
  countBad(arrays, bad);
}

template <bool kKeeps>
__global__ void updateBallsKernel(StepArrays arrays, AdamStep<float> adam, float overlapWeight, KeptView kept) {
  const uint32_t cell = globalThread() / kLanesOfBall, lane = laneOfWarp() % kLanesOfBall;
  if (kKeeps && globalThread() == 0) kept.header->isVoid = isVoid(arrays);
  if (isVoid(arrays)) return;
  const bool isCell = cell < arrays.foam.shape.cellCount;
  glm::vec4 gradient(0);
  if (isCell) {
    overlapWeight = overlapWeightAt(adam.eyes, arrays.foam.balls[cell], overlapWeight);
    for (uint32_t e = arrays.pairs.offsets[cell] + lane; e < arrays.pairs.offsets[cell + 1]; e += kLanesOfBall) {
      gradient += gradientOfPair(arrays.foam, arrays.pairs, arrays.seen, arrays.sums, overlapWeight, cell, e);
    }
  }
  __syncwarp();
  gradient = sumOfLanes(gradient, kLanesOfBall);
  if (!isCell || lane != 0) return;
  const CellSums<float>* sums = sumsOfCell(arrays.seen, arrays.sums, cell);
  gradient = gradientOfOwnSums(sums) + gradient;
  if constexpr (kKeeps) {
    kept.gradients.cells[cell] = keepCell(sums, gradient);
  } else {
    uint32_t bad = 0;
    updateBall(arrays.foam, adam, cell, gradient, bad);
    updateMeans(arrays.foam, cell, sums);
    countBad(arrays, bad);
  }
}

}  // namespace

Status updateShownCells(const StepArrays& arrays, const AdamStep<float>& adam, cudaStream_t stream) {
  const size_t threads = size_t{arrays.foam.shape.cellCount} * kWarp;
  updateShownCellsKernel<false><<<blocksFor(threads), kBlock, 0, stream>>>(arrays, adam, nullptr);
  return checkLaunch("updateShownCells");
}

Status updateBalls(const StepArrays& arrays, const AdamStep<float>& adam, float overlapWeight, cudaStream_t stream) {
  const size_t threads = size_t{arrays.foam.shape.cellCount} * kLanesOfBall;
  updateBallsKernel<false><<<blocksFor(threads), kBlock, 0, stream>>>(arrays, adam, overlapWeight, KeptView{});
  return checkLaunch("updateBalls");
}

Status keepGradients(const StepArrays& arrays, const AdamStep<float>& adam, float overlapWeight, const KeptView& kept,
                     cudaStream_t stream) {
  const size_t cells = arrays.foam.shape.cellCount;
  updateShownCellsKernel<true><<<blocksFor(cells * kWarp), kBlock, 0, stream>>>(arrays, adam, kept.gradients.details);
  updateBallsKernel<true><<<blocksFor(cells * kLanesOfBall), kBlock, 0, stream>>>(arrays, adam, overlapWeight, kept);
  return checkLaunch("keepGradients");
}

}  // namespace froth
