#include "runtime/asset/axis_labels.h"

#include <algorithm>
#include <bit>

namespace froth {
namespace {

// Three components of at most this many bits make one key.
constexpr uint32_t kKeyBits = 21;

uint64_t keyOf(const int32_t* code) {
  uint64_t key = 0;
  for (int c = 0; c < 3; ++c)
    key = key << kKeyBits | (static_cast<uint32_t>(code[c]) & ((1u << kKeyBits) - 1));
  return key;
}

struct Use {
  uint64_t key;
  size_t count;
};

// Most used first; equal counts by key.
std::vector<Use> countUses(std::vector<uint64_t> keys) {
  std::sort(keys.begin(), keys.end());
  std::vector<Use> uses;
  for (const uint64_t key : keys) {
    if (uses.empty() || uses.back().key != key) uses.push_back({key, 0});
    ++uses.back().count;
  }
  std::stable_sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.count > b.count; });
  return uses;
}

// How many of the most used axes the table takes, so that labels, table and the axes written out need the
// fewest bits. Two labels are kept free for the axes that a cell writes out.
size_t chooseTableSize(const std::vector<Use>& uses, size_t lobes, uint32_t componentBits) {
  constexpr size_t kFreeLabels = 2;
  const size_t axisBits = 3 * componentBits;
  size_t best = 0;
  size_t fewest = lobes * axisBits;
  size_t labelled = 0;
  for (size_t size = 1; size <= uses.size(); ++size) {
    labelled += uses[size - 1].count;
    const size_t labelBits = static_cast<size_t>(std::bit_width(size + kFreeLabels - 1));
    const size_t bits = (size + lobes - labelled) * axisBits + lobes * labelBits;
    if (bits < fewest) {
      fewest = bits;
      best = size;
    }
  }
  return best;
}

}  // namespace

AxisLabels labelAxes(const CellNumbers& axes) {
  AxisLabels result;
  const size_t lobes = axes.codes.size() / 3;
  result.labels.assign(lobes, AxisLabels::kNone);
  if (axes.isRaw()) return result;
  CodeRange range;
  for (const int32_t code : axes.codes) range.add(code);
  result.componentBits = range.signedWidth();
  if (result.componentBits > kKeyBits) return result;

  std::vector<uint64_t> keys(lobes);
  for (size_t lobe = 0; lobe < lobes; ++lobe) keys[lobe] = keyOf(&axes.codes[3 * lobe]);
  const std::vector<Use> uses = countUses(keys);
  std::vector<uint64_t> table;
  for (size_t i = 0; i < chooseTableSize(uses, lobes, result.componentBits); ++i)
    table.push_back(uses[i].key);
  std::sort(table.begin(), table.end());
  result.table.resize(table.size());
  for (size_t lobe = 0; lobe < lobes; ++lobe) {
    const auto found = std::lower_bound(table.begin(), table.end(), keys[lobe]);
    if (found == table.end() || *found != keys[lobe]) continue;
    const auto label = static_cast<uint32_t>(found - table.begin());
    result.labels[lobe] = label;
    std::copy_n(&axes.codes[3 * lobe], 3, result.table[label].begin());
  }
  return result;
}

}  // namespace froth
