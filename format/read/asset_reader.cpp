#include "format/read/asset_reader.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/input_file.h"
#include "format/checks.h"
#include "format/read/asset_opener.h"
#include "format/read/chunk_sections_read.h"

namespace froth {
namespace {

class FileBytes final : public ByteSource {
 public:
  explicit FileBytes(InputFile file) : file_(std::move(file)) {}
  Result<std::span<const uint8_t>> view(ByteRange range, std::vector<uint8_t>& storage) const override {
    storage.resize(static_cast<size_t>(range.size));
    if (Status status = file_.readAt(range.offset, storage); !status) return status.error();
    return std::span<const uint8_t>(storage);
  }

 private:
  InputFile file_;
};

class MemoryBytes final : public ByteSource {
 public:
  explicit MemoryBytes(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  Result<std::span<const uint8_t>> view(ByteRange range, std::vector<uint8_t>&) const override {
    return bytes_.subspan(static_cast<size_t>(range.offset), static_cast<size_t>(range.size));
  }

 private:
  std::span<const uint8_t> bytes_;
};

Result<AssetReader> openSource(std::shared_ptr<const ByteSource> source, std::string name, uint64_t size, Layer last) {
  AssetOpener opener(std::move(name), size, last);
  while (opener.wanted()) {
    std::vector<uint8_t> storage;
    const Result<std::span<const uint8_t>> bytes = source->view(*opener.wanted(), storage);
    if (!bytes) return bytes.error();
    if (Status status = opener.take(*bytes); !status) return status.error();
  }
  return AssetReader(opener.finish(), std::move(source));
}

}  // namespace

struct AssetReader::State {
  AssetHead head;
  std::shared_ptr<const ByteSource> source;  // may be null
};

AssetReader::AssetReader(AssetHead head, std::shared_ptr<const ByteSource> source)
    : state_(new State{std::move(head), std::move(source)}) {}
AssetReader::AssetReader(AssetReader&&) noexcept = default;
AssetReader& AssetReader::operator=(AssetReader&&) noexcept = default;
AssetReader::~AssetReader() = default;

Result<AssetReader> AssetReader::open(const std::filesystem::path& path, Layer last) {
  Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  std::string name = file->name();
  const uint64_t size = file->size();
  return openSource(std::make_shared<FileBytes>(std::move(*file)), std::move(name), size, last);
}

Result<AssetReader> AssetReader::openBytes(std::span<const uint8_t> bytes, std::string name, Layer last) {
  return openSource(std::make_shared<MemoryBytes>(bytes), std::move(name), bytes.size(), last);
}

const AssetContents& AssetReader::manifest() const { return state_->head.contents; }

Box AssetReader::liveBounds(uint32_t chunk) const { return state_->head.manifest.chunks[chunk].liveBounds; }

std::span<const SectionRecord> AssetReader::sections() const { return state_->head.manifest.sections; }

const std::shared_ptr<const ByteSource>& AssetReader::source() const { return state_->source; }

std::vector<ByteRange> AssetReader::rangesOf(uint32_t chunk) const {
  std::vector<ByteRange> ranges;
  for (const SectionType type : allSectionTypes()) {
    const SectionRecord* record = state_->head.manifest.findSection(chunk, type);
    if (record && sectionLayer(type) <= state_->head.last) ranges.push_back({record->offset, record->storedSize});
  }
  std::ranges::sort(ranges, {}, &ByteRange::offset);
  size_t count = 0;
  for (const ByteRange& range : ranges) {
    const bool touches = count > 0 && ranges[count - 1].offset + ranges[count - 1].size == range.offset;
    if (touches) {
      ranges[count - 1].size += range.size;
    } else {
      ranges[count++] = range;
    }
  }
  ranges.resize(count);
  return ranges;
}

Result<CodedChunk> AssetReader::readCodedChunk(uint32_t chunk, const ByteSource& bytes) const {
  const AssetHead& head = state_->head;
  if (chunk >= head.contents.chunks.size()) {
    return makeError(ErrorKind::kUsage, "%s: chunk %u asked for, there are %zu", head.name.c_str(), chunk,
                     head.contents.chunks.size());
  }
  const std::string place = chunkPlace(head.name, chunk);
  const SectionDecoder decode = [&](const SectionRecord& record, std::span<uint8_t> raw) -> Status {
    std::vector<uint8_t> storage;
    const Result<std::span<const uint8_t>> stored = bytes.view({record.offset, record.storedSize}, storage);
    return stored ? decodeStored(head.manifest, record, *stored, raw, place) : stored.error();
  };
  Result<CodedChunk> coded = unpackChunk(head.manifest, chunk, head.last, decode, place);
  if (!coded) return coded;
  const ChunkContents& contents = coded->contents;
  if (Status status = checkChunk(head.contents, contents, place); !status) return status.error();
  if (Status status = checkReferences(head.contents, head.manifest.chunks, chunk, contents.ghostRefs,
                                      contents.borderNumbers, place);
      !status) {
    return status.error();
  }
  return coded;
}

Result<ChunkContents> AssetReader::readChunk(uint32_t chunk) const {
  Result<CodedChunk> coded = readCodedChunk(chunk);
  if (!coded) return coded.error();
  return std::move(coded->contents);
}

Result<AssetContents> readAsset(const std::filesystem::path& path, Layer last) {
  Result<AssetReader> reader = AssetReader::open(path, last);
  if (!reader) return reader.error();
  AssetContents contents = reader->manifest();
  for (uint32_t chunk = 0; chunk < contents.chunks.size(); ++chunk) {
    Result<ChunkContents> decoded = reader->readChunk(chunk);
    if (!decoded) return decoded.error();
    contents.chunks[chunk] = std::move(*decoded);
  }
  return contents;
}

}  // namespace froth
