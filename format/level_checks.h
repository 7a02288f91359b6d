// What must hold of levels, groups and borders (docs/FORMAT.md "Levels"): asked by the reader after, and by the writer
// before, the bytes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

// A ball lies in another one if |c - C| + r <= R + kBallMargin * (R + |C|_max). Rounding of the left side in double is
// some 2^-51 of that bracket.
inline constexpr double kBallMargin = 0x1p-40;
bool isBallWithin(const std::array<double, 3>& centre, double radius, const LevelGroup& group);

// levels, groups and borderCount against the chunks' counts. `asset`: its chunks are not looked at.
Status checkLevels(const AssetContents& asset, std::span<const ChunkIndex> chunks, const std::string& file);

// Of one chunk: ascending cells that exist, each border once, none of them among the ghosts.
Status checkBorders(const ChunkContents& chunk, const std::string& place);

// All numbers are below borderCount.
Status checkBorderRange(const AssetContents& asset, std::span<const uint32_t> borders, const std::string& place);

}  // namespace froth
