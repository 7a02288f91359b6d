#include "runtime/asset/asset_measure.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "runtime/asset/loaded_chunk.h"
#include "runtime/asset/prepared_cells.h"

namespace froth {
namespace {

constexpr uint32_t kWalkEntriesPerCell = 2, kMostEntriesAlong = 64;

}  // namespace

// So many that from the nearest it is a few steps to any cell.
uint32_t walkEntriesAlong(uint32_t cellCount) {
  const double along = std::cbrt(static_cast<double>(cellCount) * kWalkEntriesPerCell);
  return std::clamp(static_cast<uint32_t>(along), 1u, kMostEntriesAlong);
}

// With levels: the floor, and level 0.
Result<AssetMeasure> measureAsset(const AssetSource& source, bool keepsForQueries, bool keepsForWalks,
                                  uint32_t prepared) {
  const Result<AssetReader> reader = openReader(source);
  if (!reader) return reader.error();
  const AssetContents& manifest = reader->manifest();
  AssetMeasure measure;
  measure.gpu.detailCount = manifest.detailCount;
  measure.gpu.hasHeights = shapeOf(*reader, source.lastLayer).hasHeights;
  QueryFoam foam(manifest);
  const bool hasLevels = !manifest.levels.empty();
  std::vector<uint32_t> finest;
  const ChunkUses uses{.drawing = true, .queries = keepsForQueries && manifest.hasWalkGraph};
  for (uint32_t chunk = 0; chunk < manifest.chunks.size(); ++chunk) {
    if (hasLevels && manifest.levels[chunk].level > 0 && manifest.levels[chunk].in != kNoGroup) continue;
    Result<LoadedChunk> loaded = loadChunk(*reader, *reader->source(), chunk, source.name, uses);
    if (!loaded) return loaded.error();
    measure.gpu.add(loaded->gpu);
    for (const ChunkArray& array : loaded->arrays.arrays) measure.deviceBytes += array.size;
    if (hasLevels && manifest.levels[chunk].level == 0) finest.push_back(chunk);
    if (!loaded->query) continue;
    if (hasLevels) {
      foam.setChunk(chunk, std::move(*loaded->query));
    } else {
      foam.addChunk(std::move(*loaded->query), loaded->bounds);
    }
  }
  const Status status = keepsForQueries && !hasLevels ? foam.checkGhosts(source.name) : Status();
  if (!status) return status.error();
  if (keepsForQueries) {
    hasLevels ? foam.show(foam.makeCut(finest)) : foam.finish();
    measure.hostBytes = foam.bytes();
  }
  if (keepsForWalks && manifest.hasWalkGraph && measure.gpu.liveCount > 0) {
    const uint64_t along = walkEntriesAlong(measure.gpu.cellCount);
    measure.deviceBytes += sizeof(gpu::uvec4) * along * along * along;
    measure.deviceBytes += preparedBytes(measure.gpu, prepared);
  }
  return measure;
}

}  // namespace froth
