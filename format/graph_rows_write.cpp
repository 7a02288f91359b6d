#include <algorithm>
#include <cstring>

#include "format/graph_rows.h"

namespace froth {
namespace {

struct RowEntry {
  uint32_t neighbour;
  bool isAlpha;

  bool operator<(const RowEntry& other) const { return neighbour < other.neighbour; }
};

// The rows of a chunk with their entries ascending.
class SortedRows {
 public:
  explicit SortedRows(const ChunkContents& chunk) : chunk_(chunk), entries_(chunk.neighbours.size()) {
    for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
      const uint32_t first = chunk.neighbourOffsets[cell], last = chunk.neighbourOffsets[cell + 1];
      const uint32_t alphaEnd = first + (cell < chunk.liveCount ? chunk.alphaCounts[cell] : 0);
      for (uint32_t i = first; i < last; ++i) entries_[i] = {chunk.neighbours[i], i < alphaEnd};
      std::sort(entries_.begin() + first, entries_.begin() + last);
    }
  }

  std::span<const RowEntry> row(uint32_t cell) const {
    const uint32_t first = chunk_.neighbourOffsets[cell];
    return std::span(entries_).subspan(first, chunk_.neighbourOffsets[cell + 1] - first);
  }

  // Null if `neighbour` is not in the row of `cell`.
  const RowEntry* find(uint32_t cell, uint32_t neighbour) const {
    const std::span<const RowEntry> entries = row(cell);
    const auto found = std::lower_bound(entries.begin(), entries.end(), RowEntry{neighbour, false});
    return found != entries.end() && found->neighbour == neighbour ? &*found : nullptr;
  }

 private:
  const ChunkContents& chunk_;
  std::vector<RowEntry> entries_;
};

// Whether the other cell's row agrees with an entry of the row of `cell`.
bool isMirrored(const ChunkContents& chunk, const SortedRows& rows, uint32_t cell, const RowEntry& entry,
                bool hasWalkGraph) {
  if (entry.neighbour >= chunk.cellCount) return true;  // a ghost has no row here
  const bool bothLive = std::max(cell, entry.neighbour) < chunk.liveCount;
  if (!hasWalkGraph && !bothLive) return entry.isAlpha && cell < chunk.liveCount;
  const RowEntry* mirror = rows.find(entry.neighbour, cell);
  return mirror && (!bothLive || mirror->isAlpha == entry.isAlpha);
}

void append(std::vector<uint8_t>& bytes, uint32_t element, uint32_t elementSize) {
  bytes.resize(bytes.size() + elementSize);
  std::memcpy(bytes.data() + bytes.size() - elementSize, &element, elementSize);  // little-endian
}

}  // namespace

Result<PackedGraph> packGraph(const ChunkContents& chunk, bool hasWalkGraph) {
  const SortedRows rows(chunk);
  const uint32_t elementSize = graphElementSize(chunk);
  PackedGraph packed;
  uint64_t pairCount = 0;
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    uint32_t kept = 0, next = cell + 1;
    for (const RowEntry& entry : rows.row(cell)) {
      const bool isRepeated = entry.neighbour > cell && entry.neighbour < next;
      if (entry.neighbour == cell || isRepeated || !isMirrored(chunk, rows, cell, entry, hasWalkGraph) ||
          (!hasWalkGraph && !entry.isAlpha))
        return makeError(ErrorKind::kBadInput,
                         "graph: neighbour %u of cell %u is repeated, not mutual or out of place; this is a bug of the baker",
                         entry.neighbour, cell);
      const bool isAtOther = entry.neighbour < cell && (hasWalkGraph || cell < chunk.liveCount);
      if (isAtOther) continue;
      append(packed.deltas, entry.neighbour - next, elementSize);
      next = entry.neighbour + 1;
      ++kept;
      if (hasWalkGraph) {
        if (pairCount % 8 == 0) packed.alphaBits.push_back(0);
        packed.alphaBits.back() |= static_cast<uint8_t>(entry.isAlpha << pairCount % 8);
      }
      ++pairCount;
    }
    append(packed.counts, kept, elementSize);
  }
  return packed;
}

}  // namespace froth
