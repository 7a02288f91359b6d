// Numbers of any width, one behind the other in words: the lowest bit of a word comes first.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace froth {

class BitWriter {
 public:
  // The lowest `width` bits of value; width 0..32.
  void put(uint32_t value, uint32_t width) {
    pending_ |= (value & ((uint64_t{1} << width) - 1)) << filled_;
    filled_ += width;
    flush();
  }

  // What follows starts at a byte; returns which.
  uint64_t startByte() {
    filled_ = (filled_ + 7) / 8 * 8;
    flush();
    return uint64_t{words_.size()} * 4 + filled_ / 8;
  }

  // The words up to that of the next bit, and one more: who reads a number, if of no bits, looks at its word and at the
  // one behind it.
  std::vector<uint32_t> finish() {
    words_.push_back(static_cast<uint32_t>(pending_));
    words_.push_back(0);
    return std::move(words_);
  }

 private:
  void flush() {
    if (filled_ < 32) return;
    words_.push_back(static_cast<uint32_t>(pending_));
    pending_ >>= 32;
    filled_ -= 32;
  }

  std::vector<uint32_t> words_;
  uint64_t pending_ = 0;  // bits behind the words
  uint32_t filled_ = 0;   // how many; 0..31 between calls
};

}  // namespace froth
