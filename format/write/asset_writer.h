// Writes a .froth asset; in a link target of its own (froth_format_write), so that the runtime carries no
// writer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/atomic_file.h"
#include "base/result.h"
#include "format/asset_contents.h"
#include "format/section.h"

namespace froth {

struct StoredSection {
  SectionRecord record;
  std::vector<uint8_t> stored;
};

// One chunk on its way into a file; made and read by the writer alone.
struct EncodedChunk {
  ChunkIndex index;
  std::vector<CellRef> ghostRefs;       // the highest into each chunk; the last is the highest of all
  std::vector<uint32_t> highestBorder;  // the highest border number; none: no borders
  std::vector<StoredSection> sections;  // ascending types
};

// Writes an asset chunk by chunk, so that memory holds one chunk at a time. Sections gather in a temporary
// beside `path`; finish() puts header and manifest before them, brings them into the order of docs/FORMAT.md, syncs and
// renames. Without finish() nothing is left, and an old file stays as it is. The disk must hold the file
// twice. The bytes do not depend on the threads. Thread safety: encodeChunk() may run on several threads at
// once; the rest on one.
class AssetStreamWriter {
 public:
  // `header`: counts, quantization and codebook are read; `chunks` is ignored.
  static Result<AssetStreamWriter> create(const std::filesystem::path& path, const AssetContents& header,
                                          WriteProtected isProtected = WriteProtected::kRefuse);
  AssetStreamWriter(AssetStreamWriter&&) noexcept;
  AssetStreamWriter& operator=(AssetStreamWriter&&) noexcept;
  ~AssetStreamWriter();

  // The chunk's sections, encoded. Fails if a value does not lie on its lattice, and with kCancelled once
  // `isStopped`, asked before each section, says so.
  Result<EncodedChunk> encodeChunk(const ChunkContents& chunk, const std::function<bool()>& isStopped = {}) const;
  // Appends; in the order of the chunks' indices, or in any if finish() is told.
  Status append(EncodedChunk&& chunk);
  // `header` as at the start, now with statistics, errors, levels, groups and borderCount. order[i]: which of the
  // appended chunks, by its number from 0, is chunk i of the asset; empty: as appended. A bake of levels appends level
  // 0 first and so gives the order in the end. Returns the file's size [bytes].
  Result<uint64_t> finish(const AssetContents& header, std::span<const uint32_t> order = {});

 private:
  AssetStreamWriter();
  struct State;
  std::unique_ptr<State> state_;
};

// The file's bytes, from contents with all their chunks. The same contents give the same bytes.
Result<std::vector<uint8_t>> encodeAsset(const AssetContents& contents);

// AssetStreamWriter over all chunks of `contents`. An interrupted write leaves the old file intact.
Status writeAsset(const std::filesystem::path& path, const AssetContents& contents);

}  // namespace froth
