// malloc of the whole process, also of libraries, counted by HostFaults; glibc's do the work. Not with sanitizers,
// which have their own.
#include <cerrno>
#include <cstddef>

#include "tests/faults/host_faults.h"

extern "C" {

void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) noexcept {
  froth::test::HostFaults::noteMalloc();
  return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) noexcept {
  froth::test::HostFaults::noteMalloc();
  return __libc_calloc(count, size);
}

void* realloc(void* memory, size_t size) noexcept {
  froth::test::HostFaults::noteMalloc();
  return __libc_realloc(memory, size);
}

void* aligned_alloc(size_t alignment, size_t size) noexcept {
  froth::test::HostFaults::noteMalloc();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, size_t alignment, size_t size) noexcept {
  *memory = aligned_alloc(alignment, size);
  return *memory ? 0 : ENOMEM;
}
}
