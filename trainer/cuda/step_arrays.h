// What the kernels of a step read and write: pointers to device memory, passed to them by value. CudaStep owns it all.
#pragma once

#include <cstdint>

#include "trainer/step/gradient_sums.h"
#include "trainer/step/pixels.h"
#include "trainer/step/seen_cells.h"
#include "trainer/step/tiles.h"
#include "trainer/step/trained_foam.h"

namespace froth {

// Counted on the GPU; the host reads them late, and never waits for them within a step.
struct StepCounters {
  uint32_t seenCells = 0;       // ranks
  uint32_t tileEntries = 0;     // of all tiles; more than fit: the step changes nothing, and is taken again
  uint32_t droppedCount = 0;    // contributions that were no finite numbers, of all steps
  uint32_t cellsOutOfSkin = 0;  // not 0: the pairs may lack some of the next step's
};

// Two's complement, in steps of 2^-30 of what one pixel weighs (PixelSettings::perPixel).
using FixedNumber = unsigned long long;

// Where rays add up in place of GradientSums if two runs are to give the same bits (fixed_sums.h); null: they are not.
struct FixedSums {
  FixedNumber *cells, *details, *pairs;  // all 0 between views
  size_t cellNumbers, detailNumbers, pairNumbers;
};

struct StepArrays {
  TrainedFoam<float> foam;
  NeighbourRows pairs;
  glm::vec4* foundBalls;  // [cells] when the pairs were found
  float* slacks;          // [cells] by how much they may change since (trainer/step/skin.h)
  SeenCells<float> seen;  // `count` is unused: StepCounters::seenCells
  uint32_t* pairOfPlane;  // [SeenCells::planes] its place in GradientSums::pairs
  GradientSums<float> sums;
  FixedSums fixedSums;
  PixelArrays<float> pixels;
  StepCounters* counters;

  // By cell, before the sort and after it (then by rank).
  uint32_t *powerKeys, *sortedKeys;  // of the eye's power; kUnseenKey: not seen
  uint32_t *cells, *sortedCells;
  uint32_t* tileCounts;    // [cells] tiles that see the cell
  uint32_t* planesBegin;   // [cells] by rank, in SeenCells::planes
  uint32_t* entriesBegin;  // [cells] by rank, in the list of entries

  // The lists of tiles: an entry is a tile and the rank of a cell that it sees.
  glm::vec4* tileCones;                                           // [tiles]
  glm::vec4* groupCones;                                          // [groups of tiles] (ball_tiles.h)
  uint32_t* tilesBegin;                                           // [tiles + 1] in sortedRanks
  uint32_t *entryTiles, *sortedTiles, *entryRanks, *sortedRanks;  // [entryCapacity]
  uint32_t entryCapacity;
  uint32_t *tileLengths, *sortedTileLengths, *tiles;  // [tiles]
  uint32_t* tileOrder;                                // [tiles] in which tiles are drawn
  uint32_t* metEntries;  // [metEntriesOf()] by 32 entries and warp of a tile: bits of those that some ray met
};

inline constexpr uint32_t kUnseenKey = UINT32_MAX;

inline constexpr uint32_t kWarpsPerTile = kTileSize * kTileSize / 32;

// Each tile begins a new word of 32 entries, so it has one more than its part of all.
FROTH_HD size_t metEntriesOf(size_t entries, size_t tiles) { return (entries / 32 + tiles + 1) * kWarpsPerTile; }

}  // namespace froth
