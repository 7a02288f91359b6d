// How much space a view's transients have: what it starts with, and how it grows with what frames wanted.
#pragma once

#include <cstdint>

#include "runtime/asset/gpu_asset.h"
#include "shaders/gpu/layout.h"

namespace froth {

// A raster and a walk of two eyes; of a view that fades, each of two cuts.
inline constexpr uint32_t kRecordingsPerFrame = 4;
inline constexpr uint32_t kFadingRecordingsPerFrame = 2 * kRecordingsPerFrame;

struct ViewCapacity {
  // Known before a frame is recorded.
  uint32_t frames = 1;  // in flight
  uint32_t recordings = kRecordingsPerFrame;
  uint32_t chunks = 1;
  uint32_t groups = 1;  // groupsOfCells
  uint32_t tiles = 1;
  uint64_t rays = 0;      // pixels of a view that mapped lenses draw; else 0
  uint64_t hits = 0;      // pixels of a view that keeps hits; else 0
  uint64_t quarters = 0;  // the same, where it keeps what reactive needs
  uint64_t fades = 0;     // pixels of a view that fades; else 0
  // Of visible cells. A frame that wants more is valid without what has no space.
  uint32_t cells = 1;
  uint64_t planes = 1;
  uint64_t details = 1;  // cells times K
  uint32_t pairs = 1;

  friend bool operator==(const ViewCapacity&, const ViewCapacity&) = default;
};

ViewCapacity largest(const ViewCapacity& a, const ViewCapacity& b);

// What a frame wanted of the capacities for visible cells.
struct ViewDemand {
  uint64_t cells = 0, planes = 0, pairs = 0;
};

ViewDemand demandOf(const gpu::Counters& counters);
ViewDemand largest(const ViewDemand& a, const ViewDemand& b);

// Workgroups over a list or along an image.
inline uint32_t groupsOver(uint32_t items, uint32_t perGroup) { return (items + perGroup - 1) / perGroup; }

inline constexpr uint32_t kCellKeyDigits = 4;  // bytes of a cell's sort key

// Bytes that a radix sort has to look at, of the number of a tile or of the one past the last tile.
uint32_t tileDigits(uint32_t tiles);

// FrameBlock::sortRounds of a view that shows so many cells: small groups keep a GPU busy with a short list, of a long
// one each would read the sums of too many others.
uint32_t sortRoundsOf(uint64_t cells);
// The fewest that the histograms of so large a view have room for.
uint32_t fewestSortRounds(const ViewCapacity& capacity);

// Size of the histogram of one digit over a list of up to `keys` (shaders/gpu/histogram.glsl).
uint64_t histogramBytes(uint32_t keys, uint32_t sortRounds);

// [bytes] Where in ViewBuffer::kTallies lies what every recording clears: of a walk only the
// tileLengths, superSums and sizeCounts.
struct TallyLayout {
  uint64_t cellHistograms, pairHistograms;  // one per digit
  uint64_t tileLengths, superSums, sizeCounts, tileSums;
  uint64_t end;
};

TallyLayout layOutTallies(const ViewCapacity& capacity, uint32_t sortRounds);

// Workgroups over the cells of all chunks, each of one chunk (ChunkEntry::firstGroup).
uint32_t groupsOfCells(const GpuAsset& asset);

// Of its table, now and next.
uint32_t tableChunks(const GpuAsset& asset);

// Adds what an asset needs, now and next, for all of its cells or, if it has more, `mostCells` of them to be visible.
void coverAsset(const GpuAsset& asset, uint32_t mostCells, ViewCapacity& capacity);
// Whether the asset can be recorded.
bool coversAsset(const GpuAsset& asset, const ViewCapacity& capacity);
// The same with the chunks that it has next;
bool coversNextChunks(const GpuAsset& asset, const ViewCapacity& capacity);
// and whether those lack nothing then, for all that is known: the room is for all of their cells, or `mostCells`, and
// for as many pairs as follow from `demand`.
bool coversNext(const GpuAsset& asset, uint32_t mostCells, const ViewDemand& demand, const ViewCapacity& capacity);

// What the chunks that the asset has next may want, by what those that are drawn want.
ViewDemand demandOfNext(const GpuAsset& asset, const ViewDemand& demand);

// What a cut costs a view that has room for all of it, for budgets: so much for each of its cells, with what growing
// holds twice, and the rest. Neither goes with what a frame has wanted.
VkDeviceSize bytesPerCell(uint32_t detailCount);
VkDeviceSize bytesWithoutCells(const GpuAsset& asset, const ViewCapacity& capacity);

// Whether all cells of the asset have room, should all be visible.
bool holdsAllCells(const GpuAsset& asset, const ViewCapacity& capacity);

// What a frame takes that wants this of the asset, were there so many detail sites per cell.
ViewCapacity neededBy(const GpuAsset& asset, const ViewDemand& demand, uint32_t detailCount);

// Whether a frame may have to leave cells out, for all that is known: `demand` is of the newest complete frame, all 0
// before there is one. Pairs are not known before.
bool mayLack(const GpuAsset& asset, const ViewDemand& demand, const ViewCapacity& capacity);

// For a lowered budget: `factor` [0..1] of the capacities for visible cells, and no less than a few cells and pairs.
ViewCapacity lessened(const ViewCapacity& capacity, double factor);

// Makes room for frames like the one that wanted this. Ahead of time, so that a camera that moves on overflows nothing.
void coverDemand(const GpuAsset& asset, const ViewDemand& demand, ViewCapacity& capacity);

}  // namespace froth
