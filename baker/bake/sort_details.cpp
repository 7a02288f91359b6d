#include "baker/bake/sort_details.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

namespace froth {
namespace {

// values[i] of the result is that of detail site order[i].
template <class T>
void permute(std::vector<T>& values, const std::vector<uint32_t>& order) {
  if (values.empty()) return;
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const uint32_t detail : order) sorted.push_back(values[detail]);
  values = std::move(sorted);
}

// The same for the lobes of detail site k, [offsets[k], offsets[k + 1]).
template <class T>
void permuteLobes(std::vector<T>& values, const std::vector<size_t>& offsets, const std::vector<uint32_t>& order) {
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const uint32_t detail : order) {
    sorted.insert(sorted.end(), values.begin() + static_cast<ptrdiff_t>(offsets[detail]),
                  values.begin() + static_cast<ptrdiff_t>(offsets[detail + 1]));
  }
  values = std::move(sorted);
}

}  // namespace

void sortDetails(uint32_t detailCount, ChunkContents& chunk) {
  std::vector<uint32_t> order(chunk.detailSites.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](uint32_t detail) {
    return std::tuple(chunk.detailSites[detail].x, chunk.detailSites[detail].y, detail);
  };
  for (auto first = order.begin(); first != order.end(); first += detailCount) {
    std::sort(first, first + detailCount, [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  }

  std::vector<size_t> lobeOffsets = {0};
  for (size_t detail = 0; detail < order.size(); ++detail) {
    const size_t count = chunk.lobeCounts.empty() ? chunk.lobeColours.size() / order.size() : chunk.lobeCounts[detail];
    lobeOffsets.push_back(lobeOffsets.back() + count);
  }
  permuteLobes(chunk.lobeAxes, lobeOffsets, order);
  permuteLobes(chunk.lobeColours, lobeOffsets, order);
  permute(chunk.lobeCounts, order);
  permute(chunk.baseColours, order);
  permute(chunk.detailHeights, order);
  permute(chunk.detailSites, order);
}

}  // namespace froth
