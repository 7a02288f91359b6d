// What rays find of an asset's cells without decoding them (FrothAssetInfo::prepareRays): memory beside that of its
// chunks, so that it can go first where the budget is short. The device fills it (shaders/prepare_cells.comp).
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/asset/gpu_arena.h"
#include "runtime/asset/gpu_asset.h"

namespace froth {

// What cells have together.
struct PreparedCounts {
  uint64_t live = 0, neighbours = 0;
  uint64_t lobeQuads = 0;
};

// [bytes] of some cells of an asset; form: kPreparedNothing...
VkDeviceSize preparedBytes(const GpuAsset& asset, uint32_t form, const PreparedCounts& counts);
// Of all that are drawn.
VkDeviceSize preparedBytes(const GpuAsset& asset, uint32_t form);

// Chunks have their numbers in the file. One thread at a time.
class PreparedCells {
 public:
  PreparedCells(Device& device, uint32_t chunkCount) : arena_(device), chunks_(chunkCount) {}

  // Once for a chunk; size > 0. `more` and errors: as of GpuArena::allocate.
  Status place(uint32_t chunk, VkDeviceSize size, VkDeviceSize more);
  void free(uint32_t chunk);  // the GPU must be done with it
  bool has(uint32_t chunk) const { return chunks_[chunk].size > 0; }
  VkDeviceAddress addressOf(uint32_t chunk) const { return chunks_[chunk].place.address; }

  // The frame that fills it; 0: none does yet.
  uint64_t filledBy(uint32_t chunk) const { return chunks_[chunk].serial; }
  void fill(uint32_t chunk, uint64_t serial) { chunks_[chunk].serial = serial; }
  void dropFrame(uint64_t serial);

  VkDeviceSize heldBytes() const { return arena_.heldBytes(); }  // of VkDeviceMemory
  VkDeviceSize usedBytes() const { return usedBytes_; }

 private:
  struct Chunk {
    GpuArena::Place place;
    VkDeviceSize size = 0;  // 0: it has no place
    uint64_t serial = 0;
  };

  GpuArena arena_;
  std::vector<Chunk> chunks_;
  VkDeviceSize usedBytes_ = 0;
};

}  // namespace froth
