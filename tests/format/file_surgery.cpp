#include "file_surgery.h"

#include <cstring>

#include <gtest/gtest.h>

#include "format/read/manifest_read.h"
#include "format/write/asset_writer.h"
#include "format/write/manifest_write.h"
#include "format/write/section_codec_write.h"

namespace froth {
namespace {

FileHeader headerOf(const std::vector<uint8_t>& bytes) {
  FileHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  return header;
}

void setHeader(std::vector<uint8_t>& bytes, FileHeader header) {
  header.headerHash = hashHeader(header);
  std::memcpy(bytes.data(), &header, sizeof(header));
}

std::span<uint8_t> manifestOf(std::vector<uint8_t>& bytes) {
  return std::span<uint8_t>(bytes).subspan(sizeof(FileHeader), headerOf(bytes).manifestSize);
}

void signManifest(std::vector<uint8_t>& bytes) {
  FileHeader header = headerOf(bytes);
  header.manifestHash = hashBytes(manifestOf(bytes));
  setHeader(bytes, header);
}

// The vectors of structs are edited where they lie.
fb::Section& sectionAt(std::vector<uint8_t>& bytes, size_t index) {
  const fb::Manifest* manifest = fb::GetManifest(manifestOf(bytes).data());
  return const_cast<fb::Section&>(*manifest->sections()->Get(static_cast<flatbuffers::uoffset_t>(index)));
}

}  // namespace

size_t Draft::find(SectionType type, uint32_t chunk) const {
  for (size_t i = 0; i < records.size(); ++i) {
    if (records[i].type == static_cast<uint32_t>(type) && records[i].chunk == chunk) return i;
  }
  ADD_FAILURE() << "no section " << sectionName(static_cast<uint32_t>(type));
  return 0;
}

void Draft::replace(SectionType type, std::span<const uint8_t> raw) {
  const size_t index = find(type);
  const uint32_t components = sectionComponents(type, contents.quantization);
  Result<EncodedSection> section = encodeSection(raw, {records[index].elementSize, components});
  ASSERT_TRUE(section);
  records[index].codec = static_cast<uint16_t>(section->codec);
  records[index].rawSize = raw.size();
  stored[index] = section->stored;
}

void Draft::add(const SectionRecord& record, std::vector<uint8_t> bytes) {
  records.push_back(record);
  stored.push_back(std::move(bytes));
}

std::vector<uint8_t> Draft::assemble() const {
  std::vector<SectionRecord> placed = records;
  FileHeader header;
  header.magic = kFileMagic;
  header.versionMajor = kVersionMajor;
  header.manifestOffset = sizeof(FileHeader);
  header.manifestSize = buildManifest(contents, chunks, placed).size();
  header.fileSize = header.manifestOffset + header.manifestSize;
  for (size_t i = 0; i < placed.size(); ++i) {
    placed[i].offset = header.fileSize;
    placed[i].storedSize = stored[i].size();
    placed[i].hash = hashBytes(stored[i]);
    header.fileSize += stored[i].size();
  }
  std::vector<uint8_t> bytes(sizeof(FileHeader));
  const std::vector<uint8_t> manifest = buildManifest(contents, chunks, placed);
  bytes.insert(bytes.end(), manifest.begin(), manifest.end());
  for (const std::vector<uint8_t>& section : stored) bytes.insert(bytes.end(), section.begin(), section.end());
  setHeader(bytes, header);
  signManifest(bytes);
  return bytes;
}

Draft draftOf(const AssetContents& contents) {
  std::vector<uint8_t> bytes = encodeOrFail(contents);
  const std::span<const uint8_t> packed = manifestOf(bytes);
  Result<Manifest> manifest =
      parseManifest({packed.begin(), packed.end()}, sizeof(FileHeader) + packed.size(), bytes.size(), "draft");
  Draft draft{contents, manifest->chunks, manifest->sections, {}};
  for (const SectionRecord& record : draft.records) {
    const uint8_t* first = bytes.data() + record.offset;
    draft.stored.emplace_back(first, first + record.storedSize);
  }
  return draft;
}

std::vector<uint8_t> withHeader(std::vector<uint8_t> bytes, const std::function<void(FileHeader&)>& edit) {
  FileHeader header = headerOf(bytes);
  edit(header);
  setHeader(bytes, header);
  return bytes;
}

std::vector<uint8_t> withChunk(std::vector<uint8_t> bytes, const std::function<void(fb::Chunk&)>& edit) {
  edit(const_cast<fb::Chunk&>(*fb::GetManifest(manifestOf(bytes).data())->chunks()->Get(0)));
  signManifest(bytes);
  return bytes;
}

std::vector<uint8_t> withSection(std::vector<uint8_t> bytes, size_t index,
                                 const std::function<void(fb::Section&)>& edit) {
  edit(sectionAt(bytes, index));
  signManifest(bytes);
  return bytes;
}

std::vector<uint8_t> signedAgain(std::vector<uint8_t> bytes) {
  const FileHeader header = headerOf(bytes);
  if (header.manifestSize > bytes.size() - sizeof(FileHeader)) return bytes;
  const std::span<uint8_t> manifest = manifestOf(bytes);
  flatbuffers::Verifier verifier(manifest.data(), manifest.size());
  if (fb::VerifyManifestBuffer(verifier)) {
    const auto* sections = fb::GetManifest(manifest.data())->sections();
    const bool isAligned = reinterpret_cast<uintptr_t>(sections->Data()) % alignof(fb::Section) == 0;
    for (size_t i = 0; isAligned && i < sections->size(); ++i) {
      fb::Section& s = sectionAt(bytes, i);
      if (s.offset() > bytes.size() || s.stored_size() > bytes.size() - s.offset()) continue;
      const uint64_t hash = hashBytes({bytes.data() + s.offset(), static_cast<size_t>(s.stored_size())});
      s = fb::Section(s.type(), s.chunk(), s.flags(), s.codec(), s.element_size(), s.reserved0(), s.base(),
                      s.reserved1(), s.offset(), s.stored_size(), s.raw_size(), hash);
    }
  }
  signManifest(bytes);
  return bytes;
}

std::vector<uint8_t> encodeOrFail(const AssetContents& contents) {
  Result<std::vector<uint8_t>> bytes = encodeAsset(contents);
  if (bytes) return *bytes;
  ADD_FAILURE() << bytes.error().message;
  return {};
}

Result<AssetContents> decodeAsset(std::span<const uint8_t> bytes, Layer last) {
  Result<AssetReader> reader = AssetReader::openBytes(bytes, "scene.froth", last);
  if (!reader) return reader.error();
  AssetContents contents = reader->manifest();
  for (uint32_t i = 0; i < contents.chunks.size(); ++i) {
    Result<ChunkContents> chunk = reader->readChunk(i);
    if (!chunk) return chunk.error();
    contents.chunks[i] = std::move(*chunk);
  }
  return contents;
}

}  // namespace froth
