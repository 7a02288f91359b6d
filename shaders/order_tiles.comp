// Finds where the list of each tile begins, cuts those beyond maxEntries behind their nearest cells, and orders the
// tiles by the length of their lists, longest first, in classes of a factor two: the last workgroups of the raster are
// then short ones, and no long list is left to be read alone. Lists so long that they would end last all the same are
// given to more threads. One workgroup. The order within a class is open; no image depends on it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "gpu/workgroup.glsl"

layout(local_size_x = kGroupSize) in;

const uint kClasses = 33;

shared uint places[kClasses];  // where the next tile of a class goes
shared uint longest;           // list, before it is cut
shared uint drawn;             // entries of all lists, once they are cut

// 0: the longest; the last one: nothing.
uint classOf(uint length) { return length == 0 ? kClasses - 1 : 31 - findMSB(length); }

// Counts become places. Tiles of a class before that of `longLength` are long ones, unless the frame asks for one form
// alone.
void placeClasses(uint longLength) {
  uint place = 0;
  for (uint i = 0; i < kClasses; ++i) {
    uint count = places[i];
    places[i] = place;
    place += count;
    if (i < classOf(longLength)) COUNTERS.longTiles = place;
  }
  if ((FRAME.flags & kFlagShortTiles) != 0) COUNTERS.longTiles = 0;
  if ((FRAME.flags & kFlagLongTiles) != 0) COUNTERS.longTiles = place;
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint tiles = FRAME.tilesX * FRAME.tilesY;
  if (thread < kClasses) places[thread] = 0;
  if (thread == 0) longest = drawn = 0;
  barrier();
  for (uint tile = thread; tile < tiles; tile += kGroupSize) {
    uint length = FRAME.tileLengths.v[tile];
    uint kept = min(length, FRAME.maxEntries);
    atomicAdd(places[classOf(kept)], 1u);
    atomicAdd(drawn, kept);
    atomicMax(longest, length);
  }
  barrier();
  if (thread == 0) placeClasses(max(drawn / kTilesAtOnce, 1u));
  barrier();
  uint begin = 0;
  for (uint first = 0; first < tiles; first += kGroupSize) {
    uint tile = first + thread;
    uint length = tile < tiles ? FRAME.tileLengths.v[tile] : 0;
    uint total;
    uint before = begin + scanExclusive(length, total);
    if (tile < tiles) {
      uint kept = min(length, FRAME.maxEntries);
      uint place = atomicAdd(places[classOf(kept)], 1u);
      FRAME.tileLists.v[place] = uvec4(tile, before, before + kept, 0u);
      FRAME.tileLengths.v[tile] = place;
    }
    begin += total;
  }
  if (thread != 0) return;
  COUNTERS.longestList = longest;
  COUNTERS.isCut = longest > FRAME.maxEntries ? 1 : 0;
  COUNTERS.longTileDispatch = dispatchOf(kSubTilesPerTile * COUNTERS.longTiles);
  COUNTERS.tileDrawDispatch = dispatchOf(kSubTilesPerTile * (tiles - COUNTERS.longTiles));
}
