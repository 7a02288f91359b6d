#include "tests/kept_pipelines.h"

#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace froth::test {
namespace {

std::mutex mutex;  // guards what follows
std::map<VkShaderModule, std::string> codes;
std::map<std::string, VkPipeline> pipelines;  // by code and constants
std::set<VkPipeline> kept;

VkDevice deviceOfKept = VK_NULL_HANDLE;  // the first that makes one

PFN_vkCreateShaderModule createShaderModuleBelow = nullptr;
PFN_vkCreateComputePipelines createComputePipelinesBelow = nullptr;
PFN_vkDestroyPipeline destroyPipelineBelow = nullptr;

// Constructed after the device, and so destroyed before it: validation layers would tell of pipelines that are left, at
// a time when they can no longer.
struct DestroyAtExit {
  ~DestroyAtExit() {
    for (const VkPipeline pipeline : kept) destroyPipelineBelow(deviceOfKept, pipeline, nullptr);
  }
};

VKAPI_ATTR VkResult VKAPI_CALL createShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                  const VkAllocationCallbacks* allocator, VkShaderModule* module) {
  const VkResult result = createShaderModuleBelow(device, info, allocator, module);
  if (result != VK_SUCCESS) return result;
  const std::lock_guard lock(mutex);
  codes[*module] = std::string(reinterpret_cast<const char*>(info->pCode), info->codeSize);
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                      const VkComputePipelineCreateInfo* infos,
                                                      const VkAllocationCallbacks* allocator, VkPipeline* made) {
  static const DestroyAtExit destroyAtExit;
  {
    const std::lock_guard lock(mutex);
    if (!deviceOfKept) deviceOfKept = device;
  }
  if (device != deviceOfKept) return createComputePipelinesBelow(device, cache, count, infos, allocator, made);
  for (uint32_t i = 0; i < count; ++i) {
    const std::lock_guard lock(mutex);
    std::string key = codes[infos[i].stage.module];
    if (const VkSpecializationInfo* constants = infos[i].stage.pSpecializationInfo) {
      key.append(static_cast<const char*>(constants->pData), constants->dataSize);
    }
    VkPipeline& pipeline = pipelines[key];
    if (!pipeline) {
      const VkResult result = createComputePipelinesBelow(device, cache, 1, &infos[i], nullptr, &pipeline);
      if (result != VK_SUCCESS) return result;
      kept.insert(pipeline);
    }
    made[i] = pipeline;
  }
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyPipeline(VkDevice device, VkPipeline pipeline,
                                           const VkAllocationCallbacks* allocator) {
  {
    const std::lock_guard lock(mutex);
    if (kept.count(pipeline) != 0) return;
  }
  destroyPipelineBelow(device, pipeline, allocator);
}

template <class Function>
PFN_vkVoidFunction interpose(PFN_vkVoidFunction real, Function own, Function& below) {
  below = reinterpret_cast<Function>(real);
  return reinterpret_cast<PFN_vkVoidFunction>(own);
}

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  const std::lock_guard lock(mutex);
  const PFN_vkVoidFunction real = vkGetDeviceProcAddr(device, name);
  const auto is = [&](const char* other) { return std::strcmp(name, other) == 0; };
  if (is("vkCreateShaderModule")) return interpose(real, &createShaderModule, createShaderModuleBelow);
  if (is("vkCreateComputePipelines")) return interpose(real, &createComputePipelines, createComputePipelinesBelow);
  if (is("vkDestroyPipeline")) return interpose(real, &destroyPipeline, destroyPipelineBelow);
  return real;
}

}  // namespace

PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddrKeepingPipelines(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
  return vkGetInstanceProcAddr(instance, name);
}

}  // namespace froth::test
