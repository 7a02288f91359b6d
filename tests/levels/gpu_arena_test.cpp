// Places in device memory that come and go one by one.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "runtime/asset/gpu_arena.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

Device makeDevice() {
  const FrothContextInfo info = sharedHost().contextInfo();
  Result<Device> device = Device::create(info.getInstanceProcAddr, info.instance, info.physicalDevice, info.device);
  EXPECT_TRUE(device);
  return *device;
}

struct Taken {
  GpuArena::Place place;
  VkDeviceSize size;
};

TEST(GpuArena, GivesPlacesThatDoNotOverlapAndTakesThemBack) {
  Device device = makeDevice();
  GpuArena arena(device);
  std::mt19937 random(3);
  std::vector<Taken> taken;
  VkDeviceSize takenBytes = 0, mostWaste = 0;
  bool isFull = false;  // from then on places come and go
  const auto sizeOf = [&] {
    return VkDeviceSize{200'000 + random() % 1'500'000};
  };  // of a chunk of 4 to 16 thousand cells, about
  for (int step = 0; step < 2000; ++step) {
    isFull = isFull || takenBytes > 150'000'000;
    const bool grows = takenBytes < 140'000'000 || (takenBytes < 150'000'000 && random() % 2 == 0);
    if (!isFull || grows) {
      const VkDeviceSize size = sizeOf();
      const Result<GpuArena::Place> place = arena.allocate(size, GpuArena::kMoreWherePlacesGo, "chunk");
      ASSERT_TRUE(place) << place.error().message;
      EXPECT_EQ(place->offset % GpuArena::kAlignment, 0u);
      for (const Taken& other : taken) {
        const bool isApart = other.place.buffer != place->buffer || other.place.offset + other.size <= place->offset ||
                             place->offset + size <= other.place.offset;
        ASSERT_TRUE(isApart) << step;
      }
      taken.push_back({*place, size});
      takenBytes += size;
    } else {
      const size_t index = random() % taken.size();
      arena.free(taken[index].place, taken[index].size);
      takenBytes -= taken[index].size;
      taken.erase(taken.begin() + static_cast<std::ptrdiff_t>(index));
    }
    if (isFull) mostWaste = std::max(mostWaste, (arena.heldBytes() - takenBytes) * 100 / takenBytes);
  }
  RecordProperty("mostWastePercent", static_cast<int>(mostWaste));
  EXPECT_TRUE(isFull);
  EXPECT_LT(mostWaste, 35u) << "percent of what is taken";
  for (const Taken& each : taken) arena.free(each.place, each.size);
  EXPECT_EQ(arena.heldBytes(), 0u);
  EXPECT_TRUE(arena.blocks().empty());
  EXPECT_EQ(device.ledger.deviceBytes(), 0u);
}

TEST(GpuArena, JoinsNeighbouringGaps) {
  Device device = makeDevice();
  GpuArena arena(device);
  constexpr VkDeviceSize kSize = 1 << 20;
  std::vector<GpuArena::Place> places;
  for (int i = 0; i < 5; ++i) places.push_back(*arena.allocate(kSize, 4 * kSize, "part"));
  ASSERT_EQ(arena.blocks().size(), 1u);
  for (const size_t i : {1, 3, 2}) arena.free(places[i], kSize);
  const Result<GpuArena::Place> joined = arena.allocate(3 * kSize, 0, "joined");
  ASSERT_TRUE(joined);
  EXPECT_EQ(joined->buffer, places[1].buffer);
  EXPECT_EQ(joined->offset, places[1].offset);
  EXPECT_EQ(arena.blocks().size(), 1u);
}

}  // namespace
}  // namespace froth::test
