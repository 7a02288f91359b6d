#include "runtime/asset/axis_labels.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace froth {
namespace {

// Three components of at most this many bits make one key.
constexpr uint32_t kKeyBits = 21;

uint64_t keyOf(const int32_t* code) {
  uint64_t key = 0;
  for (int c = 0; c < 3; ++c) key = key << kKeyBits | (static_cast<uint32_t>(code[c]) & ((1u << kKeyBits) - 1));
  return key;
}

using KeyedLobe = std::pair<uint64_t, uint32_t>;

// The lobes of one axis among all lobes in the order of keys.
struct Use {
  size_t begin, end;

  size_t count() const { return end - begin; }
};

// Most used first; equal counts by key.
std::vector<Use> findUses(const std::vector<KeyedLobe>& lobes) {
  std::vector<Use> uses;
  for (size_t i = 0; i < lobes.size(); ++i) {
    if (i == 0 || lobes[i].first != lobes[i - 1].first) uses.push_back({i, i});
    uses.back().end = i + 1;
  }
  std::stable_sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.count() > b.count(); });
  return uses;
}

// How many of the most used axes the table takes, so that labels, table and the axes written out need the
// fewest bits. Some labels are kept free for the axes that a cell writes out.
size_t chooseTableSize(const std::vector<Use>& uses, size_t lobes, uint32_t componentBits) {
  constexpr size_t kFreeLabels = 16;
  const size_t axisBits = 3 * componentBits;
  size_t best = 0;
  size_t fewest = lobes * axisBits;
  size_t labelled = 0;
  for (size_t size = 1; size <= uses.size(); ++size) {
    labelled += uses[size - 1].count();
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
  if (axes.isRaw()) return result;
  CodeRange range;
  for (const int32_t code : axes.codes) range.add(code);
  result.componentBits = range.signedWidth();
  if (result.componentBits > kKeyBits) return result;

  std::vector<KeyedLobe> keyed(lobes);
  for (uint32_t lobe = 0; lobe < lobes; ++lobe) keyed[lobe] = {keyOf(&axes.codes[size_t{3} * lobe]), lobe};
  std::sort(keyed.begin(), keyed.end());
  const std::vector<Use> uses = findUses(keyed);
  result.table.resize(chooseTableSize(uses, lobes, result.componentBits));
  if (result.table.empty()) return result;
  result.axisCount = static_cast<uint32_t>(uses.size());
  result.labels.resize(lobes);
  for (uint32_t label = 0; label < result.axisCount; ++label) {
    const Use& use = uses[label];
    if (label < result.table.size()) {
      std::copy_n(&axes.codes[size_t{3} * keyed[use.begin].second], 3, result.table[label].begin());
    }
    for (size_t i = use.begin; i < use.end; ++i) result.labels[keyed[i].second] = label;
  }
  return result;
}

}  // namespace froth
