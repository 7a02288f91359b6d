#include "tests/commands/passes.h"

#include <cstddef>
#include <cstring>

#include "shaders/gpu/layout.h"

namespace froth::test {
namespace {

constexpr uint32_t kCounts[] = {offsetof(gpu::FrameBlock, slotTiles), offsetof(gpu::FrameBlock, tileCounts),
                                offsetof(gpu::FrameBlock, tileSums)};

bool isFrom(const Location& location, uint32_t pushOffset, uint32_t member) {
  return location.addresses.size() >= 2 && location.addresses[0] == pushOffset && location.addresses[1] == member;
}

}  // namespace

bool happens(const std::string& shader, const Location& location, const std::array<uint8_t, 128>& push) {
  if (!shader.starts_with("sort_scatter") || location.root != Root::kPushConstants) return true;
  gpu::SortConstants constants;
  std::memcpy(&constants, push.data(), sizeof(constants));
  for (const uint32_t member : kCounts) {
    if (isFrom(location, 0, member)) return constants.step == gpu::kSortTakeTileCounts;
  }
  const bool isNextHistogram = location.addresses[0] == offsetof(gpu::SortConstants, nextHistogram);
  return !isNextHistogram || constants.step == gpu::kSortCountNextDigit;
}

bool writeDifferentPlaces(const Use& earlier, const Use& later, const Range&) {
  const auto publishes = [](const Use& use) { return use.isWrite && use.by.starts_with("publish_borders"); };
  const auto draws = [](const Use& use) { return use.isWrite && !use.isAtomic && use.by.starts_with("raster_"); };
  return (draws(earlier) && draws(later)) || (publishes(earlier) && publishes(later));
}

}  // namespace froth::test
