// Sections: the arrays of a chunk, each encoded alone and keyed {chunk, type}. What reader and writer share.
// docs/FORMAT.md says how elements stand for values.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "format/asset_contents.h"
#include "format/section_codec.h"

namespace froth {

// N cells, of these L live, G ghosts, E pairs of the graph, S lobes; K detail sites per cell; C entries of
// the codebook. Types are grouped by layer; numbers between the groups are free.
enum class SectionType : uint32_t {
  kSites = 1,           // [N × 3]
  kGhostSites = 2,      // [G × 3]
  kRadii = 3,           // [N + G] those of ghosts last
  kGhostRefs = 4,       // [G]
  kGraphCounts = 5,     // [N] format/graph_rows.h, as the next two
  kGraphDeltas = 6,     // [E]
  kGraphAlphaBits = 7,  // [ceil(E / 8)]
  kDensities = 8,       // [L]
  kOrientations = 9,    // [L × 2] octahedral normals, or [L × 4] quaternions
  kCellColours = 10,    // [L × 3]
  kCellHeights = 11,    // [L]
  kSolidBalls = 12,     // [L × 4]
  kBorderCells = 13,    // [B]
  kBorderNumbers = 14,  // [B]

  kDetailSites = 32,    // [L × K × 2]
  kDetailHeights = 33,  // [L × K]
  kColourScales = 34,   // [L]
  kBaseColours = 35,    // [L × K × 3]
  kDetailScales = 36,   // [L]

  kLobeCounts = 64,    // [L × K]
  kLobeLabels = 65,    // [S] entries of the codebook
  kLobeAxes = 66,      // [S × 3] or what they differ by from the codebook's
  kLobeColours = 67,   // [S × 3]
  kAxisCodebook = 68,  // [C × 3] shared: its chunk is kSharedChunk
};

// What the elements of a section are.
enum class ElementKind {
  kFloat,  // float32
  kInt32,  // two's complement
  kUint32,
  kGraph,     // unsigned, 2 bytes, or 4 if a chunk has more than 32768 sites
  kByte,      // unsigned, 1 byte
  kUnsigned,  // 1, 2 or 4 bytes, as the writer finds room; the number is record.base + element
  kSigned,    // 1, 2 or 4 bytes: 0, -1, 1, -2, 2, ... are 0, 1, 2, 3, 4, ...
};

inline constexpr uint32_t kSharedChunk = 0xffffffff;

inline constexpr uint16_t kSectionCritical = 1;            // a reader that does not know the type refuses the file
inline constexpr uint16_t kSectionReservedFlags = 0xff00;  // must be zero

struct SectionRecord {
  uint32_t type = 0;  // SectionType, or one that this version does not know
  uint32_t chunk = 0;
  uint16_t flags = 0;
  uint16_t codec = 0;
  uint32_t elementSize = 0;  // [bytes]
  uint32_t base = 0;         // added to every element of ElementKind::kUnsigned; 0 with other kinds
  uint64_t offset = 0;       // [bytes from the start of the file]
  uint64_t storedSize = 0;   // [bytes]
  uint64_t rawSize = 0;      // [bytes]
  uint64_t hash = 0;         // of the stored bytes
};

// Sizes that the manifest tells before a section is read.
struct ChunkCounts {
  uint64_t cells = 0, live = 0, ghosts = 0, pairs = 0, lobes = 0, borders = 0;
};

// What the manifest tells of a chunk.
struct ChunkIndex {
  std::array<double, 3> origin{};
  ChunkCounts counts;
  Box liveBounds;
};

enum class Presence { kForbidden, kOptional, kRequired };

// All types, ascending.
std::span<const SectionType> allSectionTypes();

// Null if this version does not know the type.
const char* sectionName(uint32_t type);

Layer sectionLayer(SectionType type);

// The number of elements per entry; entries are the outer dimensions in the list above.
uint32_t sectionComponents(SectionType type, const Quantization& quantization);
ElementKind sectionKind(SectionType type, const Quantization& quantization);
bool isElementSize(ElementKind kind, uint32_t size);

// Entries of a chunk's section, as the counts demand; of a shared one 0. Exact: counts are below 2^40, K at
// most 32.
uint64_t sectionEntries(SectionType type, const ChunkCounts& counts, uint32_t detailCount);

// Whether a chunk of these counts has such a section. Of `asset` the parameters are read, not the chunks;
// `hasCodebook` stands for its codebook.
Presence sectionPresence(SectionType type, const AssetContents& asset, bool hasCodebook, const ChunkCounts& counts);

// "scene.froth: chunk 17", "scene.froth: shared"
std::string chunkPlace(const std::string& file, uint32_t chunk);
// "scene.froth: chunk 17, section 'ghost_refs'"
std::string sectionPlace(const std::string& chunkPlace, uint32_t type);
std::string sectionPlace(const std::string& chunkPlace, SectionType type);

}  // namespace froth
