// The chunks of a cut that queries see, of an asset with levels of detail.
#include <algorithm>
#include <utility>

#include "format/checks.h"
#include "runtime/query/query_foam.h"

namespace froth {
namespace {

// Entries of a drawn chunk: few, so that a change of the cut costs little. From the nearest it is a dozen steps to any
// cell.
constexpr uint32_t kEntriesPerChunk = 4;

template <class Visit>
void forEachMissing(const std::vector<uint32_t>& chunks, const std::vector<uint32_t>& others, const Visit& visit) {
  for (const uint32_t chunk : chunks) {
    if (!std::ranges::binary_search(others, chunk)) visit(chunk);
  }
}

}  // namespace

void QueryFoam::setChunk(uint32_t number, QueryChunk&& made) {
  bytes_ += made.arrayBytes();
  chunks_[number] = std::move(made);
}

void QueryFoam::removeChunk(uint32_t number) {
  if (!hasWalkGraph_) return;
  bytes_ -= chunks_[number].arrayBytes();
  chunks_[number] = {};
}

QueryCut QueryFoam::makeCut(std::span<const uint32_t> ascending) const {
  std::vector<uint32_t> chunks(ascending.begin(), ascending.end());
  if (!hasWalkGraph_) return makeTrees(std::move(chunks), {});
  std::vector<EntryTree::Sample> samples;
  samples.reserve(kEntriesPerChunk * chunks.size());
  for (const uint32_t number : chunks) {
    const QueryChunk& chunk = chunks_[number];
    const uint32_t count = std::min(kEntriesPerChunk, chunk.cellCount);
    for (uint32_t i = 0; i < count; ++i) {
      const auto cell = static_cast<uint32_t>((2 * uint64_t{i} + 1) * chunk.cellCount / (2 * uint64_t{count}));
      samples.push_back({glm::vec3(chunk.origin + chunk.siteOf(cell)), {number, cell}});
    }
  }
  return makeTrees(std::move(chunks), std::move(samples));
}

// What goes before what comes: a border is in both forms of a group.
void QueryFoam::show(QueryCut&& cut) {
  isWhole_ = true;
  if (!hasWalkGraph_) return;
  forEachMissing(cut_.chunks, cut.chunks, [&](uint32_t chunk) { forgetBorders(chunk); });
  forEachMissing(cut.chunks, cut_.chunks, [&](uint32_t chunk) { tellBorders(chunk); });
  takeCut(std::move(cut));
}

void QueryFoam::tellBorders(uint32_t chunk) {
  const CellRef first = localBits_ < 32 ? chunk << localBits_ : 0;
  for (const QueryBorder border : chunks_[chunk].borders) borders_[border.number] = first | border.cell;
}

// In a file that lies two shown chunks may have a border: the other one's stays.
void QueryFoam::forgetBorders(uint32_t chunk) {
  for (const QueryBorder border : chunks_[chunk].borders) {
    CellRef& ref = borders_[border.number];
    if (ref != kNowhere && chunkOf(ref, localBits_) == chunk) ref = kNowhere;
  }
}

}  // namespace froth
