#include <algorithm>
#include <cstring>

#include "format/frame_read.h"
#include "format/graph_rows.h"

namespace froth {
namespace {

using ull = unsigned long long;

uint32_t elementAt(std::span<const uint8_t> bytes, uint64_t index, uint32_t elementSize) {
  if (elementSize == 2) {
    uint16_t element;
    std::memcpy(&element, bytes.data() + index * 2, 2);
    return element;
  }
  uint32_t element;
  std::memcpy(&element, bytes.data() + index * 4, 4);
  return element;
}

// Calls visit(cell, neighbour, isAlpha) for every pair of a graph whose pairs have been checked.
template <class Visit>
void visitPairs(const PackedGraphView& packed, bool hasWalkGraph, const ChunkContents& chunk, Visit&& visit) {
  const uint32_t elementSize = graphElementSize(chunk);
  uint64_t pair = 0;
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    uint32_t next = cell + 1;
    for (uint32_t left = elementAt(packed.counts, cell, elementSize); left > 0; --left, ++pair) {
      const uint32_t neighbour = next + elementAt(packed.deltas, pair, elementSize);
      visit(cell, neighbour, !hasWalkGraph || (packed.alphaBits[pair / 8] >> pair % 8 & 1));
      next = neighbour + 1;
    }
  }
}

// The rows hold each pair at most twice and their offsets are 32 bits wide.
constexpr uint64_t kMaxPairs = 0x7fffffff;

Status checkSizes(const PackedGraphView& packed, bool hasWalkGraph, const ChunkContents& chunk,
                  const std::string& place) {
  const uint32_t elementSize = graphElementSize(chunk);
  const auto fail = [&place](const char* what, size_t found, uint64_t expected) {
    return makeError(ErrorKind::kBadInput, "%s: graph: %s of %zu bytes instead of %llu; %s", place.c_str(), what, found,
                     ull{expected}, kSectionRemedy);
  };
  if (packed.counts.size() != uint64_t{chunk.cellCount} * elementSize)
    return fail("counts", packed.counts.size(), uint64_t{chunk.cellCount} * elementSize);
  uint64_t pairs = 0;
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) pairs += elementAt(packed.counts, cell, elementSize);
  if (packed.deltas.size() != pairs * elementSize) return fail("deltas", packed.deltas.size(), pairs * elementSize);
  const uint64_t bitBytes = hasWalkGraph ? (pairs + 7) / 8 : 0;
  if (packed.alphaBits.size() != bitBytes) return fail("alpha bits", packed.alphaBits.size(), bitBytes);
  if (pairs > kMaxPairs)
    return makeError(ErrorKind::kBadInput, "%s: graph: %llu pairs, more than %llu; %s", place.c_str(), ull{pairs},
                     ull{kMaxPairs}, kSectionRemedy);
  const bool hasSpareBits = bitBytes > 0 && pairs % 8 != 0 && packed.alphaBits.back() >> pairs % 8 != 0;
  if (hasSpareBits)
    return makeError(ErrorKind::kBadInput, "%s: graph: spare alpha bits are not zero; %s", place.c_str(),
                     kSectionRemedy);
  return {};
}

// Ascending differences cannot repeat a neighbour or name the cell itself; they can leave the chunk.
Status checkPairs(const PackedGraphView& packed, bool hasWalkGraph, const ChunkContents& chunk,
                  const std::string& place) {
  const uint64_t siteCount = uint64_t{chunk.cellCount} + chunk.ghostCount;
  const uint32_t elementSize = graphElementSize(chunk);
  uint64_t pair = 0;
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    uint64_t next = uint64_t{cell} + 1;
    for (uint32_t left = elementAt(packed.counts, cell, elementSize); left > 0; --left, ++pair) {
      const uint64_t neighbour = next + elementAt(packed.deltas, pair, elementSize);
      if (neighbour >= siteCount)
        return makeError(ErrorKind::kBadInput, "%s: graph: neighbour %llu of cell %u >= %llu; %s", place.c_str(),
                         ull{neighbour}, cell, ull{siteCount}, kSectionRemedy);
      const bool isAlpha = !hasWalkGraph || (packed.alphaBits[pair / 8] >> pair % 8 & 1);
      if (isAlpha && cell >= chunk.liveCount)
        return makeError(ErrorKind::kBadInput, "%s: graph: cell %u is not live, but a pair of the alpha-complex; %s",
                         place.c_str(), cell, kSectionRemedy);
      next = neighbour + 1;
    }
  }
  return {};
}

void countRows(const PackedGraphView& packed, bool hasWalkGraph, ChunkContents& chunk) {
  chunk.neighbourOffsets.assign(size_t{chunk.cellCount} + 1, 0);
  chunk.alphaCounts.assign(chunk.liveCount, 0);
  visitPairs(packed, hasWalkGraph, chunk, [&](uint32_t cell, uint32_t neighbour, bool isAlpha) {
    for (const uint32_t end : {cell, neighbour}) {
      const bool isLive = end < chunk.liveCount;
      if (end < chunk.cellCount && (isLive || hasWalkGraph)) ++chunk.neighbourOffsets[size_t{end} + 1];
      if (isLive && isAlpha) ++chunk.alphaCounts[end];
    }
  });
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell)
    chunk.neighbourOffsets[cell + 1] += chunk.neighbourOffsets[cell];
}

void fillRows(const PackedGraphView& packed, bool hasWalkGraph, ChunkContents& chunk) {
  chunk.neighbours.resize(chunk.neighbourOffsets.back());
  std::vector<uint32_t> nextAlpha(chunk.neighbourOffsets.begin(), chunk.neighbourOffsets.end() - 1);
  std::vector<uint32_t> nextOther = nextAlpha;
  for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) nextOther[cell] += chunk.alphaCounts[cell];
  visitPairs(packed, hasWalkGraph, chunk, [&](uint32_t cell, uint32_t neighbour, bool isAlpha) {
    const auto put = [&](uint32_t end, uint32_t other) {
      const bool isLive = end < chunk.liveCount;
      if (end >= chunk.cellCount || !(isLive || hasWalkGraph)) return;
      chunk.neighbours[isLive && isAlpha ? nextAlpha[end]++ : nextOther[end]++] = other;
    };
    put(cell, neighbour);
    put(neighbour, cell);
  });
}

}  // namespace

Status unpackGraph(const PackedGraphView& packed, bool hasWalkGraph, ChunkContents& chunk, const std::string& place) {
  if (Status status = checkSizes(packed, hasWalkGraph, chunk, place); !status) return status;
  if (Status status = checkPairs(packed, hasWalkGraph, chunk, place); !status) return status;
  countRows(packed, hasWalkGraph, chunk);
  fillRows(packed, hasWalkGraph, chunk);
  sortGraphRows(chunk, 0, chunk.cellCount);
  return {};
}

}  // namespace froth
