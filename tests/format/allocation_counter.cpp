#include "allocation_counter.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace froth {
namespace {

std::atomic<size_t> largest{0}, sum{0};

}  // namespace

void forgetAllocations() { largest = sum = 0; }
size_t largestAllocation() { return largest; }
size_t allocatedBytes() { return sum; }

}  // namespace froth

// In a file of their own: where gcc inlines only one of the two, it warns of a mismatch. All forms that free by the
// plain delete are here, for a sanitizer brings its own of those that are not.
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  froth::sum += size;
  size_t seen = froth::largest.load();
  while (seen < size && !froth::largest.compare_exchange_weak(seen, size)) {
  }
  return std::malloc(size);
}
void* operator new(size_t size) {
  if (void* memory = operator new(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
