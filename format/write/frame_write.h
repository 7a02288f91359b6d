// zstd frames. Internal to the writing half of format/.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"

namespace froth {

// Appends a frame of `content` to `stored`.
Status appendFrame(std::span<const uint8_t> content, int level, std::vector<uint8_t>& stored);

// Appends a frame of byte 0 of every element, then one of byte 1 of every element, ...: planes have little in common.
Status appendPlanes(std::span<const uint8_t> elements, uint32_t elementSize, int level, std::vector<uint8_t>& stored);

}  // namespace froth
