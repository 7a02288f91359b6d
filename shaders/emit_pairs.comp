// Writes the (tile, visible cell) pairs in the order of the cells, and plans their sort. The pairs of one cell come in any
// order. Cells whose pairs do not all find space have none, and so have all cells behind them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/histogram.glsl"
#include "gpu/tiles.glsl"

layout(local_size_x = kGroupSize) in;

shared uint places[kTileCellsPerGroup];  // [cell] where its next pair goes
shared uint lostPlace;                   // of the first pair that finds no space

// Pairs of the cells before the workgroup's.
uint pairsBefore(uint firstVisible) {
  uint thread = gl_LocalInvocationIndex;
  uint ownSum = firstVisible / kCellsPerTileSum;
  uint sum = 0;
  for (uint i = thread; i < ownSum; i += kGroupSize) sum = saturatingAdd(sum, FRAME.tileSums.v[i]);
  for (uint i = ownSum * kCellsPerTileSum + thread; i < firstVisible; i += kGroupSize) {
    sum = saturatingAdd(sum, FRAME.tileCounts.v[i]);
  }
  return sumOfThreads(uvec2(sum, 0)).x;
}

// By the workgroup that loses the first pair, or else by the last one.
void planPairs(uint kept) {
  COUNTERS.pairsKept = kept;
  COUNTERS.pairSortDispatch = dispatchOf(groupsOver(kept, kSortKeysPerGroup));
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint group = linearGroup();
  uint firstVisible = group * kTileCellsPerGroup;
  if (firstVisible >= COUNTERS.visibleCells) return;
  bool isLast = firstVisible + kTileCellsPerGroup >= COUNTERS.visibleCells;
  uint visible = firstVisible + thread;
  bool isCell = thread < kTileCellsPerGroup && visible < COUNTERS.visibleCells;
  if (thread == 0) lostPlace = 0xffffffffu;

  uint count = isCell ? FRAME.tileCounts.v[visible] : 0;
  uint before = pairsBefore(firstVisible);
  uint total;
  uint place = saturatingAdd(before, scanExclusive(count, total));
  bool fits = saturatingAdd(place, count) <= FRAME.pairCapacity;
  if (isCell) places[thread] = place;
  if (!fits) atomicMin(lostPlace, place);
  uint slot = isCell ? FRAME.order.v[visible] : 0;
  uint candidates = gatherCandidates(isCell && fits && count > 0, slot);

  UintArray histogram = FRAME.pairHistogram;
  for (uint i = thread; i < candidates; i += kGroupSize) {
    TileCandidate candidate = candidateAt(i);
    if (!meetsTile(candidate)) continue;
    uint pair = checked(atomicAdd(places[candidate.cell], 1u), FRAME.pairCapacity);
    uint tile = candidate.tile.y * FRAME.tilesX + candidate.tile.x;
    FRAME.pairTiles.v[pair] = tile;
    FRAME.pairCells.v[pair] = firstVisible + candidate.cell;
    countDigit(histogram, pair, digitOf(tile, 0));
  }

  if (thread != 0) return;
  uint end = saturatingAdd(before, total);
  if (isLast) COUNTERS.pairs = end;
  bool losesFirst = before <= FRAME.pairCapacity && end > FRAME.pairCapacity;
  if (losesFirst) planPairs(lostPlace);
  else if (isLast && end <= FRAME.pairCapacity) planPairs(end);
}
