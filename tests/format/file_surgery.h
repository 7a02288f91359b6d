// Files that are wrong in one chosen way: valid ones taken apart, changed, and signed again so that hashes
// fit.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <format/froth_generated.h>

#include "format/asset_contents.h"
#include "format/container.h"
#include "format/read/asset_reader.h"
#include "format/section.h"

namespace froth {

// The file's parts, before offsets and hashes are set.
struct Draft {
  AssetContents contents;
  std::vector<ChunkIndex> chunks;
  std::vector<SectionRecord> records;
  std::vector<std::vector<uint8_t>> stored;  // [records]

  size_t find(SectionType type, uint32_t chunk = 0) const;  // index in `records`
  // Replaces a section of chunk 0 by the encoding of `raw`, in elements of the same size.
  void replace(SectionType type, std::span<const uint8_t> raw);
  void add(const SectionRecord& record, std::vector<uint8_t> bytes);
  std::vector<uint8_t> assemble() const;  // lays the sections one after the other and signs
};

Draft draftOf(const AssetContents& contents);

template <class Element>
std::span<const uint8_t> rawBytes(const std::vector<Element>& array) {
  return {reinterpret_cast<const uint8_t*>(array.data()), array.size() * sizeof(Element)};
}

// Edits the header of a file and signs it again.
std::vector<uint8_t> withHeader(std::vector<uint8_t> bytes, const std::function<void(FileHeader&)>& edit);
// Edits fixed-size fields of the manifest in place and signs again; nothing else is brought into line.
std::vector<uint8_t> withChunk(std::vector<uint8_t> bytes, const std::function<void(fb::Chunk&)>& edit);
std::vector<uint8_t> withSection(std::vector<uint8_t> bytes, size_t index,
                                 const std::function<void(fb::Section&)>& edit);
// Sets the hashes of sections, manifest and header to what the bytes are, as far as these can be found.
std::vector<uint8_t> signedAgain(std::vector<uint8_t> bytes);

std::vector<uint8_t> encodeOrFail(const AssetContents& contents);
// Opens and reads all chunks.
Result<AssetContents> decodeAsset(std::span<const uint8_t> bytes, Layer last = Layer::kViewDependence);

}  // namespace froth
