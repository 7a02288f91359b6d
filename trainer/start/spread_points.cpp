#include "trainer/start/spread_points.h"

#include <algorithm>
#include <tuple>

#include "base/counter_random.h"
#include "base/morton_code.h"
#include "trainer/start/start_streams.h"

namespace froth {
namespace {

constexpr int kGridBits = 21;  // of a Morton code's axis

struct Placed {
  uint64_t code;      // Morton code of its smallest cube
  uint64_t priority;  // the least of a cube's stands for it
  uint32_t index;
  int level;  // bits of the coarsest cube that it stands for
};

bool isBefore(const Placed& a, const Placed& b) {
  return std::tie(a.priority, a.index) < std::tie(b.priority, b.index);
}

// The cubes of `level` bits in a range of one cube of a level less: its point of least priority keeps the coarser
// level, those of the other cubes get this one.
void assignLevels(std::vector<Placed>& placed, size_t begin, size_t end, int level) {
  if (level > kGridBits) return;
  const int shift = 3 * (kGridBits - level);
  for (size_t first = begin, next; first < end; first = next) {
    next = first + 1;
    while (next < end && placed[next].code >> shift == placed[first].code >> shift) ++next;
    const auto least = std::min_element(placed.begin() + static_cast<ptrdiff_t>(first),
                                        placed.begin() + static_cast<ptrdiff_t>(next), isBefore);
    least->level = std::min(least->level, level);
    if (next - first > 1) assignLevels(placed, first, next, level + 1);
  }
}

}  // namespace

std::vector<uint32_t> spreadOrder(const std::vector<glm::dvec3>& points, double reach, uint64_t seed) {
  const CounterRandom random = startRandom(seed, StartStream::kPriority);
  std::vector<Placed> placed;
  for (uint32_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 unit = (points[i] / reach + 1.0) * 0.5;
    if (!(glm::min(unit.x, glm::min(unit.y, unit.z)) >= 0 && glm::max(unit.x, glm::max(unit.y, unit.z)) < 1)) continue;
    const glm::uvec3 cube(unit * double(1 << kGridBits));
    placed.push_back({mortonCode({cube.x, cube.y, cube.z}), random.bits(i), i, kGridBits + 1});
  }
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.code != b.code ? a.code < b.code : isBefore(a, b); });
  assignLevels(placed, 0, placed.size(), 0);
  std::erase_if(placed, [](const Placed& point) { return point.level > kGridBits; });
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.level != b.level ? a.level < b.level : isBefore(a, b); });
  std::vector<uint32_t> order;
  order.reserve(placed.size());
  for (const Placed& point : placed) order.push_back(point.index);
  return order;
}

}  // namespace froth
