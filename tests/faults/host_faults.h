// The host memory of the runtime, which fails when it is told to, and is counted. The shared runtime gets it through
// frothSetHostAllocator. Others use operator new of the whole program, which is this one too.
#pragma once

#include <cstddef>

namespace froth::test {

// Of the calling thread.
struct HostFaults {
  static bool isAllocator();  // the runtime took it by frothSetHostAllocator
  static void install();      // again, after another

  // The allocation with this number (from 0) within zones fails. SIZE_MAX: none.
  static void arm(size_t number);
  static bool hasStruck();        // since arm()
  static size_t count();          // allocations within zones, since arm()
  static size_t foreignCount();   // of malloc within zones that do not serve the runtime's allocator, since arm()
  static long liveCount();        // allocations made in zones and not freed
  static size_t mismatchCount();  // blocks that came back with another size or alignment

  static void noteMalloc();  // of malloc_hooks.cpp

  // Around a call of the runtime.
  struct Zone {
    Zone();
    ~Zone();
    Zone(const Zone&) = delete;
    Zone& operator=(const Zone&) = delete;
  };

  // Around what the runtime calls: neither counted nor failing.
  struct Pause {
    Pause();
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;
  };
};

}  // namespace froth::test
