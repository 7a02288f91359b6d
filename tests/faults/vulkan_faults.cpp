#include "tests/faults/vulkan_faults.h"

#include <cstring>
#include <set>
#include <string_view>
#include <tuple>

#include "runtime/device/device.h"  // the functions that the runtime calls
#include "tests/faults/host_faults.h"

namespace froth::test {

size_t VulkanFaults::calls = 0;
std::string VulkanFaults::struck;
std::map<void*, std::string> VulkanFaults::live;
std::vector<std::string> VulkanFaults::misuse;
std::vector<std::string> VulkanFaults::unnamed;

namespace {

size_t armedNumber = SIZE_MAX;
VkResult armedCode = VK_SUCCESS;

bool strikes(const char* name) {
  const bool isIt = VulkanFaults::calls++ == armedNumber;
  if (isIt) VulkanFaults::struck = name;
  return isIt;
}

bool isCreation(std::string_view name) { return name.starts_with("vkCreate") || name == "vkAllocateMemory"; }
bool isDestruction(std::string_view name) { return name.starts_with("vkDestroy") || name == "vkFreeMemory"; }

// The handle that a creation wrote, the one that a destruction takes.
template <class... Args>
void* madeBy(Args... args) {
  const auto last = std::get<sizeof...(Args) - 1>(std::make_tuple(args...));
  if constexpr (std::is_pointer_v<std::remove_pointer_t<decltype(last)>>) {
    return const_cast<void*>(static_cast<const void*>(*last));
  }
  return nullptr;
}

template <class... Args>
void* takenBy(Args... args) {
  if constexpr (sizeof...(Args) >= 2) {
    const auto second = std::get<1>(std::make_tuple(args...));
    if constexpr (std::is_pointer_v<decltype(second)>) return const_cast<void*>(static_cast<const void*>(second));
  }
  return nullptr;
}

std::set<void*> named;

VKAPI_ATTR VkResult VKAPI_CALL nameObject(VkDevice, const VkDebugUtilsObjectNameInfoEXT* info) {
  const HostFaults::Pause pause;
  const bool isOurs = std::string_view(info->pObjectName).starts_with("froth: ");
  if (isOurs) named.insert(reinterpret_cast<void*>(info->objectHandle));
  return VK_SUCCESS;
}

void noteDestruction(const char* name, void* handle) {
  if (!handle) return;
  const auto made = VulkanFaults::live.find(handle);
  if (made == VulkanFaults::live.end()) {
    VulkanFaults::misuse.emplace_back(name);
    return;
  }
  if (named.erase(handle) == 0) VulkanFaults::unnamed.push_back(made->second);
  VulkanFaults::live.erase(made);
}

// One function of the driver, between it and the runtime. Its own allocations never fail.
template <class Tag, class Function>
struct Hook;

template <class Tag, class... Args>
struct Hook<Tag, VkResult(VKAPI_PTR*)(Args...)> {
  static inline VkResult(VKAPI_PTR* real)(Args...) = nullptr;
  static VKAPI_ATTR VkResult VKAPI_CALL call(Args... args) {
    const HostFaults::Pause pause;
    if (strikes(Tag::kName)) return armedCode;
    const VkResult result = real(args...);
    if (result == VK_SUCCESS && isCreation(Tag::kName)) VulkanFaults::live[madeBy(args...)] = Tag::kName;
    return result;
  }
};

template <class Tag, class Return, class... Args>
struct Hook<Tag, Return(VKAPI_PTR*)(Args...)> {
  static inline Return(VKAPI_PTR* real)(Args...) = nullptr;
  static VKAPI_ATTR Return VKAPI_CALL call(Args... args) {
    const HostFaults::Pause pause;
    if (isDestruction(Tag::kName)) noteDestruction(Tag::kName, takenBy(args...));
    return real(args...);
  }
};

// All that frames call.
#define FROTH_HOOKED_FUNCTIONS(X) \
  FROTH_DEVICE_FUNCTIONS(X)       \
  X(vkCmdBeginDebugUtilsLabelEXT) X(vkCmdEndDebugUtilsLabelEXT)

#define FROTH_TAG(name)                         \
  struct Tag_##name {                           \
    static constexpr const char* kName = #name; \
  };
FROTH_HOOKED_FUNCTIONS(FROTH_TAG)
#undef FROTH_TAG

// ---- Pipelines: compiled once per shader and constants ----

std::map<std::string, VkPipeline> keptPipelines;
std::map<void*, std::string> moduleCodes;
std::map<void*, int> uses;  // of kept pipelines

VKAPI_ATTR VkResult VKAPI_CALL createShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                  const VkAllocationCallbacks* allocator, VkShaderModule* module) {
  const HostFaults::Pause pause;
  const VkResult result =
      Hook<Tag_vkCreateShaderModule, PFN_vkCreateShaderModule>::call(device, info, allocator, module);
  if (result == VK_SUCCESS) {
    moduleCodes[*module] = std::string(reinterpret_cast<const char*>(info->pCode), info->codeSize);
  }
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                      const VkComputePipelineCreateInfo* info,
                                                      const VkAllocationCallbacks* allocator, VkPipeline* pipeline) {
  const HostFaults::Pause pause;
  if (strikes("vkCreateComputePipelines")) return armedCode;
  std::string key = moduleCodes[info->stage.module];
  if (const VkSpecializationInfo* constants = info->stage.pSpecializationInfo) {
    key.append(static_cast<const char*>(constants->pData), constants->dataSize);
  }
  VkPipeline& kept = keptPipelines[key];
  if (!kept) {
    const VkResult result = Hook<Tag_vkCreateComputePipelines, PFN_vkCreateComputePipelines>::real(
        device, cache, count, info, allocator, &kept);
    if (result != VK_SUCCESS) return result;
  }
  *pipeline = kept;
  ++uses[kept];
  VulkanFaults::live[kept] = "vkCreateComputePipelines";
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyPipeline(VkDevice, VkPipeline pipeline, const VkAllocationCallbacks*) {
  const HostFaults::Pause pause;
  if (!pipeline) return;
  int& count = uses[pipeline];
  if (count == 0 || --count == 0) noteDestruction("vkDestroyPipeline", pipeline);
}

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  const HostFaults::Pause pause;
  const PFN_vkVoidFunction real = vkGetDeviceProcAddr(device, name);
  const auto is = [&](const char* other) { return std::strcmp(name, other) == 0; };
#define FROTH_HOOK(function) \
  if (is(#function)) Hook<Tag_##function, PFN_##function>::real = reinterpret_cast<PFN_##function>(real);
  FROTH_HOOKED_FUNCTIONS(FROTH_HOOK)
#undef FROTH_HOOK
  if (is("vkCreateShaderModule")) return reinterpret_cast<PFN_vkVoidFunction>(createShaderModule);
  if (is("vkCreateComputePipelines")) return reinterpret_cast<PFN_vkVoidFunction>(createComputePipelines);
  if (is("vkDestroyPipeline")) return reinterpret_cast<PFN_vkVoidFunction>(destroyPipeline);
  if (is("vkSetDebugUtilsObjectNameEXT")) return reinterpret_cast<PFN_vkVoidFunction>(nameObject);
#define FROTH_HOOK(function) \
  if (is(#function)) return reinterpret_cast<PFN_vkVoidFunction>(Hook<Tag_##function, PFN_##function>::call);
  FROTH_HOOKED_FUNCTIONS(FROTH_HOOK)
#undef FROTH_HOOK
  return real;
}

}  // namespace

PFN_vkVoidFunction VKAPI_CALL VulkanFaults::getInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
  const HostFaults::Pause pause;
  return vkGetInstanceProcAddr(instance, name);
}

void VulkanFaults::arm(size_t number, VkResult code) {
  calls = 0;
  struck.clear();
  armedNumber = number;
  armedCode = code;
}

void VulkanFaults::disarm() { armedNumber = SIZE_MAX; }

void VulkanFaults::clear(VkDevice device) {
  for (const auto& [key, pipeline] : keptPipelines) vkDestroyPipeline(device, pipeline, nullptr);
  keptPipelines.clear();
  moduleCodes.clear();
  uses.clear();
}

}  // namespace froth::test
