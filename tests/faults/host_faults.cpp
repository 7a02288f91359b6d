#include "tests/faults/host_faults.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "froth/froth_host.h"

namespace froth::test {
namespace {

constinit thread_local size_t armedNumber = SIZE_MAX;
constinit thread_local size_t allocations = 0, foreign = 0, mismatches = 0;
// Read within malloc (noteMalloc), of which compilers believe that it reads nothing.
constinit thread_local volatile int zones = 0;
constinit thread_local bool struck = false;
constinit thread_local long live = 0;

// Before every block.
struct alignas(__STDCPP_DEFAULT_NEW_ALIGNMENT__) Header {
  size_t size, alignment;
  bool isCounted;  // made in a zone
};

size_t roomBefore(size_t alignment) { return std::max(alignment, sizeof(Header)); }

void* take(size_t size, size_t alignment, bool isCounted) {
  const size_t room = roomBefore(alignment);
  const size_t whole = (room + size + alignment - 1) / alignment * alignment;
  auto* const memory = static_cast<char*>(std::aligned_alloc(alignment, whole));
  if (!memory) return nullptr;
  reinterpret_cast<Header*>(memory + room)[-1] = {size, alignment, isCounted};
  live += isCounted;
  return memory + room;
}

Header give(void* block, size_t alignment) {
  const Header header = static_cast<Header*>(block)[-1];
  live -= header.isCounted;
  std::free(static_cast<char*>(block) - roomBefore(alignment));
  return header;
}

// For the runtime: null where it is to fail.
void* allocate(size_t size, size_t alignment) {
  const bool isCounted = zones > 0;
  if (isCounted && allocations++ == armedNumber) {
    struck = true;
    return nullptr;
  }
  const HostFaults::Pause pause;
  return take(size, alignment, isCounted);
}

constexpr FrothHostAllocator kAllocator{sizeof(FrothHostAllocator),
                                        [](void*, size_t size, size_t alignment) { return allocate(size, alignment); },
                                        [](void*, void* block, size_t size, size_t alignment) {
                                          const Header header = give(block, alignment);
                                          mismatches += header.size != size || header.alignment != alignment;
                                        },
                                        nullptr};

constinit bool isInstalled = false;
// Before the first call of the runtime.
[[maybe_unused]] const bool kIsInstalledFirst = [] {
  HostFaults::install();
  return true;
}();

constexpr size_t kPlain = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

void* allocateForProgram(size_t size) { return isInstalled ? take(size, kPlain, false) : allocate(size, kPlain); }

void release(void* block) {
  if (block) give(block, kPlain);
}

}  // namespace

bool HostFaults::isAllocator() { return isInstalled; }
void HostFaults::install() { isInstalled = frothSetHostAllocator(&kAllocator) == FROTH_OK; }

void HostFaults::arm(size_t number) {
  armedNumber = number;
  allocations = foreign = 0;
  struck = false;
}

void HostFaults::noteMalloc() { foreign += zones > 0; }

bool HostFaults::hasStruck() { return struck; }
size_t HostFaults::count() { return allocations; }
size_t HostFaults::foreignCount() { return foreign; }
long HostFaults::liveCount() { return live; }
size_t HostFaults::mismatchCount() { return mismatches; }
HostFaults::Zone::Zone() { zones = zones + 1; }
HostFaults::Zone::~Zone() { zones = zones - 1; }

// Nested pauses go deeper below zero.
HostFaults::Pause::Pause() { zones = zones - 1000; }
HostFaults::Pause::~Pause() { zones = zones + 1000; }

}  // namespace froth::test

void* operator new(size_t size) {
  if (void* block = froth::test::allocateForProgram(size)) return block;
  throw std::bad_alloc();
}
void* operator new[](size_t size) { return operator new(size); }
// The nothrow forms too: a sanitizer brings its own, which know nothing of headers.
void* operator new(size_t size, const std::nothrow_t&) noexcept { return froth::test::allocateForProgram(size); }
void* operator new[](size_t size, const std::nothrow_t& tag) noexcept { return operator new(size, tag); }
void operator delete(void* memory) noexcept { froth::test::release(memory); }
void operator delete[](void* memory) noexcept { froth::test::release(memory); }
void operator delete(void* memory, size_t) noexcept { froth::test::release(memory); }
void operator delete[](void* memory, size_t) noexcept { froth::test::release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { froth::test::release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { froth::test::release(memory); }
