#include "runtime/context/level_budget.h"

#include <algorithm>

namespace froth {
namespace {

// Of what blocks hold: they leave up to 29 % unused where chunks come and go (GpuArena).
constexpr double kUsedPart = 0.7;
// The streamer leaves an eighth of its budget free for changes.
constexpr double kWantedPart = 7.0 / 8;

uint64_t scaled(uint64_t bytes, double factor) { return static_cast<uint64_t>(static_cast<double>(bytes) * factor); }

uint64_t blocksForAll(const LevelNeeds& needs) { return scaled(needs.allBytes, 1 / kUsedPart / kWantedPart); }

}  // namespace

LevelNeeds& LevelNeeds::operator+=(const LevelNeeds& other) {
  floorBytes += other.floorBytes;
  changeBytes = std::max(changeBytes, other.changeBytes);
  finestBytes += other.finestBytes;
  allBytes += other.allBytes;
  floorViewBytes += other.floorViewBytes;
  finestViewBytes += other.finestViewBytes;
  reservedViewBytes += other.reservedViewBytes;
  return *this;
}

uint64_t bytesForAll(const LevelNeeds& needs) { return blocksForAll(needs) + needs.reservedViewBytes; }

LevelShares shareBudget(uint64_t bytes, const LevelNeeds& needs) {
  const uint64_t leastBlocks = scaled(needs.floorBytes + needs.changeBytes, 1 / kUsedPart);
  const uint64_t mostBlocks = blocksForAll(needs);
  const uint64_t least = leastBlocks + needs.floorViewBytes;
  const double finestBlocks = static_cast<double>(needs.finestBytes) / kUsedPart / kWantedPart;
  const double viewPart = static_cast<double>(needs.finestViewBytes) /
                          std::max(finestBlocks + static_cast<double>(needs.finestViewBytes), 1.0);
  uint64_t views = needs.floorViewBytes + scaled(bytes - std::min(bytes, least), viewPart);
  if (bytes - std::min(bytes, mostBlocks) > views) views = bytes - mostBlocks;
  const bool isAll = views >= needs.reservedViewBytes;
  views = std::min({views, needs.reservedViewBytes, bytes - std::min(bytes, leastBlocks)});
  return {scaled(bytes - views, kUsedPart), isAll ? UINT64_MAX : views};
}

}  // namespace froth
