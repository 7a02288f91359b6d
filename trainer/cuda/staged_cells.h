// The cells that a warp takes, one after the other. What makes up a cell lies in three places of device memory, and
// rays would wait for each. So the next cell is on its way to shared memory while the warp is at one.
#pragma once

#include <cuda_pipeline.h>

#include "trainer/cuda/warp_pixels.h"

namespace froth {

// Planes of a cell: as many as there is room for in shared memory, and the rest where it is.
struct StagedPlanes {
  const SeenPlane<float>* staged;
  uint32_t stagedCount;
  const SeenPlane<float>* all;

  __device__ const SeenPlane<float>& operator[](uint32_t i) const { return i < stagedCount ? staged[i] : all[i]; }
};

template <class Visit>
__device__ void visitPlanes(const StagedPlanes& planes, uint32_t count, const Visit& visit) {
  const uint32_t staged = min(count, planes.stagedCount);
  for (uint32_t i = 0; i < staged; ++i) visit(i, planes.staged[i]);
  for (uint32_t i = staged; i < count; ++i) visit(i, planes.all[i]);
}

// A cell as a warp fetches it, 16 bytes by each lane: the cell, its details and its first planes; then further planes.
// Details of a number that the compiler does not know (0) stay where they are.
template <uint32_t kDetails>
struct StagedCell {
  static constexpr uint32_t kFirstDetail = sizeof(SeenCell<float>) / 16;
  static constexpr uint32_t kFirstPlane = kFirstDetail + sizeof(SeenDetail<float>) * kDetails / 16;
  static constexpr uint32_t kPlanes = 2 * kWarp - kFirstPlane;
  static_assert(sizeof(SeenPlane<float>) == 16 && sizeof(SeenDetail<float>) * kDetails % 16 == 0);

  uint4 pieces[2 * kWarp];
};

// One that has come.
struct CellAtHand {
  uint32_t place, rank;
  const SeenCell<float>& cell;
  StagedPlanes planes;
  const SeenDetail<float>* details;
};

// Of a tile's list.
struct alignas(16) StagedEntry {
  uint32_t place, rank;             // in the list, of the cell
  uint32_t planesBegin, planesEnd;  // SeenCell
};

// Shared memory of a warp.
template <uint32_t kDetails>
struct CellStage {
  StagedEntry entries[kWarp];
  StagedCell<kDetails> cells[2];  // that at hand, and the next
};

// All lanes call it. Of 32 entries from `first` on: those that matter, in their order or the reverse of it; returns how
// many there are.
template <bool kIsReverse, uint32_t kDetails, class Matters>
__device__ uint32_t stageEntries(const StepArrays& arrays, uint32_t first, uint32_t end, CellStage<kDetails>& stage,
                                 const Matters& matters) {
  StagedEntry own{first + laneOfWarp(), 0, 0, 0};
  bool isStaged = false;
  if (own.place < end) {
    own.rank = arrays.sortedRanks[own.place];
    const SeenCell<float>& cell = arrays.seen.cells[own.rank];
    isStaged = matters(cell);
    if (isStaged) {
      own.planesBegin = cell.planesBegin;
      own.planesEnd = cell.planesEnd;
    }
  }
  const uint32_t staged = __ballot_sync(kAllLanes, isStaged);
  const uint32_t count = __popc(staged), before = __popc(staged & lanesBefore());
  if (isStaged) stage.entries[kIsReverse ? count - 1 - before : before] = own;
  __syncwarp();
  return count;
}

// What a lane fetches of a cell: from where, by the rank of the cell or the place of its first plane.
struct CellLane {
  const char* base;
  uint32_t stride;
  bool isPlane;

  template <uint32_t kDetails>
  __device__ static CellLane of(const SeenCells<float>& seen) {
    using Staged = StagedCell<kDetails>;
    const uint32_t lane = laneOfWarp();
    if (lane < Staged::kFirstDetail) {
      return {reinterpret_cast<const char*>(seen.cells) + 16 * lane, sizeof(SeenCell<float>), false};
    }
    if (lane < Staged::kFirstPlane) {
      return {reinterpret_cast<const char*>(seen.details) + 16 * (lane - Staged::kFirstDetail),
              sizeof(SeenDetail<float>) * kDetails, false};
    }
    return {reinterpret_cast<const char*>(seen.planes) + 16 * (lane - Staged::kFirstPlane), 16, true};
  }
};

// All lanes.
template <uint32_t kDetails>
__device__ void fetchCell(const SeenCells<float>& seen, const CellLane& own, const StagedEntry& entry,
                          StagedCell<kDetails>& to) {
  using Staged = StagedCell<kDetails>;
  const uint32_t lane = laneOfWarp(), planeCount = entry.planesEnd - entry.planesBegin;
  if (!own.isPlane || lane - Staged::kFirstPlane < planeCount) {
    const char* from = own.base + size_t{own.isPlane ? entry.planesBegin : entry.rank} * own.stride;
    __pipeline_memcpy_async(to.pieces + lane, from, 16);
  }
  const uint32_t further = kWarp - Staged::kFirstPlane + lane;
  if (further < planeCount) {
    __pipeline_memcpy_async(to.pieces + kWarp + lane, seen.planes + entry.planesBegin + further, 16);
  }
}

template <uint32_t kDetails>
__device__ CellAtHand cellAtHand(const SeenCells<float>& seen, const StagedEntry& entry, uint32_t detailCount,
                                 const StagedCell<kDetails>& staged) {
  using Staged = StagedCell<kDetails>;
  const auto* details = reinterpret_cast<const SeenDetail<float>*>(staged.pieces + Staged::kFirstDetail);
  const auto* planes = reinterpret_cast<const SeenPlane<float>*>(staged.pieces + Staged::kFirstPlane);
  return {entry.place,
          entry.rank,
          reinterpret_cast<const SeenCell<float>&>(staged.pieces[0]),
          {planes, Staged::kPlanes, seen.planes + entry.planesBegin},
          kDetails > 0 ? details : seen.details + size_t{entry.rank} * detailCount};
}

// All lanes call it. visit(cell): for each of the first `count` entries of the stage, until it returns false.
template <uint32_t kDetails, class Visit>
__device__ void visitCells(const SeenCells<float>& seen, const CellLane& lane, uint32_t count, uint32_t detailCount,
                           CellStage<kDetails>& stage, const Visit& visit) {
  if (count > 0) fetchCell(seen, lane, stage.entries[0], stage.cells[0]);
  __pipeline_commit();
  for (uint32_t i = 0; i < count; ++i) {
    if (i + 1 < count) fetchCell(seen, lane, stage.entries[i + 1], stage.cells[(i + 1) % 2]);
    __pipeline_commit();
    __pipeline_wait_prior(1);
    __syncwarp();
    if (!visit(cellAtHand(seen, stage.entries[i], detailCount, stage.cells[i % 2]))) break;
    __syncwarp();
  }
  __pipeline_wait_prior(0);
  __syncwarp();
}

}  // namespace froth
