// Numbers of any width, one behind the other in words: the lowest bit of a word comes first.
#pragma once

#include <cstddef>
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

// Unsigned numbers, 2^shift of them in a word.
struct PackedElements {
  uint32_t shift = 0;  // 0: 32 bits each, 1: 16, 2: 8
  std::vector<uint32_t> words;
};

// In the fewest bits that hold the largest one.
inline PackedElements packElements(const std::vector<uint32_t>& elements) {
  uint32_t any = 0;
  for (const uint32_t element : elements) any |= element;
  const uint32_t shift = any < (1u << 8) ? 2 : any < (1u << 16) ? 1 : 0;
  PackedElements packed{shift, {}};
  packed.words.assign((elements.size() + (size_t{1} << shift) - 1) >> shift, 0);
  for (size_t i = 0; i < elements.size(); ++i) {
    const size_t place = i & ((size_t{1} << shift) - 1);
    packed.words[i >> shift] |= elements[i] << (place * (32 >> shift));
  }
  return packed;
}

}  // namespace froth
