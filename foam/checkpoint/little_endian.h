// Numbers in a file's byte order, at any alignment.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace froth {

static_assert(std::endian::native == std::endian::little, "checkpoints are read and written by copying");

// `bytes` must hold sizeof(Number) bytes: nothing is checked here.
template <class Number>
Number loadLittleEndian(const uint8_t* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

template <class Number>
void appendLittleEndian(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace froth
