// An asset resident on the GPU: what the asset loader hands to the renderer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "runtime/core/device.h"

namespace froth {

// Addresses of one chunk's arrays, exactly the arrays of ChunkContents (format/asset_contents.h), tightly packed:
// vec3 takes 12 bytes. An absent array (heights all zero) has address 0.
struct GpuChunk {
  std::array<double, 3> origin{};
  uint32_t cellCount = 0, liveCount = 0;
  uint32_t neighbourCount = 0;       // length of `neighbours`
  uint64_t alphaTotal = 0;           // sum of alphaCounts
  VkDeviceAddress siteRadius = 0;    // vec4 [cellCount]: site relative to origin, radius
  VkDeviceAddress neighbourOffsets = 0;  // uint [cellCount + 1]
  VkDeviceAddress neighbours = 0;        // CellRef [neighbourCount]
  VkDeviceAddress alphaCounts = 0;       // uint [liveCount]
  VkDeviceAddress densities = 0;         // float [liveCount]
  VkDeviceAddress orientations = 0;      // vec4 [liveCount] (w, x, y, z)
  VkDeviceAddress detailSites = 0;       // vec2 [liveCount * K]
  VkDeviceAddress detailHeights = 0;     // float [liveCount * K]
  VkDeviceAddress lobeAxes = 0;          // vec3 [liveCount * K * M]
  VkDeviceAddress lobeColours = 0;       // vec3 [liveCount * K * M]
};

struct GpuAsset {
  uint32_t detailCount = 0, lobeCount = 0;  // K, M
  uint32_t localBits = 32;
  bool hasWalkGraph = false, hasHeights = false;
  float detailSharpness = 10.0f, nearRatio = 4.0f, nearDepth = 0.0f;
  uint32_t liveCount = 0;     // over all chunks
  uint64_t alphaTotal = 0;    // over all chunks
  std::vector<GpuChunk> chunks;
};

}  // namespace froth
