// How the gradients of a warp's rays become one sum per value of a cell. A ray that meets the cell writes its numbers
// into a column of shared memory; then each lane adds up rows and adds their sums to global memory: of n rays, n reads
// per row of the shared memory, and one atomic per value, those of a cell next to each other.
#pragma once

#include "trainer/cuda/fixed_sums.h"
#include "trainer/step/gradient_sums.h"
#include "trainer/step/ray_cell_gradient.h"

namespace froth {

inline constexpr uint32_t kCellRows = sizeof(CellSums<float>) / sizeof(float);
inline constexpr uint32_t kDetailRows = sizeof(DetailSums<float>) / sizeof(float);
inline constexpr uint32_t kColumns = kWarp + 1;  // one more than lanes: rows of neighbouring lanes lie in other banks
static_assert(kCellRows == 10 && kDetailRows == 6, "rows are written one by one below");

constexpr uint32_t rowCountOf(uint32_t detailCount) { return kCellRows + kDetailRows * detailCount; }

// A sink of differentiateSegment().
struct GradientColumn {
  float* column;  // of the warp's rows

  __device__ float& at(uint32_t row) { return column[row * kColumns]; }
  __device__ void addColour(uint32_t k, const glm::vec2& place, const glm::vec3& colour) {
    const uint32_t row = kCellRows + kDetailRows * k;
    at(row) = place.x;
    at(row + 1) = place.y;
    at(row + 2) = 0;
    for (int c = 0; c < 3; ++c) at(row + 3 + c) = colour[c];
  }
  __device__ void addHeight(uint32_t k, const glm::vec2& place, float height) {
    const uint32_t row = kCellRows + kDetailRows * k;
    at(row) += place.x;
    at(row + 1) += place.y;
    at(row + 2) = height;
  }
  __device__ void setCell(const CellSums<float>& sums) {
    for (int c = 0; c < 3; ++c) at(c) = sums.site[c];
    at(3) = sums.radius;
    for (int c = 0; c < 3; ++c) at(4 + c) = sums.torque[c];
    at(7) = sums.density;
    at(8) = sums.contribution;
    at(9) = sums.error;
  }
  __device__ void clear(uint32_t rowCount) {
    for (uint32_t row = 0; row < rowCount; ++row) at(row) = 0;
  }
};

// All lanes, between __syncwarp()s.
template <class Number>
__device__ void addColumns(const float* rows, uint32_t columnCount, uint32_t rowCount, uint32_t detailCount,
                           const SumTarget<Number>& sums, uint32_t rank) {
  Number* cell = sums.cells + size_t{rank} * kCellRows;
  Number* details = sums.details + size_t{rank} * detailCount * kDetailRows;
  for (uint32_t row = laneOfWarp(); row < rowCount; row += kWarp) {
    float sum = 0;
#pragma unroll 4
    for (uint32_t column = 0; column < columnCount; ++column) sum += rows[row * kColumns + column];
    addTo(row < kCellRows ? cell + row : details + (row - kCellRows), sum, sums.scale);
  }
}

// The sum over the warp of four values, one in each of lanes 0 to 3: 6 shuffles in place of 20.
__device__ inline float sumQuads(const glm::vec4& quad) {
  const bool isOdd = laneOfWarp() % 2 != 0, isUpper = laneOfWarp() / 2 % 2 != 0;
  const float x = __shfl_xor_sync(kAllLanes, isOdd ? quad.x : quad.y, 1) + (isOdd ? quad.y : quad.x);
  const float z = __shfl_xor_sync(kAllLanes, isOdd ? quad.z : quad.w, 1) + (isOdd ? quad.w : quad.z);
  float sum = __shfl_xor_sync(kAllLanes, isUpper ? x : z, 2) + (isUpper ? z : x);
  for (int distance = 4; distance < 32; distance *= 2) sum += __shfl_xor_sync(kAllLanes, sum, distance);
  return sum;
}

// Adds the sums of a pair once per plane that some lanes' rays end at; other lanes' plane is no place of a plane.
template <class Number>
__device__ void addPairs(uint32_t plane, const glm::vec4& pair, const uint32_t* pairOfPlane,
                         const SumTarget<Number>& sums) {
  uint32_t waiting = __ballot_sync(kAllLanes, plane < kBoundedByEye);
  while (waiting != 0) {
    const uint32_t shared = __shfl_sync(kAllLanes, plane, __ffs(static_cast<int>(waiting)) - 1);
    const bool isShared = plane == shared;
    waiting &= ~__ballot_sync(kAllLanes, isShared);
    const float sum = sumQuads(isShared ? pair : glm::vec4(0));
    Number* pairSum = sums.pairs + size_t{4} * pairOfPlane[shared];
    if (laneOfWarp() < 4) addTo(pairSum + laneOfWarp(), sum, sums.scale);
  }
}

}  // namespace froth
