#include "format/container.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace froth {

uint64_t hashBytes(std::span<const uint8_t> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

uint64_t hashHeader(const FileHeader& header) {
  return hashBytes({reinterpret_cast<const uint8_t*>(&header), offsetof(FileHeader, headerHash)});
}

bool hashMatches(std::span<const uint8_t> bytes, uint64_t expected) {
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
  (void)bytes, (void)expected;
  return true;
#else
  return hashBytes(bytes) == expected;
#endif
}

}  // namespace froth
