// A chunk as it comes out of a job: decoded, checked and packed. Only its places on the GPU are missing.
#pragma once

#include <optional>
#include <string>

#include "format/read/asset_reader.h"
#include "runtime/asset/chunk_arrays.h"
#include "runtime/asset/gpu_asset.h"
#include "runtime/query/chunk_geometry.h"
#include "runtime/query/query_foam.h"

namespace froth {

struct LoadedChunk {
  GpuChunk gpu;        // without addresses
  ChunkArrays arrays;  // for the GPU
  std::optional<QueryChunk> query;
  LiveBounds bounds;
};

// What an asset wants of its chunks besides their counts and bounds.
struct ChunkUses {
  bool drawing = false, queries = false;
};

// Any thread. `bytes`: as for AssetReader::readCodedChunk. `name` is the asset's, for messages.
Result<LoadedChunk> loadChunk(const AssetReader& reader, const ByteSource& bytes, uint32_t chunk,
                              const std::string& name, ChunkUses uses);

}  // namespace froth
