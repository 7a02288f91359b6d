// Where sections lie in a file, and the bytes before them. Part of froth_format_write.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

// Sections are stored as they are appended, chunk after chunk. Their order in the file is decided in the end: what is
// shared, then layer after layer of all chunks; with levels layer after layer of the floor, then chunk after chunk.
class AssetLayout {
 public:
  void addShared(const SectionRecord& record) { add(record, shared_); }
  // Chunks are known by the order in which they are appended.
  void addChunk(const ChunkIndex& chunk, std::span<const SectionRecord> records);

  struct Part {
    uint64_t offset = 0, size = 0;  // [bytes] of what was appended
  };
  struct Plan {
    std::vector<uint8_t> head;  // header and manifest
    std::vector<Part> parts;    // in the order of the file
    uint64_t fileSize = 0;
  };
  // `contents`: its chunks are not looked at. order[i] is the appended chunk that is chunk i.
  Plan plan(const AssetContents& contents, std::span<const uint32_t> order) const;
  std::vector<ChunkIndex> chunks(std::span<const uint32_t> order) const;

  size_t chunkCount() const { return chunks_.size(); }

 private:
  struct Chunk {
    ChunkIndex index;
    std::vector<SectionRecord> records;
  };

  void add(const SectionRecord& record, std::vector<SectionRecord>& records);
  std::vector<SectionRecord> recordsInOrder(std::span<const ChunkLevel> levels, std::span<const uint32_t> order) const;

  std::vector<SectionRecord> shared_;  // offsets from the start of what was appended
  std::vector<Chunk> chunks_;
  uint64_t size_ = 0;
};

}  // namespace froth
