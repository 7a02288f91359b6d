#include "tests/commands/command_stream.h"

#include <cstring>

#include "tests/commands/passes.h"

namespace froth::test {
namespace {

constexpr uint64_t kImages = uint64_t{1} << 62;  // addresses of images: of their handles

std::string describe(const std::string& shader, const Location& location) {
  std::string text = shader + " (";
  for (const uint32_t address : location.addresses) text += std::to_string(address) + " -> ";
  return text + std::to_string(location.place) + ")";
}

}  // namespace

CommandStream* currentStream = nullptr;  // for the stand-ins

CommandStream::CommandStream() : hazards(writeDifferentPlaces) { currentStream = this; }
CommandStream::~CommandStream() { currentStream = nullptr; }

Range CommandStream::rangeOf(VkImage image) {
  const uint64_t place = kImages | reinterpret_cast<uint64_t>(image);
  return {place, place + 1};
}

void CommandStream::write(VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, const std::string& by) {
  const Buffer& target = at(buffer);
  const uint64_t begin = target.address + offset;
  const uint64_t end = size == VK_WHOLE_SIZE ? target.address + target.size : begin + size;
  hazards.use({begin, end},
              {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, true, false, ++command_, by});
}

void CommandStream::copy(VkBuffer from, VkBuffer to, const VkBufferCopy& region) {
  Buffer &source = at(from), &target = at(to);
  const uint64_t begin = source.address + region.srcOffset;
  hazards.use({begin, begin + region.size},
              {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, false, false, ++command_, "a copy"});
  write(to, region.dstOffset, region.size, "a copy");
  if (!mapped_.contains(source.memory)) return;
  target.copied.resize(target.size);
  std::memcpy(target.copied.data() + region.dstOffset, mapped_[source.memory] + source.offset + region.srcOffset,
              region.size);
}

// Memory is mapped before it is bound. What no command writes reads as zeros.
void CommandStream::bind(VkBuffer handle, VkDeviceMemory memory, VkDeviceSize offset) {
  Buffer& buffer = at(handle);
  buffer.memory = memory;
  buffer.offset = offset;
  if (mapped_.contains(memory)) std::memset(mapped_[memory] + offset, 0, buffer.size);
}

// 0: unknown.
uint64_t CommandStream::readAddress(uint64_t address) {
  for (const auto& [handle, buffer] : buffers_) {
    if (address < buffer.address || address + sizeof(uint64_t) > buffer.address + buffer.copied.size()) continue;
    uint64_t value = 0;
    std::memcpy(&value, buffer.copied.data() + (address - buffer.address), sizeof(value));
    return value;
  }
  return 0;
}

// False: an address on the way is null, so nothing is accessed.
bool CommandStream::resolve(const Location& location, VkDescriptorSet set, Range& range) {
  uint64_t base = 0;
  size_t next = 0;
  if (location.root == Root::kPushConstants) {
    std::memcpy(&base, push.data() + location.addresses[next++], sizeof(base));
  } else {
    const auto& bindings = sets[set];
    const auto found = bindings.find(location.binding);
    if (found == bindings.end()) return false;
    base = found->second.range.begin;
  }
  for (; next < location.addresses.size() && base != 0; ++next) base = readAddress(base + location.addresses[next]);
  range = {base + location.place, base + location.place + 1};
  return base != 0;
}

void CommandStream::useAll(const Bound& bound, VkPipelineStageFlags2 stage) {
  ++command_;
  for (const Shader* shader : pipelines[bound.pipeline]) {
    dispatched.insert(shader->name);
    for (const auto& [location, mode] : shader->accesses) {
      Range range{};
      if (!happens(shader->name, location, push) || !resolve(location, bound.set, range)) continue;
      const bool isDescriptor = location.root == Root::kDescriptor && location.addresses.empty();
      const VkDescriptorType type =
          isDescriptor ? sets[bound.set][location.binding].type : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
      const VkAccessFlags2 read = type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER  ? VK_ACCESS_2_UNIFORM_READ_BIT
                                  : type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT
                                                                             : VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
      const VkAccessFlags2 access = mode == AccessMode::kRead    ? read
                                    : mode == AccessMode::kWrite ? VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT
                                                                 : read | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
      hazards.use(range, {stage, access, mode != AccessMode::kRead, mode == AccessMode::kAtomic, command_,
                          describe(shader->name, location)});
    }
  }
}

void CommandStream::dispatch() { useAll(compute, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT); }

void CommandStream::dispatchIndirect(VkBuffer buffer, VkDeviceSize offset) {
  const uint64_t begin = at(buffer).address + offset;
  hazards.use({begin, begin + sizeof(VkDispatchIndirectCommand)},
              {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, false, false, ++command_,
               "a dispatch's size"});
  dispatch();
}

void CommandStream::draw() {
  useAll(graphics, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
  hazards.use(rangeOf(images_[depthAttachment]),
              {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,
               VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, true,
               false, command_, "the depth test"});
}

void CommandStream::wait(const VkDependencyInfo& dependency) {
  const bool isToHost =
      dependency.memoryBarrierCount > 0 && dependency.pMemoryBarriers[0].dstStageMask == VK_PIPELINE_STAGE_2_HOST_BIT;
  if (!isToHost && barriers_++ == leftOut_) return;
  const auto scopesOf = [](const auto& barrier) {
    return Dependency{barrier.srcStageMask, barrier.srcAccessMask, barrier.dstStageMask, barrier.dstAccessMask};
  };
  for (uint32_t i = 0; i < dependency.memoryBarrierCount; ++i) hazards.wait(scopesOf(dependency.pMemoryBarriers[i]));
  for (uint32_t i = 0; i < dependency.imageMemoryBarrierCount; ++i) {
    const VkImageMemoryBarrier2& barrier = dependency.pImageMemoryBarriers[i];
    if (barrier.oldLayout == barrier.newLayout) {
      hazards.wait(scopesOf(barrier), rangeOf(barrier.image));
    } else {
      hazards.change(scopesOf(barrier), rangeOf(barrier.image), "a barrier");
    }
  }
}

void CommandStream::complete(uint64_t serial) {
  std::vector<Range> ranges;
  for (const auto& [handle, buffer] : buffers_) {
    if (mapped_.contains(buffer.memory)) ranges.push_back({buffer.address, buffer.address + buffer.size});
  }
  hazards.complete(serial, ranges);
}

}  // namespace froth::test
