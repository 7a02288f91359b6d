// From cell to cell: along a ray, and down to the power cell that holds a point.
#ifndef FROTH_GPU_DESCEND_GLSL
#define FROTH_GPU_DESCEND_GLSL
#include "gpu/asset.glsl"
#include "foam/cell.h"

// The key of a step along a ray: the same bits wherever the same site is stepped to.
float orderAlong(vec3 direction, vec3 centre) {
  precise float key = direction.x * centre.x + direction.y * centre.y + direction.z * centre.z;
  return key;
}

float powerAt(vec3 point, Ball ball) { return powerOfOrigin(ball.centre - point, ball.radius); }

// The power goes with the search into the next chunk, where it may be rounded otherwise: it falls with every step, so the
// search ends. point: relative to the eye. steps: how many it took.
uvec2 descendTo(vec3 point, uvec2 first, out uint steps) {
  uvec2 cell = first;
  Chunk chunk = loadChunk(cell.x);
  float power = powerAt(point, ballOfSite(chunk, cell.y));
  for (steps = 0; steps < FRAME.maxSteps; ++steps) {
    uvec2 row = neighbourRow(chunk, cell.y);
    float least = power;
    uint site = kNoCell;
    for (uint i = row.x; i < row.y; ++i) {
      uint other = neighbourAt(chunk, i);
      float otherPower = powerAt(point, ballOfSite(chunk, other));
      if (otherPower < least) {
        least = otherPower;
        site = other;
      }
    }
    if (site == kNoCell) break;
    cell = cellOfSite(chunk, site);
    if (cell.x != chunk.index) chunk = loadChunk(cell.x);
    power = least;
  }
  return cell;
}

uvec2 cellHolding(vec3 point, uvec2 first) {
  uint steps;
  return descendTo(point, first, steps);
}

#endif
