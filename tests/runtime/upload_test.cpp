// What arrives on the GPU, seen from the inside: the arrays of a loaded asset are those of its file.
#include <utility>

#include "runtime/asset/cell_packer.h"
#include "runtime/context/context.h"
#include "runtime/query/packed_elements.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Upload : public RuntimeGpuTest {
 protected:
  // A device as the context has one, for read-back.
  Device device() {
    Result<Device> device =
        Device::create(vkGetInstanceProcAddr, host_->instance, host_->physicalDevice, host_->device);
    EXPECT_TRUE(device);
    return *device;
  }

  template <class T>
  void expectOnGpu(const Asset& asset, VkDeviceAddress address, const std::vector<T>& expected, const char* name) {
    if (expected.empty()) {
      EXPECT_EQ(address, 0u) << name;
      return;
    }
    const auto buffers = asset.buffers();
    const auto source = std::find_if(buffers.begin(), buffers.end(), [&](const GpuBuffer& buffer) {
      return buffer.address <= address && address < buffer.address + buffer.size;
    });
    ASSERT_NE(source, buffers.end()) << name;
    const VkDeviceSize offset = address - source->address, size = expected.size() * sizeof(T);
    ASSERT_LE(offset + size, source->size) << name;
    Device reader = device();
    Result<GpuBuffer> copy = reader.createBuffer(MemoryUse::kUploadsHost, BufferKind::kReadback, size, "read-back");
    ASSERT_TRUE(copy) << copy.error().message;
    const Status status = host_->submit([&](VkCommandBuffer commands, uint64_t) {
      const VkBufferCopy region{offset, 0, size};
      vkCmdCopyBuffer(commands, source->buffer, copy->buffer, 1, &region);
      return Status();
    });
    EXPECT_TRUE(status);
    EXPECT_EQ(std::memcmp(copy->mapped, expected.data(), size), 0) << name;
    reader.destroyBuffer(*copy);
  }

  void expectContentsOnGpu(FrothAsset handle, const AssetContents& contents) {
    const Asset* asset = context_->findAsset(handle);
    ASSERT_EQ(asset->gpu().chunks.size(), contents.chunks.size());
    for (size_t c = 0; c < contents.chunks.size(); ++c) {
      const ChunkContents& chunk = contents.chunks[c];
      const GpuChunk& gpu = asset->gpu().chunks[c];
      EXPECT_EQ(gpu.origin, chunk.origin);
      EXPECT_EQ(gpu.cellCount, chunk.cellCount);
      EXPECT_EQ(gpu.liveCount, chunk.liveCount);
      EXPECT_EQ(gpu.neighbourCount, chunk.neighbours.size());
      std::vector<glm::vec4> siteRadius;
      for (size_t i = 0; i < chunk.sites.size(); ++i) siteRadius.emplace_back(chunk.sites[i], chunk.radii[i]);
      expectOnGpu(*asset, gpu.siteRadius, siteRadius, "siteRadius");
      expectOnGpu(*asset, gpu.neighbourOffsets, chunk.neighbourOffsets, "neighbourOffsets");
      expectOnGpu(*asset, gpu.neighbours, packElements(chunk.neighbours).words, "neighbours");
      expectOnGpu(*asset, gpu.alphaCounts, packElements(chunk.alphaCounts).words, "alphaCounts");
      const Result<PackedCells> cells = packCells(chunk, {}, contents);
      ASSERT_TRUE(cells);
      expectOnGpu(*asset, gpu.cellStarts, cells->starts, "cellStarts");
      expectOnGpu(*asset, gpu.cellWords, cells->words, "cellWords");
      expectOnGpu(*asset, gpu.solidBalls, chunk.solidBalls, "solidBalls");
    }
  }

  // Records a frame and does not submit it.
  void dropFrame(uint64_t uploadBytes) {
    const uint64_t serial = host_->nextSerial();
    ASSERT_EQ(update(serial, uploadBytes), FROTH_OK);
    const Status status = host_->submit([&](VkCommandBuffer commands, uint64_t) -> Status {
      EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK);
      return makeError(ErrorKind::kCancelled, "dropped");
    });
    ASSERT_FALSE(status);
    ASSERT_EQ(frothDropFrame(context_, serial), FROTH_OK) << lastText();
  }
};

TEST_F(Upload, InOneFrameGivesTheContents) {
  createContext(host_->contextInfo());
  const FrothAsset asset = openBytes(encodeSample());
  runFrame();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_GT(statusOf(asset).deviceBytes, 0u);
  expectContentsOnGpu(asset, makeSampleAsset());
}

TEST_F(Upload, WithoutHeightsAllocatesNothingForThem) {
  createContext(host_->contextInfo());
  const FrothAsset asset = openBytes(encodeSample({.hasHeights = false}));
  runFrame();
  EXPECT_FALSE(context_->findAsset(asset)->gpu().hasHeights);
  expectContentsOnGpu(asset, makeSampleAsset({.hasHeights = false}));
}

TEST_F(Upload, InPiecesWithADroppedFrameAmongThemGivesTheContents) {
  createContext(host_->contextInfo());
  const SampleOptions options{.chunkCount = 3, .cellsPerChunk = 12, .localBits = 16, .detailCount = 3};
  const FrothAsset asset = openBytes(encodeSample(options));
  constexpr uint64_t kPiece = 611;  // no divisor of anything
  int frames = 0;
  while (statusOf(asset).state == FROTH_ASSET_OPENING && frames < 200) {
    if (++frames % 4 == 0) {
      dropFrame(kPiece);
      EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING) << "what was dropped is not uploaded";
    } else {
      runFrame(kPiece);
    }
  }
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_GT(frames, 10);
  expectContentsOnGpu(asset, makeSampleAsset(options));
}

TEST_F(Upload, ThroughALittleStagingMemoryGivesTheContents) {
  FrothContextInfo info = host_->contextInfo();
  info.stagingBytes = 65535;
  FrothContext* refused = nullptr;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &refused), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("stagingBytes: 65535; at least 65536"));
  info.stagingBytes = 65536;
  createContext(info);
  auto report = makeStruct<FrothMemoryReport>();
  ASSERT_EQ(frothGetMemoryReport(context_, &report), FROTH_OK);
  EXPECT_EQ(report.categories[static_cast<uint32_t>(MemoryUse::kUploadsHost)].granted, 65536u);
  const SampleOptions options{.chunkCount = 60, .cellsPerChunk = 36, .localBits = 16, .detailCount = 3};
  const FrothAsset asset = openBytes(encodeSample(options));
  for (int frame = 0; statusOf(asset).state == FROTH_ASSET_OPENING && frame < 1000; ++frame) runFrame();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  EXPECT_GT(statusOf(asset).deviceBytes, 2 * info.stagingBytes);
  expectContentsOnGpu(asset, makeSampleAsset(options));
}

TEST_F(Upload, DroppedAtTheEndTakesTheAssetBackToOpening) {
  createContext(host_->contextInfo());
  const FrothAsset asset = openBytes(encodeSample());
  dropFrame(0);
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
  runFrame(100);  // smaller pieces than before
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_OPENING);
  runFrame();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  expectContentsOnGpu(asset, makeSampleAsset());
}

TEST_F(Upload, IsReportedInBytes) {
  createContext(host_->contextInfo());
  const FrothAsset asset = openBytes(encodeSample());
  runFrame(300);
  auto frame = makeStruct<FrothFrame>();
  frame.serial = host_->nextSerial();
  frame.completedSerial = frame.serial - 1;
  auto status = makeStruct<FrothFrameStatus>();
  ASSERT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK);
  const FrothAssetStatus described = statusOf(asset);
  uint64_t size = 0;
  for (uint32_t i = 0; i < described.memoryCount; ++i) {
    if (std::strcmp(described.memory[i].name, "alignment, spare") != 0) size += described.memory[i].bytes;
  }
  EXPECT_EQ(status.uploadBytesQueued, size - 300);
  EXPECT_EQ(status.assetsOpening, 1u);
  EXPECT_EQ(status.deviceBytes, statusOf(asset).deviceBytes);
  EXPECT_GE(status.hostBytes, 1u << 20);
}

TEST_F(Upload, OfSeveralCallsInAFrameKeepsToTheBytesOfTheFrame) {
  createContext(host_->contextInfo());
  openBytes(encodeSample());
  auto frame = makeStruct<FrothFrame>();
  auto status = makeStruct<FrothFrameStatus>();
  uint64_t queuedBefore = 0;
  for (const uint64_t limit : {300, 100, 200}) {
    frame.serial = host_->nextSerial();
    frame.completedSerial = frame.serial - 1;
    frame.uploadBytes = limit;
    ASSERT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK);
    if (queuedBefore > 0) {
      EXPECT_EQ(queuedBefore - status.uploadBytesQueued, limit == 100 ? 300u : 100u);
    }
    queuedBefore = status.uploadBytesQueued;
    ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
      for (int call = 0; call < 3; ++call) EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK);
      return Status();
    }));
  }
}

TEST_F(Upload, BeyondTheBudgetFailsWithNumbersAndGivesTheMemoryBack) {
  FrothContextInfo info = host_->contextInfo();
  info.deviceBudget = 1000;
  createContext(info);
  const FrothAsset asset = openBytes(encodeSample({.cellsPerChunk = 12}));
  runFrame();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_FAILED);
  EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_MEMORY);
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_THAT(messages_[0].text, HasSubstr("chunk 0"));
  EXPECT_THAT(messages_[0].text, HasSubstr("of 1000 bytes are in use; raise FrothContextInfo::deviceBudget by"));
  runFrame();
  auto frame = makeStruct<FrothFrame>();
  frame.serial = host_->nextSerial();
  frame.completedSerial = frame.serial - 1;
  auto status = makeStruct<FrothFrameStatus>();
  ASSERT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK);
  EXPECT_EQ(status.deviceBytes, 0u);
  EXPECT_EQ(messages_.size(), 1u) << "once, not in every frame";
}

TEST_F(Upload, ThatFitsTheBudgetWhileTheViewDoesNotLeavesTheViewRefused) {
  FrothContextInfo info = host_->contextInfo();
  info.deviceBudget = 16 << 10;
  createContext(info);
  const FrothAsset asset = openBytes(encodeSample());
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = {4096, 4096};
  FrothView view{};
  EXPECT_EQ(frothCreateView(context_, &viewInfo, &view), FROTH_ERROR_MEMORY);
  ASSERT_EQ(messages_.size(), 1u);
  EXPECT_THAT(messages_[0].text, HasSubstr("of 16384 bytes are in use; raise FrothContextInfo::deviceBudget by"));
  runFrame();
  EXPECT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
}

TEST_F(Upload, OfAnAssetThatIsClosedHalfwayStopsAndLeavesTheOther) {
  createContext(host_->contextInfo());
  const FrothAsset first = openBytes(encodeSample());
  const FrothAsset second = openBytes(encodeSample());
  runFrame(500);
  dropFrame(500);  // has copies of the first that would be recorded again
  ASSERT_EQ(frothCloseAsset(context_, first), FROTH_OK);
  runFrame();
  EXPECT_EQ(statusOf(second).state, FROTH_ASSET_READY);
  expectContentsOnGpu(second, makeSampleAsset());
}

TEST_F(Upload, ThroughASmallRingWrapsAround) {
  Device gpu = device();
  Result<std::unique_ptr<UploadRing>> ring = UploadRing::create(gpu, 1000);
  Result<GpuBuffer> target = gpu.createBuffer(MemoryUse::kUploadsHost, BufferKind::kReadback, 4096, "target");
  ASSERT_TRUE(ring && target);
  std::vector<uint8_t> bytes(4096);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(i * 7 + i / 256);
  VkDeviceSize staged = 0;
  while (staged < bytes.size()) {
    const Status status = host_->submit([&](VkCommandBuffer commands, uint64_t serial) {
      (*ring)->retire(serial - 1);
      const VkDeviceSize piece = std::min<VkDeviceSize>(700, bytes.size() - staged);
      EXPECT_EQ((*ring)->stage(this, target->buffer, staged, bytes.data() + staged, piece), piece);
      EXPECT_EQ((*ring)->record(commands, serial, UINT64_MAX), piece);
      staged += piece;
      return Status();
    });
    ASSERT_TRUE(status);
  }
  EXPECT_EQ(std::memcmp(target->mapped, bytes.data(), bytes.size()), 0);
  gpu.destroyBuffer(*target);
}

TEST_F(Upload, TakesNothingIntoAFullRingBeforeAFrameIsComplete) {
  Device gpu = device();
  Result<std::unique_ptr<UploadRing>> ring = UploadRing::create(gpu, 1000);
  Result<GpuBuffer> target = gpu.createBuffer(MemoryUse::kAssets, BufferKind::kDevice, 4096, "target");
  ASSERT_TRUE(ring && target);
  const std::vector<uint8_t> bytes(4096);
  EXPECT_EQ((*ring)->stage(this, target->buffer, 0, bytes.data(), 4096), 1000u);
  EXPECT_FALSE((*ring)->isWithin(this, UINT64_MAX - 1)) << "not yet recorded";
  (*ring)->retire(UINT64_MAX - 1);
  EXPECT_EQ((*ring)->stage(this, target->buffer, 1000, bytes.data(), 1), 0u) << "staged, not yet recorded";
  ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
    EXPECT_EQ((*ring)->record(commands, 7, UINT64_MAX), 1000u);
    return Status();
  }));
  EXPECT_FALSE((*ring)->isWithin(this, 6));
  EXPECT_TRUE((*ring)->isWithin(this, 7));
  (*ring)->retire(6);
  EXPECT_EQ((*ring)->stage(this, target->buffer, 1000, bytes.data(), 1), 0u) << "recorded, not yet complete";
  (*ring)->retire(7);
  EXPECT_EQ((*ring)->stage(this, target->buffer, 1000, bytes.data(), 4096), 1000u);
  gpu.destroyBuffer(*target);
}

TEST_F(Upload, KeepsForgottenTargetsAsLongAsTheirOwnCopies) {
  Device gpu = device();
  Result<std::unique_ptr<UploadRing>> ring = UploadRing::create(gpu, 1000);
  Result<GpuBuffer> buffer = gpu.createBuffer(MemoryUse::kAssets, BufferKind::kDevice, 4096, "target");
  ASSERT_TRUE(ring && buffer);
  const int first = 0, second = 0;  // owners
  const std::vector<uint8_t> bytes(100);
  ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
    (*ring)->stage(&first, buffer->buffer, 0, bytes.data(), 100);
    (*ring)->record(commands, 5, UINT64_MAX);
    (*ring)->stage(&second, buffer->buffer, 100, bytes.data(), 100);
    (*ring)->record(commands, 6, UINT64_MAX);
    return Status();
  }));
  EXPECT_EQ((*ring)->newestInFlight(), 6u);
  auto targets = std::make_shared<int>();
  (*ring)->forget(&second, targets);
  const std::weak_ptr<int> kept = std::exchange(targets, nullptr);
  (*ring)->drop(5);  // its copy stands before the other, and waits
  (*ring)->retire(5);
  EXPECT_FALSE(kept.expired());
  (*ring)->retire(6);
  EXPECT_TRUE(kept.expired());
  EXPECT_EQ((*ring)->newestInFlight(), 0u);
  EXPECT_FALSE((*ring)->isWithin(&first, 6));
  gpu.destroyBuffer(*buffer);
}

TEST_F(Upload, BufferLargerThanTheDeviceAllowsIsRefusedWithNumbers) {
  Device gpu = device();
  const Result<GpuBuffer> buffer =
      gpu.createBuffer(MemoryUse::kAssets, BufferKind::kDevice, gpu.maxAllocationSize + 1, "lobe axes");
  ASSERT_FALSE(buffer);
  EXPECT_THAT(buffer.error().message, HasSubstr("lobe axes"));
  EXPECT_THAT(buffer.error().message, HasSubstr(std::to_string(gpu.maxAllocationSize)));
}

}  // namespace
}  // namespace froth
