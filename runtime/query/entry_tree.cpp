#include "runtime/query/entry_tree.h"

#include <algorithm>
#include <bit>

namespace froth {

EntryTree::EntryTree(std::vector<Sample> samples) {
  const size_t count = std::bit_floor(samples.size());
  // Evenly spread: the samples come along a curve that fills space.
  for (size_t i = 0; i < count; ++i) samples[i] = samples[i * samples.size() / count];
  samples.resize(count);
  splits_.resize(count);
  leaves_.resize(count);
  build(1, samples);
}

void EntryTree::build(size_t node, std::span<Sample> samples) {
  if (samples.size() == 1) {
    leaves_[node - leaves_.size()] = samples[0].cell;
    return;
  }
  glm::vec3 low = samples[0].site, high = low;
  for (const Sample& sample : samples) {
    low = glm::min(low, sample.site);
    high = glm::max(high, sample.site);
  }
  const glm::vec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const size_t half = samples.size() / 2;
  std::nth_element(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(half), samples.end(),
                   [&](const Sample& a, const Sample& b) { return a.site[axis] < b.site[axis]; });
  splits_[node] = {samples[half].site[axis], static_cast<uint32_t>(axis)};
  build(2 * node, samples.first(half));
  build(2 * node + 1, samples.subspan(half));
}

CellAddress EntryTree::find(const glm::vec3& point) const {
  size_t node = 1;
  while (node < leaves_.size()) {
    const Split split = splits_[node];
    node = 2 * node + (point[static_cast<int>(split.axis)] >= split.place ? 1 : 0);
  }
  return leaves_[node - leaves_.size()];
}

}  // namespace froth
