#include "runtime/asset/prepared_cells.h"

namespace froth {

// The layout of shaders/gpu/prepared_cells.glsl.
VkDeviceSize preparedBytes(const GpuAsset& asset, uint32_t form, const PreparedCounts& counts) {
  if (form == gpu::kPreparedNothing) return 0;
  const bool isSeen = form == gpu::kPreparedRadiance;
  const uint32_t detailQuads = (isSeen || asset.hasHeights ? 1 : 0) + (isSeen ? 1 : 0);
  const uint64_t cellQuads = gpu::kFaceQuads + uint64_t{asset.detailCount} * detailQuads;
  return sizeof(gpu::uvec4) * (counts.neighbours + counts.live * cellQuads + (isSeen ? counts.lobeQuads : 0));
}

VkDeviceSize preparedBytes(const GpuAsset& asset, uint32_t form) {
  return preparedBytes(asset, form, {asset.liveCount, asset.neighbourTotal, asset.lobeQuadTotal});
}

Status PreparedCells::place(uint32_t chunk, VkDeviceSize size, VkDeviceSize more) {
  const Result<GpuArena::Place> place = arena_.allocate(size, more, "cells prepared for rays");
  if (!place) return place.error();
  chunks_[chunk] = {*place, size, 0};
  usedBytes_ += size;
  return {};
}

void PreparedCells::free(uint32_t chunk) {
  if (!has(chunk)) return;
  arena_.free(chunks_[chunk].place, chunks_[chunk].size);
  usedBytes_ -= chunks_[chunk].size;
  chunks_[chunk] = {};
}

void PreparedCells::dropFrame(uint64_t serial) {
  for (Chunk& chunk : chunks_) {
    if (chunk.serial == serial) chunk.serial = 0;
  }
}

}  // namespace froth
