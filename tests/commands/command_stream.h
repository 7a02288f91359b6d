// The commands that the runtime records, and what each of them reads and writes. Nothing is compiled or executed:
// commands end here, pipelines and shader modules are numbers.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "tests/commands/hazards.h"
#include "tests/commands/shader_accesses.h"

namespace froth::test {

// One at a time: the functions that getInstanceProcAddr gives write to it.
class CommandStream {
 public:
  CommandStream();
  ~CommandStream();
  // Given to frothCreateContext in the place of the loader's.
  static PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name);
  static std::set<std::string> namesOfShaders();  // of the runtime

  static Range rangeOf(VkImage image);
  void nameView(VkImageView view, VkImage image) { images_[view] = image; }  // made outside of the runtime
  void complete(uint64_t serial);                                            // the host has waited for the frame

  // Plants a fault. Those to the host do not count: the next one makes up for them.
  void leaveOut(uint64_t barrier) { leftOut_ = barrier; }
  uint64_t barrierCount() const { return barriers_; }  // so far

  Hazards hazards;
  std::set<std::string> dispatched;  // names of shaders

  struct Shader {
    std::string name;
    std::set<ShaderAccess> accesses;
  };
  struct Descriptor {
    VkDescriptorType type;
    Range range;
  };
  struct Buffer {
    VkDeviceSize size = 0;
    uint64_t address = 0;  // buffers that have none get one too
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    std::vector<uint8_t> copied{};  // what device memory holds
  };
  struct Bound {
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE;
  };

  // For the functions that stand in for the driver's.
  Buffer& at(VkBuffer buffer) { return buffers_[buffer]; }
  void map(VkDeviceMemory memory, uint8_t* bytes) { mapped_[memory] = bytes; }
  void unmap(VkDeviceMemory memory) { mapped_.erase(memory); }
  void bind(VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset);
  void copy(VkBuffer from, VkBuffer to, const VkBufferCopy& region);
  void write(VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, const std::string& by);
  void dispatch();
  void dispatchIndirect(VkBuffer buffer, VkDeviceSize offset);
  void draw();
  void wait(const VkDependencyInfo& dependency);
  void forget(VkBuffer buffer) { buffers_.erase(buffer); }
  VkImage imageOf(VkImageView view) { return images_[view]; }
  std::map<VkShaderModule, const Shader*> modules;
  std::map<VkPipeline, std::vector<const Shader*>> pipelines;
  std::map<VkDescriptorSet, std::map<uint32_t, Descriptor>> sets;
  std::array<uint8_t, 128> push{};
  Bound compute, graphics;
  VkImageView depthAttachment = VK_NULL_HANDLE;

 private:
  void useAll(const Bound& bound, VkPipelineStageFlags2 stage);
  bool resolve(const Location& location, VkDescriptorSet set, Range& range);
  uint64_t readAddress(uint64_t address);

  uint64_t leftOut_ = UINT64_MAX, barriers_ = 0;
  uint64_t command_ = 1;  // 0: none of these
  std::map<VkBuffer, Buffer> buffers_;
  std::map<VkDeviceMemory, uint8_t*> mapped_;
  std::map<VkImageView, VkImage> images_;
};

}  // namespace froth::test
