#include "baker/tool/statistics.h"

#include <fmt/format.h>

namespace froth {
namespace {

struct CellCounts {
  uint64_t cells = 0, live = 0;
};

CellCounts countCells(const AssetContents& contents) {
  CellCounts counts;
  for (const ChunkContents& chunk : contents.chunks) {
    counts.cells += chunk.cellCount;
    counts.live += chunk.liveCount;
  }
  return counts;
}

// Both ends of a pair count it.
double meanDegree(uint64_t pairs, uint64_t cells) {
  return cells > 0 ? 2.0 * static_cast<double>(pairs) / static_cast<double>(cells) : 0.0;
}

}  // namespace

void printStatistics(const AssetContents& contents) {
  const CellCounts counts = countCells(contents);
  const BakeStatistics& bake = contents.statistics;
  fmt::print("preset            {}, from {}\n", contents.preset, contents.source);
  fmt::print("cells             {} in {} chunks, {} of them live\n", counts.cells, contents.chunks.size(),
             counts.live);
  fmt::print("input             {} cells; {} hidden, of these {} duplicates; {} empty; {} dead\n",
             bake.inputCells, bake.hiddenDropped, bake.duplicatesMerged, bake.emptyCells, bake.deadCells);
  fmt::print("detail sites      {} per cell, {} lobes each\n", contents.detailCount, contents.lobeCount);
  fmt::print("walk graph        {}\n", contents.hasWalkGraph
                                           ? fmt::format("{} pairs, mean degree {:.2f}", bake.walkPairs,
                                                         meanDegree(bake.walkPairs, counts.cells))
                                           : "none");
  fmt::print("alpha-complex     {} pairs, mean degree {:.2f}\n", bake.alphaPairs,
             meanDegree(bake.alphaPairs, counts.live));
  fmt::print("near limits       ratio {}, depth {}\n", contents.nearRatio, contents.nearDepth);
  fmt::print("cameras           {}, {} key frames of a flight\n",
             contents.hasStartView ? "a start view" : "no start view", contents.flightPath.size());
}

nlohmann::ordered_json statisticsAsJson(const AssetContents& contents) {
  const CellCounts counts = countCells(contents);
  const BakeStatistics& bake = contents.statistics;
  return {{"preset", contents.preset},
          {"source", contents.source},
          {"cells", counts.cells},
          {"liveCells", counts.live},
          {"chunks", contents.chunks.size()},
          {"detailCount", contents.detailCount},
          {"lobeCount", contents.lobeCount},
          {"hasWalkGraph", contents.hasWalkGraph},
          {"inputCells", bake.inputCells},
          {"hiddenDropped", bake.hiddenDropped},
          {"duplicatesMerged", bake.duplicatesMerged},
          {"emptyCells", bake.emptyCells},
          {"deadCells", bake.deadCells},
          {"walkPairs", bake.walkPairs},
          {"alphaPairs", bake.alphaPairs},
          {"walkDegree", meanDegree(bake.walkPairs, counts.cells)},
          {"alphaDegree", meanDegree(bake.alphaPairs, counts.live)},
          {"nearRatio", contents.nearRatio},
          {"nearDepth", contents.nearDepth},
          {"detailSharpness", contents.detailSharpness},
          {"hasStartView", contents.hasStartView},
          {"flightPath", contents.flightPath.size()}};
}

}  // namespace froth
