// The calls of streaming: numbers checked, and what LevelStreaming tells.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/context/context.h"

namespace froth {
namespace {

bool isAtLeastZero(double value) { return std::isfinite(value) && value >= 0; }

// The name of the first field that is wrong; null: none.
const char* findWrongField(const FrothStreamPoint& point) {
  for (const double coordinate : point.position) {
    if (!std::isfinite(coordinate)) return "position";
  }
  if (!isAtLeastZero(point.radius)) return "radius";
  if (!isAtLeastZero(point.pixelAngle) || point.pixelAngle == 0) return "pixelAngle";
  return isAtLeastZero(point.detail) ? nullptr : "detail";
}

SeenFrom seenFrom(const FrothStreamPoint& point) {
  SeenFrom seen;
  std::copy(std::begin(point.position), std::end(point.position), seen.position.begin());
  seen.radius = point.radius;
  seen.pixelAngle = point.pixelAngle;
  seen.detail = point.detail == 0 ? 1 : point.detail;
  return seen;
}

}  // namespace

FrothResult Context::setStreaming(const FrothStreamInfo& info) {
  constexpr const char* kCall = "frothSetStreaming";
  if (!isAtLeastZero(info.detail)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "detail: %g; a finite number of 0 or more", info.detail);
  }
  if (info.pointCount > 0 && !info.points) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "points: null, and pointCount is %u", info.pointCount);
  }
  std::vector<SeenFrom> points;
  for (uint32_t i = 0; i < info.pointCount; ++i) {
    if (const char* const field = findWrongField(info.points[i])) {
      return messages.fail(
          FROTH_ERROR_ARGUMENT, kCall,
          "points[%u].%s: out of range; numbers are finite, pixelAngle above 0, radius and detail 0 or "
          "more",
          i, field);
    }
    points.push_back(seenFrom(info.points[i]));
  }
  streamPoints_ = std::move(points);
  streamDetail_ = info.detail == 0 ? 1 : info.detail;
  streamCells_ = info.mostCells == 0 ? std::numeric_limits<uint64_t>::max() : info.mostCells;
  areEyesFrozen_ = info.isFrozen != 0;
  return FROTH_OK;
}

FrothResult Context::describeStreaming(FrothStreamStatus& status) const {
  const StreamStatistics figures = levels_.streamer().statistics();
  const auto chunksIn = [&](ChunkState state) {
    return static_cast<uint32_t>(figures.states[static_cast<size_t>(state)].chunks);
  };
  status.isSettled = levels_.isSettled();
  status.drawnChunks = levels_.drawnChunks();
  status.residentChunks = chunksIn(ChunkState::kResident);
  status.comingChunks = chunksIn(ChunkState::kReading);
  status.failedChunks = chunksIn(ChunkState::kFailed);
  status.usedBytes = figures.usedBytes;
  status.budgetBytes = levels_.budgetBytes() == UINT64_MAX ? 0 : levels_.budgetBytes();
  status.excessBytes = figures.excessBytes;
  status.oldestRequest = figures.oldestRequest;
  status.floorHits = figures.floorHits;
  status.evictions = figures.evictions;
  status.retries = figures.retries;
  status.failures = figures.failures;
  return FROTH_OK;
}

FrothResult Context::copyChunks(FrothAsset handle, uint32_t capacity, FrothChunk* chunks, uint32_t& count) const {
  constexpr const char* kCall = "frothGetChunks";
  const Asset* asset = assets_.find(handle);
  if (!asset) {
    return messages.fail(FROTH_ERROR_HANDLE, kCall, "asset {%u, %u}: closed or never opened", handle.index,
                         handle.generation);
  }
  if (capacity > 0 && !chunks) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "chunks: null, with capacity %u", capacity);
  }
  const FrothAssetState state = stateOf(*asset);
  count = asset->chunkCount();
  for (uint32_t chunk = 0; chunk < std::min(capacity, count); ++chunk) {
    chunks[chunk] = asset->describeChunk(chunk, state);
  }
  return FROTH_OK;
}

}  // namespace froth
