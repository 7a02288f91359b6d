#include "format/asset_writer.h"

#include <algorithm>
#include <cstring>

#include "format/atomic_file.h"
#include "format/checks.h"
#include "format/container.h"
#include "format/manifest_write.h"
#include "format/section_codec_write.h"

namespace froth {
namespace {

constexpr char kContents[] = "contents to be written";  // stands for the file in messages of checks

struct Sections {
  std::vector<SectionRecord> records;
  std::vector<std::vector<uint8_t>> stored;  // [records]
};

// Encodes the arrays of one chunk that hold anything.
class SectionEncoder {
 public:
  SectionEncoder(uint32_t chunk, Sections& sections) : chunk_(chunk), sections_(sections) {}

  template <class Element>
  void operator()(SectionType type, const std::vector<Element>& array) {
    if (!status_ || array.empty() || isAbsent(type, array)) return;
    const std::span<const uint8_t> raw{reinterpret_cast<const uint8_t*>(array.data()),
                                       array.size() * sizeof(Element)};
    Result<EncodedSection> section = encodeSection(raw);
    if (!section) {
      status_ = section.error();
      return;
    }
    SectionRecord record;
    record.type = static_cast<uint32_t>(type);
    record.chunk = chunk_;
    record.flags = kSectionCritical;
    record.codec = static_cast<uint16_t>(section->codec);
    record.storedSize = section->stored.size();
    record.rawSize = raw.size();
    record.hash = hashBytes(section->stored);
    sections_.records.push_back(record);
    sections_.stored.push_back(std::move(section->stored));
  }

  const Status& status() const { return status_; }

 private:
  template <class Element>
  static bool isAbsent(SectionType type, const std::vector<Element>& array) {
    if constexpr (std::is_same_v<Element, float>)
      return type == SectionType::kDetailHeights &&
             std::all_of(array.begin(), array.end(), [](float height) { return height == 0; });
    return false;
  }

  uint32_t chunk_;
  Sections& sections_;
  Status status_;
};

template <class Pod>
std::span<const uint8_t> bytesOf(const Pod& pod) {
  return {reinterpret_cast<const uint8_t*>(&pod), sizeof(Pod)};
}

// Header, manifest, sections, one after the other. Frees sections.stored as it goes: most of the memory.
std::vector<uint8_t> assemble(const AssetContents& contents, Sections& sections) {
  FileHeader header;
  header.magic = kFileMagic;
  header.versionMajor = kVersionMajor;
  header.versionMinor = kVersionMinor;
  header.manifestOffset = sizeof(FileHeader);
  header.manifestSize = buildManifest(contents, sections.records).size();
  header.fileSize = header.manifestOffset + header.manifestSize;
  for (SectionRecord& record : sections.records) {
    record.offset = header.fileSize;
    header.fileSize += record.storedSize;
  }
  const std::vector<uint8_t> manifest = buildManifest(contents, sections.records);
  header.manifestHash = hashBytes(manifest);
  header.headerHash = hashHeader(header);

  std::vector<uint8_t> file;
  file.reserve(header.fileSize);
  const auto append = [&file](std::span<const uint8_t> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
  };
  append(bytesOf(header));
  append(manifest);
  for (std::vector<uint8_t>& stored : sections.stored) {
    append(stored);
    std::vector<uint8_t>().swap(stored);
  }
  return file;
}

}  // namespace

Result<std::vector<uint8_t>> encodeAsset(const AssetContents& contents) {
  if (Status status = checkParameters(contents, kContents); !status) return status.error();
  Sections sections;
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    const ChunkContents& chunk = contents.chunks[index];
    if (Status status = checkChunk(contents, index, chunk, kContents); !status) return status.error();
    SectionEncoder encoder(index, sections);
    visitSections(chunk, encoder);
    if (!encoder.status()) return encoder.status().error();
  }
  return assemble(contents, sections);
}

Status writeAsset(const std::filesystem::path& path, const AssetContents& contents) {
  Result<std::vector<uint8_t>> bytes = encodeAsset(contents);
  if (!bytes) return bytes.error();
  return writeFileAtomically(path, *bytes);
}

}  // namespace froth
