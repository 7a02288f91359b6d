#include "tests/faults/host_faults.h"

#include <cstdint>
#include <cstdlib>
#include <new>

namespace froth::test {
namespace {

constinit thread_local size_t armedNumber = SIZE_MAX;
constinit thread_local size_t allocations = 0;
constinit thread_local int zones = 0;
constinit thread_local bool struck = false;
constinit thread_local long live = 0;

// Before every block: whether it was made in a zone.
struct alignas(__STDCPP_DEFAULT_NEW_ALIGNMENT__) Header {
  bool isCounted;
};

void* allocate(size_t size) {
  const bool isCounted = zones > 0;
  if (isCounted && allocations++ == armedNumber) {
    struck = true;
    throw std::bad_alloc();
  }
  auto* const header = static_cast<Header*>(std::malloc(sizeof(Header) + size));
  if (!header) throw std::bad_alloc();
  header->isCounted = isCounted;
  live += isCounted;
  return header + 1;
}

void release(void* memory) {
  if (!memory) return;
  Header* const header = static_cast<Header*>(memory) - 1;
  live -= header->isCounted;
  std::free(header);
}

}  // namespace

void HostFaults::arm(size_t number) {
  armedNumber = number;
  allocations = 0;
  struck = false;
}

size_t HostFaults::count() { return allocations; }

bool HostFaults::hasStruck() { return struck; }
long HostFaults::liveCount() { return live; }
HostFaults::Zone::Zone() { ++zones; }
HostFaults::Zone::~Zone() { --zones; }

// Nested pauses go deeper below zero.
HostFaults::Pause::Pause() { zones -= 1000; }
HostFaults::Pause::~Pause() { zones += 1000; }

}  // namespace froth::test

void* operator new(size_t size) { return froth::test::allocate(size); }
void* operator new[](size_t size) { return froth::test::allocate(size); }
// The nothrow forms too: a sanitizer brings its own, which know nothing of headers.
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  try {
    return froth::test::allocate(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new[](size_t size, const std::nothrow_t& tag) noexcept { return operator new(size, tag); }
void operator delete(void* memory) noexcept { froth::test::release(memory); }
void operator delete[](void* memory) noexcept { froth::test::release(memory); }
void operator delete(void* memory, size_t) noexcept { froth::test::release(memory); }
void operator delete[](void* memory, size_t) noexcept { froth::test::release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { froth::test::release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { froth::test::release(memory); }
