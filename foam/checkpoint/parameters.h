// The tensors of a checkpoint, in the order in which published tools write them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace froth {

enum class Parameter : size_t {
  kPoints,         // [N, 3]
  kDensity,        // [N], softplus
  kRadii,          // [N], softplus
  kOrientations,   // [N, 4] (w, x, y, z), normalised
  kDetailSites,    // [N, K, 2]
  kLobeAxes,       // [N, K, 3M] or [N, K, M, 3]
  kLobeColours,    // [N, K, 3M] or [N, K, M, 3]
  kDetailHeights,  // [N, K]
};

inline constexpr std::array<std::string_view, 8> kParameterKeys = {
    "points", "density", "radii", "quaternions", "texel_sites", "texel_sv_axis", "texel_sv_rgb", "texel_height"};
inline constexpr size_t kParameterCount = kParameterKeys.size();

// Limits of a foam's counts; cells are counted in 32 bits.
inline constexpr uint64_t kMaxDetails = 32, kMaxLobes = 32;

// Of the Cech graph; read by nobody here (docs/FOAM.md: the stored one lacks pairs), written for other tools.
inline constexpr std::string_view kAdjacencyKey = "adjacency", kAdjacencyOffsetsKey = "adjacency_offsets";

}  // namespace froth
