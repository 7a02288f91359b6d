// All host memory of the shared runtime goes through the engine's allocator.
#include "froth/froth_host.h"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "host/make_struct.h"
#include "tests/faults/engine.h"
#include "tests/faults/host_faults.h"
#include "tests/faults/vulkan_faults.h"
#include "tests/format/sample_asset.h"

namespace froth::test {
namespace {

constexpr int kMostFrames = 30;

FrothHostAllocator allocatorOf(void* (*allocate)(void*, size_t, size_t), void* user = nullptr) {
  return {sizeof(FrothHostAllocator), allocate, [](void*, void* memory, size_t, size_t) { std::free(memory); }, user};
}

FrothResult createNullContext(FrothContext** context) {
  auto info = makeStruct<FrothContextInfo>();
  info.abiVersion = FROTH_ABI_VERSION;
  const HostFaults::Zone zone;
  return frothCreateContext(&info, context);
}

class HostAllocator : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(HostFaults::isAllocator());
    HostFaults::arm(SIZE_MAX);
  }
  void TearDown() override { HostFaults::install(); }
};

// Loads, draws, asks, and ends.
void runThrough(Engine& engine) {
  EXPECT_EQ(engine.start(), FROTH_OK);
  EXPECT_EQ(engine.makeObjects(), FROTH_OK);
  for (int frame = 0; frame < kMostFrames && !engine.isAssetReady(); ++frame) EXPECT_GE(engine.drawFrame(), 0);
  EXPECT_EQ(engine.drawFrame(), FROTH_OK);
  EXPECT_EQ(engine.query(), FROTH_OK);
  EXPECT_EQ(engine.stop(), FROTH_OK);
  EXPECT_GT(HostFaults::count(), 100u);
  EXPECT_EQ(HostFaults::liveCount(), 0);
  EXPECT_EQ(HostFaults::mismatchCount(), 0u);
  EXPECT_EQ(HostFaults::foreignCount(), 0u);
}

TEST_F(HostAllocator, GivesAllMemoryOfANullContextAndGetsItBack) {
  for (const Engine::Source source : {Engine::Source::kMemory, Engine::Source::kReader}) {
    const std::vector<uint8_t> bytes =
        *encodeAsset(makeSampleAsset({.chunkCount = 2, .localBits = 16, .isQuantized = true}));
    HostFaults::arm(SIZE_MAX);
    Engine engine(nullptr, bytes, source);
    runThrough(engine);
  }
}

// Vulkan's own memory is the driver's: VulkanFaults stands around its calls.
TEST_F(HostAllocator, GivesAllMemoryOfAContextOnADeviceAndGetsItBack) {
  Result<std::unique_ptr<Host>> host = Host::create({});
  ASSERT_TRUE(host) << host.error().message;
  VulkanFaults::arm(SIZE_MAX, VK_SUCCESS);
  const std::vector<uint8_t> bytes = *encodeAsset(makeSampleAsset({.chunkCount = 2, .localBits = 16}));
  {
    Engine engine(host->get(), bytes);
    runThrough(engine);
  }
  VulkanFaults::clear((*host)->device);
}

TEST_F(HostAllocator, StaysWhileItsBlocksAreAlive) {
  FrothContext* context = nullptr;
  ASSERT_EQ(createNullContext(&context), FROTH_OK);
  EXPECT_EQ(frothSetHostAllocator(nullptr), FROTH_ERROR_STATE);
  EXPECT_EQ(frothDestroyContext(context, UINT64_MAX), FROTH_OK);
  EXPECT_EQ(frothSetHostAllocator(nullptr), FROTH_OK);
}

TEST_F(HostAllocator, OfNullIsMalloc) {
  ASSERT_EQ(frothSetHostAllocator(nullptr), FROTH_OK);
  FrothContext* context = nullptr;
  ASSERT_EQ(createNullContext(&context), FROTH_OK);
  EXPECT_EQ(HostFaults::count(), 0u);
  EXPECT_GT(HostFaults::foreignCount(), 0u);
  EXPECT_EQ(frothDestroyContext(context, UINT64_MAX), FROTH_OK);
}

TEST_F(HostAllocator, IsRefusedWhereItIsNotWhole) {
  const FrothHostAllocator whole = allocatorOf([](void*, size_t, size_t) -> void* { return nullptr; });
  FrothHostAllocator wrong = whole;
  wrong.allocate = nullptr;
  EXPECT_EQ(frothSetHostAllocator(&wrong), FROTH_ERROR_ARGUMENT);
  wrong = whole;
  wrong.release = nullptr;
  EXPECT_EQ(frothSetHostAllocator(&wrong), FROTH_ERROR_ARGUMENT);
  wrong = whole;
  wrong.structSize = 0;
  EXPECT_EQ(frothSetHostAllocator(&wrong), FROTH_ERROR_ARGUMENT);
  FrothContext* context = nullptr;
  ASSERT_EQ(createNullContext(&context), FROTH_OK);
  EXPECT_GT(HostFaults::count(), 0u) << "the allocator before is still in place";
  EXPECT_EQ(frothDestroyContext(context, UINT64_MAX), FROTH_OK);
}

// Fails, after it has thrown and caught what only the program's C++ library knows.
void* failAfterAnException(void* user, size_t, size_t) {
  try {
    throw std::runtime_error("in the allocator");
  } catch (const std::exception& error) {
    *static_cast<std::string*>(user) = error.what();
  }
  return nullptr;
}

TEST_F(HostAllocator, ThatFailsGivesMemoryAndItsExceptionsAndTheLibrarysDoNotMeet) {
  std::string caught;
  const FrothHostAllocator failing = allocatorOf(failAfterAnException, &caught);
  ASSERT_EQ(frothSetHostAllocator(&failing), FROTH_OK);
  try {
    try {
      throw std::invalid_argument("of the program");
    } catch (const std::exception&) {
      FrothContext* context = nullptr;  // the library throws and catches while this exception is handled
      EXPECT_EQ(createNullContext(&context), FROTH_ERROR_MEMORY);
      EXPECT_EQ(context, nullptr);
      throw;
    }
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "of the program");
  }
  EXPECT_EQ(caught, "in the allocator");
  EXPECT_EQ(std::uncaught_exceptions(), 0);
}

}  // namespace
}  // namespace froth::test
