// operator new of the shared library. It is hidden, and so is the copy of the C++ library that is linked in with it:
// both serve no code but the library's, and all of that.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "runtime/heap/host_allocator.h"

namespace froth {
namespace {

// In front of each block, for a delete that knows neither.
struct BlockHeader {
  size_t size, alignment;  // as given to the allocator
};
constexpr size_t kLeastAlignment = 16;
static_assert(sizeof(BlockHeader) == kLeastAlignment && __STDCPP_DEFAULT_NEW_ALIGNMENT__ <= kLeastAlignment);

void* allocateByMalloc(void*, size_t size, size_t alignment) {
  if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__) {
    return std::malloc(size);
  }
  void* memory = nullptr;
  return posix_memalign(&memory, alignment, size) == 0 ? memory : nullptr;
}

void releaseByFree(void*, void* pointer, size_t, size_t) { std::free(pointer); }

constexpr FrothHostAllocator kMalloc{sizeof(FrothHostAllocator), allocateByMalloc, releaseByFree, nullptr};

// There before any initializer of the library runs.
constinit FrothHostAllocator allocator = kMalloc;
constinit std::atomic<size_t> liveBlocks = 0;

void* takeBlock(size_t size, size_t wantedAlignment) {
  const size_t alignment = std::max(wantedAlignment, kLeastAlignment);  // and the room in front of the block
  if (size > SIZE_MAX - alignment) {
    throw std::bad_alloc();
  }
  const BlockHeader header{alignment + size, alignment};
  void* const memory = allocator.allocate(allocator.user, header.size, header.alignment);
  if (!memory) {
    throw std::bad_alloc();
  }
  liveBlocks.fetch_add(1, std::memory_order_relaxed);
  void* const block = static_cast<char*>(memory) + alignment;
  static_cast<BlockHeader*>(block)[-1] = header;
  return block;
}

void releaseBlock(void* block) noexcept {
  if (!block) {
    return;
  }
  const BlockHeader header = static_cast<BlockHeader*>(block)[-1];
  allocator.release(allocator.user, static_cast<char*>(block) - header.alignment, header.size, header.alignment);
  liveBlocks.fetch_sub(1, std::memory_order_release);
}

}  // namespace

FrothResult setHostAllocator(const FrothHostAllocator* wanted) {
  if (liveBlocks.load(std::memory_order_acquire) != 0) {
    return FROTH_ERROR_STATE;
  }
  allocator = wanted ? *wanted : kMalloc;
  return FROTH_OK;
}

}  // namespace froth

// By the standard the other forms, of arrays and nothrow, call these.
void* operator new(size_t size) { return froth::takeBlock(size, 0); }
void* operator new(size_t size, std::align_val_t alignment) {
  return froth::takeBlock(size, static_cast<size_t>(alignment));
}
void operator delete(void* block) noexcept { froth::releaseBlock(block); }
void operator delete(void* block, size_t) noexcept { froth::releaseBlock(block); }
void operator delete(void* block, std::align_val_t) noexcept { froth::releaseBlock(block); }
void operator delete(void* block, size_t, std::align_val_t) noexcept { froth::releaseBlock(block); }
