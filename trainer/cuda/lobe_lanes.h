// How a warp takes the lobes of a cell: some detail sites at a time, as many as have a lane for each lobe. The rows of
// a cell follow each other in memory, so lanes read and write their numbers side by side, lane i the numbers i, i + 32
// and i + 64 of the round; shared memory hands the three of a lobe to its lane, and back.
#pragma once

#include "trainer/cuda/launch.h"
#include "trainer/step/trained_cell.h"

namespace froth {

inline constexpr uint32_t kStageNumbers = 3 * kWarp;
// Per multiprocessor, of the kernels that update lobes: 80 registers a thread in place of 100 to 121 keep more warps.
inline constexpr uint32_t kMinBlocks = 3;

// What one lane has of the detail sites from `firstDetail` on. All lanes of a warp go through the same rounds.
struct LobeRound {
  uint32_t lanes;   // neighbouring ones that share a detail site: the power of two from M on
  uint32_t detail;  // of this lane's lobe; K or more: none
  bool hasDetail, hasLobe;
  bool isFirst;           // of the lanes of a detail site that there is
  uint32_t lobe;          // the lane's, counted from the first of the round
  uint32_t begin, count;  // numbers of the round in the rows of axes and colours
  float* stage;           // [kStageNumbers] shared memory of the warp

  __device__ LobeRound(const FoamShape& shape, uint32_t firstDetail, float* warpStage) : stage(warpStage) {
    const uint32_t lobeCount = shape.lobeCount;
    lanes = lanesOf(lobeCount);
    detail = firstDetail + laneOfWarp() / lanes;
    hasDetail = detail < shape.detailCount;
    hasLobe = hasDetail && laneOfWarp() % lanes < lobeCount;
    isFirst = hasDetail && laneOfWarp() % lanes == 0;
    lobe = hasLobe ? laneOfWarp() / lanes * lobeCount + laneOfWarp() % lanes : 0;
    begin = 3 * firstDetail * lobeCount;
    count = 3 * min(detailsAtATime(shape), shape.detailCount - firstDetail) * lobeCount;
  }

  __device__ static uint32_t lanesOf(uint32_t lobeCount) { return 1u << (32 - __clz(static_cast<int>(lobeCount - 1))); }
  __device__ static uint32_t detailsAtATime(const FoamShape& shape) { return kWarp / lanesOf(shape.lobeCount); }
};

// From the numbers of a lane to those of its lobe; lanes without one get those of lobe 0.
__device__ inline glm::vec3 numbersOfLobe(const LobeRound& round, const glm::vec3& ofLane) {
  for (uint32_t j = 0; j < 3; ++j) round.stage[laneOfWarp() + j * kWarp] = ofLane[j];
  __syncwarp();
  const float* own = round.stage + 3 * round.lobe;
  const glm::vec3 ofLobe(own[0], own[1], own[2]);
  __syncwarp();
  return ofLobe;
}

// The other way. Numbers behind round.count have no meaning.
__device__ inline glm::vec3 numbersOfLane(const LobeRound& round, const glm::vec3& ofLobe) {
  if (round.hasLobe) {
    for (uint32_t c = 0; c < 3; ++c) round.stage[3 * round.lobe + c] = ofLobe[c];
  }
  __syncwarp();
  const float* own = round.stage + laneOfWarp();
  const glm::vec3 ofLane(own[0], own[kWarp], own[2 * kWarp]);
  __syncwarp();
  return ofLane;
}

// The numbers of a lane, of one parameter.
struct LaneNumbers {
  ParameterPart<float> part;
  TrainedValue<float> trained[3];  // as stored, until catchUp()

  // All loads come before what is made of them, so that they overlap.
  __device__ LaneNumbers(const TrainedCell<float>& cell, Parameter parameter, const LobeRound& round, bool hasMoments)
      : part(cell.part(parameter, round.begin)), trained{} {
    for (uint32_t j = 0; j < 3; ++j) {
      const uint32_t i = laneOfWarp() + j * kWarp;
      if (i < round.count) trained[j] = hasMoments ? part.stored(i) : TrainedValue<float>{part.values[i], 0, 0};
    }
  }
  __device__ void catchUp() {
    for (TrainedValue<float>& number : trained) number = part.catchUp(number);
  }
  __device__ glm::vec3 values() const { return {trained[0].value, trained[1].value, trained[2].value}; }
  __device__ void update(const LobeRound& round, const glm::vec3& gradient, uint32_t& bad) const {
    for (uint32_t j = 0; j < 3; ++j) {
      const uint32_t i = laneOfWarp() + j * kWarp;
      if (i < round.count) bad += !part.update(i, trained[j], gradient[j]);
    }
  }
};

// The part of the lane's lobe in the colour of its detail site: as foam::addLobe() weighs them.
__device__ inline float shareOfLobe(const LobeRound& round, float exponent) {
  const float largest = largestOfLanes(round.hasLobe ? exponent : -1e30f, round.lanes);
  const float weight = round.hasLobe ? expf(exponent - largest) : 0;
  const float sum = sumOfLanes(weight, round.lanes);
  return round.hasLobe ? weight / sum : 0;
}

}  // namespace froth
