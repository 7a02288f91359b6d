// The recipe of docs/EMBEDDING.md "Async compute" as a program: the compute queue draws a frame while the graphics
// queue uses the image of the frame before, and uploads have a third queue. What the device lacks is its first queue.
#include <algorithm>
#include <array>
#include <optional>

#include "froth/froth_walk.h"
#include "runtime_fixture.h"
#include "timeline_queue.h"

namespace froth {
namespace {

constexpr VkExtent2D kExtent{48, 48};
constexpr VkFormat kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr size_t kFloats = size_t{4} * kExtent.width * kExtent.height;
constexpr uint64_t kFrames = 6;
constexpr VkPipelineStageFlags2 kUse = VK_PIPELINE_STAGE_2_COPY_BIT;  // of the graphics queue

class AsyncCompute : public RuntimeGpuTest {
 protected:
  void SetUp() override {
    host_ = hostOfSeveralQueues();
    ASSERT_NE(host_, nullptr);
    compute_.emplace(*host_, host_->computeQueue);
    graphics_.emplace(*host_, HostQueue{host_->queue, host_->queueFamily});
    uploads_.emplace(*host_, host_->uploadQueue);
    for (HostImage& image : images_) image = *host_->createImage(kFormat, kExtent);
  }

  void TearDown() override {
    uploads_.reset();
    graphics_.reset();
    compute_.reset();
    for (HostImage& image : images_) host_->destroyImage(image);
    RuntimeGpuTest::TearDown();
  }

  static FrothRenderInfo renderInfo(uint64_t frame) {
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = makeCamera(kExtent.width, kExtent.height);
    info.camera.eye[0] = 0.05 * static_cast<double>(frame);  // no two images are the same
    info.camera.eye[2] = 1e6 - 1;                            // where the sample lies
    return info;
  }

  // Image by image, by one queue.
  std::vector<std::vector<float>> drawOneByOne(const std::vector<uint8_t>& bytes) {
    createContext(host_->contextInfo());
    createInstance(openBytes(bytes));
    const FrothView view = createView(kExtent);
    runFrame();
    std::vector<std::vector<float>> drawn;
    for (uint64_t frame = 1; frame <= kFrames; ++frame) {
      FrothRenderInfo info = renderInfo(frame);
      info.colour = host_->describe(images_[0]);
      runFrame(0, [&](VkCommandBuffer commands) {
        EXPECT_EQ(frothRecordRaster(context_, view, commands, &info), FROTH_OK) << lastText();
      });
      drawn.push_back(*host_->readImage(images_[0]));
    }
    EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
    context_ = nullptr;
    return drawn;
  }

  FrothContextInfo contextInfo() const {
    FrothContextInfo info = host_->contextInfo();
    info.queueFamily = host_->computeQueue.family;
    info.hasUploadQueue = 1;
    info.uploadQueueFamily = host_->uploadQueue.family;
    info.walkShaders = 1;
    return info;
  }

  FrothFrameStatus beginFrame() {
    const uint64_t serial = compute_->nextValue();
    EXPECT_TRUE(compute_->wait(serial - std::min<uint64_t>(serial, 2)));  // FrothContextInfo::framesInFlight
    auto frame = makeStruct<FrothFrame>();
    frame.serial = serial;
    frame.completedSerial = compute_->completedValue();
    frame.uploadSerial = uploads_->nextValue();
    frame.completedUploadSerial = uploads_->completedValue();
    auto status = makeStruct<FrothFrameStatus>();
    EXPECT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK) << lastText();
    if (status.uploadBytesQueued > 0) {
      uploads_->submit({}, [&](VkCommandBuffer commands) {
        EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK) << lastText();
      });
    }
    return status;
  }

  // From the compute queue, which records it as a release, to the graphics queue, which records it as an acquisition.
  // With one family it is a barrier that changes nothing.
  VkImageMemoryBarrier2 ownershipTransfer(const HostImage& image) const {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.oldLayout = barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    barrier.srcQueueFamilyIndex = host_->computeQueue.family;
    barrier.dstQueueFamilyIndex = host_->queueFamily;
    barrier.image = image.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    return barrier;
  }

  static void recordBarrier(VkCommandBuffer commands, const VkImageMemoryBarrier2& barrier) {
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
  }

  // Draws frame n into its image, which the graphics queue used in its submission n - 1.
  void drawFrame(FrothView view, uint64_t frame) {
    const HostImage& image = images_[frame % images_.size()];
    const FrothFrameStatus status = beginFrame();
    FrothRenderInfo info = renderInfo(frame);
    info.colour = host_->describe(image);
    info.colour.stageIn = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;  // where the submission waits for that use
    info.colour.accessIn = 0;
    info.colour.layoutOut = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    info.colour.stageOut = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;  // of the release
    info.colour.accessOut = 0;
    VkImageMemoryBarrier2 release = ownershipTransfer(image);
    release.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    compute_->submit({graphics_->reached(frame - 1, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT),
                      uploads_->reached(status.waitUploadSerial, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT)},
                     [&](VkCommandBuffer commands) {
                       EXPECT_EQ(frothRecordRaster(context_, view, commands, &info), FROTH_OK) << lastText();
                       recordBarrier(commands, release);
                     });
  }

  // The engine's frame: it uses the image of Froth's frame `drawn`, which `serial` on the compute queue has drawn.
  void useImage(uint64_t drawn, uint64_t serial, const HostBuffer& copy) {
    const HostImage& image = images_[drawn % images_.size()];
    VkImageMemoryBarrier2 acquire = ownershipTransfer(image);
    acquire.srcStageMask = kUse;  // where the submission waits
    acquire.dstStageMask = kUse;
    acquire.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
    graphics_->submit({compute_->reached(serial, kUse)}, [&](VkCommandBuffer commands) {
      recordBarrier(commands, acquire);
      VkBufferImageCopy region{};
      region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      region.imageExtent = {kExtent.width, kExtent.height, 1};
      vkCmdCopyImageToBuffer(commands, image.image, acquire.newLayout, copy.buffer, 1, &region);
      recordMemoryBarrier(commands, kUse, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                          VK_ACCESS_2_HOST_READ_BIT);
    });
  }

  void loadAll(FrothAsset asset) {
    while (statusOf(asset).state == FROTH_ASSET_OPENING && compute_->nextValue() < 100) {
      const FrothFrameStatus status = beginFrame();
      compute_->submit({uploads_->reached(status.waitUploadSerial, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT)},
                       [](VkCommandBuffer) {});
      EXPECT_TRUE(uploads_->waitForAll());
    }
    ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  }

  std::optional<TimelineQueue> compute_, graphics_, uploads_;
  std::array<HostImage, 2> images_;
};

TEST_F(AsyncCompute, DrawsAFrameWhileGraphicsUsesTheFrameBefore) {
  const std::vector<uint8_t> bytes = encodeSample({.chunkCount = 2, .cellsPerChunk = 12, .localBits = 16});
  const std::vector<std::vector<float>> expected = drawOneByOne(bytes);
  ASSERT_NE(expected[0], expected[1]);
  createContext(contextInfo());
  const FrothAsset asset = openBytes(bytes);
  createInstance(asset);
  const FrothView view = createView(kExtent);
  loadAll(asset);

  std::vector<HostBuffer> copies;
  const uint64_t before = compute_->nextValue() - 1;  // submissions
  for (uint64_t frame = 1; frame <= kFrames; ++frame) {
    drawFrame(view, frame);
    copies.push_back(*host_->createBuffer(kFloats * sizeof(float), VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    if (frame == 1) {
      graphics_->submit({}, [](VkCommandBuffer) {});  // has no image yet
    } else {
      useImage(frame - 1, before + frame - 1, copies[frame - 2]);
    }
  }
  useImage(kFrames, before + kFrames, copies.back());
  ASSERT_TRUE(graphics_->waitForAll());
  for (uint64_t frame = 1; frame <= kFrames; ++frame) {
    const auto* texels = static_cast<const float*>(copies[frame - 1].mapped);
    EXPECT_EQ(std::vector<float>(texels, texels + kFloats), expected[frame - 1]) << "frame " << frame;
    host_->destroyBuffer(copies[frame - 1]);
  }
}

TEST_F(AsyncCompute, CastsRays) {
  createContext(contextInfo());
  const FrothAsset asset = openBytes(encodeSample());
  createInstance(asset);
  loadAll(asset);
  const FrothFrameStatus status = beginFrame();
  auto walk = makeStruct<FrothWalkInfo>();
  walk.eye[2] = 1e6 - 1;  // where the sample lies
  HostBuffer buffer =
      *host_->createBuffer(sizeof(FrothGpuRay) + sizeof(FrothGpuHit),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
  FrothGpuRay ray{};
  ray.direction[2] = 1;
  FrothGpuHit hit{};
  hit.transmittance = -1;
  std::memcpy(buffer.mapped, &ray, sizeof(ray));
  std::memcpy(static_cast<char*>(buffer.mapped) + sizeof(ray), &hit, sizeof(hit));
  compute_->submit({uploads_->reached(status.waitUploadSerial, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT)},
                   [&](VkCommandBuffer commands) {
                     VkDescriptorSet set = VK_NULL_HANDLE;
                     EXPECT_EQ(frothRecordWalkSet(context_, commands, &walk, &set), FROTH_OK) << lastText();
                     EXPECT_EQ(frothRecordRays(context_, commands, buffer.address, buffer.address + sizeof(ray), 1,
                                               FROTH_RAY_RADIANCE),
                               FROTH_OK)
                         << lastText();
                   });
  ASSERT_TRUE(compute_->waitForAll());
  std::memcpy(&hit, static_cast<const char*>(buffer.mapped) + sizeof(ray), sizeof(hit));
  EXPECT_GE(hit.transmittance, 0);
  EXPECT_LT(hit.transmittance, 1) << "the ray met the foam";
  host_->destroyBuffer(buffer);
}

}  // namespace
}  // namespace froth
