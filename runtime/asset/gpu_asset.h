// An asset resident on the GPU: what the asset loader hands to the renderer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/core/device.h"

namespace froth {

// Addresses of one chunk's arrays, those of ChunkContents (format/asset_contents.h), tightly packed: vec3 takes 12 bytes.
// An absent array has address 0. Arrays by cell hold the chunk's own cells; `sites` are cells, then ghosts.
struct GpuChunk {
  std::array<double, 3> origin{};
  uint32_t cellCount = 0, liveCount = 0;
  uint32_t siteCount = 0;            // cells and ghosts
  uint32_t neighbourCount = 0;       // length of `neighbours`
  uint64_t alphaTotal = 0;           // sum of alphaCounts
  VkDeviceAddress siteRadius = 0;    // vec4 [siteCount]: site relative to origin, radius
  VkDeviceAddress neighbourOffsets = 0;  // uint [cellCount + 1]
  VkDeviceAddress neighbours = 0;        // uint [neighbourCount] sites
  VkDeviceAddress ghostRefs = 0;         // CellRef [siteCount - cellCount]
  VkDeviceAddress alphaCounts = 0;       // uint [liveCount]
  VkDeviceAddress densities = 0;         // float [liveCount]
  VkDeviceAddress orientations = 0;      // vec4 [liveCount] (w, x, y, z)
  VkDeviceAddress detailSites = 0;       // vec2 [liveCount * K]
  VkDeviceAddress detailHeights = 0;     // float [liveCount * K]; absent: all zero
  VkDeviceAddress baseColours = 0;       // vec3 [liveCount * K]; absent: all zero
  VkDeviceAddress lobeOffsets = 0;       // uint [liveCount * K + 1] first lobe of a detail site; absent: M each
  VkDeviceAddress lobeAxes = 0;          // vec3 [lobes]
  VkDeviceAddress lobeColours = 0;       // vec3 [lobes]
};

struct GpuAsset {
  uint32_t detailCount = 0, lobeCount = 0;  // K, M
  uint32_t localBits = 32;
  bool hasWalkGraph = false;
  bool hasHeights = false, hasBaseColours = false, hasLobeOffsets = false;  // in any chunk
  float detailSharpness = 10.0f, nearRatio = 4.0f, nearDepth = 0.0f;
  uint32_t liveCount = 0;     // over all chunks
  uint64_t alphaTotal = 0;    // over all chunks
  std::vector<GpuChunk> chunks;
};

}  // namespace froth
