// Where sections lie in a file, and the bytes before them. Part of froth_format_write.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

// Sections follow each other in streams, and streams in the file: what is shared, then layer after layer of
// all chunks.
inline constexpr size_t kStreamCount = 4;
size_t streamOf(const SectionRecord& record);

class AssetLayout {
 public:
  void addChunk(const ChunkIndex& chunk) { chunks_.push_back(chunk); }
  // Behind the sections of its stream so far.
  void addSection(const SectionRecord& record);

  const std::vector<ChunkIndex>& chunks() const { return chunks_; }

  struct Head {
    std::vector<uint8_t> bytes;  // header and manifest
    uint64_t fileSize = 0;
  };
  // `contents`: its chunks are not looked at.
  Head buildHead(const AssetContents& contents) const;

 private:
  std::vector<ChunkIndex> chunks_;
  std::array<std::vector<SectionRecord>, kStreamCount> streams_;  // offsets from the start of the stream
  std::array<uint64_t, kStreamCount> sizes_{};
};

}  // namespace froth
