#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "baker/appearance/axis_codebook.h"

namespace froth {
namespace {

constexpr uint32_t kBatches = 24;
constexpr uint32_t kSamplesPerEntry = 16;  // in a batch
constexpr float kEntryStep = 1.0f / 32;    // entries lie on a lattice, finer than they differ: fewer bytes

struct Centre {
  glm::dvec3 warped;
  double weight;
};

std::vector<glm::vec3> axesOf(const std::vector<Centre>& centres) {
  std::vector<glm::vec3> axes;
  for (const Centre& centre : centres) axes.push_back(unwarpAxis(centre.warped));
  return axes;
}

std::vector<uint32_t> assign(const std::vector<glm::vec3>& batch, const std::vector<Centre>& centres) {
  const AxisCodebook tree(axesOf(centres));
  std::vector<uint32_t> nearest(batch.size());
  tbb::parallel_for(size_t{0}, batch.size(), [&](size_t i) { nearest[i] = tree.findNearest(batch[i]); });
  return nearest;
}

}  // namespace

std::vector<glm::vec3> trainCodebook(std::span<const glm::vec3> samples, uint32_t size, uint64_t seed,
                                     const Progress& progress) {
  if (samples.empty() || size == 0) return {};
  std::mt19937_64 random(seed);
  const auto draw = [&] { return samples[random() % samples.size()]; };
  std::vector<Centre> centres(size);
  for (Centre& centre : centres) centre = {warpAxis(draw()), 1};

  std::vector<glm::vec3> batch(size_t{size} * kSamplesPerEntry);
  for (uint32_t b = 0; b < kBatches; ++b) {
    if (!report(progress, "codebook", b, kBatches)) return {};
    for (glm::vec3& axis : batch) axis = draw();
    const std::vector<uint32_t> nearest = assign(batch, centres);
    for (size_t i = 0; i < batch.size(); ++i) {
      Centre& centre = centres[nearest[i]];
      centre.weight += 1;
      centre.warped += (glm::dvec3(warpAxis(batch[i])) - centre.warped) / centre.weight;
    }
  }
  std::stable_sort(centres.begin(), centres.end(),
                   [](const Centre& a, const Centre& b) { return a.weight > b.weight; });

  std::vector<glm::vec3> entries;
  std::set<std::array<float, 3>> taken;
  for (const glm::vec3& axis : axesOf(centres)) {
    const glm::vec3 entry = snapAxis(axis, kEntryStep);
    if (taken.insert({entry.x, entry.y, entry.z}).second) entries.push_back(entry);
  }
  return entries;
}

}  // namespace froth
