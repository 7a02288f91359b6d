// What tests of jobs share: jobs that wait for the test, and who makes pipelines.
#pragma once

#include <atomic>
#include <deque>
#include <string_view>

#include "froth/froth_precompile.h"
#include "runtime_fixture.h"

namespace froth {

inline constexpr VkExtent2D kJobsExtent{40, 40};

// Keeps jobs until the test runs them.
struct HeldJobs {
  struct Held {
    FrothJob job;
    void* argument;
  };
  std::deque<Held> held;

  static void hold(void* user, FrothJob job, void* argument) {
    static_cast<HeldJobs*>(user)->held.push_back({job, argument});
  }
  void runFirst() {
    const Held first = held.front();
    held.pop_front();
    first.job(first.argument);
  }
  void runLast() {
    const Held last = held.back();
    held.pop_back();
    last.job(last.argument);
  }
  void runAll() {
    while (!held.empty()) runFirst();
  }
};

// Which threads make pipelines, take memory and give it back. The table of a context is filled through the loader
// function that it is given.
inline std::atomic<int> pipelinesMadeHere = 0, pipelinesMadeElsewhere = 0;
inline std::atomic<int> memoryCallsInUpdate = 0, memoryCallsElsewhere = 0;
inline thread_local bool isFrameThread = false, isInUpdate = false;
inline PFN_vkAllocateMemory allocateMemoryBelow = nullptr;
inline PFN_vkFreeMemory freeMemoryBelow = nullptr;
inline PFN_vkCreateComputePipelines createPipelinesBelow = nullptr;
inline PFN_vkGetDeviceProcAddr deviceFunctionBelow = nullptr;

inline VKAPI_ATTR VkResult VKAPI_CALL countPipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                     const VkComputePipelineCreateInfo* infos,
                                                     const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  (isFrameThread ? pipelinesMadeHere : pipelinesMadeElsewhere) += static_cast<int>(count);
  return createPipelinesBelow(device, cache, count, infos, allocator, pipelines);
}

inline VKAPI_ATTR VkResult VKAPI_CALL countAllocation(VkDevice device, const VkMemoryAllocateInfo* info,
                                                      const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
  ++(isInUpdate ? memoryCallsInUpdate : memoryCallsElsewhere);
  return allocateMemoryBelow(device, info, allocator, memory);
}

inline VKAPI_ATTR void VKAPI_CALL countFree(VkDevice device, VkDeviceMemory memory,
                                            const VkAllocationCallbacks* allocator) {
  ++(isInUpdate ? memoryCallsInUpdate : memoryCallsElsewhere);
  freeMemoryBelow(device, memory, allocator);
}

// `counting` in place of the device's own, which `below` keeps.
template <class Function>
PFN_vkVoidFunction interpose(PFN_vkVoidFunction own, Function counting, Function& below) {
  below = reinterpret_cast<Function>(own);
  return reinterpret_cast<PFN_vkVoidFunction>(counting);
}

inline VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
  const PFN_vkVoidFunction own = deviceFunctionBelow(device, name);
  const std::string_view called = name;
  if (called == "vkCreateComputePipelines") return interpose(own, &countPipelines, createPipelinesBelow);
  if (called == "vkAllocateMemory") return interpose(own, &countAllocation, allocateMemoryBelow);
  if (called == "vkFreeMemory") return interpose(own, &countFree, freeMemoryBelow);
  return own;
}

inline VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name) {
  const PFN_vkVoidFunction function = test::getInstanceProcAddrKeepingPipelines(instance, name);
  if (std::string(name) != "vkGetDeviceProcAddr") return function;
  deviceFunctionBelow = reinterpret_cast<PFN_vkGetDeviceProcAddr>(function);
  return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
}

class Jobs : public RuntimeGpuTest {
 protected:
  void SetUp() override {
    RuntimeGpuTest::SetUp();
    isFrameThread = true;
  }

  void createWith(FrothRunJob runJob, void* user, uint32_t mostJobs = 0) {
    FrothContextInfo info = host_->contextInfo();
    info.mostJobs = mostJobs;
    info.getInstanceProcAddr = instanceFunction;
    info.runJob = runJob;
    info.jobUser = user;
    createContext(info);
    pipelinesMadeHere = pipelinesMadeElsewhere = 0;
    memoryCallsInUpdate = memoryCallsElsewhere = 0;
  }

  // Of all READY instances.
  std::vector<float> draw(FrothView view, FrothResult expected = FROTH_OK) {
    FrothResult result = FROTH_OK;
    std::vector<float> pixels = drawAnyway(view, result);
    EXPECT_EQ(result, expected);
    return pixels;
  }

  std::vector<float> drawAnyway(FrothView view, FrothResult& result) {
    HostImage image = *host_->createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kJobsExtent);
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = makeCamera(kJobsExtent.width, kJobsExtent.height);
    info.camera.eye[2] = 1e6 - 1;  // where the sample lies
    info.colour = host_->describe(image);
    EXPECT_TRUE(host_->submit([&](VkCommandBuffer commands, uint64_t serial) {
      isInUpdate = true;
      EXPECT_EQ(update(serial), FROTH_OK) << lastText();
      isInUpdate = false;
      EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK);
      result = frothRecordRaster(context_, view, commands, &info);
      return Status();
    }));
    std::vector<float> pixels = *host_->readImage(image);
    host_->destroyImage(image);
    return pixels;
  }

  // The same asset loaded within frothUpdate.
  std::vector<float> drawWithoutJobs() {
    createContext(host_->contextInfo());
    createInstance(openBytes(bytes_));
    const FrothView view = createView(kJobsExtent);
    runFrame();
    std::vector<float> pixels = draw(view);
    frothDestroyContext(context_, UINT64_MAX);
    context_ = nullptr;
    return pixels;
  }

  FrothVariant variantOf(const std::vector<uint8_t>& bytes) {
    auto info = makeStruct<FrothAssetInfo>();
    info.data = bytes.data();
    info.dataSize = bytes.size();
    FrothVariant variant{};
    EXPECT_EQ(frothReadVariant(context_, &info, &variant), FROTH_OK) << lastText();
    return variant;
  }

  HeldJobs jobs_;
  const std::vector<uint8_t> bytes_ =
      encodeSample({.chunkCount = 7, .cellsPerChunk = 9, .localBits = 8, .detailCount = 3, .lobeCount = 2});
};

}  // namespace froth
