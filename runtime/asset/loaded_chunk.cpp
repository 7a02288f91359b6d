#include "runtime/asset/loaded_chunk.h"

#include <numeric>
#include <utility>

#include "format/checks.h"
#include "runtime/asset/cell_packer.h"
#include "runtime/asset/chunk_checks.h"
#include "runtime/query/packed_elements.h"

namespace froth {
namespace {

Status packArrays(CodedChunk&& coded, const AssetContents& manifest, LoadedChunk& loaded) {
  ChunkContents& contents = coded.contents;
  Result<PackedCells> cells = packCells(contents, std::move(coded.codes), manifest);
  if (!cells) {
    return cells.error();
  }
  PackedElements neighbours = packElements(contents.neighbours);
  PackedElements alphaCounts = packElements(contents.alphaCounts);
  loaded.gpu.neighbourShift = neighbours.shift;
  loaded.gpu.alphaShift = alphaCounts.shift;
  loaded.gpu.cellWordCount = static_cast<uint32_t>(cells->words.size());
  loaded.gpu.code = cells->code;
  loaded.gpu.lobeTotal = static_cast<uint32_t>(contents.lobeColours.size());
  loaded.gpu.lobeQuads = cells->hasShortLobes ? 1 : 2;
  ChunkArrays& arrays = loaded.arrays;
  arrays.add(joinSitesAndRadii(contents), "sites and radii", &GpuChunk::siteRadius);
  arrays.add(std::move(contents.neighbourOffsets), "neighbour offsets", &GpuChunk::neighbourOffsets);
  arrays.add(std::move(neighbours.words), "neighbours", &GpuChunk::neighbours);
  arrays.add(std::move(contents.ghostRefs), "ghost references", &GpuChunk::ghostRefs);
  arrays.add(std::move(alphaCounts.words), "alpha counts", &GpuChunk::alphaCounts);
  arrays.add(std::move(cells->starts), "cell starts", &GpuChunk::cellStarts);
  arrays.add(std::move(cells->words), "cells", &GpuChunk::cellWords);
  arrays.add(std::move(contents.solidBalls), "solid balls", &GpuChunk::solidBalls);
  arrays.add(std::move(contents.borderCells), "borders", &GpuChunk::borderCells);
  arrays.add(std::move(contents.borderNumbers), "borders", &GpuChunk::borderNumbers);
  return {};
}

}  // namespace

Result<LoadedChunk> loadChunk(const AssetReader& reader, const ByteSource& bytes, uint32_t chunk,
                              const std::string& name, ChunkUses uses) {
  Result<CodedChunk> coded = reader.readCodedChunk(chunk, bytes);
  if (!coded) {
    return coded.error();
  }
  const ChunkContents& contents = coded->contents;
  if (const Status status = checkClaims(contents, reader.liveBounds(chunk), chunkPlace(name, chunk)); !status) {
    return status.error();
  }
  LoadedChunk loaded;
  loaded.bounds = findLiveBounds(contents);
  GpuChunk& gpu = loaded.gpu;
  gpu.origin = contents.origin;
  for (int axis = 0; axis < 3; ++axis) {
    gpu.liveLow[static_cast<size_t>(axis)] = loaded.bounds.low[axis];
    gpu.liveHigh[static_cast<size_t>(axis)] = loaded.bounds.high[axis];
  }
  gpu.number = chunk;
  gpu.borderCount = static_cast<uint32_t>(contents.borderCells.size());
  gpu.cellCount = contents.cellCount;
  gpu.liveCount = contents.liveCount;
  gpu.siteCount = contents.cellCount + contents.ghostCount;
  gpu.neighbourCount = static_cast<uint32_t>(contents.neighbours.size());
  gpu.alphaTotal = std::accumulate(contents.alphaCounts.begin(), contents.alphaCounts.end(), uint64_t{0});
  if (uses.queries) {
    loaded.query = makeQueryChunk(contents);
  }
  if (uses.drawing) {
    if (const Status status = packArrays(std::move(*coded), reader.manifest(), loaded); !status) {
      return status.error();
    }
  }
  return loaded;
}

}  // namespace froth
