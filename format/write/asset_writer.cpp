#include "format/write/asset_writer.h"

#include <array>
#include <utility>

#include "base/temporary_file.h"
#include "format/checks.h"
#include "format/container.h"
#include "format/write/asset_layout.h"
#include "format/write/chunk_sections_write.h"
#include "format/write/section_codec_write.h"

namespace froth {
namespace {

constexpr char kContents[] = "contents to be written";  // stands for the file in messages of checks

using ull = unsigned long long;

Result<StoredSection> encodeRaw(RawSection raw, uint32_t chunk, const ChunkCounts& counts,
                                const Quantization& quantization) {
  const uint32_t components = sectionComponents(raw.type, quantization);
  Result<EncodedSection> encoded = EncodedSection{};
  if (sectionKind(raw.type, quantization) == ElementKind::kInt32) {
    std::vector<uint32_t> runs;  // live cells and other cells, or ghosts
    const bool isOwn = raw.type == SectionType::kSites;
    for (const uint64_t run : {isOwn ? counts.live : counts.ghosts, isOwn ? counts.cells - counts.live : 0}) {
      if (run > 0) runs.push_back(static_cast<uint32_t>(run));
    }
    encoded = encodePositions(raw.bytes, runs);
  } else {
    encoded = encodeSection(raw.bytes, {raw.elementSize, components});
  }
  if (!encoded) return encoded.error();
  StoredSection section;
  section.record.type = static_cast<uint32_t>(raw.type);
  section.record.chunk = chunk;
  section.record.flags = kSectionCritical;
  section.record.codec = static_cast<uint16_t>(encoded->codec);
  section.record.elementSize = raw.elementSize;
  section.record.base = raw.base;
  section.record.storedSize = encoded->stored.size();
  section.record.rawSize = raw.bytes.size();
  section.record.hash = hashBytes(encoded->stored);
  section.stored = std::move(encoded->stored);
  return section;
}

// The highest reference into each chunk, of ascending ones.
std::vector<CellRef> highestRefs(const std::vector<CellRef>& refs, uint32_t localBits) {
  std::vector<CellRef> highest;
  for (const CellRef ref : refs) {
    if (!highest.empty() && chunkOf(highest.back(), localBits) == chunkOf(ref, localBits)) highest.pop_back();
    highest.push_back(ref);
  }
  return highest;
}

// What both ways of writing share: a header that was checked, and what is known of the chunks so far.
class AssetEncoder {
 public:
  static Result<AssetEncoder> create(const AssetContents& header) {
    if (Status status = checkParameters(header, kContents); !status) return status.error();
    return AssetEncoder(header);
  }

  Result<std::vector<uint8_t>> encodeCodebook() {
    if (header_.axisCodebook.empty()) return std::vector<uint8_t>{};
    const uint8_t* first = reinterpret_cast<const uint8_t*>(header_.axisCodebook.data());
    RawSection raw{
        SectionType::kAxisCodebook, sizeof(float), 0, {first, first + header_.axisCodebook.size() * sizeof(glm::vec3)}};
    Result<StoredSection> section = encodeRaw(std::move(raw), kSharedChunk, {}, header_.quantization);
    if (!section) return section.error();
    layout_.addSection(section->record);
    return std::move(section->stored);
  }

  Result<EncodedChunk> encode(const ChunkContents& chunk, const std::string& place,
                              const std::function<bool()>& isStopped) const {
    EncodedChunk encoded;
    encoded.index.origin = chunk.origin;
    if (Status status = checkChunk(header_, chunk, place); !status) return status.error();
    Result<RawChunk> raw = packChunk(header_, axes_, chunk, place);
    if (!raw) return raw.error();
    encoded.index.counts = raw->counts;
    encoded.index.liveBounds = liveBoundsOf(chunk);
    if (Status status = checkChunkIndex(header_, encoded.index, place); !status) return status.error();
    encoded.ghostRefs = highestRefs(chunk.ghostRefs, header_.localBits);
    for (RawSection& section : raw->sections) {
      if (isStopped && isStopped()) return makeError(ErrorKind::kCancelled, "encoding stopped on request");
      Result<StoredSection> stored = encodeRaw(std::move(section), 0, raw->counts, header_.quantization);
      if (!stored) return stored.error();
      encoded.sections.push_back(std::move(*stored));
    }
    return encoded;
  }

  // Its place in the file; the bytes go where `sink` puts those of their stream.
  template <class Sink>
  Status add(EncodedChunk& chunk, Sink sink) {
    const uint32_t index = static_cast<uint32_t>(layout_.chunks().size());
    layout_.addChunk(chunk.index);
    ghostRefs_.push_back(std::move(chunk.ghostRefs));
    for (StoredSection& section : chunk.sections) {
      section.record.chunk = index;
      layout_.addSection(section.record);
      if (Status status = sink(streamOf(section.record), std::move(section.stored)); !status) return status;
    }
    return {};
  }

  // Once all chunks are there. `header`: the one from the start, with what became known since.
  Result<AssetLayout::Head> finish(const AssetContents& header) const {
    if (Status status = checkParameters(header, kContents); !status) return status.error();
    if (Status status = checkChunkIndices(header, layout_.chunks(), kContents); !status) return status.error();
    for (uint32_t index = 0; index < ghostRefs_.size(); ++index) {
      if (Status status =
              checkGhostRefs(header, layout_.chunks(), index, ghostRefs_[index], chunkPlace(kContents, index));
          !status) {
        return status.error();
      }
    }
    return layout_.buildHead(header);
  }

 private:
  explicit AssetEncoder(const AssetContents& header) : axes_(header.axisCodebook, header.quantization.lobeAxisStep) {
    header_ = header;
    header_.chunks.clear();
  }

  AssetContents header_;
  AxisSearch axes_;
  AssetLayout layout_;
  std::vector<std::vector<CellRef>> ghostRefs_;  // [chunks]
};

}  // namespace

struct AssetStreamWriter::State {
  State(std::filesystem::path target, AssetEncoder assetEncoder)
      : path(std::move(target)), encoder(std::move(assetEncoder)) {}

  std::filesystem::path path;
  AssetEncoder encoder;
  std::vector<TemporaryFile> streams;  // [kStreamCount]
};

AssetStreamWriter::AssetStreamWriter() = default;
AssetStreamWriter::AssetStreamWriter(AssetStreamWriter&&) noexcept = default;
AssetStreamWriter& AssetStreamWriter::operator=(AssetStreamWriter&&) noexcept = default;
AssetStreamWriter::~AssetStreamWriter() = default;

Result<AssetStreamWriter> AssetStreamWriter::create(const std::filesystem::path& path, const AssetContents& header,
                                                    WriteProtected isProtected) {
  if (Status status = checkTarget(path, isProtected); !status) return status.error();
  Result<AssetEncoder> encoder = AssetEncoder::create(header);
  if (!encoder) return encoder.error();
  AssetStreamWriter writer;
  writer.state_ = std::make_unique<State>(path, std::move(*encoder));
  for (size_t stream = 0; stream < kStreamCount; ++stream) {
    Result<TemporaryFile> file = TemporaryFile::create(path);
    if (!file) return file.error();
    file->removeName();
    writer.state_->streams.push_back(std::move(*file));
  }
  const Result<std::vector<uint8_t>> codebook = writer.state_->encoder.encodeCodebook();
  if (!codebook) return codebook.error();
  if (Status status = writer.state_->streams[0].append(*codebook); !status) return status.error();
  return writer;
}

Result<EncodedChunk> AssetStreamWriter::encodeChunk(const ChunkContents& chunk,
                                                    const std::function<bool()>& isStopped) const {
  return state_->encoder.encode(chunk, std::string(kContents) + ": a chunk", isStopped);
}

Status AssetStreamWriter::append(EncodedChunk&& chunk) {
  return state_->encoder.add(
      chunk, [&](size_t stream, std::vector<uint8_t> bytes) { return state_->streams[stream].append(bytes); });
}

Result<uint64_t> AssetStreamWriter::finish(const AssetContents& header) {
  Result<AssetLayout::Head> head = state_->encoder.finish(header);
  if (!head) return head.error();
  Result<TemporaryFile> file = TemporaryFile::create(state_->path);
  if (!file) return file.error();
  if (Status status = file->append(head->bytes); !status) return status.error();
  for (const TemporaryFile& stream : state_->streams) {
    if (Status status = file->appendFile(stream); !status) return status.error();
  }
  if (Status status = file->replaceTarget(); !status) return status.error();
  return head->fileSize;
}

Result<std::vector<uint8_t>> encodeAsset(const AssetContents& contents) {
  Result<AssetEncoder> encoder = AssetEncoder::create(contents);
  if (!encoder) return encoder.error();
  std::array<std::vector<uint8_t>, kStreamCount> streams;
  Result<std::vector<uint8_t>> codebook = encoder->encodeCodebook();
  if (!codebook) return codebook.error();
  streams[0] = std::move(*codebook);
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    Result<EncodedChunk> chunk = encoder->encode(contents.chunks[index], chunkPlace(kContents, index), {});
    if (!chunk) return chunk.error();
    const Status added = encoder->add(*chunk, [&](size_t stream, std::vector<uint8_t> bytes) {
      streams[stream].insert(streams[stream].end(), bytes.begin(), bytes.end());
      return Status();
    });
    if (!added) return added.error();
  }
  Result<AssetLayout::Head> head = encoder->finish(contents);
  if (!head) return head.error();
  for (const std::vector<uint8_t>& stream : streams) {
    head->bytes.insert(head->bytes.end(), stream.begin(), stream.end());
  }
  return std::move(head->bytes);
}

Status writeAsset(const std::filesystem::path& path, const AssetContents& contents) {
  Result<AssetStreamWriter> writer = AssetStreamWriter::create(path, contents);
  if (!writer) return writer.error();
  for (const ChunkContents& chunk : contents.chunks) {
    Result<EncodedChunk> encoded = writer->encodeChunk(chunk);
    if (!encoded) return encoded.error();
    if (Status status = writer->append(std::move(*encoded)); !status) return status;
  }
  const Result<uint64_t> size = writer->finish(contents);
  return size ? Status() : Status(size.error());
}

}  // namespace froth
