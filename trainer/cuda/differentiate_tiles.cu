// From the image's gradients back to the cells: each warp goes through its tile's list back to front, from where its
// rays ended, and finds the segments again of what some of them met. Bound: flops, about three times those of
// renderTiles; 4 K + 7 shared writes and 2 reads per ray and value are a tenth of that.
#include "trainer/cuda/gradient_columns.h"
#include "trainer/cuda/passes.h"
#include "trainer/cuda/staged_cells.h"

namespace froth {
namespace {

constexpr uint32_t kThreads = kTileSize * kTileSize;
constexpr uint32_t kBlocksAtATime = 10;  // of a multiprocessor: as many as its shared memory has room for

// What one ray adds for one cell that it meets; moves the adjoint to before the cell.
__device__ void differentiateCell(const CellAtHand& at, uint32_t detailCount, const glm::vec3& direction,
                                  const PixelSettings<float>& settings, const Segment<float>& segment,
                                  PixelAdjoint<float>& adjoint, SegmentGradient<float>& gradient,
                                  GradientColumn& column, uint32_t* droppedCount) {
  float weight;
  const SegmentSeeds<float> seeds = seedSegment(at.cell, segment, settings, adjoint, weight);
  const glm::vec3 miss = glm::abs(segment.colour - glm::vec3(adjoint.wanted));
  const bool isGood = differentiateSegment(at.cell, at.planes, at.details, detailCount, direction, settings.sharpness,
                                           segment, seeds, gradient, column);
  if (!isGood) {
    gradient = {};
    column.clear(rowCountOf(detailCount));
    atomicAdd(droppedCount, 1u);
  }
  gradient.cell.contribution = weight * settings.perPixel;
  gradient.cell.error = weight * adjoint.wanted.w * (miss.x + miss.y + miss.z) * settings.perPixel;
  column.setCell(gradient.cell);
}

template <uint32_t kDetails, class Number>
__global__ __launch_bounds__(kThreads, kBlocksAtATime) void differentiateTilesKernel(StepArrays arrays,
                                                                                     TrainingView<float> view,
                                                                                     PixelSettings<float> settings) {
  extern __shared__ float sharedRows[];
  __shared__ CellStage<kDetails> stages[kWarpsPerTile];
  if (isVoid(arrays)) return;
  const uint32_t detailCount = kDetails > 0 ? kDetails : arrays.foam.shape.detailCount;
  CellStage<kDetails>& stage = stages[threadIdx.x / kWarp];
  const CellLane lane = CellLane::of<kDetails>(arrays.seen);
  const SumTarget<Number> sums = targetOfSums<Number>(arrays, settings);
  const uint32_t rowCount = rowCountOf(detailCount);
  float* rows = sharedRows + threadIdx.x / kWarp * rowCount * kColumns;
  const WarpPixel own = pixelOfThread(arrays, view);
  PixelAdjoint<float> adjoint{};
  uint32_t end = 0;
  if (own.isInside) {
    adjoint = beginAdjoint(arrays.pixels, own.pixel);
    end = own.listBegin + arrays.pixels.ends[own.pixel];
  }
  const uint32_t last = __reduce_max_sync(kAllLanes, end);
  if (last <= own.listBegin) return;
  for (uint32_t batch = (last - own.listBegin + kWarp - 1) / kWarp; batch-- > 0;) {
    const uint32_t first = own.listBegin + batch * kWarp;
    const uint32_t met = own.metEntries[size_t{batch} * kWarpsPerTile];
    const uint32_t count = stageEntries<true>(arrays, first, last, stage,
                                              [&](const SeenCell<float>&) { return (met >> laneOfWarp() & 1) != 0; });
    visitCells(arrays.seen, lane, count, detailCount, stage, [&](const CellAtHand& at) {
      Segment<float> segment;
      const bool isHit = at.place < end && meetCell(at.cell, at.planes, at.details, detailCount, own.direction,
                                                    settings.sharpness, segment);
      const uint32_t hits = __ballot_sync(kAllLanes, isHit);
      if (hits == 0) return true;
      SegmentGradient<float> gradient;
      if (isHit) {
        GradientColumn column{rows + __popc(hits & lanesBefore())};
        differentiateCell(at, detailCount, own.direction, settings, segment, adjoint, gradient, column,
                          &arrays.counters->droppedCount);
      }
      __syncwarp();
      addColumns(rows, __popc(hits), rowCount, detailCount, sums, at.rank);
      for (int side = 0; side < 2; ++side) {
        addPairs(gradient.planes[side], gradient.pairs[side], arrays.pairOfPlane + at.cell.planesBegin, sums);
      }
      return true;
    });
  }
}

template <class Number>
Status differentiateInto(const StepArrays& arrays, const TrainingView<float>& view,
                         const PixelSettings<float>& settings, cudaStream_t stream) {
  const uint32_t tileCount = tilesAlong(view.width) * tilesAlong(view.height);
  const size_t bytes = sizeof(float) * kWarpsPerTile * rowCountOf(arrays.foam.shape.detailCount) * kColumns;
  return withDetailCount(arrays.foam.shape.detailCount, [&]<uint32_t kDetails>() -> Status {
    const auto kernel = differentiateTilesKernel<kDetails, Number>;
    const Status allowed =
        checkCuda(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(bytes)),
                  "shared memory of differentiateTiles");
    if (!allowed) return allowed;
    kernel<<<tileCount, kThreads, bytes, stream>>>(arrays, view, settings);
    return checkLaunch("differentiateTiles");
  });
}

}  // namespace

Status differentiateTiles(const StepArrays& arrays, const TrainingView<float>& view,
                          const PixelSettings<float>& settings, cudaStream_t stream) {
  if (arrays.fixedSums.cells == nullptr) return differentiateInto<float>(arrays, view, settings, stream);
  const Status added = differentiateInto<FixedNumber>(arrays, view, settings, stream);
  return added ? takeFixedSums(arrays, settings.perPixel, stream) : added;
}

}  // namespace froth
