// Differences of neighbouring numbers as small unsigned ones: shared by encoders and decoders.
#pragma once

#include <cstdint>
#include <type_traits>

namespace froth {

// 0, -1, 1, -2, 2 ... become 0, 1, 2, 3, 4 ...; Word is unsigned and stands for its two's complement number.
template <class Word>
constexpr Word foldDelta(Word difference) {
  constexpr int kSignBit = sizeof(Word) * 8 - 1;
  const Word sign = static_cast<Word>(difference >> kSignBit);
  return static_cast<Word>(static_cast<Word>(difference << 1) ^ static_cast<Word>(Word{0} - sign));
}
template <class Word>
constexpr Word unfoldDelta(Word folded) {
  const Word sign = folded & 1;
  return static_cast<Word>(static_cast<Word>(folded >> 1) ^ static_cast<Word>(Word{0} - sign));
}

}  // namespace froth
