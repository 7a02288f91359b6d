// Reads a .froth asset. Nothing in the file is trusted: any bytes give a value or a named error, never a crash, a hang
// or an allocation beyond what the file's size justifies.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/chunk_codes.h"
#include "format/read/byte_source.h"
#include "format/section.h"

namespace froth {

struct AssetHead;

// An opened asset: header and manifest are read and checked, sections are decoded on demand.
// Thread safety: readChunk() and readCodedChunk() may run on several threads at once.
class AssetReader {
 public:
  // Layers behind `last` are left alone: the contents are those of a coarser scene (K = 1 or M = 0), complete for every
  // user.
  static Result<AssetReader> open(const std::filesystem::path& path, Layer last = Layer::kViewDependence);
  // `bytes` must outlive the reader; `name` stands for the file in messages.
  static Result<AssetReader> openBytes(std::span<const uint8_t> bytes, std::string name,
                                       Layer last = Layer::kViewDependence);
  // Of an AssetOpener. Without `source` the caller brings the bytes of each chunk.
  explicit AssetReader(AssetHead head, std::shared_ptr<const ByteSource> source = nullptr);

  AssetReader(AssetReader&&) noexcept;
  AssetReader& operator=(AssetReader&&) noexcept;
  ~AssetReader();

  // Everything but the chunks' arrays; `chunks` holds origins and counts.
  const AssetContents& manifest() const;
  // The balls of a chunk's live cells, relative to its origin; known before any section is read. chunk < chunks.size().
  Box liveBounds(uint32_t chunk) const;
  // Stored sizes, for `froth info`: one record per section.
  std::span<const SectionRecord> sections() const;
  // Where the sections of a chunk lie (up to the last layer), ascending; sections that touch are one range.
  std::vector<ByteRange> rangesOf(uint32_t chunk) const;
  // Decodes and checks all sections of one chunk (up to the last layer): hashes, sizes, index ranges, finite numbers,
  // positive radii. Needs no other chunk. `bytes` holds rangesOf(chunk); it is source() where there is one.
  Result<CodedChunk> readCodedChunk(uint32_t chunk, const ByteSource& bytes) const;
  Result<CodedChunk> readCodedChunk(uint32_t chunk) const { return readCodedChunk(chunk, *source()); }
  Result<ChunkContents> readChunk(uint32_t chunk) const;  // its contents, for those who need no lattice indices
  const std::shared_ptr<const ByteSource>& source() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The whole asset in memory, or its first layers.
Result<AssetContents> readAsset(const std::filesystem::path& path, Layer last = Layer::kViewDependence);

// What `froth verify` does beyond reading: every section decodes, the graph is symmetric (also across chunks) and
// without loops or double entries, alpha rows are prefixes in nearest-first order. With levels each level is such an
// asset, borders are the same balls wherever they stand, and both forms of a group have the same neighbours outside.
Status verifyAsset(const std::filesystem::path& path);

}  // namespace froth
