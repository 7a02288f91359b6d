// The cones around the rays of a mapped lens: of sub-tiles, tiles and blocks of tiles.
#ifndef FROTH_GPU_PIXEL_CONES_GLSL
#define FROTH_GPU_PIXEL_CONES_GLSL
#include "gpu/frame.glsl"
#include "foam/cones.h"
#include "foam/rays.h"

uint tileIndex(uvec2 tile) { return tile.y * FRAME.tilesX + tile.x; }

uint tileConeAt(uint tile) { return kSubTilesPerTile * FRAME.tilesX * FRAME.tilesY + tile; }

uint blockConeAt(uint block) { return (kSubTilesPerTile + 1) * FRAME.tilesX * FRAME.tilesY + block; }

// Sub-tiles of a tile lie row by row.
uint subTileConeAt(uvec2 firstPixel) {
  uvec2 place = firstPixel % kTileSize / kSubTileSize;
  return tileIndex(firstPixel / kTileSize) * kSubTilesPerTile + place.y * (kTileSize / kSubTileSize) + place.x;
}

// radius: guarded.
bool blockMeetsBall(uint block, vec3 centre, float radius) {
  return coneMeetsBall(FRAME.cones.v[blockConeAt(block)], centre, radius);
}

bool anyBlockMeetsBall(vec3 centre, float radius) {
  for (uint block = 0; block < FRAME.blocksX * FRAME.blocksY; ++block) {
    if (blockMeetsBall(block, centre, radius)) return true;
  }
  return false;
}

// size: kSubTileSize, kTileSize, or more: the whole region.
bool conesMeetBall(vec3 centre, float exactRadius, uvec2 firstPixel, uint size) {
  float radius = guardedRadius(centre, exactRadius);
  if (size > kTileSize) return anyBlockMeetsBall(centre, radius);
  uint place = size == kTileSize ? tileConeAt(tileIndex(firstPixel / kTileSize)) : subTileConeAt(firstPixel);
  return coneMeetsBall(FRAME.cones.v[place], centre, radius);
}

#endif
