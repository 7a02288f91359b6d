// The functions that stand in for the driver's.
#include <algorithm>
#include <cstring>
#include <iterator>
#include <span>
#include <string_view>

#include "shader_list.h"  // made by CMake: FROTH_SHADERS(X), X(name) of each of the runtime's
#include "tests/commands/command_stream.h"

namespace froth::test {

extern CommandStream* currentStream;

namespace {

struct NamedCode {
  const char* name;
  std::span<const uint32_t> code;
};

#define FROTH_NAMED(name) {#name, name##_spirv},
const NamedCode kShaders[] = {FROTH_SHADERS(FROTH_NAMED)};
#undef FROTH_NAMED

// Traced once in the program.
const CommandStream::Shader& shaderOf(std::span<const uint32_t> code) {
  static std::map<std::string, CommandStream::Shader> known;
  const auto isIt = [&](const NamedCode& named) { return std::ranges::equal(named.code, code); };
  const auto found = std::find_if(std::begin(kShaders), std::end(kShaders), isIt);
  const std::string name = found != std::end(kShaders) ? found->name : "a shader that no list names";
  const auto [shader, isNew] = known.try_emplace(name);
  if (isNew) shader->second = {name, findAccesses(code)};
  return shader->second;
}

template <class Handle>
Handle newHandle() {
  static uint64_t last = 0;
  return reinterpret_cast<Handle>(++last);
}

template <class Function>
Function real(VkDevice device, const char* name) {
  return reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
}
#define FROTH_REAL(name) real<PFN_##name>(device, #name)

// ---- Memory: made by the driver ----

VkResult VKAPI_CALL createBuffer(VkDevice device, const VkBufferCreateInfo* info,
                                 const VkAllocationCallbacks* allocator, VkBuffer* buffer) {
  static uint64_t made = 0;
  const VkResult result = FROTH_REAL(vkCreateBuffer)(device, info, allocator, buffer);
  if (result == VK_SUCCESS) currentStream->at(*buffer) = {.size = info->size, .address = ++made << 36};
  return result;
}

void VKAPI_CALL destroyBuffer(VkDevice device, VkBuffer buffer, const VkAllocationCallbacks* allocator) {
  if (currentStream) currentStream->forget(buffer);
  FROTH_REAL(vkDestroyBuffer)(device, buffer, allocator);
}

VkResult VKAPI_CALL bindBufferMemory(VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset) {
  currentStream->bind(buffer, memory, offset);
  return FROTH_REAL(vkBindBufferMemory)(device, buffer, memory, offset);
}

VkDeviceAddress VKAPI_CALL getBufferDeviceAddress(VkDevice, const VkBufferDeviceAddressInfo* info) {
  return currentStream->at(info->buffer).address;
}

VkResult VKAPI_CALL mapMemory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                              VkMemoryMapFlags flags, void** mapped) {
  const VkResult result = FROTH_REAL(vkMapMemory)(device, memory, offset, size, flags, mapped);
  if (result == VK_SUCCESS) currentStream->map(memory, static_cast<uint8_t*>(*mapped) - offset);
  return result;
}

// The driver may give the same handle to memory that is not mapped.
void VKAPI_CALL freeMemory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* allocator) {
  if (currentStream) currentStream->unmap(memory);
  FROTH_REAL(vkFreeMemory)(device, memory, allocator);
}

VkResult VKAPI_CALL createImageView(VkDevice device, const VkImageViewCreateInfo* info,
                                    const VkAllocationCallbacks* allocator, VkImageView* view) {
  const VkResult result = FROTH_REAL(vkCreateImageView)(device, info, allocator, view);
  if (result == VK_SUCCESS) currentStream->nameView(*view, info->image);
  return result;
}

void VKAPI_CALL updateDescriptorSets(VkDevice, uint32_t count, const VkWriteDescriptorSet* writes, uint32_t,
                                     const VkCopyDescriptorSet*) {
  for (uint32_t i = 0; i < count; ++i) {
    const VkWriteDescriptorSet& write = writes[i];
    CommandStream::Descriptor& descriptor = currentStream->sets[write.dstSet][write.dstBinding];
    descriptor.type = write.descriptorType;
    if (write.pBufferInfo) {
      const VkDescriptorBufferInfo& info = *write.pBufferInfo;
      const uint64_t begin = currentStream->at(info.buffer).address + info.offset;
      descriptor.range = {begin, begin + info.range};
    } else {
      descriptor.range = CommandStream::rangeOf(currentStream->imageOf(write.pImageInfo->imageView));
    }
  }
}

// ---- Shaders and pipelines: numbers ----

VkResult VKAPI_CALL createShaderModule(VkDevice, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks*,
                                       VkShaderModule* module) {
  *module = newHandle<VkShaderModule>();
  currentStream->modules[*module] = &shaderOf({info->pCode, info->codeSize / sizeof(uint32_t)});
  return VK_SUCCESS;
}
void VKAPI_CALL destroyShaderModule(VkDevice, VkShaderModule, const VkAllocationCallbacks*) {}

VkResult VKAPI_CALL createComputePipelines(VkDevice, VkPipelineCache, uint32_t, const VkComputePipelineCreateInfo* info,
                                           const VkAllocationCallbacks*, VkPipeline* pipeline) {
  *pipeline = newHandle<VkPipeline>();
  currentStream->pipelines[*pipeline] = {currentStream->modules[info->stage.module]};
  return VK_SUCCESS;
}
VkResult VKAPI_CALL createGraphicsPipelines(VkDevice, VkPipelineCache, uint32_t,
                                            const VkGraphicsPipelineCreateInfo* info, const VkAllocationCallbacks*,
                                            VkPipeline* pipeline) {
  *pipeline = newHandle<VkPipeline>();
  for (uint32_t i = 0; i < info->stageCount; ++i) {
    currentStream->pipelines[*pipeline].push_back(currentStream->modules[info->pStages[i].module]);
  }
  return VK_SUCCESS;
}
void VKAPI_CALL destroyPipeline(VkDevice, VkPipeline, const VkAllocationCallbacks*) {}

// ---- Commands: not executed ----

CommandStream::Bound& boundAt(VkPipelineBindPoint point) {
  return point == VK_PIPELINE_BIND_POINT_COMPUTE ? currentStream->compute : currentStream->graphics;
}

void VKAPI_CALL bindPipeline(VkCommandBuffer, VkPipelineBindPoint point, VkPipeline pipeline) {
  boundAt(point).pipeline = pipeline;
}
void VKAPI_CALL bindDescriptorSets(VkCommandBuffer, VkPipelineBindPoint point, VkPipelineLayout, uint32_t, uint32_t,
                                   const VkDescriptorSet* sets, uint32_t, const uint32_t*) {
  boundAt(point).set = *sets;
}
void VKAPI_CALL pushConstants(VkCommandBuffer, VkPipelineLayout, VkShaderStageFlags, uint32_t offset, uint32_t size,
                              const void* values) {
  std::memcpy(currentStream->push.data() + offset, values, size);
}
void VKAPI_CALL dispatch(VkCommandBuffer, uint32_t, uint32_t, uint32_t) { currentStream->dispatch(); }
void VKAPI_CALL dispatchIndirect(VkCommandBuffer, VkBuffer buffer, VkDeviceSize offset) {
  currentStream->dispatchIndirect(buffer, offset);
}
void VKAPI_CALL pipelineBarrier(VkCommandBuffer, const VkDependencyInfo* dependency) {
  currentStream->wait(*dependency);
}
void VKAPI_CALL copyBuffer(VkCommandBuffer, VkBuffer from, VkBuffer to, uint32_t count, const VkBufferCopy* regions) {
  for (uint32_t i = 0; i < count; ++i) currentStream->copy(from, to, regions[i]);
}
void VKAPI_CALL fillBuffer(VkCommandBuffer, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, uint32_t) {
  currentStream->write(buffer, offset, size, "a fill");
}
void VKAPI_CALL updateBuffer(VkCommandBuffer, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, const void*) {
  currentStream->write(buffer, offset, size, "an update");
}
void VKAPI_CALL resetQueryPool(VkCommandBuffer, VkQueryPool, uint32_t, uint32_t) {}
void VKAPI_CALL writeTimestamp(VkCommandBuffer, VkPipelineStageFlags2, VkQueryPool, uint32_t) {}
void VKAPI_CALL beginRendering(VkCommandBuffer, const VkRenderingInfo* info) {
  currentStream->depthAttachment = info->pDepthAttachment->imageView;
}
void VKAPI_CALL endRendering(VkCommandBuffer) {}
void VKAPI_CALL setViewport(VkCommandBuffer, uint32_t, uint32_t, const VkViewport*) {}
void VKAPI_CALL setScissor(VkCommandBuffer, uint32_t, uint32_t, const VkRect2D*) {}
void VKAPI_CALL setDepthCompareOp(VkCommandBuffer, VkCompareOp) {}
void VKAPI_CALL draw(VkCommandBuffer, uint32_t, uint32_t, uint32_t, uint32_t) { currentStream->draw(); }

// A command without a stand-in is none of the driver's either: the context would not be made.
PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  const std::map<std::string_view, PFN_vkVoidFunction> standIns = {
#define FROTH_STAND_IN(name, function) {#name, reinterpret_cast<PFN_vkVoidFunction>(static_cast<PFN_##name>(function))}
      FROTH_STAND_IN(vkCreateBuffer, createBuffer),
      FROTH_STAND_IN(vkDestroyBuffer, destroyBuffer),
      FROTH_STAND_IN(vkBindBufferMemory, bindBufferMemory),
      FROTH_STAND_IN(vkGetBufferDeviceAddress, getBufferDeviceAddress),
      FROTH_STAND_IN(vkMapMemory, mapMemory),
      FROTH_STAND_IN(vkFreeMemory, freeMemory),
      FROTH_STAND_IN(vkCreateImageView, createImageView),
      FROTH_STAND_IN(vkUpdateDescriptorSets, updateDescriptorSets),
      FROTH_STAND_IN(vkCreateShaderModule, createShaderModule),
      FROTH_STAND_IN(vkDestroyShaderModule, destroyShaderModule),
      FROTH_STAND_IN(vkCreateComputePipelines, createComputePipelines),
      FROTH_STAND_IN(vkCreateGraphicsPipelines, createGraphicsPipelines),
      FROTH_STAND_IN(vkDestroyPipeline, destroyPipeline),
      FROTH_STAND_IN(vkCmdBindPipeline, bindPipeline),
      FROTH_STAND_IN(vkCmdBindDescriptorSets, bindDescriptorSets),
      FROTH_STAND_IN(vkCmdPushConstants, pushConstants),
      FROTH_STAND_IN(vkCmdDispatch, dispatch),
      FROTH_STAND_IN(vkCmdDispatchIndirect, dispatchIndirect),
      FROTH_STAND_IN(vkCmdPipelineBarrier2, pipelineBarrier),
      FROTH_STAND_IN(vkCmdCopyBuffer, copyBuffer),
      FROTH_STAND_IN(vkCmdFillBuffer, fillBuffer),
      FROTH_STAND_IN(vkCmdUpdateBuffer, updateBuffer),
      FROTH_STAND_IN(vkCmdResetQueryPool, resetQueryPool),
      FROTH_STAND_IN(vkCmdWriteTimestamp2, writeTimestamp),
      FROTH_STAND_IN(vkCmdBeginRendering, beginRendering),
      FROTH_STAND_IN(vkCmdEndRendering, endRendering),
      FROTH_STAND_IN(vkCmdSetViewport, setViewport),
      FROTH_STAND_IN(vkCmdSetScissor, setScissor),
      FROTH_STAND_IN(vkCmdSetDepthCompareOp, setDepthCompareOp),
      FROTH_STAND_IN(vkCmdDraw, draw),
#undef FROTH_STAND_IN
  };
  const auto found = standIns.find(name);
  if (found != standIns.end()) return found->second;
  return std::string_view(name).starts_with("vkCmd") ? nullptr : vkGetDeviceProcAddr(device, name);
}

}  // namespace

PFN_vkVoidFunction VKAPI_CALL CommandStream::getInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
  return vkGetInstanceProcAddr(instance, name);
}

std::set<std::string> CommandStream::namesOfShaders() {
  std::set<std::string> names;
  for (const NamedCode& shader : kShaders) names.insert(shader.name);
  return names;
}

}  // namespace froth::test
