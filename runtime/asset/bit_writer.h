// Numbers of any width, one behind the other in words: the lowest bit of a word comes first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace froth {

class BitWriter {
 public:
  // The lowest `width` bits of value; width 0..32.
  void put(uint32_t value, uint32_t width) {
    if (width == 0) return;
    const uint64_t masked = value & (~uint64_t{0} >> (64 - width));
    const size_t word = static_cast<size_t>(end_ / 32);
    const uint32_t shift = static_cast<uint32_t>(end_ % 32);
    end_ += width;
    words_.resize(static_cast<size_t>((end_ + 31) / 32), 0);
    words_[word] |= static_cast<uint32_t>(masked << shift);
    if (shift + width > 32) words_[word + 1] |= static_cast<uint32_t>(masked >> (32 - shift));
  }

  // What follows starts at a byte; returns which.
  uint64_t startByte() {
    end_ = (end_ + 7) / 8 * 8;
    return end_ / 8;
  }

  // The words, and one more: who reads a number may look at the word behind it.
  std::vector<uint32_t> finish() {
    words_.resize(static_cast<size_t>((end_ + 31) / 32) + 1, 0);
    return std::move(words_);
  }

 private:
  std::vector<uint32_t> words_;
  uint64_t end_ = 0;  // [bits]
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
