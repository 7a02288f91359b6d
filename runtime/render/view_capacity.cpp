#include "runtime/render/view_capacity.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/view_buffers.h"

namespace froth {
namespace {

// Nearly twice what views of miku_plush and tankard_rough take from 330 x 247 to 1319 x 989 pixels.
constexpr uint64_t kLeastPairs = uint64_t{1} << 14;
constexpr uint64_t kPairsPerCell = 2;
constexpr uint64_t kPairsPerTile = 64;
constexpr uint64_t kMostPairs = uint64_t{1} << 30;
// What a view keeps of any budget.
constexpr uint32_t kFewestCells = 1u << 10;
constexpr uint32_t kFewestPairs = 1u << 12;

constexpr uint32_t kManyCells = 1u << 17;
// Histograms of single rounds take 32 bytes per cell.
constexpr uint32_t kMostInSingleRounds = 1u << 20;

// Half more than a frame wanted once it comes within an eighth of the capacity; never more than there can be.
uint64_t roomFor(uint64_t wanted, uint64_t capacity, uint64_t most) {
  if (wanted + wanted / 8 <= capacity) return capacity;
  return std::max(capacity, std::min(wanted + wanted / 2, most));
}

}  // namespace

ViewCapacity largest(const ViewCapacity& a, const ViewCapacity& b) {
  return {.frames = std::max(a.frames, b.frames),
          .recordings = std::max(a.recordings, b.recordings),
          .chunks = std::max(a.chunks, b.chunks),
          .groups = std::max(a.groups, b.groups),
          .tiles = std::max(a.tiles, b.tiles),
          .rays = std::max(a.rays, b.rays),
          .hits = std::max(a.hits, b.hits),
          .quarters = std::max(a.quarters, b.quarters),
          .fades = std::max(a.fades, b.fades),
          .cells = std::max(a.cells, b.cells),
          .planes = std::max(a.planes, b.planes),
          .details = std::max(a.details, b.details),
          .pairs = std::max(a.pairs, b.pairs)};
}

ViewDemand largest(const ViewDemand& a, const ViewDemand& b) {
  return {std::max(a.cells, b.cells), std::max(a.planes, b.planes), std::max(a.pairs, b.pairs)};
}

ViewDemand demandOf(const gpu::Counters& counters) {
  return {counters.cellsWanted, counters.planesWanted, uint64_t{counters.pairs} + counters.droppedPairs};
}

uint32_t tileDigits(uint32_t tiles) {
  uint32_t digits = 1;
  while (tiles >> (8 * digits) != 0) ++digits;
  return digits;
}

uint32_t sortRoundsOf(uint64_t cells) { return cells > kManyCells ? gpu::kManyKeysRounds : 1; }

uint32_t fewestSortRounds(const ViewCapacity& capacity) {
  return capacity.cells > kMostInSingleRounds ? gpu::kManyKeysRounds : 1;
}

uint64_t histogramBytes(uint32_t keys, uint32_t sortRounds) {
  const uint32_t groups = groupsOver(keys, sortRounds * gpu::kGroupSize);
  return gpu::kSortDigits * sizeof(uint32_t) * (uint64_t{groups} + groupsOver(groups, gpu::kSortGroupsPerSum));
}

TallyLayout layOutTallies(const ViewCapacity& capacity, uint32_t sortRounds) {
  TallyLayout layout;
  layout.cellHistograms = 0;
  layout.pairHistograms = kCellKeyDigits * histogramBytes(capacity.cells, sortRounds);
  layout.tileLengths = layout.pairHistograms + tileDigits(capacity.tiles) * histogramBytes(capacity.pairs, sortRounds);
  layout.superSums = layout.tileLengths + sizeof(uint32_t[2]) * (capacity.tiles / 2 + 1);
  layout.sizeCounts = layout.superSums + sizeof(uint32_t[2]) * groupsOver(capacity.groups, gpu::kGroupSize);
  layout.tileSums = layout.sizeCounts + sizeof(uint32_t[2]) * gpu::kSizeKeys;
  layout.end = layout.tileSums + sizeof(uint32_t) * groupsOver(capacity.cells, gpu::kCellsPerTileSum);
  return layout;
}

uint32_t groupsOfCells(const GpuAsset& asset) {
  uint32_t groups = 0;
  for (const GpuChunk& chunk : asset.chunks) groups += groupsOver(chunk.cellCount, gpu::kGroupSize);
  return groups;
}

uint32_t tableChunks(const GpuAsset& asset) {
  return std::max(static_cast<uint32_t>(asset.chunks.size()), asset.next.chunkCount);
}

namespace {

CutCounts countsOf(const GpuAsset& asset) {
  return {static_cast<uint32_t>(asset.chunks.size()), groupsOfCells(asset), asset.cellCount, asset.liveCount,
          asset.alphaTotal};
}

// What `cells` visible cells take of a view.
ViewCapacity neededFor(uint64_t cells, uint64_t planes, uint32_t detailCount, uint32_t tiles) {
  ViewCapacity needed;
  needed.cells = static_cast<uint32_t>(cells);
  needed.planes = planes;
  needed.details = cells * detailCount;
  needed.pairs =
      static_cast<uint32_t>(std::clamp(kPairsPerCell * cells + kPairsPerTile * tiles, kLeastPairs, kMostPairs));
  return needed;
}

// For all cells of a cut, or `mostCells` of them.
ViewCapacity neededBy(const CutCounts& counts, uint32_t detailCount, uint32_t mostCells, uint32_t tiles) {
  const uint64_t cells = std::min(counts.cellCount, mostCells);
  const uint64_t meanPlanes = counts.alphaTotal / std::max(counts.liveCount, 1u) + 1;
  ViewCapacity needed = neededFor(cells, std::min(counts.alphaTotal, cells * meanPlanes), detailCount, tiles);
  needed.chunks = counts.chunkCount;
  needed.groups = counts.groupCount;
  return needed;
}

// Cuts come one after the other, each with more cells: room for half more, as far as the asset may have them, spares
// most of the exchanges of buffers.
CutCounts aheadOf(const GpuAsset& asset) {
  CutCounts ahead = asset.next;
  const uint64_t most = std::max(ahead.cellCount, asset.mostCells);
  const uint64_t cells = std::min(uint64_t{ahead.cellCount} + ahead.cellCount / 2, most);
  const uint64_t meanPlanes = ahead.alphaTotal / std::max(ahead.liveCount, 1u) + 1;
  ahead.alphaTotal += (cells - ahead.cellCount) * meanPlanes;
  ahead.cellCount = static_cast<uint32_t>(cells);
  return ahead;
}

}  // namespace

void coverAsset(const GpuAsset& asset, uint32_t mostCells, ViewCapacity& capacity) {
  capacity = largest(capacity, neededBy(countsOf(asset), asset.detailCount, mostCells, capacity.tiles));
  const ViewCapacity next = neededBy(asset.next, asset.detailCount, mostCells, capacity.tiles);
  if (largest(next, capacity) == capacity) return;
  capacity = largest(capacity, neededBy(aheadOf(asset), asset.detailCount, mostCells, capacity.tiles));
}

bool coversAsset(const GpuAsset& asset, const ViewCapacity& capacity) {
  return asset.chunks.size() <= capacity.chunks && groupsOfCells(asset) <= capacity.groups;
}

bool coversNextChunks(const GpuAsset& asset, const ViewCapacity& capacity) {
  return asset.next.chunkCount <= capacity.chunks && asset.next.groupCount <= capacity.groups;
}

bool coversNext(const GpuAsset& asset, uint32_t mostCells, const ViewDemand& demand, const ViewCapacity& capacity) {
  ViewCapacity needed = neededBy(asset.next, asset.detailCount, mostCells, 0);
  needed.pairs = static_cast<uint32_t>(std::min(demandOfNext(asset, demand).pairs, kMostPairs));
  return largest(needed, capacity) == capacity;
}

// A ball that is s tiles wide has about (s + 1)^2 pairs. The f balls that stand for it in a finer form fill the same
// solid, so each is s / f^(1/3) tiles wide, and they have f (s / f^(1/3) + 1)^2 pairs.
ViewDemand demandOfNext(const GpuAsset& asset, const ViewDemand& demand) {
  if (asset.next.liveCount <= asset.liveCount || demand.cells == 0) return demand;
  const double growth = asset.next.liveCount / static_cast<double>(std::max(asset.liveCount, 1u));
  const double width = std::sqrt(static_cast<double>(demand.pairs) / static_cast<double>(demand.cells)) - 1;
  const double finer = std::max(width, 0.0) / std::cbrt(growth) + 1;
  ViewDemand next = demand;
  next.pairs = static_cast<uint64_t>(static_cast<double>(demand.cells) * growth * finer * finer);
  next.pairs = std::max(next.pairs, demand.pairs);
  return next;
}

VkDeviceSize bytesPerCell(uint32_t detailCount) {
  constexpr uint32_t kCells = 1u << 20;   // so many that what does not go with cells is nothing beside them
  constexpr uint64_t kPlanesPerCell = 8;  // 7 on average
  ViewCapacity some = neededFor(kCells, kPlanesPerCell * kCells, detailCount, 1);
  some.groups = kCells / gpu::kGroupSize;
  const ViewCapacity replaced{.cells = some.cells, .details = some.details};  // the largest part of growInParts
  return (bytesOf(some) + bytesOf(replaced)) / kCells;
}

VkDeviceSize bytesWithoutCells(const GpuAsset& asset, const ViewCapacity& capacity) {
  ViewCapacity rest = capacity;
  rest.chunks = std::max(asset.fileChunkCount, 1u);
  rest.groups = rest.cells = 1;
  rest.planes = rest.details = 1;
  rest.pairs = neededFor(0, 0, 0, capacity.tiles).pairs;
  return bytesOf(rest);
}

bool holdsAllCells(const GpuAsset& asset, const ViewCapacity& capacity) {
  const uint64_t details = uint64_t{asset.cellCount} * asset.detailCount;
  return capacity.cells >= asset.cellCount && capacity.planes >= asset.alphaTotal && capacity.details >= details;
}

ViewCapacity neededBy(const GpuAsset& asset, const ViewDemand& demand, uint32_t detailCount) {
  const uint64_t cells = std::min(demand.cells, uint64_t{asset.cellCount});
  ViewCapacity needed;
  needed.chunks = tableChunks(asset);
  needed.groups = std::max(groupsOfCells(asset), asset.next.groupCount);
  needed.cells = static_cast<uint32_t>(cells);
  needed.planes = std::min(demand.planes, asset.neighbourTotal);
  needed.details = cells * detailCount;
  needed.pairs = static_cast<uint32_t>(std::min(demand.pairs, kMostPairs));
  return needed;
}

bool mayLack(const GpuAsset& asset, const ViewDemand& demand, const ViewCapacity& capacity) {
  const bool isKnown = demand.cells > 0;
  const uint64_t cells = std::min(uint64_t{capacity.cells}, capacity.details / asset.detailCount);
  const bool holdsCells = cells >= asset.cellCount || (isKnown && demand.cells <= cells);
  const bool holdsPlanes = capacity.planes >= asset.alphaTotal || (isKnown && demand.planes <= capacity.planes);
  return !holdsCells || !holdsPlanes || demand.pairs > capacity.pairs;
}

ViewCapacity lessened(const ViewCapacity& capacity, double factor) {
  const auto partOf = [&](uint64_t count, uint64_t fewest) {
    return std::max(std::min(count, fewest), static_cast<uint64_t>(static_cast<double>(count) * factor));
  };
  const uint64_t cells = partOf(capacity.cells, kFewestCells);
  const auto perCell = [&](uint64_t count) {  // in proportion to the cells
    return std::max(uint64_t{1},
                    static_cast<uint64_t>(static_cast<double>(count) * static_cast<double>(cells) / capacity.cells));
  };
  ViewCapacity less = capacity;
  less.cells = static_cast<uint32_t>(cells);
  less.planes = perCell(capacity.planes);
  less.details = perCell(capacity.details);
  less.pairs = static_cast<uint32_t>(partOf(capacity.pairs, kFewestPairs));
  return less;
}

void coverDemand(const GpuAsset& asset, const ViewDemand& demand, ViewCapacity& capacity) {
  const uint64_t cells = roomFor(demand.cells, capacity.cells, asset.cellCount);
  capacity.cells = static_cast<uint32_t>(cells);
  capacity.planes = roomFor(demand.planes, capacity.planes, asset.neighbourTotal);
  capacity.details = std::max(capacity.details, cells * asset.detailCount);
  capacity.pairs = static_cast<uint32_t>(roomFor(demand.pairs, capacity.pairs, kMostPairs));
}

}  // namespace froth
