#include "trainer/photos/box_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace froth {
namespace {

// Pixels [first, end) of the large image that one of the small image covers, and the shares of the first and the last.
struct Cover {
  uint32_t first, end;
  double firstShare, lastShare;

  double shareOf(uint32_t at) const { return at == first ? firstShare : at + 1 == end ? lastShare : 1; }
};

// Exact where it matters: multiples of `from` and `to` are integers.
Cover coverOf(uint32_t index, uint32_t from, uint32_t to) {
  const uint64_t low = uint64_t{index} * from, high = low + from;  // in 1/to of a pixel
  const auto first = static_cast<uint32_t>(low / to), end = static_cast<uint32_t>((high + to - 1) / to);
  const double firstShare = static_cast<double>(std::min<uint64_t>(uint64_t{first + 1} * to, high) - low) / to;
  const double lastShare = static_cast<double>(high - uint64_t{end - 1} * to) / to;
  return {first, end, firstShare, lastShare};
}

}  // namespace

uint32_t reducedSide(uint32_t pixels, double factor) {
  return std::max(1u, static_cast<uint32_t>(std::lround(pixels / factor)));
}

std::vector<uint8_t> reducePixels(const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height, uint32_t toWidth,
                                  uint32_t toHeight) {
  const double area = static_cast<double>(width) / toWidth * height / toHeight;
  std::vector<uint8_t> reduced;
  reduced.reserve(size_t{toWidth} * toHeight * 4);
  for (uint32_t y = 0; y < toHeight; ++y) {
    const Cover rows = coverOf(y, height, toHeight);
    for (uint32_t x = 0; x < toWidth; ++x) {
      const Cover columns = coverOf(x, width, toWidth);
      double sums[4] = {};
      for (uint32_t row = rows.first; row < rows.end; ++row) {
        for (uint32_t column = columns.first; column < columns.end; ++column) {
          const double share = rows.shareOf(row) * columns.shareOf(column);
          for (int c = 0; c < 4; ++c) sums[c] += share * rgba[(size_t{row} * width + column) * 4 + c];
        }
      }
      for (const double sum : sums) reduced.push_back(static_cast<uint8_t>(std::lround(sum / area)));
    }
  }
  return reduced;
}

std::vector<uint8_t> reduceFlags(const std::vector<uint8_t>& flags, uint32_t width, uint32_t height, uint32_t toWidth,
                                 uint32_t toHeight) {
  std::vector<uint8_t> reduced;
  reduced.reserve(size_t{toWidth} * toHeight);
  for (uint32_t y = 0; y < toHeight; ++y) {
    const Cover rows = coverOf(y, height, toHeight);
    for (uint32_t x = 0; x < toWidth; ++x) {
      const Cover columns = coverOf(x, width, toWidth);
      bool isSet = true;
      for (uint32_t row = rows.first; row < rows.end; ++row) {
        const auto begin = flags.begin() + static_cast<ptrdiff_t>(size_t{row} * width);
        isSet =
            isSet && std::all_of(begin + columns.first, begin + columns.end, [](uint8_t flag) { return flag != 0; });
      }
      reduced.push_back(isSet);
    }
  }
  return reduced;
}

}  // namespace froth
