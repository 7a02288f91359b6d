#include "runtime/asset/chunk_checks.h"

#include "format/checks.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "bake the scene again";

Status checkBounds(const ChunkContents& chunk, const Box& told, const std::string& place) {
  const Box found = liveBoundsOf(chunk);
  for (size_t axis = 0; axis < 3; ++axis) {
    if (told.min[axis] <= found.min[axis] && found.max[axis] <= told.max[axis]) continue;
    return makeError(ErrorKind::kBadInput,
                     "%s: live_bounds: %g to %g along axis %zu, and its live cells reach from %g to %g; %s",
                     place.c_str(), told.min[axis], told.max[axis], axis, found.min[axis], found.max[axis], kRemedy);
  }
  return {};
}

Status checkNeighbours(const ChunkContents& chunk, const std::string& place) {
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    for (uint32_t i = chunk.neighbourOffsets[cell]; i < chunk.neighbourOffsets[cell + 1]; ++i) {
      if (chunk.sites[chunk.neighbours[i]] != chunk.sites[cell]) continue;
      return makeError(ErrorKind::kBadInput,
                       "%s: cell %u and its neighbour %u are the same point, no plane parts them; %s", place.c_str(),
                       cell, chunk.neighbours[i], kRemedy);
    }
  }
  return {};
}

}  // namespace

Status checkClaims(const ChunkContents& chunk, const Box& liveBounds, const std::string& place) {
  const Status status = checkBounds(chunk, liveBounds, place);
  return status ? checkNeighbours(chunk, place) : status;
}

}  // namespace froth
