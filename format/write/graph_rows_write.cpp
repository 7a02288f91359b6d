#include <algorithm>
#include <cstring>

#include "format/graph_rows.h"
#include "format/pair_order.h"

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

Status checkRows(const ChunkContents& chunk, const SortedRows& rows, bool hasWalkGraph) {
  DegreeCheck degrees(uint64_t{chunk.cellCount} + chunk.ghostCount);
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    const RowEntry* before = nullptr;
    for (const RowEntry& entry : rows.row(cell)) {
      const bool isRepeated = before && before->neighbour == entry.neighbour;
      const bool isUnmarked = !hasWalkGraph && !entry.isAlpha;
      if (entry.neighbour == cell || isRepeated || isUnmarked || !isMirrored(chunk, rows, cell, entry, hasWalkGraph)) {
        return makeError(ErrorKind::kBadInput,
                         "graph: neighbour %u of cell %u is repeated, not mutual or out of place; report a "
                         "bug of the baker",
                         entry.neighbour, cell);
      }
      before = &entry;
      const bool isKept = entry.neighbour > cell;  // else it was counted there
      if (Status status = isKept ? degrees.add(cell, entry.neighbour, "chunk") : Status(); !status) return status;
    }
  }
  return {};
}

class Packer {
 public:
  Packer(const ChunkContents& chunk, bool hasWalkGraph)
      : chunk_(chunk), hasWalkGraph_(hasWalkGraph), elementSize_(graphElementSize(chunk)), order_(chunk) {}

  // `row` ascends.
  void addCell(uint32_t cell, std::span<const RowEntry> row) {
    const auto behind = std::upper_bound(row.begin(), row.end(), RowEntry{cell, false});
    const std::span<const RowEntry> kept = row.subspan(static_cast<size_t>(behind - row.begin()));
    append(packed_.counts, static_cast<uint32_t>(kept.size()));
    order_.startCell(cell);
    uint64_t nextPlace = 0;
    const auto addPair = [&](const RowEntry& entry, uint64_t place) {
      append(packed_.deltas, static_cast<uint32_t>(place - nextPlace));
      nextPlace = place + 1;
      if (hasWalkGraph_) appendBit(entry.isAlpha != isLikelyAlpha(chunk_, cell, entry.neighbour));
      order_.add(entry.neighbour);
    };
    uint64_t place = 0;
    for (const uint32_t candidate : order_.candidates()) {
      const auto found = std::lower_bound(kept.begin(), kept.end(), RowEntry{candidate, false});
      if (found != kept.end() && found->neighbour == candidate) addPair(*found, place);
      ++place;
    }
    for (const RowEntry& entry : kept) {
      if (!order_.isCandidate(entry.neighbour)) addPair(entry, order_.placeOf(entry.neighbour));
    }
  }

  PackedGraph take() { return std::move(packed_); }

 private:
  void append(std::vector<uint8_t>& bytes, uint32_t element) const {
    bytes.resize(bytes.size() + elementSize_);
    std::memcpy(bytes.data() + bytes.size() - elementSize_, &element, elementSize_);  // little-endian
  }
  void appendBit(bool bit) {
    const size_t pair = order_.neighbours().size();
    if (pair % 8 == 0) packed_.alphaBits.push_back(0);
    packed_.alphaBits.back() |= static_cast<uint8_t>(bit << pair % 8);
  }

  const ChunkContents& chunk_;
  bool hasWalkGraph_;
  uint32_t elementSize_;
  PairOrder order_;
  PackedGraph packed_;
};

}  // namespace

Result<PackedGraph> packGraph(const ChunkContents& chunk, bool hasWalkGraph) {
  const SortedRows rows(chunk);
  if (Status status = checkRows(chunk, rows, hasWalkGraph); !status) return status.error();
  Packer packer(chunk, hasWalkGraph);
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) packer.addCell(cell, rows.row(cell));
  return packer.take();
}

}  // namespace froth
