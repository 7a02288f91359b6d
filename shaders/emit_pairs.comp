// Writes the (tile, slot) pairs in the order of the cells, counts them by tile, and plans their sort. The pairs of one
// cell come in any order. They are as many as count_tiles.comp found: compilers may round the two passes' tests apart,
// so what is more is left out, and for what is less there are pairs of a tile past the last one, whose list no pass
// reads. Cells whose pairs do not all find space have none, and so have all cells behind them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/histogram.glsl"
#include "gpu/tiles.glsl"
#define FROTH_SCANNED uvec3
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

shared uint slots[kTileCellsPerGroup];
shared uint places[kTileCellsPerGroup];  // [cell] where its next pair goes
shared uint ends[kTileCellsPerGroup];    // [cell] behind its last pair
shared uint pairEnd, candidateEnd;       // of the first cell whose pairs lack space: where they would begin

// Pairs of the cells before the workgroup's: this thread's share of the sum.
uint shareOfPairsBefore(uint firstVisible) {
  uint thread = gl_LocalInvocationIndex;
  uint ownSum = firstVisible / kCellsPerTileSum;
  uint sum = 0;
  for (uint i = thread; i < ownSum; i += kGroupSize) sum = saturatingAdd(sum, FRAME.tileSums.v[i]);
  for (uint i = ownSum * kCellsPerTileSum + thread; i < firstVisible; i += kGroupSize) {
    sum = saturatingAdd(sum, FRAME.tileCounts.v[i]);
  }
  return sum;
}

// By the workgroup that loses the first pair, or else by the last one.
void planPairs(uint kept) {
  COUNTERS.pairsKept = kept;
  COUNTERS.pairSortDispatch = dispatchOf(groupsOver(kept, keysPerSortGroup()));
}

void writePair(uint pair, uint tile, uint slot) {
  uint place = checked(pair, FRAME.pairCapacity);
  FRAME.pairTiles.v[place] = tile;
  FRAME.pairCells.v[place] = slot;
  atomicAdd(FRAME.tileLengths.v[tile], 1u);
  UintArray histogram = FRAME.pairHistogram;
  countDigit(histogram, place, digitOf(tile, 0));
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint firstVisible = linearGroup() * kTileCellsPerGroup;
  if (firstVisible >= COUNTERS.visibleCells) return;
  bool isLast = firstVisible + kTileCellsPerGroup >= COUNTERS.visibleCells;
  uint visible = firstVisible + thread;
  bool isCell = thread < kTileCellsPerGroup && visible < COUNTERS.visibleCells;
  if (thread == 0) pairEnd = candidateEnd = 0xffffffffu;

  uint count = isCell ? FRAME.tileCounts.v[visible] : 0;
  uint share = shareOfPairsBefore(firstVisible);
  uint slot = isCell ? FRAME.order.v[visible] : 0;
  uint candidates = count > 0 ? takeCell(slot) : 0;
  uvec3 total;
  uvec3 start = scanExclusive(uvec3(count, candidates, share), total);
  uint place = saturatingAdd(total.z, start.x);
  if (isCell) {
    slots[thread] = slot;
    places[thread] = place;
    ends[thread] = saturatingAdd(place, count);
  }
  if (count > 0 && saturatingAdd(place, count) > FRAME.pairCapacity) {
    atomicMin(pairEnd, place);
    atomicMin(candidateEnd, start.y);
  }
  startCandidates(start.y);

  uint end = min(total.y, candidateEnd);
  for (uint i = thread; i < end; i += kGroupSize) {
    TileCandidate candidate = candidateAt(i);
    if (!meetsTile(candidate)) continue;
    uint pair = atomicAdd(places[candidate.cell], 1u);
    if (pair >= ends[candidate.cell]) continue;
    writePair(pair, candidate.tile.y * FRAME.tilesX + candidate.tile.x, slots[candidate.cell]);
  }
  barrier();
  if (isCell && place < pairEnd) {
    for (uint pair = places[thread]; pair < ends[thread]; ++pair) writePair(pair, FRAME.tilesX * FRAME.tilesY, slot);
  }

  if (thread != 0) return;
  uint wanted = saturatingAdd(total.z, total.x);
  if (isLast) COUNTERS.pairs = wanted;
  if (wanted <= FRAME.pairCapacity ? isLast : total.z <= FRAME.pairCapacity) planPairs(min(wanted, pairEnd));
}
