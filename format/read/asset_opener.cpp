#include "format/read/asset_opener.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/float_span.h"
#include "format/checks.h"
#include "format/container.h"
#include "format/read/section_codec_read.h"

namespace froth {
namespace {

constexpr char kNoAsset[] = "this is no .froth asset, or a damaged one";

// Read before anything is known: the whole head of an asset of some forty chunks [bytes].
constexpr uint64_t kFirstRead = 64u << 10;

using ull = unsigned long long;

Status checkHeader(const FileHeader& header, const AssetHead& head) {
  const char* name = head.name.c_str();
  if (header.magic != kFileMagic) return makeError(ErrorKind::kBadInput, "%s: wrong magic bytes; %s", name, kNoAsset);
  if (!hashMatches({reinterpret_cast<const uint8_t*>(&header), offsetof(FileHeader, headerHash)}, header.headerHash)) {
    return makeError(ErrorKind::kBadInput, "%s: header: hash does not match; %s", name, kNoAsset);
  }
  if (header.versionMajor < kOldestMajor || header.versionMajor > kVersionMajor) {
    return makeError(ErrorKind::kUnsupported, "%s: format version %u.%u, this program reads %u and %u; %s", name,
                     header.versionMajor, header.versionMinor, kOldestMajor, kVersionMajor,
                     header.versionMajor < kOldestMajor ? "bake the scene again" : "update this program");
  }
  if (header.reserved0 != 0 || header.reserved1 != 0) {
    return makeError(ErrorKind::kUnsupported, "%s: header: reserved bytes are not zero; update this program", name);
  }
  if (header.fileSize != head.size) {
    return makeError(ErrorKind::kBadInput, "%s: %llu bytes long, its header says %llu; copy it again", name,
                     ull{head.size}, ull{header.fileSize});
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

Status checkWithin(const AssetHead& head, uint64_t offset, uint64_t size) {
  if (offset <= head.size && size <= head.size - offset) return {};
  return makeError(ErrorKind::kBadInput, "%s: %llu bytes at byte %llu do not lie within the file's %llu; %s",
                   head.name.c_str(), ull{size}, ull{offset}, ull{head.size}, kNoAsset);
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

AssetOpener::AssetOpener(std::string name, uint64_t size, Layer last) : wanted_({0, std::min(size, kFirstRead)}) {
  head_.name = std::move(name);
  head_.size = size;
  head_.last = last;
}

Status AssetOpener::take(std::span<const uint8_t> bytes) {
  wanted_.reset();
  if (awaitedBook_) return takeCodebook(*awaitedBook_, bytes);
  start_.insert(start_.end(), bytes.begin(), bytes.end());
  return takeStart();
}

Status AssetOpener::takeStart() {
  if (Status status = checkWithin(head_, 0, sizeof(FileHeader)); !status) return status;
  FileHeader header;
  std::memcpy(&header, start_.data(), sizeof(header));
  if (Status status = checkHeader(header, head_); !status) return status;
  if (Status status = checkWithin(head_, header.manifestOffset, header.manifestSize); !status) return status;
  const uint64_t manifestEnd = header.manifestOffset + header.manifestSize;
  if (start_.size() < manifestEnd) {
    wanted_ = {start_.size(), manifestEnd - start_.size()};
    return {};
  }
  return takeManifest(manifestEnd, header.manifestHash);
}

Status AssetOpener::takeManifest(uint64_t manifestEnd, uint64_t expectedHash) {
  const std::vector<uint8_t> start = std::move(start_);
  // Aligned for FlatBuffers, as the memory of the vector and the size of the header are.
  const std::span<const uint8_t> bytes =
      std::span(start).subspan(sizeof(FileHeader), static_cast<size_t>(manifestEnd) - sizeof(FileHeader));
  if (!hashMatches(bytes, expectedHash)) {
    return makeError(ErrorKind::kBadInput, "%s: manifest: hash does not match; copy it again or bake the scene again",
                     head_.name.c_str());
  }
  Result<Manifest> manifest = parseManifest(bytes, manifestEnd, head_.size, head_.name);
  if (!manifest) return manifest.error();
  head_.manifest = std::move(*manifest);
  head_.contents = coarsened(head_.manifest.contents, head_.last);
  const SectionRecord* book = head_.manifest.findSection(kSharedChunk, SectionType::kAxisCodebook);
  if (!book || head_.last != Layer::kViewDependence) return {};
  if (book->offset + book->storedSize <= start.size()) {
    return takeCodebook(
        *book, std::span(start).subspan(static_cast<size_t>(book->offset), static_cast<size_t>(book->storedSize)));
  }
  awaitedBook_ = *book;
  wanted_ = {book->offset, book->storedSize};
  return {};
}

Status AssetOpener::takeCodebook(const SectionRecord& record, std::span<const uint8_t> stored) {
  Manifest& manifest = head_.manifest;
  std::vector<glm::vec3>& codebook = manifest.contents.axisCodebook;
  codebook.resize(manifest.codebookSize);
  const std::span<uint8_t> raw{reinterpret_cast<uint8_t*>(codebook.data()), codebook.size() * sizeof(glm::vec3)};
  const std::string place = chunkPlace(head_.name, kSharedChunk);
  if (Status status = decodeStored(manifest, record, stored, raw, place); !status) return status;
  manifest.codebookStep = commonStep(floatsOf(codebook));
  if (Status status = checkParameters(manifest.contents, head_.name); !status) return status;
  head_.contents.axisCodebook = codebook;
  return {};
}

Status decodeStored(const Manifest& manifest, const SectionRecord& record, std::span<const uint8_t> stored,
                    std::span<uint8_t> raw, const std::string& place) {
  const uint32_t components = sectionComponents(static_cast<SectionType>(record.type), manifest.contents.quantization);
  return decodeSection(record, stored, raw, sectionPlace(place, record.type), {record.elementSize, components});
}

}  // namespace froth
