// Draws 8 x 8 pixels of the tiles in which the instance is alone. Long tiles are drawn by a form with one pixel per
// thread, which is done with a list sooner though it costs more. Tiles that several instances share are drawn by
// raster_ordered.comp and raster_merged.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/device_depth.glsl"
#include "gpu/draw_cell.glsl"
#include "gpu/hits.glsl"
#include "gpu/outputs.glsl"

layout(local_size_x = kSubTileSize, local_size_y = kRows) in;

const uint kSubTilesAlong = kTileSize / kSubTileSize;

// The tile of this workgroup, and its place in the order; false: there is none.
bool findTile(out uint tile, out uint place) {
  place = linearGroup() / kSubTilesPerTile;
  bool isLong = kRays == 1;
  if (!isLong) place += COUNTERS.longTiles;
  if (place >= (isLong ? COUNTERS.longTiles : FRAME.tilesX * FRAME.tilesY)) return false;
  tile = FRAME.tileLists.v[place].x;
  return true;
}

void main() {
  uint tile, place;
  if (!findTile(tile, place)) return;
  uint subTile = linearGroup() % kSubTilesPerTile;
  uvec2 corner = uvec2(tile % FRAME.tilesX, tile / FRAME.tilesX) * kTileSize +
                 uvec2(subTile % kSubTilesAlong, subTile / kSubTilesAlong) * kSubTileSize;
  if (!isInRegion(corner)) return;
  uvec2 range = FRAME.tileLists.v[place].yz;
  Shading shading = loadShading();
  vec3 rays[kRays];
  float ends[kRays];  // where the scene stops them
  Radiance radiances[kRays];
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = pixelOfThread(corner, r);
    rays[r] = rayOf(pixel);
    ends[r] = isInRegion(pixel) ? sceneDistance(pixel, rays[r]) : 0.0;
    radiances[r] = startOf(pixel, rays[r]);
  }
  drawList(shading, range, corner, rays, ends, radiances);
  for (uint r = 0; r < kRays; ++r) {
    uvec2 pixel = pixelOfThread(corner, r);
    if (!isInRegion(pixel)) continue;
    Radiance radiance = radiances[r];
    if (seesNothing(rays[r])) radiance = emptyRadiance();
    float depth = isFull ? deviceDepthAt(rays[r], radiance.distance) : 0.0;
    float distance = radiance.distance * FRAME.scale;
    writePixel(pixel, radiance.colour, coverageOf(radiance.logTransmittance), FRAME.exposure, distance,
               isFull ? inWorld(radiance.normal) : vec3(0.0), depth);
    if (isFull && wantsHits()) writeHit(pixel, distance, FRAME.part, cellCodeOf(radiance.cell));
    if (keepsQuarters && wantsQuarters()) {
      writeQuarters(pixel, radiance.quarters * FRAME.scale, uvec4(FRAME.part));
    }
  }
}
