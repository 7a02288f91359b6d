// The least distance at which a ray of a tile can meet the ball of a visible cell: there walks begin, for before it they
// gain nothing. As the complement of the bits of a float, so that 0 says that the tile meets no ball.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/tiles.glsl"
#include "gpu/view_rays.glsl"
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

// What is left of a distance less its rounding.
const float kKeptOfDistance = 1.0 - 1e-5;

// The ball of a cell and not its solid ball: what a ray meets in a cell depends on where it enters the ball. None of a
// cell that only guides walks.
uint takeWalkedCell(uint slot) {
  uvec4 cell = FRAME.visibleCells.v[checked(slot, FRAME.visibleCapacity)];
  Chunk chunk = loadChunk(cell.x);
  return cell.y < chunk.liveCount ? takeBall(ballOfSite(chunk, cell.y)) : 0;
}

float distanceTo(vec4 ball) { return distanceToBall(ball.xyz, guardedRadius(ball.xyz, ball.w)) * kKeptOfDistance; }

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint slot = linearGroup() * kTileCellsPerGroup + thread;
  bool isCell = thread < kTileCellsPerGroup && slot < COUNTERS.visibleCells;
  uint candidates;
  startCandidates(scanExclusive(isCell ? takeWalkedCell(slot) : 0, candidates));
  for (uint i = thread; i < candidates; i += kGroupSize) {
    TileCandidate candidate = candidateAt(i);
    if (!meetsTile(candidate)) continue;
    atomicMax(FRAME.tileLengths.v[tileIndex(candidate.tile)], ~floatBitsToUint(distanceTo(balls[candidate.cell])));
  }
}
