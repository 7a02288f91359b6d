// Counts what another reader is asked for.
#pragma once

#include <cstdint>

#include "froth/froth_reader.h"

namespace froth {

// It does not move while it is used.
class CountingReader {
 public:
  explicit CountingReader(const FrothReader& counted) : counted_(counted) {}

  FrothReader reader() {
    FrothReader reader = counted_;
    reader.user = this;
    reader.read = [](void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
      CountingReader& self = *static_cast<CountingReader*>(user);
      ++self.reads_;
      self.bytes_ += size;
      self.counted_.read(self.counted_.user, request, offset, size, destination);
    };
    reader.cancel = [](void* user, uint64_t request) {
      const FrothReader& counted = static_cast<CountingReader*>(user)->counted_;
      counted.cancel(counted.user, request);
    };
    return reader;
  }

  uint64_t reads() const { return reads_; }
  uint64_t bytes() const { return bytes_; }

 private:
  FrothReader counted_;
  uint64_t reads_ = 0, bytes_ = 0;  // of the frame's thread
};

}  // namespace froth
