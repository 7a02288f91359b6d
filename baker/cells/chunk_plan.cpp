#include "baker/cells/chunk_plan.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include "baker/cells/cell_order.h"
#include "baker/cells/slices.h"

namespace froth {
namespace {

// A total order along an axis, so that a median splits the same way however it is found.
struct AlongAxis {
  const std::vector<glm::vec3>& sites;
  int axis;

  bool operator()(uint32_t a, uint32_t b) const { return std::pair(sites[a][axis], a) < std::pair(sites[b][axis], b); }
};

class KdSplitter {
 public:
  KdSplitter(const BakeCells& cells, const Progress& progress) : cells_(cells), progress_(progress) {}

  // Splits into `chunkCount` chunks of nearly the same number of live cells. False: asked to stop.
  bool split(std::span<uint32_t> live, size_t chunkCount, std::vector<PlannedChunk>& chunks) {
    if (!report(progress_, "chunks", chunks.size(), 0)) return false;
    if (chunkCount <= 1) {
      PlannedChunk& chunk = chunks.emplace_back();
      chunk.liveCount = static_cast<uint32_t>(live.size());
      chunk.cells.assign(live.begin(), live.end());
      return true;
    }
    const AlongAxis isBefore{cells_.sites, widestAxis(live)};
    const size_t leftChunks = chunkCount / 2, leftCells = live.size() * leftChunks / chunkCount;
    std::nth_element(live.begin(), live.begin() + leftCells, live.end(), isBefore);
    return split(live.first(leftCells), leftChunks, chunks) &&
           split(live.subspan(leftCells), chunkCount - leftChunks, chunks);
  }

 private:
  int widestAxis(std::span<const uint32_t> cells) const {
    glm::vec3 low = cells_.sites[cells[0]], high = low;
    for (const uint32_t cell : cells) {
      low = glm::min(low, cells_.sites[cell]);
      high = glm::max(high, cells_.sites[cell]);
    }
    const glm::vec3 size = high - low;
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
  }

  const BakeCells& cells_;
  const Progress& progress_;
};

// Of a cell of the scene, in place of a chunk: it has none yet; it belongs to none.
constexpr uint32_t kOpen = 0xfffffffe, kOutside = 0xffffffff;

// The least of those that are most frequent; kOpen: the neighbours are in none.
uint32_t findCommonChunk(std::span<const uint32_t> neighbours, std::span<const uint32_t> chunkOf) {
  std::vector<uint32_t> chunks;
  for (const uint32_t neighbour : neighbours) {
    if (chunkOf[neighbour] < kOpen) chunks.push_back(chunkOf[neighbour]);
  }
  std::sort(chunks.begin(), chunks.end());
  uint32_t common = kOpen;
  std::ptrdiff_t most = 0;
  for (auto run = chunks.begin(); run != chunks.end();) {
    const auto end = std::upper_bound(run, chunks.end(), *run);
    if (end - run > most) common = *run, most = end - run;
    run = end;
  }
  return common;
}

// Those beside live cells first, then those beside them, and so on. A cell that is looked at again gets its place, so
// each is looked at twice at most.
void placeOthers(const BakeCells& cells, const std::vector<uint32_t>& others, const RowOf& rowOf,
                 std::vector<PlannedChunk>& chunks) {
  std::vector<uint32_t> chunkOf(cells.count(), kOutside);
  for (uint32_t chunk = 0; chunk < chunks.size(); ++chunk) {
    for (const uint32_t cell : chunks[chunk].cells) chunkOf[cell] = chunk;
  }
  for (const uint32_t cell : others) chunkOf[cell] = kOpen;
  for (std::vector<uint32_t> wave = others; !wave.empty();) {
    std::vector<std::pair<uint32_t, uint32_t>> placed;  // cells, their chunks
    for (const uint32_t cell : wave) {
      const uint32_t chunk = findCommonChunk(rowOf(cell), chunkOf);
      if (chunk != kOpen) placed.emplace_back(cell, chunk);
    }
    for (const auto& [cell, chunk] : placed) chunkOf[cell] = chunk;
    wave.clear();
    for (const auto& [cell, chunk] : placed) {
      for (const uint32_t neighbour : rowOf(cell)) {
        if (chunkOf[neighbour] == kOpen) wave.push_back(neighbour);
      }
    }
    std::sort(wave.begin(), wave.end());
    wave.erase(std::unique(wave.begin(), wave.end()), wave.end());
  }
  for (const uint32_t cell : others) {
    const bool isAlone = chunkOf[cell] == kOpen;  // no path leads from it to a live cell: any chunk will do
    chunks[isAlone ? 0 : chunkOf[cell]].cells.push_back(cell);
  }
}

void appendRow(const CellGraph& graph, uint32_t cell, CellGraph& rows) {
  const std::span<const uint32_t> row = neighboursOf(graph, cell);
  rows.neighbours.insert(rows.neighbours.end(), row.begin(), row.end());
  rows.offsets.push_back(static_cast<uint32_t>(rows.neighbours.size()));
}

}  // namespace

CellRows gatherRows(const CellGraph& walk, const CellGraph& alpha, std::span<const uint32_t> cells) {
  CellRows rows{{{0}, {}}, {{0}, {}}};
  for (const uint32_t cell : cells) {
    appendRow(walk, cell, rows.walk);
    appendRow(alpha, cell, rows.alpha);
  }
  return rows;
}

Result<std::vector<PlannedChunk>> splitIntoChunks(const BakeCells& cells, std::vector<uint32_t> live,
                                                  std::vector<uint32_t> others, const RowOf& rowOf, uint32_t chunkCells,
                                                  double positionStep, const Progress& progress) {
  std::vector<PlannedChunk> chunks;
  const size_t chunkCount = (live.size() + chunkCells - 1) / chunkCells;
  KdSplitter splitter(cells, progress);
  const auto sortChunk = [&](uint32_t index) {
    PlannedChunk& chunk = chunks[index];
    const std::span<uint32_t> own(chunk.cells);
    orderCells(own.first(chunk.liveCount), own.subspan(chunk.liveCount), cells, positionStep);
  };
  if (!splitter.split(live, chunkCount, chunks)) return stoppedOnRequest("bake");
  placeOthers(cells, others, rowOf, chunks);
  if (!forEachSlice(static_cast<uint32_t>(chunks.size()), 1, {progress, "order", 0, chunkCount}, sortChunk)) {
    return stoppedOnRequest("bake");
  }
  return chunks;
}

Result<uint32_t> chooseLocalBits(std::span<const PlannedChunk> chunks) {
  if (chunks.size() == 1) return 32;
  size_t largest = 1;
  for (const PlannedChunk& chunk : chunks) largest = std::max(largest, chunk.cells.size());
  // a file has one bit at least
  const auto localBits = static_cast<uint32_t>(std::bit_width(std::max<size_t>(largest - 1, 1)));
  if (static_cast<int>(localBits) + std::bit_width(chunks.size() - 1) <= 32) return localBits;
  return makeError(ErrorKind::kUnsupported,
                   "chunks: %zu of them with up to %zu cells exceed 2^32 places; bake with more cells per chunk",
                   chunks.size(), largest);
}

Result<ChunkPlan> planChunks(const BakeCells& cells, const std::vector<CellState>& states, const CellGraph& walk,
                             uint32_t chunkCells, double positionStep, const Progress& progress) {
  std::vector<uint32_t> live, others;
  for (uint32_t cell = 0; cell < cells.count(); ++cell) {
    if (isInAsset(states[cell])) (states[cell] == CellState::kLive ? live : others).push_back(cell);
  }
  Result<std::vector<PlannedChunk>> chunks = splitIntoChunks(
      cells, std::move(live), std::move(others), [&](uint32_t cell) { return neighboursOf(walk, cell); }, chunkCells,
      positionStep, progress);
  if (!chunks) return chunks.error();
  const Result<uint32_t> localBits = chooseLocalBits(*chunks);
  if (!localBits) return localBits.error();
  ChunkPlan plan{std::move(*chunks), *localBits, std::vector<CellRef>(cells.count(), kNoRef)};
  for (uint32_t chunk = 0; chunk < plan.chunks.size(); ++chunk) {
    const CellRef base = plan.localBits < 32 ? chunk << plan.localBits : 0;
    const std::vector<uint32_t>& own = plan.chunks[chunk].cells;
    for (uint32_t local = 0; local < own.size(); ++local) plan.refs[own[local]] = base | local;
  }
  return plan;
}

}  // namespace froth
