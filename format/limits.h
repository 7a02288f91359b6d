// The ranges of values that docs/FORMAT.md sets. Baker, writer and reader ask for the same ones.
#pragma once

#include <cstdint>

namespace froth {

// Lengths [scene units], places and heights [radii], lobe axes and colours. Differences of such numbers have squares of
// 2^102 at most; three of them times kMaxSharpness, and the sRGB curve of a colour, are finite floats.
inline constexpr float kMaxNumber = 0x1p50f;
inline constexpr float kMaxDensity = 0x1p100f;  // [1 / scene unit]
inline constexpr float kMaxSharpness = 0x1p20f;
inline constexpr float kMaxNearRatio = 0x1p10f;

// Neighbours of a site in a chunk, and the sum of their numbers' squares over all sites of the chunk.
inline constexpr uint32_t kMaxNeighbours = 65535;
constexpr uint64_t mostSquaredDegrees(uint64_t siteCount) { return (uint64_t{1} << 32) + (siteCount << 12); }

}  // namespace froth
