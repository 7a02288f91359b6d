#include "runtime/device/upload_ring.h"

#include <algorithm>
#include <cstring>

namespace froth {

Result<std::unique_ptr<UploadRing>> UploadRing::create(Device& device, VkDeviceSize size) {
  std::unique_ptr<UploadRing> ring(new UploadRing(device));
  const Result<GpuBuffer> buffer =
      device.createBuffer(MemoryUse::kUploadsHost, BufferKind::kStaging, size, "upload ring");
  if (!buffer) {
    return buffer.error();
  }
  ring->buffer_ = *buffer;
  return ring;
}

UploadRing::~UploadRing() { device_.destroyBuffer(buffer_); }

VkDeviceSize UploadRing::stage(const void* owner, VkBuffer target, VkDeviceSize targetOffset, const void* bytes,
                               VkDeviceSize size) {
  VkDeviceSize staged = 0;
  copies_.reserve(copies_.size() + 2);  // one, or two around the end of the ring
  while (staged < size && used_ < buffer_.size) {
    const VkDeviceSize part = std::min({size - staged, buffer_.size - used_, buffer_.size - head_});
    std::memcpy(static_cast<char*>(buffer_.mapped) + head_, static_cast<const char*>(bytes) + staged, part);
    copies_.push_back({owner, target, {head_, targetOffset + staged, part}, kStaged});
    head_ = (head_ + part) % buffer_.size;
    used_ += part;
    staged += part;
  }
  return staged;
}

VkDeviceSize UploadRing::record(VkCommandBuffer commandBuffer, uint64_t serial, VkDeviceSize limit) {
  VkDeviceSize recorded = 0;
  copies_.reserve(copies_.size() + 1);  // one may be split
  for (size_t i = 0; i < copies_.size() && recorded < limit; ++i) {
    if (copies_[i].serial != kStaged) {
      continue;
    }
    splitCopy(i, limit - recorded);
    Copy& copy = copies_[i];
    device_.table.vkCmdCopyBuffer(commandBuffer, buffer_.buffer, copy.target, 1, &copy.region);
    copy.serial = serial;
    recorded += copy.region.size;
  }
  return recorded;
}

void UploadRing::splitCopy(size_t index, VkDeviceSize size) {
  Copy rest = copies_[index];
  if (rest.region.size <= size) {
    return;
  }
  rest.region.srcOffset += size;
  rest.region.dstOffset += size;
  rest.region.size -= size;
  copies_.insert(copies_.begin() + static_cast<std::ptrdiff_t>(index) + 1, rest);
  copies_[index].region.size = size;
}

bool UploadRing::isWithin(const void* owner, uint64_t serial) const {
  return std::none_of(copies_.begin(), copies_.end(),
                      [&](const Copy& copy) { return copy.owner == owner && copy.serial > serial; });
}

uint64_t UploadRing::newestInFlight() const {
  uint64_t newest = 0;
  for (const Copy& copy : copies_) {
    if (copy.serial != kStaged && copy.serial > completedSerial_) newest = std::max(newest, copy.serial);
  }
  return newest;
}

VkDeviceSize UploadRing::stagedBytes() const {
  VkDeviceSize bytes = 0;
  for (const Copy& copy : copies_) {
    bytes += copy.serial == kStaged ? copy.region.size : 0;
  }
  return bytes;
}

void UploadRing::retire(uint64_t completedSerial) {
  completedSerial_ = completedSerial;
  const auto isPending = [&](const Copy& copy) { return copy.serial > completedSerial; };
  for (Copy& copy : copies_) {
    if (!isPending(copy)) copy.targets.reset();  // also of those that have to wait for others to leave the ring
  }
  const auto firstPending = std::find_if(copies_.begin(), copies_.end(), isPending);
  for (auto copy = copies_.begin(); copy != firstPending; ++copy) {
    used_ -= copy->region.size;
  }
  copies_.erase(copies_.begin(), firstPending);
}

void UploadRing::drop(uint64_t serial) {
  for (Copy& copy : copies_) {
    if (copy.serial == serial) {
      copy.serial = copy.owner ? kStaged : kForgotten;
    }
  }
}

void UploadRing::forget(const void* owner, const std::shared_ptr<void>& targets) {
  for (Copy& copy : copies_) {
    if (copy.owner != owner) continue;
    copy.owner = nullptr;
    if (copy.serial == kStaged) {
      copy.serial = kForgotten;
    } else if (copy.serial > completedSerial_) {
      copy.targets = targets;
    }
  }
}

}  // namespace froth
