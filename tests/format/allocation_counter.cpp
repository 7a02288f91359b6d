#include "allocation_counter.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace froth {
namespace {

std::atomic<size_t> largest{0};

}  // namespace

void forgetAllocations() {
  largest = 0;
}
size_t largestAllocation() {
  return largest;
}

}  // namespace froth

// In a file of their own: where gcc inlines only one of the two, it warns of a mismatch.
void* operator new(size_t size) {
  size_t seen = froth::largest.load();
  while (seen < size && !froth::largest.compare_exchange_weak(seen, size)) {
  }
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
