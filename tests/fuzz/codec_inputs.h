// How the bytes of the fuzz targets of sections and graphs are cut up; shared with the program that makes
// their seeds.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace froth {

// An encoded section: this header, then the stored bytes.
struct SectionInput {
  uint8_t codec = 0;
  uint8_t elementSizeLog = 0;  // modulo 3
  uint8_t components = 1;      // modulo 8, plus 1
  uint8_t unused = 0;
  uint32_t entries = 0;  // modulo 2^12
};

// A packed graph: this header, then per site three coordinates and a radius (float), then counts, deltas,
// bits.
struct GraphInput {
  uint8_t hasWalkGraph = 0;                  // modulo 2
  uint8_t isWide = 0;                        // 255: 2^15 more ghosts, so that elements are 4 bytes
  uint16_t cells = 0, live = 0, ghosts = 0;  // modulo 256, cells + 1, 256
  uint32_t deltasSize = 0;                   // [bytes]
};

// Takes bytes from the front of the input; zeros where it ends.
class InputBytes {
 public:
  explicit InputBytes(std::span<const uint8_t> bytes) : left_(bytes) {}

  template <class Pod>
  Pod take() {
    Pod value{};
    const std::span<const uint8_t> bytes = takeBytes(sizeof(Pod));
    if (!bytes.empty()) std::memcpy(&value, bytes.data(), bytes.size());
    return value;
  }
  // As many of `size` bytes as are left.
  std::span<const uint8_t> takeBytes(size_t size) {
    const std::span<const uint8_t> bytes = left_.first(size < left_.size() ? size : left_.size());
    left_ = left_.subspan(bytes.size());
    return bytes;
  }
  std::span<const uint8_t> left() const { return left_; }

 private:
  std::span<const uint8_t> left_;
};

}  // namespace froth
