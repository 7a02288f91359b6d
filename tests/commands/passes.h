// What no tool reads from a shader: which of its accesses depend on push constants, and which passes share an image by
// pixels.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tests/commands/hazards.h"
#include "tests/commands/shader_accesses.h"

namespace froth::test {

// False: with these push constants the shader does not get there.
bool happens(const std::string& shader, const Location& location, const std::array<uint8_t, 128>& push);

// The passes that draw one image share its pixels, and those of FrameBlock::hits, among themselves; of the chunks that
// are drawn at a time, each holds other borders.
bool writeDifferentPlaces(const Use& earlier, const Use& later, const Range& range);

}  // namespace froth::test
