// Where device memory comes from, and the report of it.
#include "callers_memory.h"
#include "one_cell_chunks.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class DeviceMemory : public RuntimeGpuTest {
 protected:
  FrothContextInfo infoWith(CallersMemory& memory) { return memory.with(host_->contextInfo()); }
  FrothMemoryReport report() { return reportOf(context_); }

  void draw(VkCommandBuffer commands, FrothView view, const HostImage& image) {
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = makeCamera(image.extent.width, image.extent.height);
    info.camera.eye[2] = 1e6 - 1;  // where the sample lies
    info.colour = host_->describe(image);
    EXPECT_EQ(frothRecordRaster(context_, view, commands, &info), FROTH_OK) << lastText();
  }

  // Draws what there is and reads it back.
  std::vector<float> draw(FrothView view, VkExtent2D extent = {32, 32}) {
    Result<HostImage> image = host_->createImage(VK_FORMAT_R16G16B16A16_SFLOAT, extent);
    runFrame(0, [&](VkCommandBuffer commands) { draw(commands, view, *image); });
    const Result<std::vector<float>> texels = host_->readImage(*image);
    host_->destroyImage(*image);
    return *texels;
  }

  // Opens the sample, draws it twice.
  std::vector<float> drawSample() {
    const FrothAsset asset = openBytes(encodeSample());
    const FrothInstance instance = createInstance(asset);
    const FrothView view = createView({32, 32});
    runFrame();
    std::vector<float> texels = draw(view);
    EXPECT_EQ(frothDestroyView(context_, view), FROTH_OK);
    EXPECT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
    EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
    return texels;
  }
};

TEST_F(DeviceMemory, OfTheCallersAllocatorServesEverythingAndAllOfItIsGivenBack) {
  createContext(host_->contextInfo());
  const std::vector<float> expected = drawSample();
  EXPECT_NE(expected, std::vector<float>(expected.size())) << "something is to be seen";
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);

  CallersMemory memory{.device = host_->device};
  createContext(infoWith(memory));
  EXPECT_EQ(drawSample(), expected);
  runFrame();
  const FrothMemoryReport now = report();
  size_t count = 0;
  for (uint32_t i = 0; i < now.categoryCount; ++i) count += now.categories[i].count;
  EXPECT_EQ(grantedIn(now), memory.bytes());
  EXPECT_EQ(count, memory.live.size());
  EXPECT_EQ(now.deviceBytes, 0u) << "only staging is left";
  EXPECT_GT(now.devicePeak, 0u);
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
  EXPECT_TRUE(memory.live.empty());
}

// Devices allow as few as 4096 allocations; a file may have more chunks than that.
TEST_F(DeviceMemory, OfAThousandChunksIsFewAllocationsAndDrawsAsOneChunkDoes) {
  CallersMemory memory{.device = host_->device};
  createContext(infoWith(memory));
  const AssetContents parted = makeOneCellChunks(1000);
  std::vector<std::vector<float>> images;
  const FrothView view = createView({64, 64});
  runFrame();
  const size_t before = memory.live.size();
  for (const AssetContents& contents : {parted, joinChunks(parted)}) {
    const FrothAsset asset = openBytes(*encodeAsset(contents));
    for (int frame = 0; frame < 6; ++frame) runFrame();
    ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
    EXPECT_LE(memory.live.size(), before + 4);
    const FrothAssetStatus status = statusOf(asset);
    uint64_t named = 0;
    for (uint32_t i = 0; i + 1 < status.memoryCount; ++i) named += status.memory[i].bytes;
    EXPECT_LE(status.deviceBytes, named + named / 4) << "little is spare";
    const FrothInstance instance = createInstance(asset);
    runFrame();
    draw(view, {64, 64});
    images.push_back(draw(view, {64, 64}));  // with space for all cells
    ASSERT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
    ASSERT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
    runFrame();
    runFrame();
    EXPECT_EQ(report().categories[0].count, 0u) << "blocks are given back";
  }
  EXPECT_GT(*std::max_element(images[0].begin(), images[0].end()), 0.1f);
  for (size_t i = 0; i < images[0].size(); ++i) ASSERT_NEAR(images[0][i], images[1][i], 2e-3) << i;
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
  EXPECT_TRUE(memory.live.empty());
}

TEST_F(DeviceMemory, ThatTheCallerRefusesIsAnErrorOfMemoryWithText) {
  CallersMemory memory{.device = host_->device, .most = 0};
  FrothContextInfo info = infoWith(memory);
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_MEMORY);
  EXPECT_THAT(lastText(), HasSubstr("upload ring: FrothContextInfo::allocateMemory of 16777216 bytes"));
  memory.most = 2;  // the upload ring and the placeholders of a view
  createContext(info);
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = {16, 16};
  FrothView view{};
  EXPECT_EQ(frothCreateView(context_, &viewInfo, &view), FROTH_ERROR_MEMORY);
  EXPECT_THAT(lastText(), HasSubstr("view: frames: FrothContextInfo::allocateMemory"));
  EXPECT_EQ(memory.live.size(), 1u) << "what was made before the refusal is given back";
  memory.most = 1;
  const FrothAsset asset = openBytes(encodeSample());
  runFrame();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED);
  EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_MEMORY);
  memory.most = SIZE_MAX;
  ASSERT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  EXPECT_EQ(drawSample().size(), size_t{4 * 32 * 32}) << "the context goes on";
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
  EXPECT_TRUE(memory.live.empty());
}

// Each allocation costs drivers a fraction of a millisecond, in frothCreateView and in frothUpdate.
TEST_F(DeviceMemory, OfAViewIsFiveAllocationsPerInstanceAndOneMore) {
  createContext(host_->contextInfo());
  const FrothAsset asset = openBytes(encodeSample());
  runFrame();
  createInstance(asset);
  createInstance(asset);
  const FrothView view = createView({32, 32});
  const FrothMemoryReport now = report();
  EXPECT_STREQ(now.categories[1].name, "views");
  EXPECT_EQ(now.categories[1].count, 1u + 2 * 5);
  EXPECT_STREQ(now.categories[2].name, "views, host");
  EXPECT_EQ(now.categories[2].count, 2u * 2);
  auto info = makeStruct<FrothViewInfo>();
  info.maxExtent = {32, 32};
  info.keepsHits = 1;
  FrothView withHits{};
  ASSERT_EQ(frothCreateView(context_, &info, &withHits), FROTH_OK);
  EXPECT_EQ(report().categories[1].count - now.categories[1].count, 1u + 2 * 5 + 1);
  EXPECT_EQ(frothDestroyView(context_, view), FROTH_OK);
}

TEST_F(DeviceMemory, OfAViewIsMadeOnceAndInItsSizeByTheCallThatMakesIt) {
  CallersMemory memory{.device = host_->device};
  createContext(infoWith(memory));
  createInstance(openBytes(encodeSample()));
  runFrame();
  const uintptr_t before = memory.count;
  createView({32, 32});
  EXPECT_EQ(memory.count - before, 1u + 5 + 2);
  runFrame();
  runFrame();
  EXPECT_EQ(memory.count - before, 1u + 5 + 2) << "frames allocate nothing";
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
}

TEST_F(DeviceMemory, IsNotTouchedByAWindowThatIsResizedOrMinimized) {
  createContext(host_->contextInfo());
  const FrothInstance instance = createInstance(openBytes(encodeSample()));
  const FrothView view = createView({32, 32});
  runFrame();
  const std::vector<float> whole = draw(view);
  runFrame();
  runFrame();  // what the view replaced as it grew is free
  const FrothMemoryReport before = report();
  for (const VkExtent2D extent : {VkExtent2D{16, 8}, VkExtent2D{1, 32}, VkExtent2D{31, 31}}) draw(view, extent);
  for (int frame = 0; frame < 5; ++frame) runFrame();  // minimized: frames without a picture
  EXPECT_EQ(draw(view), whole);
  const FrothMemoryReport after = report();
  for (uint32_t i = 0; i < after.categoryCount; ++i) {
    EXPECT_EQ(after.categories[i].count, before.categories[i].count);
    EXPECT_EQ(after.categories[i].peak, before.categories[i].peak);
  }
  EXPECT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
}

// Of three frames in flight, S is the first: of the objects that are closed behind it, and of a view that grows.
TEST_F(DeviceMemory, ThatAFrameUsesIsFreedWhenTheFrameIsCompleteAndNotBefore) {
  CallersMemory memory{.device = host_->device};
  FrothContextInfo info = infoWith(memory);
  info.framesInFlight = 3;
  createContext(info);
  const FrothAsset small = openBytes(encodeSample()), large = openBytes(encodeSample({.cellsPerChunk = 90}));
  const FrothView kept = createView({32, 32}), closed = createView({32, 32});
  Result<HostImage> image = host_->createImage(VK_FORMAT_R16G16B16A16_SFLOAT, {32, 32});
  auto frame = makeStruct<FrothFrame>();
  const auto runFrame = [&](uint64_t completedSerial, std::initializer_list<FrothView> views) {
    ++frame.serial;
    frame.completedSerial = completedSerial;
    ASSERT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK) << lastText();
    ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
      EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK);
      for (const FrothView view : views) draw(commands, view, *image);
      return Status();
    }));
  };
  const auto viewBytes = [&] {
    auto status = makeStruct<FrothViewStatus>();
    EXPECT_EQ(frothGetViewStatus(context_, kept, &status), FROTH_OK);
    return status.deviceBytes;
  };
  runFrame(0, {});
  const FrothInstance before = createInstance(small);
  runFrame(1, {});  // the views grow for it
  runFrame(2, {kept, closed});
  const uint64_t s = frame.serial;
  ASSERT_EQ(frothDestroyInstance(context_, before), FROTH_OK);
  ASSERT_EQ(frothCloseAsset(context_, small), FROTH_OK);
  ASSERT_EQ(frothDestroyView(context_, closed), FROTH_OK);
  createInstance(large);  // `kept` grows
  const std::map<void*, VkDeviceSize> used = memory.live;
  const auto isLive = [&](const auto& block) { return memory.live.contains(block.first); };
  for (int i = 0; i < 2; ++i) {
    runFrame(s - 1, {});
    EXPECT_TRUE(std::all_of(used.begin(), used.end(), isLive)) << "completedSerial is S - 1";
    EXPECT_EQ(grantedIn(report()), memory.bytes());
  }
  EXPECT_GT(memory.live.size(), used.size());
  const FrothMemoryReport late = report();
  const uint64_t lateViewBytes = viewBytes();
  runFrame(s, {});
  EXPECT_EQ(report().categories[0].count, late.categories[0].count - 1);
  EXPECT_LT(report().categories[1].count, late.categories[1].count / 2)
      << "those of `closed`, and what `kept` replaced";
  EXPECT_EQ(grantedIn(report()), memory.bytes());
  EXPECT_LT(viewBytes(), lateViewBytes) << "what a view replaced counted as long as it was there";
  host_->destroyImage(*image);
  ASSERT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  context_ = nullptr;
}

TEST_F(DeviceMemory, CallbacksComeInPairs) {
  FrothContextInfo info = nullContextInfo();
  info.freeMemory = CallersMemory::free;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("set both or none"));
}

TEST_F(DeviceMemory, IsReportedByPurpose) {
  createContext(host_->contextInfo());
  const FrothMemoryReport empty = report();
  ASSERT_EQ(empty.categoryCount, 6u);
  EXPECT_EQ(empty.deviceBytes, 0u);
  EXPECT_STREQ(empty.categories[3].name, "uploads, host");
  EXPECT_EQ(empty.categories[3].granted, 16u << 20);
  EXPECT_EQ(empty.categories[3].used, 0u);
  const FrothAsset asset = openBytes(encodeSample());
  createView({32, 32});
  runFrame();
  const FrothMemoryReport loaded = report();
  EXPECT_STREQ(loaded.categories[0].name, "assets");
  EXPECT_EQ(loaded.categories[0].granted, statusOf(asset).deviceBytes);
  EXPECT_LE(loaded.categories[0].used, loaded.categories[0].granted);
  EXPECT_GT(loaded.categories[0].used, 0u);
  EXPECT_EQ(loaded.deviceBytes, loaded.categories[0].granted + loaded.categories[1].granted);
  EXPECT_GT(loaded.categories[3].used, 0u) << "the upload is not known to be complete";
  ASSERT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  runFrame();
  const FrothMemoryReport closed = report();
  EXPECT_EQ(closed.categories[0].granted, 0u);
  EXPECT_EQ(closed.categories[0].count, 0u);
  EXPECT_EQ(closed.categories[0].peak, loaded.categories[0].peak);
  EXPECT_EQ(closed.categories[3].used, 0u);
}

}  // namespace
}  // namespace froth
