// The colours by which the fly-through tells levels of detail apart.
#pragma once

#include <array>
#include <cstdint>

namespace froth {

using LevelColour = std::array<float, 3>;  // linear light; its greatest channel is 1

inline constexpr std::array<LevelColour, 14> kLevelColours = {{
    {0.10f, 1.00f, 0.12f},  // green: the finest
    {1.00f, 0.80f, 0.05f},  // yellow
    {1.00f, 0.25f, 0.03f},  // orange
    {1.00f, 0.06f, 0.35f},  // pink
    {0.45f, 0.12f, 1.00f},  // violet
    {0.05f, 0.30f, 1.00f},  // blue
    {0.05f, 0.85f, 1.00f},  // cyan
    {1.00f, 1.00f, 1.00f},
    {0.45f, 1.00f, 0.45f},  // the first six, paler
    {1.00f, 0.90f, 0.45f},
    {1.00f, 0.50f, 0.35f},
    {1.00f, 0.45f, 0.75f},
    {0.70f, 0.50f, 1.00f},
    {0.40f, 0.65f, 1.00f},
}};

// They come again after as many levels.
inline const LevelColour& colourOfLevel(uint32_t level) { return kLevelColours[level % kLevelColours.size()]; }

}  // namespace froth
