// The colour of each detail site of the visible cells, seen from the eye. A thread per detail site.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/detail_colour.glsl"

layout(local_size_x = kGroupSize) in;
layout(constant_id = kConstantDetailCount) const uint detailCount = 8;
layout(constant_id = kConstantLobeCount) const uint lobeCount = 8;

void main() {
  uint index = linearGroup() * kGroupSize + gl_LocalInvocationIndex;
  uint slot = index / detailCount;
  uint k = index % detailCount;
  if (slot >= COUNTERS.visibleCells) return;

  uvec4 cell = FRAME.visibleCells.v[slot];
  Chunk chunk = loadChunk(cell.x);
  if (cell.y >= chunk.liveCount) return;
  CellCode code = FRAME.chunks.v[cell.x].code;
  CellHeader header = loadCellHeader(code, cell.x, cell.y);
  DetailSite detail = loadDetailSite(code, header, detailCount, k);

  BitCursor bits = cellBits(cell.x, cell.y);
  takeDensity(code, bits);
  Frame frame = takeFrame(code, bits);
  Ball ball = ballOfSite(chunk, cell.y);
  vec3 toDetail = ball.centre + ball.radius * (frame.tangent * detail.place.x + frame.bitangent * detail.place.y);
  vec3 direction = lensClass == kLensClassOrthographic ? FRAME.forward.xyz : directionToDetail(toDetail, frame.normal);
  Lobes lobes = noLobes(header);
  if (lobeCount > 0) lobes = loadLobes(code, header, detailCount, k);
  vec3 colour = detailColour(code, header, lobes, detail.base, direction);

  if (floatColours) {
    FRAME.details.v[index] =
        DetailRecord(detail.place, detail.height, floatBitsToUint(colour.b), floatBitsToUint(colour.rg));
    return;
  }
  FRAME.details.v[index] =
      DetailRecord(detail.place, detail.height, 0u, uvec2(packHalf2x16(colour.rg), packHalf2x16(vec2(colour.b, 0.0))));
}
