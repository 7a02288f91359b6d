// How many tiles each visible cell's solid ball meets, by slot.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/tiles.glsl"
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

shared uint counts[kTileCellsPerGroup];

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint slot = linearGroup() * kTileCellsPerGroup + thread;
  bool isCell = thread < kTileCellsPerGroup && slot < COUNTERS.visibleCells;
  if (isCell) counts[thread] = 0;
  uint candidates;
  startCandidates(scanExclusive(isCell ? takeCell(slot) : 0, candidates));

  for (uint i = thread; i < candidates; i += kGroupSize) {
    TileCandidate candidate = candidateAt(i);
    if (meetsTile(candidate)) atomicAdd(counts[candidate.cell], 1u);
  }
  barrier();
  if (isCell) FRAME.slotTiles.v[slot] = counts[thread];
}
