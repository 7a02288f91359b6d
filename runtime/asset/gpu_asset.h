// An asset resident on the GPU: what the asset loader hands to the renderer.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include "runtime/device/device.h"
#include "shaders/gpu/layout.h"

namespace froth {

// Addresses of one chunk's arrays; an empty array has address 0. Arrays by cell hold the chunk's own cells; sites are
// cells, then ghosts.
struct GpuChunk {
  std::array<double, 3> origin{};
  std::array<double, 3> liveLow{}, liveHigh{};  // box of the balls of live cells, in the axes of the asset
  uint32_t cellCount = 0, liveCount = 0;
  uint32_t siteCount = 0;                // cells and ghosts
  uint32_t neighbourCount = 0;           // length of `neighbours`
  uint64_t alphaTotal = 0;               // sum of alphaCounts
  VkDeviceAddress siteRadius = 0;        // vec4 [siteCount]: site relative to origin, radius
  VkDeviceAddress neighbourOffsets = 0;  // uint [cellCount + 1]
  VkDeviceAddress neighbours = 0;        // uint of 32 >> neighbourShift bits [neighbourCount] sites
  VkDeviceAddress ghostRefs = 0;         // CellRef, or with levels border numbers [siteCount - cellCount]
  VkDeviceAddress alphaCounts = 0;       // uint of 32 >> alphaShift bits [liveCount]
  VkDeviceAddress cellStarts = 0;        // uint [liveCount] first byte of a live cell in cellWords
  VkDeviceAddress cellWords = 0;         // uint [cellWordCount] PackedCells (runtime/asset/cell_packer.h)
  VkDeviceAddress solidBalls = 0;        // uint [liveCount] ChunkContents::solidBalls; absent: kWholeBall each
  VkDeviceAddress prepared = 0;          // uvec4 [] as GpuAsset::preparing says (shaders/gpu/prepared_cells.glsl)
  uint32_t neighbourShift = 0, alphaShift = 0;
  uint32_t cellWordCount = 0;
  gpu::CellCode code{};
  uint32_t lobeTotal = 0;  // over all detail sites
  uint32_t lobeQuads = 0;  // of each, prepared (shaders/gpu/prepared_cells.glsl)
  uint32_t number = 0;     // in the file
  // With levels, as in ChunkContents.
  uint32_t borderCount = 0;
  VkDeviceAddress borderCells = 0;    // uint [borderCount]
  VkDeviceAddress borderNumbers = 0;  // uint [borderCount]

  uint64_t lobeQuadTotal() const { return uint64_t{lobeTotal} * lobeQuads; }
};

// What the shaders that draw an asset are specialized on.
struct AssetShape {
  uint32_t detailCount = 1, lobeCount = 1;
  bool hasHeights = false;
  friend auto operator<=>(const AssetShape&, const AssetShape&) = default;
};

// What some chunks of an asset have together.
struct CutCounts {
  uint32_t chunkCount = 0;  // of the table, with slots that are empty
  uint32_t groupCount = 0;  // groupsOfCells (runtime/render/view_capacity.h)
  uint32_t cellCount = 0, liveCount = 0;
  uint64_t alphaTotal = 0;
};

struct GpuAsset {
  uint32_t detailCount = 0, lobeCount = 0;  // K, M
  uint32_t localBits = 32;
  bool hasWalkGraph = false;
  bool hasHeights = false;  // in any chunk
  float detailSharpness = 10.0f, nearRatio = 4.0f, nearDepth = 0.0f;
  uint32_t liveCount = 0;                           // over all chunks
  uint32_t cellCount = 0;                           // over all chunks
  uint64_t alphaTotal = 0;                          // over all chunks
  uint64_t neighbourTotal = 0, lobeQuadTotal = 0;   // over all chunks
  std::array<double, 3> boundsLow{}, boundsHigh{};  // of the balls of live cells, with levels of all
  uint32_t walkEntriesAlong = 0;  // WalkInstance::entries (shaders/gpu/walk_layout.h); 0: there are none
  VkDeviceAddress walkEntries = 0;
  // What GpuChunk::prepared has places for, and what of it is filled in all chunks that are drawn; as of the newest
  // walk set.
  uint32_t preparing = gpu::kPreparedNothing, prepared = gpu::kPreparedNothing;
  // With levels by slot: a chunk keeps its slot as long as it is resident, and slots of chunks that are not drawn are
  // empty. Else in the order of the file.
  std::vector<GpuChunk> chunks;

  // Levels of detail.
  uint32_t fileChunkCount = 0;  // 0: there are none
  uint32_t borderCount = 0;     // AssetContents::borderCount
  VkBuffer borderBuffer = VK_NULL_HANDLE;
  VkDeviceSize borderOffset = 0;  // in the buffer
  VkDeviceAddress borders = 0;    // FrameBlock::borders
  uint32_t firstSlot = 0;         // that is drawn and has cells
  CutCounts next;                 // of the chunks that are to be drawn next: views make room for them before
  uint32_t mostCells = 0;         // that views make room for ahead of the chunks that are to be drawn

  bool hasLevels() const { return fileChunkCount != 0; }
  VkDeviceSize borderBytes() const { return sizeof(uint32_t) * (VkDeviceSize{borderCount} + fileChunkCount); }
  AssetShape shape() const { return {detailCount, lobeCount, hasHeights}; }
  void add(const GpuChunk& chunk) {
    count(chunk);
    chunks.push_back(chunk);
  }
  void count(const GpuChunk& chunk) {
    liveCount += chunk.liveCount;
    cellCount += chunk.cellCount;
    alphaTotal += chunk.alphaTotal;
    neighbourTotal += chunk.neighbourCount;
    lobeQuadTotal += chunk.lobeQuadTotal();
  }
};

// Along each axis of the table of entries for rays.
uint32_t walkEntriesAlong(uint32_t cellCount);

}  // namespace froth
