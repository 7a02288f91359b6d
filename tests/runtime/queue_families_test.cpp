// What Froth asks of two queue families, on a device that is said to have them: buffers, barriers.
#include "froth/froth_walk.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

// Family 0 computes and cannot draw, family 1 copies. The device has one, and makes buffers for that one.
struct TwoFamilies {
  static inline std::vector<std::vector<uint32_t>> shared;  // families of each buffer with VK_SHARING_MODE_CONCURRENT
  static inline uint32_t exclusiveCount = 0;
  static inline std::vector<VkMemoryBarrier2> barriers;
  static inline PFN_vkCreateBuffer createBuffer = nullptr;
  static inline PFN_vkCmdPipelineBarrier2 pipelineBarrier = nullptr;

  static void forget() {
    shared.clear();
    exclusiveCount = 0;
    barriers.clear();
  }

  static VKAPI_ATTR void VKAPI_CALL getFamilies(VkPhysicalDevice, uint32_t* count, VkQueueFamilyProperties* families) {
    *count = 2;
    if (!families) return;
    families[0] = {VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT, 1, 0, {1, 1, 1}};
    families[1] = {VK_QUEUE_TRANSFER_BIT, 1, 0, {1, 1, 1}};
  }
  static VKAPI_ATTR VkResult VKAPI_CALL create(VkDevice device, const VkBufferCreateInfo* info,
                                               const VkAllocationCallbacks* callbacks, VkBuffer* buffer) {
    VkBufferCreateInfo known = *info;
    if (info->sharingMode == VK_SHARING_MODE_CONCURRENT) {
      shared.emplace_back(info->pQueueFamilyIndices, info->pQueueFamilyIndices + info->queueFamilyIndexCount);
      known.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    } else {
      ++exclusiveCount;
    }
    return createBuffer(device, &known, callbacks, buffer);
  }
  static VKAPI_ATTR void VKAPI_CALL barrier(VkCommandBuffer commands, const VkDependencyInfo* info) {
    barriers.insert(barriers.end(), info->pMemoryBarriers, info->pMemoryBarriers + info->memoryBarrierCount);
    pipelineBarrier(commands, info);
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    const PFN_vkVoidFunction real = vkGetDeviceProcAddr(device, name);
    if (std::strcmp(name, "vkCreateBuffer") == 0) {
      createBuffer = reinterpret_cast<PFN_vkCreateBuffer>(real);
      return reinterpret_cast<PFN_vkVoidFunction>(create);
    }
    if (std::strcmp(name, "vkCmdPipelineBarrier2") == 0) {
      pipelineBarrier = reinterpret_cast<PFN_vkCmdPipelineBarrier2>(real);
      return reinterpret_cast<PFN_vkVoidFunction>(barrier);
    }
    return real;
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    if (std::strcmp(name, "vkGetPhysicalDeviceQueueFamilyProperties") == 0) {
      return reinterpret_cast<PFN_vkVoidFunction>(getFamilies);
    }
    return vkGetInstanceProcAddr(instance, name);
  }
};

class QueueFamilies : public RuntimeGpuTest {
 protected:
  FrothContextInfo contextInfo() {
    FrothContextInfo info = host_->contextInfo();
    info.getInstanceProcAddr = TwoFamilies::getInstanceProcAddr;
    info.queueFamily = 0;
    info.walkShaders = 1;
    TwoFamilies::forget();
    return info;
  }

  void beginFrame(uint64_t uploadSerial, uint64_t completedUploadSerial) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = host_->nextSerial();
    frame.completedSerial = frame.serial - 1;
    frame.uploadSerial = uploadSerial;
    frame.completedUploadSerial = completedUploadSerial;
    ASSERT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK) << lastText();
  }

  template <class Record>
  void submit(const Record& record) {
    ASSERT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t) {
      EXPECT_EQ(record(commands), FROTH_OK) << lastText();
      return Status();
    }));
  }
};

TEST_F(QueueFamilies, ShareWhatUploadsWriteAndNothingElse) {
  FrothContextInfo info = contextInfo();
  info.hasUploadQueue = 1;
  info.uploadQueueFamily = 1;
  createContext(info);
  createInstance(openBytes(encodeSample()));
  createView({16, 16});
  EXPECT_TRUE(TwoFamilies::shared.empty());
  EXPECT_GT(TwoFamilies::exclusiveCount, 0u);
  beginFrame(1, 0);
  ASSERT_EQ(TwoFamilies::shared.size(), 1u) << "the asset's";
  EXPECT_EQ(TwoFamilies::shared[0], (std::vector<uint32_t>{0, 1}));
  TwoFamilies::barriers.clear();
  submit([&](VkCommandBuffer commands) { return frothRecordUpload(context_, commands); });
  EXPECT_TRUE(TwoFamilies::barriers.empty()) << "the queue of uploads knows no stage of shaders";
}

TEST_F(QueueFamilies, ThatAreOneAreNotShared) {
  FrothContextInfo info = contextInfo();
  info.hasUploadQueue = 1;
  createContext(info);
  openBytes(encodeSample());
  beginFrame(1, 0);
  EXPECT_TRUE(TwoFamilies::shared.empty());
}

TEST_F(QueueFamilies, WithoutGraphicsWaitForNoFragments) {
  createContext(contextInfo());
  createInstance(openBytes(encodeSample()));
  runFrame();
  TwoFamilies::barriers.clear();
  const auto walk = makeStruct<FrothWalkInfo>();
  VkDescriptorSet set = VK_NULL_HANDLE;
  beginFrame(0, 0);
  submit([&](VkCommandBuffer commands) { return frothRecordWalkSet(context_, commands, &walk, &set); });
  EXPECT_FALSE(TwoFamilies::barriers.empty());
  for (const VkMemoryBarrier2& barrier : TwoFamilies::barriers) {
    EXPECT_EQ((barrier.srcStageMask | barrier.dstStageMask) & VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0u);
  }
}

}  // namespace
}  // namespace froth
