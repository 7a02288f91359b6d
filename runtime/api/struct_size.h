// The rule of growing structs: structSize comes first, new fields at the end, absent ones are zero.
#pragma once

#include <algorithm>
#include <cstring>

#include "froth/froth.h"

namespace froth {

// No struct will ever be as large: beyond it structSize was not set.
inline constexpr uint32_t kMaxStructSize = 1 << 16;

// Copies a caller's struct of another age. FROTH_ERROR_VERSION: longer than known, and what is unknown is not
// zero.
template <class T>
FrothResult readStruct(const T& given, T& known) {
  if (given.structSize < sizeof(given.structSize) || given.structSize > kMaxStructSize) {
    return FROTH_ERROR_ARGUMENT;
  }
  const auto* bytes = reinterpret_cast<const unsigned char*>(&given);
  if (given.structSize > sizeof(T) &&
      std::any_of(bytes + sizeof(T), bytes + given.structSize, [](unsigned char byte) { return byte != 0; })) {
    return FROTH_ERROR_VERSION;
  }
  known = {};
  std::memcpy(&known, bytes, std::min<size_t>(given.structSize, sizeof(T)));
  known.structSize = sizeof(T);
  return FROTH_OK;
}

// Fills as much as the caller's struct has; what is unknown becomes zero. False: structSize is not set.
template <class T>
bool writeStruct(const T& known, T& given) {
  const size_t size = given.structSize;
  if (size < sizeof(given.structSize) || size > kMaxStructSize) {
    return false;
  }
  auto* bytes = reinterpret_cast<unsigned char*>(&given);
  const size_t header = sizeof(given.structSize);
  const size_t copied = std::min(size, sizeof(T));
  std::memcpy(bytes + header, reinterpret_cast<const unsigned char*>(&known) + header, copied - header);
  std::memset(bytes + copied, 0, size - copied);
  return true;
}

}  // namespace froth
