// The manifest as the reader holds it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

struct Manifest {
  AssetContents contents;  // chunks: origin and counts, no arrays
  std::vector<ChunkIndex> chunks;
  uint32_t codebookSize = 0;
  float codebookStep = 0;               // commonStep of its entries, once they are read
  std::vector<SectionRecord> sections;  // of known types, sorted by {chunk, type}

  // Null if there is none.
  const SectionRecord* findSection(uint32_t chunk, SectionType type) const;
};

// Checks everything that can be known without reading a section: FlatBuffers structure, ranges, and for every
// section place, size against the counts and the limit of expansion. `bytes` is aligned to 8, at most kMaxManifestSize
// and ends in the file at `manifestEnd`; no section may begin before that.
Result<Manifest> parseManifest(std::span<const uint8_t> bytes, uint64_t manifestEnd, uint64_t fileSize,
                               const std::string& file);

}  // namespace froth
