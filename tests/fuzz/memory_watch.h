// How much memory lives at once while a fuzz target runs: every malloc and free, through the hooks of
// AddressSanitizer.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <sanitizer/allocator_interface.h>

namespace froth {

// Counts from its construction on, on all threads. One at a time.
class MemoryWatch {
 public:
  MemoryWatch() {
    [[maybe_unused]] static const int hooks = __sanitizer_install_malloc_and_free_hooks(&addBlock, &removeBlock);
    live = peak = 0;
  }

  // Ends the run as a fault if more than `limit` bytes lived at once.
  void expectAtMost(size_t limit) const {
    if (peak <= static_cast<int64_t>(limit)) return;
    std::fprintf(stderr, "%lld bytes of memory at once, at most %zu are justified\n",
                 static_cast<long long>(peak.load()), limit);
    std::abort();
  }

 private:
  static void addBlock(const volatile void*, size_t size) {
    const int64_t now = live += static_cast<int64_t>(size);
    int64_t seen = peak;
    while (seen < now && !peak.compare_exchange_weak(seen, now)) {
    }
  }
  static void removeBlock(const volatile void* block) {
    live -= static_cast<int64_t>(__sanitizer_get_allocated_size(const_cast<void*>(block)));
  }

  static inline std::atomic<int64_t> live{0}, peak{0};  // [bytes]; live is negative where older blocks go
};

}  // namespace froth
