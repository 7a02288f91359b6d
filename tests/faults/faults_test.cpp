// Every call that can fail does, one after the other: each time a status of the contract, one message, and
// the engine goes on.
#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "froth/froth_host.h"
#include "tests/faults/engine.h"
#include "tests/faults/host_faults.h"
#include "tests/faults/vulkan_faults.h"
#include "tests/format/sample_asset.h"

namespace froth::test {
namespace {

constexpr int kFrames = 5, kMostFrames = 30;
constexpr int kMostRetries = 3;

std::vector<uint8_t> encodeSample(uint32_t chunkCount) {
  return *encodeAsset(makeSampleAsset({.chunkCount = chunkCount, .localBits = 16}));
}

// Calls `step` until it goes well, and does what the contract says about its errors. Each must be `expected`.
template <class Step>
bool persist(Engine& engine, FrothResult expected, Step step) {
  for (int retry = 0; retry < kMostRetries; ++retry) {
    const FrothResult result = step();
    if (result >= 0) return true;
    EXPECT_EQ(result, expected) << frothResultName(result);
    if (!engine.recover(result)) return false;
  }
  return false;
}

// From the first call to the last. False: it could not go on.
bool runScenario(Engine& engine, FrothResult expected) {
  if (const FrothResult result = engine.start(); result != FROTH_OK) {
    EXPECT_EQ(result, expected) << frothResultName(result);
    EXPECT_FALSE(engine.hasContext());
    if (engine.start() != FROTH_OK) return false;
  }
  for (int readyFrames = 0, frames = 0; readyFrames < kFrames && frames < kMostFrames; ++frames) {
    if (!persist(engine, expected, [&] { return engine.makeObjects(); })) return false;
    if (!persist(engine, expected, [&] { return engine.drawFrame(); })) return false;
    readyFrames = engine.isAssetReady() ? readyFrames + 1 : 0;  // it loads again after a loss
  }
  return persist(engine, expected, [&] { return engine.stop(); });
}

class VulkanFault : public testing::TestWithParam<VkResult> {
 protected:
  void SetUp() override {
    Result<std::unique_ptr<Host>> host = Host::create({});
    ASSERT_TRUE(host) << host.error().message;
    host_ = std::move(*host);
  }
  void TearDown() override { VulkanFaults::clear(host_->device); }

  std::unique_ptr<Host> host_;
};

TEST_P(VulkanFault, InAnyCallGivesItsStatusAndOneMessageAndTheEngineGoesOn) {
  const std::vector<uint8_t> bytes = encodeSample(2);
  const FrothResult expected = GetParam() == VK_ERROR_DEVICE_LOST ? FROTH_ERROR_DEVICE : FROTH_ERROR_MEMORY;
  Engine well(host_.get(), bytes);
  VulkanFaults::arm(SIZE_MAX, VK_SUCCESS);
  ASSERT_TRUE(runScenario(well, FROTH_OK));
  ASSERT_TRUE(well.messages.empty());
  ASSERT_TRUE(VulkanFaults::live.empty()) << VulkanFaults::live.begin()->second;
  ASSERT_TRUE(VulkanFaults::unnamed.empty()) << VulkanFaults::unnamed.front();
  EXPECT_NE(well.raster, std::vector<float>(well.raster.size()));
  const size_t calls = VulkanFaults::calls;
  EXPECT_GT(calls, 100u);
  const size_t stride = GetParam() == VK_ERROR_OUT_OF_HOST_MEMORY ? 8 : 1;  // goes the way of the other memory
  for (size_t number = 0; number < calls; number += stride) {
    Engine engine(host_.get(), bytes);
    VulkanFaults::arm(number, GetParam());
    ASSERT_TRUE(runScenario(engine, expected)) << VulkanFaults::struck << ", call " << number;
    SCOPED_TRACE(VulkanFaults::struck + ", call " + std::to_string(number));
    EXPECT_NE(VulkanFaults::struck, "");
    const bool isUnimportant = VulkanFaults::struck == "vkGetQueryPoolResults" && expected != FROTH_ERROR_DEVICE;
    EXPECT_EQ(engine.messages.size(), isUnimportant ? 0u : 1u);
    for (const Engine::Message& message : engine.messages) {
      EXPECT_EQ(message.code, expected) << message.text;
      EXPECT_EQ(message.text.find("frothDeviceLost") != std::string::npos, expected == FROTH_ERROR_DEVICE);
    }
    EXPECT_EQ(engine.raster, well.raster);
    EXPECT_EQ(engine.walk, well.walk);
    ASSERT_TRUE(VulkanFaults::live.empty()) << VulkanFaults::live.begin()->second;
    ASSERT_TRUE(VulkanFaults::misuse.empty()) << VulkanFaults::misuse.front();
  }
}

INSTANTIATE_TEST_SUITE_P(Of, VulkanFault,
                         testing::Values(VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY,
                                         VK_ERROR_DEVICE_LOST),
                         [](const auto& test) {
                           return test.param == VK_ERROR_DEVICE_LOST          ? "Device"
                                  : test.param == VK_ERROR_OUT_OF_HOST_MEMORY ? "HostMemory"
                                                                              : "DeviceMemory";
                         });

// Each allocation fails once.
void exhaustHostMemory(Host* host, Engine::Source source = Engine::Source::kMemory) {
  const std::vector<uint8_t> bytes = encodeSample(host ? 1 : 2);
  Engine well(host, bytes, source);
  HostFaults::arm(SIZE_MAX);
  ASSERT_TRUE(runScenario(well, FROTH_OK));
  const long liveBefore = HostFaults::liveCount();
  size_t number = 0;
  for (bool hasStruck = true; hasStruck; ++number) {
    SCOPED_TRACE("allocation " + std::to_string(number));
    {
      Engine engine(host, bytes, source);
      HostFaults::arm(number);
      ASSERT_TRUE(runScenario(engine, FROTH_ERROR_MEMORY));
      hasStruck = HostFaults::hasStruck();
      EXPECT_EQ(engine.raster, well.raster);
      EXPECT_EQ(engine.walk, well.walk);
      EXPECT_LE(engine.messages.size(), 1u);
      for (const Engine::Message& message : engine.messages) EXPECT_EQ(message.code, FROTH_ERROR_MEMORY);
    }
    ASSERT_EQ(HostFaults::liveCount(), liveBefore);
    ASSERT_TRUE(VulkanFaults::live.empty()) << VulkanFaults::live.begin()->second;
  }
  HostFaults::arm(SIZE_MAX);
  EXPECT_GT(number, 100u);
}

TEST(HostAllocators, AreForARuntimeWithAHeapOfItsOwn) {
  EXPECT_EQ(HostFaults::isAllocator(), FROTH_HAS_OWN_HEAP != 0);
  if (!HostFaults::isAllocator()) {
    EXPECT_EQ(frothSetHostAllocator(nullptr), FROTH_ERROR_UNSUPPORTED);
  }
}

// Once all is loaded.
TEST(HostAllocations, AreNotMadeByFramesAndQueries) {
  Result<std::unique_ptr<Host>> host = Host::create({});
  ASSERT_TRUE(host) << host.error().message;
  VulkanFaults::arm(SIZE_MAX, VK_SUCCESS);
  const std::vector<uint8_t> bytes = encodeSample(2);
  {
    Engine engine(host->get(), bytes);
    ASSERT_EQ(engine.start(), FROTH_OK);
    ASSERT_EQ(engine.makeObjects(), FROTH_OK);
    for (int frame = 0; frame < kMostFrames && !engine.isAssetReady(); ++frame) ASSERT_GE(engine.drawFrame(), 0);
    for (int frame = 0; frame < kFrames; ++frame) ASSERT_EQ(engine.drawFrame(), FROTH_OK);
    HostFaults::arm(SIZE_MAX);
    EXPECT_EQ(engine.drawFrame(), FROTH_OK);
    EXPECT_EQ(HostFaults::count(), 0u);
    EXPECT_EQ(engine.query(), FROTH_OK);
    EXPECT_EQ(HostFaults::count(), 0u);
    EXPECT_EQ(HostFaults::foreignCount(), 0u);
    EXPECT_EQ(engine.stop(), FROTH_OK);
  }
  VulkanFaults::clear((*host)->device);
}

TEST(HostFault, InAnyAllocationOfANullContextGivesMemoryAndTheEngineGoesOn) { exhaustHostMemory(nullptr); }

TEST(HostFault, InAnyAllocationBesideAReaderGivesMemoryAndTheEngineGoesOn) {
  exhaustHostMemory(nullptr, Engine::Source::kReader);
}

TEST(HostFault, InAnyAllocationOnADeviceGivesMemoryAndTheEngineGoesOn) {
  Result<std::unique_ptr<Host>> host = Host::create({});
  ASSERT_TRUE(host) << host.error().message;
  VulkanFaults::arm(SIZE_MAX, VK_SUCCESS);
  exhaustHostMemory(host->get());
  VulkanFaults::clear((*host)->device);
}

}  // namespace
}  // namespace froth::test
