#include "runtime/device/device_memory.h"

#include <algorithm>

namespace froth {
namespace {

// In the order of MemoryUse.
constexpr const char* kUseNames[kMemoryUseCount] = {"assets",        "views", "views, host",
                                                    "uploads, host", "walks", "walks, host"};

}  // namespace

VkDeviceSize append(const VkMemoryRequirements& own, VkMemoryRequirements& all) {
  const VkDeviceSize offset = (all.size + own.alignment - 1) / own.alignment * own.alignment;
  all = {offset + own.size, std::max(all.alignment, own.alignment), all.memoryTypeBits & own.memoryTypeBits};
  return offset;
}

void MemoryLedger::add(const MemoryBlock& block) {
  Entry& entry = entries_[static_cast<uint32_t>(block.use)];
  entry.granted += block.granted;
  entry.used += block.used;
  entry.peak = std::max(entry.peak, entry.granted);
  ++entry.count;
  ++count_;
  if (isHostUse(block.use)) {
    hostBytes_ += block.granted;
  } else {
    deviceBytes_ += block.granted;
    devicePeak_ = std::max(devicePeak_, deviceBytes_);
  }
}

void MemoryLedger::remove(const MemoryBlock& block) {
  Entry& entry = entries_[static_cast<uint32_t>(block.use)];
  entry.granted -= block.granted;
  entry.used -= block.used;
  --entry.count;
  --count_;
  (isHostUse(block.use) ? hostBytes_ : deviceBytes_) -= block.granted;
}

void MemoryLedger::restartPeaks() {
  for (Entry& entry : entries_) {
    entry.peak = entry.granted;
  }
  devicePeak_ = deviceBytes_;
}

void MemoryLedger::describe(FrothMemoryReport& report) const {
  report.categoryCount = kMemoryUseCount;
  for (uint32_t i = 0; i < kMemoryUseCount; ++i) {
    const Entry& entry = entries_[i];
    report.categories[i] = {kUseNames[i], entry.granted, entry.used,
                            entry.peak,   entry.count,   isHostUse(static_cast<MemoryUse>(i))};
  }
  report.deviceBytes = deviceBytes_;
  report.devicePeak = devicePeak_;
}

}  // namespace froth
