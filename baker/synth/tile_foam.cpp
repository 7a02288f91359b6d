#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>
#include <glm/gtc/quaternion.hpp>

#include "baker/synth/golden_angle.h"
#include "baker/synth/synth.h"
#include "foam/foam_arrays.h"

namespace froth {

using glm::dvec3;

namespace {

constexpr double kGap = 0.05;  // of the bounding box

struct Bounds {
  dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};

Bounds boundBalls(const Foam& foam) {
  Bounds bounds;
  for (size_t i = 0; i < foam.sites.size(); ++i) {
    bounds.low = glm::min(bounds.low, dvec3(foam.sites[i]) - double{foam.radii[i]});
    bounds.high = glm::max(bounds.high, dvec3(foam.sites[i]) + double{foam.radii[i]});
  }
  return bounds;
}

template <class T>
void repeat(std::vector<T>& values, uint32_t count) {
  const size_t length = values.size();
  values.reserve(length * count);
  for (uint32_t copy = 1; copy < count; ++copy) {
    values.insert(values.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(length));
  }
}

void repeatOffsets(std::vector<uint64_t>& offsets, uint32_t count) {
  if (offsets.empty()) return;
  const size_t details = offsets.size() - 1;
  const uint64_t lobes = offsets.back();
  offsets.reserve(details * count + 1);
  for (uint32_t copy = 1; copy < count; ++copy) {
    for (size_t detail = 1; detail <= details; ++detail) offsets.push_back(copy * lobes + offsets[detail]);
  }
}

// Turns copy `copy` by `angle` about the vertical through `centre`, then moves it.
void placeCopy(Foam& foam, size_t copy, size_t cells, const dvec3& centre, double angle, const dvec3& move) {
  const glm::dquat turn(std::cos(0.5 * angle), 0, 0, std::sin(0.5 * angle));
  tbb::parallel_for(copy * cells, (copy + 1) * cells, [&](size_t i) {
    foam.sites[i] = centre + turn * (dvec3(foam.sites[i]) - centre) + move;
    // The frame's vectors are rows: turning them multiplies the inverse turn from the right.
    const glm::vec4 o = foam.orientations[i];
    const glm::dquat q = glm::normalize(glm::dquat(o.x, o.y, o.z, o.w) * glm::conjugate(turn));
    foam.orientations[i] = {q.w, q.x, q.y, q.z};
    for (uint64_t detail = i * foam.detailCount; detail < (i + 1) * foam.detailCount; ++detail) {
      const LobeRange lobes = lobesOf(foam, detail);
      for (uint64_t m = lobes.first; m < lobes.first + lobes.count; ++m) {
        foam.lobeAxes[m] = turn * dvec3(foam.lobeAxes[m]);
      }
    }
  });
}

}  // namespace

Result<Foam> tileFoam(const Foam& foam, uint32_t count) {
  if (count == 0) return makeError(ErrorKind::kUsage, "tiling into 0 copies; ask for at least 1");
  if (uint64_t{count} * foam.cellCount > std::numeric_limits<uint32_t>::max()) {
    return makeError(ErrorKind::kUsage, "%u copies of %u cells exceed 2^32 - 1; ask for at most %u", count,
                     foam.cellCount, std::numeric_limits<uint32_t>::max() / foam.cellCount);
  }
  Foam tiled = foam;
  tiled.cellCount = count * foam.cellCount;
  visitArrays([&](const FoamArray&, auto values) { repeat(tiled.*values, count); });
  repeatOffsets(tiled.lobeOffsets, count);

  const Bounds bounds = boundBalls(foam);
  const dvec3 extent = bounds.high - bounds.low;
  // A turned copy reaches as far sideways as the diagonal of its footprint.
  const double across = (1 + kGap) * std::hypot(extent.x, extent.y);
  const dvec3 pitch(across, across, (1 + kGap) * extent.z);
  const auto side = static_cast<uint32_t>(std::ceil(std::cbrt(static_cast<double>(count)) - 1e-9));
  for (uint32_t copy = 1; copy < count; ++copy) {
    const dvec3 place(copy % side, copy / side % side, copy / side / side);
    // No two copies are turned alike.
    placeCopy(tiled, copy, foam.cellCount, 0.5 * (bounds.low + bounds.high), kGoldenAngle * copy, pitch * place);
  }
  return tiled;
}

}  // namespace froth
