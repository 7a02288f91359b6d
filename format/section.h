// Sections: the arrays of a chunk, each encoded alone and keyed {chunk, type}. What reader and writer share.
#pragma once

#include <cstdint>
#include <string>

#include "format/asset_contents.h"
#include "format/section_codec.h"

namespace froth {

// Every section is an array of 32-bit words (float32 or uint32). A section of no words does not exist;
// detail_heights does not exist either if all heights are zero.
enum class SectionType : uint32_t {
  kSites = 1,             // [cellCount × 3] float
  kRadii = 2,             // [cellCount] float
  kNeighbourOffsets = 3,  // [cellCount + 1] uint
  kNeighbours = 4,        // [neighbourCount] uint, CellRef
  kAlphaCounts = 5,       // [liveCount] uint
  kDensities = 6,         // [liveCount] float
  kOrientations = 7,      // [liveCount × 4] float
  kDetailSites = 8,       // [liveCount × K × 2] float
  kDetailHeights = 9,     // [liveCount × K] float, optional
  kLobeAxes = 10,         // [liveCount × K × M × 3] float
  kLobeColours = 11,      // [liveCount × K × M × 3] float
};

inline constexpr uint16_t kSectionCritical = 1;  // a reader that does not know the type refuses the file
inline constexpr uint16_t kSectionReservedFlags = 0xff00;  // must be zero

inline constexpr uint64_t kWordSize = 4;  // [bytes]

struct SectionRecord {
  uint32_t type = 0;  // SectionType, or one that this version does not know
  uint32_t chunk = 0;
  uint16_t flags = 0;
  uint16_t codec = 0;
  uint64_t offset = 0;      // [bytes from the start of the file]
  uint64_t storedSize = 0;  // [bytes]
  uint64_t rawSize = 0;     // [bytes]
  uint64_t hash = 0;        // of the stored bytes
};

struct ChunkCounts {
  uint64_t cells = 0, live = 0, neighbours = 0;
};

// Calls visit(type, array) for every array of a chunk, in the order of their types.
template <class Chunk, class Visit>
void visitSections(Chunk& chunk, Visit&& visit) {
  visit(SectionType::kSites, chunk.sites);
  visit(SectionType::kRadii, chunk.radii);
  visit(SectionType::kNeighbourOffsets, chunk.neighbourOffsets);
  visit(SectionType::kNeighbours, chunk.neighbours);
  visit(SectionType::kAlphaCounts, chunk.alphaCounts);
  visit(SectionType::kDensities, chunk.densities);
  visit(SectionType::kOrientations, chunk.orientations);
  visit(SectionType::kDetailSites, chunk.detailSites);
  visit(SectionType::kDetailHeights, chunk.detailHeights);
  visit(SectionType::kLobeAxes, chunk.lobeAxes);
  visit(SectionType::kLobeColours, chunk.lobeColours);
}

// Null if this version does not know the type.
const char* sectionName(uint32_t type);

// Words of a section's array, as the counts demand. Exact: counts are below 2^33, K and M at most 32.
uint64_t sectionWords(SectionType type, const ChunkCounts& counts, uint32_t detailCount, uint32_t lobeCount);

// "scene.froth: chunk 17, section 'neighbours'"
std::string sectionPlace(const std::string& file, uint32_t chunk, uint32_t type);

}  // namespace froth
