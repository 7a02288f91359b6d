// Buffers that share an allocation.
#include <array>
#include <cstring>

#include "runtime/device/device.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

// Odd sizes, and one that is not made.
constexpr std::array<BufferWish, 4> kWishes = {{{1000, "first"}, {0, "none"}, {77, "second"}, {5000, "third"}}};
using Made = std::array<GpuBuffer, kWishes.size()>;

class SharedMemory : public RuntimeGpuTest {
 protected:
  void SetUp() override {
    RuntimeGpuTest::SetUp();
    Result<Device> device =
        Device::create(vkGetInstanceProcAddr, host_->instance, host_->physicalDevice, host_->device);
    ASSERT_TRUE(device);
    device_ = *device;
  }

  Status make(BufferKind kind, Made& made) {
    const MemoryUse use = kind == BufferKind::kDevice ? MemoryUse::kViews : MemoryUse::kViewsHost;
    return device_.createBuffers(use, kind, "group", kWishes, made);
  }

  void destroy(Made& made) {
    for (GpuBuffer& buffer : made) device_.destroyBuffer(buffer);
    EXPECT_EQ(device_.ledger.count(), 0u);
    EXPECT_EQ(device_.ledger.deviceBytes() + device_.ledger.hostBytes(), 0u);
  }

  Device device_;
};

TEST_F(SharedMemory, IsOneAllocationOfPartsThatLieApart) {
  Made made{};
  ASSERT_TRUE(make(BufferKind::kReadback, made));
  EXPECT_EQ(device_.ledger.count(), 1u);
  EXPECT_EQ(made[1].buffer, VkBuffer(VK_NULL_HANDLE));
  EXPECT_EQ(made[1].size, 0u);
  VkDeviceSize end = 0;
  for (const size_t i : {0, 2, 3}) {
    VkMemoryRequirements own{};
    vkGetBufferMemoryRequirements(host_->device, made[i].buffer, &own);
    EXPECT_EQ(made[i].size, kWishes[i].size);
    EXPECT_EQ(made[i].offset % own.alignment, 0u);
    EXPECT_GE(made[i].offset, end);
    end = made[i].offset + own.size;
    EXPECT_EQ(made[i].address - made[0].address, made[i].offset);
    EXPECT_EQ(static_cast<char*>(made[i].mapped) - static_cast<char*>(made[0].mapped),
              static_cast<ptrdiff_t>(made[i].offset));
  }
  EXPECT_LE(end, made[3].memory.granted);
  EXPECT_EQ(made[3].memory.used, 1000u + 77 + 5000);
  // The GPU writes where the mapped address is read.
  for (const size_t i : {0, 2, 3}) std::memset(made[i].mapped, 0, made[i].size);
  ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
    vkCmdFillBuffer(commands, made[2].buffer, 0, 76, 0x01010101);
    return Status();
  }));
  for (const size_t i : {0, 2, 3}) {
    const auto* bytes = static_cast<const char*>(made[i].mapped);
    EXPECT_EQ(std::count(bytes, bytes + made[i].size, 1), i == 2 ? 76 : 0) << kWishes[i].name;
  }
  destroy(made);
}

TEST_F(SharedMemory, IsNeverMoreThanOneAllocationMayHold) {
  device_.maxAllocationSize = 5200;  // the third alone
  Made made{};
  ASSERT_TRUE(make(BufferKind::kDevice, made));
  EXPECT_EQ(device_.ledger.count(), 2u);
  EXPECT_EQ(made[2].memory.used, 1000u + 77);
  EXPECT_EQ(made[3].memory.used, 5000u);
  EXPECT_EQ(made[3].offset, 0u);
  destroy(made);
  device_.maxAllocationSize = 4999;
  const Status status = make(BufferKind::kDevice, made);
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("third: 5000 bytes, but a buffer of this device has at most 4999"));
  destroy(made);
}

TEST_F(SharedMemory, ThatDoesNotFitTheBudgetLeavesNothing) {
  device_.maxAllocationSize = 5200;
  device_.budget = 5200;  // enough for each allocation, not for both
  Made made{};
  const Status status = make(BufferKind::kDevice, made);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, ErrorKind::kMemory);
  EXPECT_THAT(status.error().message, HasSubstr("group: "));
  for (const GpuBuffer& buffer : made) EXPECT_EQ(buffer.buffer, VkBuffer(VK_NULL_HANDLE));
  EXPECT_EQ(device_.ledger.count(), 0u);
}

}  // namespace
}  // namespace froth
