// operator new of the whole program, which fails when it is told to, and counts what the runtime allocates.
#pragma once

#include <cstddef>

namespace froth::test {

// Of the calling thread.
struct HostFaults {
  // The allocation with this number (from 0) within zones throws std::bad_alloc. SIZE_MAX: none.
  static void arm(size_t number);
  static bool hasStruck();  // since arm()
  static size_t count();    // allocations within zones, since arm()
  static long liveCount();  // allocations made in zones and not freed

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
