#include <cstring>

#include "format/graph_rows.h"
#include "format/pair_order.h"
#include "format/read/frame_read.h"

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

// The rows hold each pair at most twice and their offsets are 32 bits wide.
constexpr uint64_t kMaxPairs = 0x7fffffff;

Status checkSizes(const PackedGraphView& packed, bool hasWalkGraph, const ChunkContents& chunk,
                  const std::string& place) {
  const uint32_t elementSize = graphElementSize(chunk);
  const auto fail = [&place](const char* what, size_t found, uint64_t expected) {
    return makeError(ErrorKind::kBadInput, "%s: graph: %s of %zu bytes instead of %llu; %s", place.c_str(), what, found,
                     ull{expected}, kSectionRemedy);
  };
  if (packed.counts.size() != uint64_t{chunk.cellCount} * elementSize) {
    return fail("counts", packed.counts.size(), uint64_t{chunk.cellCount} * elementSize);
  }
  uint64_t pairs = 0;
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) pairs += elementAt(packed.counts, cell, elementSize);
  if (packed.deltas.size() != pairs * elementSize) return fail("deltas", packed.deltas.size(), pairs * elementSize);
  const uint64_t bitBytes = hasWalkGraph ? (pairs + 7) / 8 : 0;
  if (packed.alphaBits.size() != bitBytes) return fail("alpha bits", packed.alphaBits.size(), bitBytes);
  if (pairs > kMaxPairs) {
    return makeError(ErrorKind::kBadInput, "%s: graph: %llu pairs, more than %llu; %s", place.c_str(), ull{pairs},
                     ull{kMaxPairs}, kSectionRemedy);
  }
  const bool hasSpareBits = bitBytes > 0 && pairs % 8 != 0 && packed.alphaBits.back() >> pairs % 8 != 0;
  if (hasSpareBits) {
    return makeError(ErrorKind::kBadInput, "%s: graph: spare alpha bits are not zero; %s", place.c_str(),
                     kSectionRemedy);
  }
  return {};
}

// The pairs of a chunk, those of a cell behind each other.
struct Pairs {
  std::vector<uint32_t> starts;      // [cellCount + 1]
  std::vector<uint32_t> neighbours;  // [pairs]
  std::vector<bool> isAlpha;         // [pairs]

  // Calls visit(cell, neighbour, isAlpha) for every pair.
  template <class Visit>
  void visit(Visit&& call) const {
    for (uint32_t cell = 0; cell + 1 < starts.size(); ++cell) {
      for (uint32_t pair = starts[cell]; pair < starts[cell + 1]; ++pair) call(cell, neighbours[pair], isAlpha[pair]);
    }
  }
};

// Places ascend, so a pair comes twice only if it is a candidate; they can leave the chunk.
Result<Pairs> readPairs(const PackedGraphView& packed, bool hasWalkGraph, const ChunkContents& chunk,
                        const std::string& place) {
  const uint64_t siteCount = uint64_t{chunk.cellCount} + chunk.ghostCount;
  const uint32_t elementSize = graphElementSize(chunk);
  Pairs pairs;
  pairs.isAlpha.reserve(packed.deltas.size() / elementSize);
  PairOrder order(chunk);
  DegreeCheck degrees(siteCount);
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    order.startCell(cell);
    uint64_t nextPlace = 0;
    for (uint32_t left = elementAt(packed.counts, cell, elementSize); left > 0; --left) {
      const size_t pair = pairs.isAlpha.size();
      const uint64_t pairPlace = nextPlace + elementAt(packed.deltas, pair, elementSize);
      const uint64_t site = order.siteAt(pairPlace);
      if (site >= siteCount) {
        return makeError(ErrorKind::kBadInput, "%s: graph: neighbour %llu of cell %u >= %llu; %s", place.c_str(),
                         ull{site}, cell, ull{siteCount}, kSectionRemedy);
      }
      const uint32_t neighbour = static_cast<uint32_t>(site);
      if (pairPlace >= order.candidates().size() && order.isCandidate(neighbour)) {
        return makeError(ErrorKind::kBadInput, "%s: graph: neighbour %u of cell %u stands at its second place; %s",
                         place.c_str(), neighbour, cell, kSectionRemedy);
      }
      const bool isSurprise = hasWalkGraph && (packed.alphaBits[pair / 8] >> pair % 8 & 1);
      const bool isAlpha = !hasWalkGraph || isSurprise != isLikelyAlpha(chunk, cell, neighbour);
      if (isAlpha && cell >= chunk.liveCount) {
        return makeError(ErrorKind::kBadInput, "%s: graph: cell %u is not live, but in a pair of the alpha-complex; %s",
                         place.c_str(), cell, kSectionRemedy);
      }
      if (Status status = degrees.add(cell, neighbour, place); !status) return status.error();
      order.add(neighbour);
      pairs.isAlpha.push_back(isAlpha);
      nextPlace = pairPlace + 1;
    }
  }
  pairs.starts = order.starts();
  pairs.starts.push_back(static_cast<uint32_t>(order.neighbours().size()));
  pairs.neighbours = order.neighbours();
  return pairs;
}

void countRows(const Pairs& pairs, bool hasWalkGraph, ChunkContents& chunk) {
  chunk.neighbourOffsets.assign(size_t{chunk.cellCount} + 1, 0);
  chunk.alphaCounts.assign(chunk.liveCount, 0);
  pairs.visit([&](uint32_t cell, uint32_t neighbour, bool isAlpha) {
    for (const uint32_t end : {cell, neighbour}) {
      const bool isLive = end < chunk.liveCount;
      if (end < chunk.cellCount && (isLive || hasWalkGraph)) ++chunk.neighbourOffsets[size_t{end} + 1];
      if (isLive && isAlpha) ++chunk.alphaCounts[end];
    }
  });
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    chunk.neighbourOffsets[cell + 1] += chunk.neighbourOffsets[cell];
  }
}

void fillRows(const Pairs& pairs, bool hasWalkGraph, ChunkContents& chunk) {
  chunk.neighbours.resize(chunk.neighbourOffsets.back());
  std::vector<uint32_t> nextAlpha(chunk.neighbourOffsets.begin(), chunk.neighbourOffsets.end() - 1);
  std::vector<uint32_t> nextOther = nextAlpha;
  for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) nextOther[cell] += chunk.alphaCounts[cell];
  pairs.visit([&](uint32_t cell, uint32_t neighbour, bool isAlpha) {
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
  const Result<Pairs> pairs = readPairs(packed, hasWalkGraph, chunk, place);
  if (!pairs) return pairs.error();
  countRows(*pairs, hasWalkGraph, chunk);
  fillRows(*pairs, hasWalkGraph, chunk);
  sortGraphRows(chunk, 0, chunk.cellCount);
  return {};
}

}  // namespace froth
