// What frothGetChunks tells of the chunks of an asset.
#include <limits>

#include "format/to_vector.h"
#include "runtime/asset/asset.h"

namespace froth {
namespace {

FrothChunkState chunkStateOf(SlotState state) {
  switch (state) {
    case SlotState::kAbsent:
      break;
    case SlotState::kComing:
      return FROTH_CHUNK_COMING;
    case SlotState::kResident:
    case SlotState::kLeaving:
      return FROTH_CHUNK_RESIDENT;
    case SlotState::kFailed:
      return FROTH_CHUNK_FAILED;
  }
  return FROTH_CHUNK_ABSENT;
}

FrothChunk describePlace(const AssetReader& reader, uint32_t number) {
  const AssetContents& manifest = reader.manifest();
  FrothChunk chunk{};
  chunk.liveCount = manifest.chunks[number].liveCount;
  chunk.coarserError = std::numeric_limits<double>::infinity();
  const Box box = reader.liveBounds(number);
  const glm::dvec3 centre = toVector(manifest.chunks[number].origin) + (toVector(box.min) + toVector(box.max)) / 2.0;
  for (int axis = 0; axis < 3; ++axis) chunk.centre[axis] = centre[axis];
  if (chunk.liveCount > 0) chunk.radius = glm::length(toVector(box.max) - toVector(box.min)) / 2;
  if (manifest.levels.empty()) return chunk;
  const ChunkLevel& level = manifest.levels[number];
  chunk.level = level.level;
  if (level.madeBy != kNoGroup) chunk.error = manifest.groups[level.madeBy].error;
  if (level.in != kNoGroup) chunk.coarserError = manifest.groups[level.in].error;
  return chunk;
}

}  // namespace

void Asset::describeChunks(const AssetReader& reader) {
  chunks_.clear();
  for (uint32_t chunk = 0; chunk < description_.chunkCount; ++chunk) chunks_.push_back(describePlace(reader, chunk));
}

FrothChunk Asset::describeChunk(uint32_t number, FrothAssetState state) const {
  FrothChunk chunk = chunks_[number];
  chunk.deviceBytes = chunkBytes(number);
  const bool isFloor = number < floorCount_;
  if (state == FROTH_ASSET_FAILED) {
    chunk.state = FROTH_CHUNK_FAILED;
  } else if (state == FROTH_ASSET_OPENING && isFloor) {
    chunk.state = FROTH_CHUNK_COMING;
  } else if (!hasLevels() || slots_.isDrawn(number)) {
    chunk.state = FROTH_CHUNK_DRAWN;
  } else {
    chunk.state = chunkStateOf(slots_.stateOf(number));
  }
  return chunk;
}

}  // namespace froth
