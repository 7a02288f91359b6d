// The Cech pairs with a skin (trainer/cpu/skin_pairs.h). Cells lie along a Morton curve, so 32 that follow each other
// are neighbours: a warp tests boxes around 32 cells against its own box, and cells only where boxes meet. Rows come
// ascending and without atomics. Bound: flops, some 10 per pair of boxes and per pair of cells whose boxes meet, twice.
#include <cub/device/device_scan.cuh>

#include "trainer/cuda/cub_call.h"
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"
#include "trainer/step/crowds.h"
#include "trainer/step/skin.h"

namespace froth {
namespace {

__global__ void enlargeBallsKernel(StepArrays arrays, PairLists lists, float leastSkin) {
  const uint32_t cell = globalThread();
  if (cell / kWarp >= blocksOfCells(arrays.foam.shape.cellCount)) return;
  glm::vec3 low(INFINITY), high(-INFINITY);
  if (cell < arrays.foam.shape.cellCount) {
    const glm::vec4 ball = arrays.foam.balls[cell];
    const float skin = skinOf(ball.w, leastSkin);
    // A millionth more, for the rounding of the test below.
    const glm::vec4 enlarged(glm::vec3(ball), (ball.w + skin) * (1 + 1e-6f));
    arrays.foundBalls[cell] = ball;
    arrays.slacks[cell] = slackOf(skin);
    lists.enlarged[cell] = enlarged;
    low = glm::vec3(ball) - enlarged.w;
    high = glm::vec3(ball) + enlarged.w;
  }
  for (int distance = 1; distance < 32; distance *= 2) {
    for (int c = 0; c < 3; ++c) {
      low[c] = fminf(low[c], __shfl_xor_sync(kAllLanes, low[c], distance));
      high[c] = fmaxf(high[c], __shfl_xor_sync(kAllLanes, high[c], distance));
    }
  }
  if (laneOfWarp() == 0) {
    lists.boxes[2 * (cell / kWarp)] = low;
    lists.boxes[2 * (cell / kWarp) + 1] = high;
  }
}

__device__ bool boxesMeet(const glm::vec3* boxes, uint32_t a, uint32_t b) {
  for (int c = 0; c < 3; ++c) {
    if (!(boxes[2 * a][c] < boxes[2 * b + 1][c] && boxes[2 * b][c] < boxes[2 * a + 1][c])) return false;
  }
  return true;
}

// Whether a ball meets the box of a block.
__device__ bool ballMeetsBox(const glm::vec4& ball, const glm::vec3* boxes, uint32_t block) {
  float squared = 0;
  for (int c = 0; c < 3; ++c) {
    const float outside = fmaxf(fmaxf(boxes[2 * block][c] - ball[c], ball[c] - boxes[2 * block + 1][c]), 0.0f);
    squared += outside * outside;
  }
  return squared <= ball.w * ball.w * (1 + 1e-6f);
}

__device__ glm::vec4 ballOfLane(const glm::vec4& own, int lane) {
  glm::vec4 ball;
  for (int c = 0; c < 4; ++c) ball[c] = __shfl_sync(kAllLanes, own[c], lane);
  return ball;
}

// All lanes call it, each for its own cell of block `own`. visit(lane, other, hits): by all lanes, for the cell of each
// lane whose ball meets the box of a block, ascending: each lane's cell `other` of that block, and which lanes' overlap
// it. So a huge ball, which meets all boxes, takes one test per block, and not one per cell.
template <class Visit>
__device__ void visitPairs(const PairLists& lists, uint32_t cellCount, uint32_t own, const Visit& visit) {
  const uint32_t blockCount = blocksOfCells(cellCount), cell = own * kWarp + laneOfWarp();
  const glm::vec4 none(INFINITY, 0, 0, 0);
  const glm::vec4 ball = cell < cellCount ? lists.enlarged[cell] : none;
  for (uint32_t first = 0; first < blockCount; first += kWarp) {
    const uint32_t block = first + laneOfWarp();
    uint32_t meeting = __ballot_sync(kAllLanes, block < blockCount && boxesMeet(lists.boxes, own, block));
    for (; meeting != 0; meeting &= meeting - 1) {
      const uint32_t met = first + __ffs(static_cast<int>(meeting)) - 1, other = met * kWarp + laneOfWarp();
      const glm::vec4 otherBall = other < cellCount ? lists.enlarged[other] : none;
      uint32_t lanes = __ballot_sync(kAllLanes, cell < cellCount && ballMeetsBox(ball, lists.boxes, met));
      for (; lanes != 0; lanes &= lanes - 1) {
        const int lane = __ffs(static_cast<int>(lanes)) - 1;
        const glm::vec4 laneBall = ballOfLane(ball, lane);
        const bool isHit = other < cellCount && other != own * kWarp + lane && ballsOverlap(laneBall, otherBall);
        visit(lane, other, __ballot_sync(kAllLanes, isHit));
      }
    }
  }
}

__global__ void countPairsKernel(PairLists lists, uint32_t cellCount) {
  const uint32_t block = globalThread() / kWarp;
  if (block >= blocksOfCells(cellCount)) return;
  uint32_t count = 0;
  visitPairs(lists, cellCount, block, [&](int lane, uint32_t, uint32_t hits) {
    if (laneOfWarp() == static_cast<uint32_t>(lane)) count += __popc(hits);
  });
  const uint32_t cell = globalThread();
  if (cell < cellCount) lists.offsets[cell] = count;
  if (cell == cellCount - 1) lists.offsets[cellCount] = 0;  // the sum behind the last row
}

__global__ void listPairsKernel(PairLists lists, uint32_t cellCount) {
  const uint32_t block = globalThread() / kWarp, cell = globalThread();
  if (block >= blocksOfCells(cellCount)) return;
  uint32_t place = cell < cellCount ? lists.offsets[cell] : 0;
  visitPairs(lists, cellCount, block, [&](int lane, uint32_t other, uint32_t hits) {
    const uint32_t begin = __shfl_sync(kAllLanes, place, lane);
    if (hits >> laneOfWarp() & 1) lists.neighbours[begin + __popc(hits & lanesBefore())] = other;
    if (laneOfWarp() == static_cast<uint32_t>(lane)) place += __popc(hits);
  });
}

// Where in the other's row the cell stands, by a warp per cell.
__global__ void findReversesKernel(PairLists lists, uint32_t cellCount) {
  const uint32_t cell = globalThread() / kWarp;
  if (cell >= cellCount) return;
  for (uint32_t e = lists.offsets[cell] + laneOfWarp(); e < lists.offsets[cell + 1]; e += kWarp) {
    uint32_t low = lists.offsets[lists.neighbours[e]], high = lists.offsets[lists.neighbours[e] + 1];
    while (low < high) {
      const uint32_t middle = (low + high) / 2;
      if (lists.neighbours[middle] < cell) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    lists.reverses[e] = low;
  }
}

__global__ void countOverlapsKernel(StepArrays arrays, uint32_t* overlaps) {
  const uint32_t cell = globalThread();
  if (cell < arrays.foam.shape.cellCount) overlaps[cell] = countOverlaps(arrays.foam.balls, arrays.pairs, cell);
}

uint32_t smallBlocksFor(size_t cells) { return blocksFor(size_t{blocksOfCells(cells)} * kWarp, kSmallBlock); }

}  // namespace

Status countPairs(const StepArrays& arrays, const PairLists& lists, float leastSkin, Scratch& scratch,
                  cudaStream_t stream) {
  const uint32_t count = arrays.foam.shape.cellCount;
  enlargeBallsKernel<<<smallBlocksFor(count), kSmallBlock, 0, stream>>>(arrays, lists, leastSkin);
  countPairsKernel<<<smallBlocksFor(count), kSmallBlock, 0, stream>>>(lists, count);
  const Status summed = callCub(scratch, "sums over pairs", [&](void* memory, size_t& bytes) {
    return cub::DeviceScan::ExclusiveSum(memory, bytes, lists.offsets, lists.offsets, static_cast<int>(count + 1),
                                         stream);
  });
  return summed ? checkLaunch("countPairs") : summed;
}

Status listPairs(const StepArrays& arrays, const PairLists& lists, cudaStream_t stream) {
  const uint32_t count = arrays.foam.shape.cellCount;
  listPairsKernel<<<smallBlocksFor(count), kSmallBlock, 0, stream>>>(lists, count);
  findReversesKernel<<<blocksFor(size_t{count} * kWarp), kBlock, 0, stream>>>(lists, count);
  return checkLaunch("listPairs");
}

Status countCellOverlaps(const StepArrays& arrays, uint32_t* overlaps, cudaStream_t stream) {
  countOverlapsKernel<<<blocksFor(arrays.foam.shape.cellCount), kBlock, 0, stream>>>(arrays, overlaps);
  return checkLaunch("countCellOverlaps");
}

}  // namespace froth
