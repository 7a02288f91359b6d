// Device memory by purpose: what it is for, how much of it there is.
#pragma once

#include <array>
#include <cstdint>

#include "froth/froth.h"

namespace froth {

enum class MemoryUse : uint32_t { kAssets, kViews, kViewsHost, kUploadsHost, kWalks, kWalksHost };
inline constexpr uint32_t kMemoryUseCount = 6;

inline bool isHostUse(MemoryUse use) {
  return use == MemoryUse::kViewsHost || use == MemoryUse::kUploadsHost || use == MemoryUse::kWalksHost;
}

// For %llu.
inline unsigned long long asPrinted(VkDeviceSize bytes) { return bytes; }

// What several buffers, or several images, ask of an allocation that they share.
inline constexpr VkMemoryRequirements kNoRequirements{0, 1, UINT32_MAX};
VkDeviceSize append(const VkMemoryRequirements& own, VkMemoryRequirements& all);  // returns its offset

// One allocation, for buffers or images.
struct MemoryBlock {
  FrothDeviceMemory place{};  // memory null: none
  VkDeviceSize granted = 0;   // [bytes] what the budget is charged
  VkDeviceSize used = 0;      // [bytes]
  MemoryUse use = MemoryUse::kAssets;
};

// One thread at a time.
class MemoryLedger {
 public:
  void add(const MemoryBlock& block);
  void remove(const MemoryBlock& block);
  void restartPeaks();  // at what is held now

  VkDeviceSize deviceBytes() const { return deviceBytes_; }
  VkDeviceSize deviceBytes(MemoryUse use) const { return entries_[static_cast<uint32_t>(use)].granted; }
  VkDeviceSize hostBytes() const { return hostBytes_; }
  uint32_t count() const { return count_; }        // of allocations
  void describe(FrothMemoryReport& report) const;  // all but the budget

 private:
  struct Entry {
    VkDeviceSize granted = 0, used = 0, peak = 0;
    uint32_t count = 0;
  };
  std::array<Entry, kMemoryUseCount> entries_{};
  VkDeviceSize deviceBytes_ = 0, devicePeak_ = 0, hostBytes_ = 0;
  uint32_t count_ = 0;
};

}  // namespace froth
