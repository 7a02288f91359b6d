#include "format/write/asset_writer.h"

#include <algorithm>
#include <numeric>
#include <optional>
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
    layout_.addShared(section->record);
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
    const auto border = std::max_element(chunk.borderNumbers.begin(), chunk.borderNumbers.end());
    if (border != chunk.borderNumbers.end()) encoded.highestBorder = {*border};
    for (RawSection& section : raw->sections) {
      if (isStopped && isStopped()) return makeError(ErrorKind::kCancelled, "encoding stopped on request");
      Result<StoredSection> stored = encodeRaw(std::move(section), 0, raw->counts, header_.quantization);
      if (!stored) return stored.error();
      encoded.sections.push_back(std::move(*stored));
    }
    return encoded;
  }

  // Its bytes go to `sink`, section after section.
  template <class Sink>
  Status add(EncodedChunk& chunk, Sink sink) {
    std::vector<SectionRecord> records;
    for (const StoredSection& section : chunk.sections) records.push_back(section.record);
    layout_.addChunk(chunk.index, records);
    references_.push_back({std::move(chunk.ghostRefs), std::move(chunk.highestBorder)});
    for (StoredSection& section : chunk.sections) {
      if (Status status = sink(std::move(section.stored)); !status) return status;
    }
    return {};
  }

  // Once all chunks are there. `header`: the one from the start, with what became known since. `order`: as in
  // AssetStreamWriter::finish.
  Result<AssetLayout::Plan> finish(const AssetContents& header, std::span<const uint32_t> order) const {
    std::vector<uint32_t> places(layout_.chunkCount());
    std::iota(places.begin(), places.end(), 0u);
    if (!order.empty()) {
      if (!std::is_permutation(order.begin(), order.end(), places.begin(), places.end())) {
        return makeError(ErrorKind::kUsage, "%s: the order of %zu chunks does not name each of the %zu once", kContents,
                         order.size(), places.size());
      }
      places.assign(order.begin(), order.end());
    }
    const std::vector<ChunkIndex> chunks = layout_.chunks(places);
    if (Status status = checkParameters(header, kContents); !status) return status.error();
    if (Status status = checkChunkIndices(header, chunks, kContents); !status) return status.error();
    for (uint32_t index = 0; index < places.size(); ++index) {
      const References& chunk = references_[places[index]];
      if (Status status =
              checkReferences(header, chunks, index, chunk.ghosts, chunk.highestBorder, chunkPlace(kContents, index));
          !status) {
        return status.error();
      }
    }
    return layout_.plan(header, places);
  }

 private:
  explicit AssetEncoder(const AssetContents& header) : axes_(header.axisCodebook, header.quantization.lobeAxisStep) {
    header_ = header;
    header_.chunks.clear();
  }

  struct References {
    std::vector<CellRef> ghosts;          // the highest into each chunk
    std::vector<uint32_t> highestBorder;  // or none
  };

  AssetContents header_;
  AxisSearch axes_;
  AssetLayout layout_;
  std::vector<References> references_;  // [chunks] as appended
};

}  // namespace

struct AssetStreamWriter::State {
  State(std::filesystem::path target, AssetEncoder assetEncoder)
      : path(std::move(target)), encoder(std::move(assetEncoder)) {}

  std::filesystem::path path;
  AssetEncoder encoder;
  std::optional<TemporaryFile> sections;  // as appended
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
  Result<TemporaryFile> file = TemporaryFile::create(path);
  if (!file) return file.error();
  file->removeName();
  writer.state_->sections = std::move(*file);
  const Result<std::vector<uint8_t>> codebook = writer.state_->encoder.encodeCodebook();
  if (!codebook) return codebook.error();
  if (Status status = writer.state_->sections->append(*codebook); !status) return status.error();
  return writer;
}

Result<EncodedChunk> AssetStreamWriter::encodeChunk(const ChunkContents& chunk,
                                                    const std::function<bool()>& isStopped) const {
  return state_->encoder.encode(chunk, std::string(kContents) + ": a chunk", isStopped);
}

Status AssetStreamWriter::append(EncodedChunk&& chunk) {
  return state_->encoder.add(chunk, [&](std::vector<uint8_t> bytes) { return state_->sections->append(bytes); });
}

Result<uint64_t> AssetStreamWriter::finish(const AssetContents& header, std::span<const uint32_t> order) {
  Result<AssetLayout::Plan> plan = state_->encoder.finish(header, order);
  if (!plan) return plan.error();
  Result<TemporaryFile> file = TemporaryFile::create(state_->path);
  if (!file) return file.error();
  if (Status status = file->append(plan->head); !status) return status.error();
  for (const AssetLayout::Part& part : plan->parts) {
    if (Status status = file->appendPart(*state_->sections, part.offset, part.size); !status) return status.error();
  }
  if (Status status = file->replaceTarget(); !status) return status.error();
  return plan->fileSize;
}

Result<std::vector<uint8_t>> encodeAsset(const AssetContents& contents) {
  Result<AssetEncoder> encoder = AssetEncoder::create(contents);
  if (!encoder) return encoder.error();
  Result<std::vector<uint8_t>> sections = encoder->encodeCodebook();
  if (!sections) return sections.error();
  for (uint32_t index = 0; index < contents.chunks.size(); ++index) {
    Result<EncodedChunk> chunk = encoder->encode(contents.chunks[index], chunkPlace(kContents, index), {});
    if (!chunk) return chunk.error();
    const Status added = encoder->add(*chunk, [&](const std::vector<uint8_t>& bytes) {
      sections->insert(sections->end(), bytes.begin(), bytes.end());
      return Status();
    });
    if (!added) return added.error();
  }
  Result<AssetLayout::Plan> plan = encoder->finish(contents, {});
  if (!plan) return plan.error();
  std::vector<uint8_t> bytes = std::move(plan->head);
  for (const AssetLayout::Part& part : plan->parts) {
    const auto begin = sections->begin() + static_cast<ptrdiff_t>(part.offset);
    bytes.insert(bytes.end(), begin, begin + static_cast<ptrdiff_t>(part.size));
  }
  return bytes;
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
