// Arrays of small numbers in words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace froth {

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
