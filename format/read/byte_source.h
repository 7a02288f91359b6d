// The bytes of an asset, wherever they lie.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"

namespace froth {

struct ByteRange {
  uint64_t offset = 0, size = 0;  // [bytes]
};

// Thread safety: view() may run on several threads at once.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  // The bytes of a range within the asset's size; `storage` receives those that are not in memory.
  virtual Result<std::span<const uint8_t>> view(ByteRange range, std::vector<uint8_t>& storage) const = 0;
};

}  // namespace froth
