#include "format/read/asset_reader.h"

#include <cstring>
#include <optional>
#include <vector>

#include "base/float_span.h"
#include "base/input_file.h"
#include "format/checks.h"
#include "format/container.h"
#include "format/read/chunk_sections_read.h"
#include "format/read/manifest_read.h"
#include "format/read/section_codec_read.h"

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
  Result<std::span<const uint8_t>> view(uint64_t offset, uint64_t length, std::vector<uint8_t>& storage) const {
    if (offset > size || length > size - offset) {
      return makeError(ErrorKind::kBadInput, "%s: %llu bytes at byte %llu do not lie within the file's %llu; %s",
                       name.c_str(), ull{length}, ull{offset}, ull{size}, kNoAsset);
    }
    if (!file) return memory.subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
    storage.resize(static_cast<size_t>(length));
    if (Status status = file->readAt(offset, storage); !status) return status.error();
    return std::span<const uint8_t>(storage);
  }
};

Status checkHeader(const FileHeader& header, const Source& source) {
  const char* name = source.name.c_str();
  if (header.magic != kFileMagic) return makeError(ErrorKind::kBadInput, "%s: wrong magic bytes; %s", name, kNoAsset);
  if (!hashMatches({reinterpret_cast<const uint8_t*>(&header), offsetof(FileHeader, headerHash)}, header.headerHash)) {
    return makeError(ErrorKind::kBadInput, "%s: header: hash does not match; %s", name, kNoAsset);
  }
  if (header.versionMajor != kVersionMajor) {
    return makeError(ErrorKind::kUnsupported, "%s: format version %u.%u, this program reads %u; %s", name,
                     header.versionMajor, header.versionMinor, kVersionMajor,
                     header.versionMajor < kVersionMajor ? "bake the scene again" : "update this program");
  }
  if (header.reserved0 != 0 || header.reserved1 != 0) {
    return makeError(ErrorKind::kUnsupported, "%s: header: reserved bytes are not zero; update this program", name);
  }
  if (header.fileSize != source.size) {
    return makeError(ErrorKind::kBadInput, "%s: %llu bytes long, its header says %llu; copy it again", name,
                     ull{source.size}, ull{header.fileSize});
  }
  if (header.manifestOffset != sizeof(FileHeader)) {
    return makeError(ErrorKind::kBadInput, "%s: header: manifest at byte %llu, not %zu; %s", name,
                     ull{header.manifestOffset}, sizeof(FileHeader), kNoAsset);
  }
  if (header.manifestSize > kMaxManifestSize) {
    return makeError(ErrorKind::kBadInput, "%s: header: manifest of %llu bytes, more than %llu; %s", name,
                     ull{header.manifestSize}, ull{kMaxManifestSize}, kNoAsset);
  }
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
  if (!hashMatches(*bytes, header.manifestHash)) {
    return makeError(ErrorKind::kBadInput, "%s: manifest: hash does not match; copy it again or bake the scene again",
                     source.name.c_str());
  }
  const std::vector<uint8_t> aligned(bytes->begin(), bytes->end());
  return parseManifest(aligned, header.manifestOffset + header.manifestSize, source.size, source.name);
}

// What a reader of the first layers sees.
AssetContents coarsened(AssetContents contents, Layer last) {
  if (last == Layer::kGeometry) contents.detailCount = 1;
  if (last != Layer::kViewDependence) {
    contents.lobeCount = 0;
    contents.axisCodebook.clear();
  }
  return contents;
}

}  // namespace

struct AssetReader::State {
  Source source;
  Manifest manifest;       // of the file
  AssetContents contents;  // what the chosen layers make of it
  Layer last = Layer::kViewDependence;

  // Thread-safe, as the source is.
  Status decode(const SectionRecord& record, std::span<uint8_t> raw, const std::string& place) const {
    std::vector<uint8_t> storage;
    Result<std::span<const uint8_t>> stored = source.view(record.offset, record.storedSize, storage);
    if (!stored) return stored.error();
    const uint32_t components =
        sectionComponents(static_cast<SectionType>(record.type), manifest.contents.quantization);
    return decodeSection(record, *stored, raw, sectionPlace(place, record.type), {record.elementSize, components});
  }

  Status readCodebook() {
    const SectionRecord* record = manifest.findSection(kSharedChunk, SectionType::kAxisCodebook);
    if (!record || last != Layer::kViewDependence) return {};
    std::vector<glm::vec3>& codebook = manifest.contents.axisCodebook;
    codebook.resize(manifest.codebookSize);
    const std::span<uint8_t> raw{reinterpret_cast<uint8_t*>(codebook.data()), codebook.size() * sizeof(glm::vec3)};
    if (Status status = decode(*record, raw, chunkPlace(source.name, kSharedChunk)); !status) return status;
    manifest.codebookStep = commonStep(floatsOf(codebook));
    return checkParameters(manifest.contents, source.name);
  }

  Status start(Layer lastLayer) {
    last = lastLayer;
    Result<Manifest> found = readManifest(source);
    if (!found) return found.error();
    manifest = std::move(*found);
    if (Status status = readCodebook(); !status) return status;
    contents = coarsened(manifest.contents, last);
    return {};
  }
};

AssetReader::AssetReader() : state_(std::make_unique<State>()) {}
AssetReader::AssetReader(AssetReader&&) noexcept = default;
AssetReader& AssetReader::operator=(AssetReader&&) noexcept = default;
AssetReader::~AssetReader() = default;

Result<AssetReader> AssetReader::open(const std::filesystem::path& path, Layer last) {
  Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  AssetReader reader;
  Source& source = reader.state_->source;
  source.name = file->name();
  source.size = file->size();
  source.file = std::move(*file);
  if (Status status = reader.state_->start(last); !status) return status.error();
  return reader;
}

Result<AssetReader> AssetReader::openBytes(std::span<const uint8_t> bytes, std::string name, Layer last) {
  AssetReader reader;
  Source& source = reader.state_->source;
  source.name = std::move(name);
  source.size = bytes.size();
  source.memory = bytes;
  if (Status status = reader.state_->start(last); !status) return status.error();
  return reader;
}

const AssetContents& AssetReader::manifest() const { return state_->contents; }

Box AssetReader::liveBounds(uint32_t chunk) const { return state_->manifest.chunks[chunk].liveBounds; }

std::span<const SectionRecord> AssetReader::sections() const { return state_->manifest.sections; }

Result<CodedChunk> AssetReader::readCodedChunk(uint32_t chunk) const {
  const State& state = *state_;
  if (chunk >= state.contents.chunks.size()) {
    return makeError(ErrorKind::kUsage, "%s: chunk %u asked for, there are %zu", state.source.name.c_str(), chunk,
                     state.contents.chunks.size());
  }
  const std::string place = chunkPlace(state.source.name, chunk);
  const SectionDecoder decode = [&](const SectionRecord& record, std::span<uint8_t> raw) {
    return state.decode(record, raw, place);
  };
  Result<CodedChunk> coded = unpackChunk(state.manifest, chunk, state.last, decode, place);
  if (!coded) return coded;
  const ChunkContents& contents = coded->contents;
  if (Status status = checkChunk(state.contents, contents, place); !status) return status.error();
  if (Status status = checkGhostRefs(state.contents, state.manifest.chunks, chunk, contents.ghostRefs, place);
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
