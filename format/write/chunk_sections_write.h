// The raw bytes of a chunk's sections; chunk_sections_read.h turns them back into values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/section.h"
#include "format/write/axis_search.h"

namespace froth {

struct RawSection {
  SectionType type{};
  uint32_t elementSize = 0;  // [bytes]
  uint32_t base = 0;         // SectionRecord::base
  std::vector<uint8_t> bytes;
};

struct RawChunk {
  ChunkCounts counts;
  std::vector<RawSection> sections;  // ascending types; those that hold something
};

// `chunk` has passed checkChunk. Fails if a value does not lie on its lattice, or if a neighbour is one in
// one direction only. `axes` searches asset.axisCodebook. Thread-safe.
Result<RawChunk> packChunk(const AssetContents& asset, const AxisSearch& axes, const ChunkContents& chunk,
                           const std::string& place);

}  // namespace froth
