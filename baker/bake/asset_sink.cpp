#include "baker/bake/asset_sink.h"

#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "base/progress_printer.h"

namespace froth {

ChunkSink AssetFileSink::sink() {
  ChunkSink sink;
  sink.begin = [this](const AssetContents& header) -> Status {
    Result<AssetStreamWriter> writer = AssetStreamWriter::create(path_, header, isProtected_);
    if (!writer) return writer.error();
    writer_ = std::move(*writer);
    return {};
  };
  sink.append = [this](std::vector<ChunkContents>&& batch) { return append(std::move(batch)); };
  return sink;
}

Status AssetFileSink::append(std::vector<ChunkContents>&& batch) {
  std::vector<std::optional<Result<EncodedChunk>>> encoded(batch.size());
  tbb::parallel_for(size_t{0}, batch.size(), [&](size_t index) {
    const ChunkContents chunk = std::move(batch[index]);  // freed as soon as it is encoded
    encoded[index] = writer_->encodeChunk(chunk, isStopRequested);
  });
  for (std::optional<Result<EncodedChunk>>& chunk : encoded) {
    if (!*chunk) return chunk->error();
    if (Status status = writer_->append(std::move(**chunk)); !status) return status;
  }
  return {};
}

Result<uint64_t> AssetFileSink::finish(const AssetContents& contents) { return writer_->finish(contents); }

}  // namespace froth
