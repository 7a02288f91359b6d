// Any bytes as the packed graph of a chunk: no crash, no leak, no hang, memory as promised, and rows that
// hold what ChunkContents says of them.
#include <cstdlib>

#include "codec_inputs.h"
#include "format/graph_rows.h"
#include "memory_watch.h"

namespace froth {
namespace {

void expect(bool holds) {
  if (!holds) std::abort();
}

void expectRows(const ChunkContents& chunk) {
  const size_t siteCount = chunk.sites.size();
  expect(chunk.neighbourOffsets.size() == size_t{chunk.cellCount} + 1 && chunk.neighbourOffsets.front() == 0);
  expect(chunk.neighbourOffsets.back() == chunk.neighbours.size() && chunk.alphaCounts.size() == chunk.liveCount);
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    const uint32_t first = chunk.neighbourOffsets[cell], last = chunk.neighbourOffsets[cell + 1];
    expect(first <= last && (cell >= chunk.liveCount || chunk.alphaCounts[cell] <= last - first));
    for (uint32_t i = first; i < last; ++i) expect(chunk.neighbours[i] < siteCount && chunk.neighbours[i] != cell);
  }
}

void unpack(std::span<const uint8_t> data) {
  InputBytes bytes(data);
  const GraphInput input = bytes.take<GraphInput>();
  ChunkContents chunk;
  chunk.cellCount = input.cells % 256;
  chunk.ghostCount = input.ghosts % 256u + (input.isWide == 255 ? 0x8000 : 0);
  chunk.liveCount = input.live % (chunk.cellCount + 1);
  const size_t siteCount = size_t{chunk.cellCount} + chunk.ghostCount;
  for (size_t i = 0; i < siteCount; ++i) {
    chunk.sites.push_back(bytes.take<glm::vec3>());
    chunk.radii.push_back(bytes.take<float>());
  }
  const std::span<const uint8_t> counts = bytes.takeBytes(size_t{chunk.cellCount} * graphElementSize(chunk));
  const std::span<const uint8_t> deltas = bytes.takeBytes(input.deltasSize);
  const bool hasWalkGraph = input.hasWalkGraph % 2 == 1;

  constexpr size_t kMessage = 4096;
  const MemoryWatch watch;
  const Status status = unpackGraph({counts, deltas, bytes.left()}, hasWalkGraph, chunk, "chunk");
  const size_t pairs = deltas.size() / graphElementSize(chunk);
  watch.expectAtMost(80 * pairs + 80 * siteCount +
                     kMessage);  // vectors that grow hold up to twice their content, and its copy
  if (status) expectRows(chunk);
}

}  // namespace
}  // namespace froth

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  froth::unpack({data, size});
  return 0;
}
