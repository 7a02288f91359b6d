#include "format/asset_reader.h"

#include <cstring>
#include <optional>
#include <vector>

#include "format/checks.h"
#include "format/container.h"
#include "format/input_file.h"
#include "format/manifest_read.h"
#include "format/section_codec_read.h"

namespace froth {
namespace {

constexpr char kNoAsset[] = "this is no .froth asset, or a damaged one";

using ull = unsigned long long;

// The asset's bytes: an open file, or memory of the caller.
struct Source {
  std::string name;
  uint64_t size = 0;
  std::optional<InputFile> file;
  std::span<const uint8_t> memory;  // if there is no file

  // A range of the bytes; `storage` holds them if they must be read.
  Result<std::span<const uint8_t>> view(uint64_t offset, uint64_t length,
                                        std::vector<uint8_t>& storage) const {
    if (offset > size || length > size - offset)
      return makeError(ErrorKind::kBadInput,
                       "%s: %llu bytes at byte %llu do not lie within the file's %llu; %s", name.c_str(),
                       ull{length}, ull{offset}, ull{size}, kNoAsset);
    if (!file) return memory.subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
    storage.resize(static_cast<size_t>(length));
    if (Status status = file->readAt(offset, storage); !status) return status.error();
    return std::span<const uint8_t>(storage);
  }
};

Status checkHeader(const FileHeader& header, const Source& source) {
  const char* name = source.name.c_str();
  if (header.magic != kFileMagic)
    return makeError(ErrorKind::kBadInput, "%s: wrong magic bytes; %s", name, kNoAsset);
  if (!hashMatches({reinterpret_cast<const uint8_t*>(&header), offsetof(FileHeader, headerHash)},
                   header.headerHash))
    return makeError(ErrorKind::kBadInput, "%s: header: hash does not match; %s", name, kNoAsset);
  if (header.versionMajor != kVersionMajor)
    return makeError(ErrorKind::kUnsupported,
                     "%s: format version %u.%u, this program reads %u; update the older one", name,
                     header.versionMajor, header.versionMinor, kVersionMajor);
  if (header.reserved0 != 0 || header.reserved1 != 0)
    return makeError(ErrorKind::kUnsupported, "%s: header: reserved bytes are not zero; update this program",
                     name);
  if (header.fileSize != source.size)
    return makeError(ErrorKind::kBadInput, "%s: %llu bytes long, its header says %llu; copy it again", name,
                     ull{source.size}, ull{header.fileSize});
  if (header.manifestOffset != sizeof(FileHeader))
    return makeError(ErrorKind::kBadInput, "%s: header: manifest at byte %llu, not %zu; %s", name,
                     ull{header.manifestOffset}, sizeof(FileHeader), kNoAsset);
  if (header.manifestSize > kMaxManifestSize)
    return makeError(ErrorKind::kBadInput, "%s: header: manifest of %llu bytes, more than %llu; %s", name,
                     ull{header.manifestSize}, ull{kMaxManifestSize}, kNoAsset);
  return {};
}

Result<Manifest> readManifest(const Source& source) {
  std::vector<uint8_t> storage;
  Result<std::span<const uint8_t>> start = source.view(0, sizeof(FileHeader), storage);
  if (!start) return start.error();
  FileHeader header;
  std::memcpy(&header, start->data(), sizeof(header));
  if (Status status = checkHeader(header, source); !status) return status.error();

  Result<std::span<const uint8_t>> bytes = source.view(header.manifestOffset, header.manifestSize, storage);
  if (!bytes) return bytes.error();
  if (!hashMatches(*bytes, header.manifestHash))
    return makeError(ErrorKind::kBadInput,
                     "%s: manifest: hash does not match; copy it again or bake the scene again",
                     source.name.c_str());
  const std::vector<uint8_t> aligned(bytes->begin(), bytes->end());
  return parseManifest(aligned, header.manifestOffset + header.manifestSize, source.size, source.name);
}

// Decodes the sections of one chunk into its arrays.
class SectionReader {
 public:
  SectionReader(const Source& source, const Manifest& manifest, uint32_t chunk)
      : source_(source), manifest_(manifest), chunk_(chunk) {}

  template <class Element>
  void operator()(SectionType type, std::vector<Element>& array) {
    const SectionRecord* record = manifest_.findSection(chunk_, type);
    if (!status_ || !record) return;
    Result<std::span<const uint8_t>> stored = source_.view(record->offset, record->storedSize, storage_);
    if (!stored) {
      status_ = stored.error();
      return;
    }
    // The manifest's check has tied rawSize to the counts, and so to a whole number of elements.
    array.resize(static_cast<size_t>(record->rawSize / sizeof(Element)));
    status_ = decodeSection(*record, *stored,
                            {reinterpret_cast<uint8_t*>(array.data()), array.size() * sizeof(Element)},
                            sectionPlace(source_.name, chunk_, record->type));
  }

  const Status& status() const { return status_; }

 private:
  const Source& source_;
  const Manifest& manifest_;
  uint32_t chunk_;
  std::vector<uint8_t> storage_;
  Status status_;
};

}  // namespace

struct AssetReader::State {
  Source source;
  Manifest manifest;
};

AssetReader::AssetReader() : state_(std::make_unique<State>()) {}
AssetReader::AssetReader(AssetReader&&) noexcept = default;
AssetReader& AssetReader::operator=(AssetReader&&) noexcept = default;
AssetReader::~AssetReader() = default;

Result<AssetReader> AssetReader::open(const std::filesystem::path& path, Layer) {
  Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  AssetReader reader;
  Source& source = reader.state_->source;
  source.name = file->name();
  source.size = file->size();
  source.file = std::move(*file);
  Result<Manifest> manifest = readManifest(source);
  if (!manifest) return manifest.error();
  reader.state_->manifest = std::move(*manifest);
  return reader;
}

Result<AssetReader> AssetReader::openBytes(std::span<const uint8_t> bytes, std::string name, Layer) {
  AssetReader reader;
  Source& source = reader.state_->source;
  source.name = std::move(name);
  source.size = bytes.size();
  source.memory = bytes;
  Result<Manifest> manifest = readManifest(source);
  if (!manifest) return manifest.error();
  reader.state_->manifest = std::move(*manifest);
  return reader;
}

const AssetContents& AssetReader::manifest() const {
  return state_->manifest.contents;
}

Box AssetReader::liveBounds(uint32_t chunk) const {
  return state_->manifest.chunks[chunk].liveBounds;
}

Result<ChunkContents> AssetReader::readChunk(uint32_t chunk) const {
  const AssetContents& asset = state_->manifest.contents;
  if (chunk >= asset.chunks.size())
    return makeError(ErrorKind::kUsage, "%s: chunk %u asked for, there are %zu", state_->source.name.c_str(),
                     chunk, asset.chunks.size());
  ChunkContents contents = asset.chunks[chunk];
  SectionReader sections(state_->source, state_->manifest, chunk);
  visitSections(contents, sections);
  if (!sections.status()) return sections.status().error();
  if (Status status = checkChunk(asset, chunk, contents, state_->source.name); !status) return status.error();
  return contents;
}

Result<AssetContents> readAsset(const std::filesystem::path& path, Layer) {
  Result<AssetReader> reader = AssetReader::open(path);
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
