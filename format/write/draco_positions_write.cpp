#include <algorithm>
#include <numeric>

#include <draco/compression/point_cloud/algorithms/dynamic_integer_points_kd_tree_encoder.h>

#include "format/draco_positions.h"
#include "format/point_box.h"
#include "format/position_order.h"

namespace froth {
namespace {

void append(std::vector<uint8_t>& bytes, const void* data, size_t size) {
  const uint8_t* first = static_cast<const uint8_t*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

// Appends a run. The tree depends on the set of points alone, for they are sorted before Draco splits them.
Status appendRun(std::span<const LatticePoint> points, std::vector<uint8_t>& stored) {
  const PointBox box = boxOf(points);
  if (box.bits > kMaxPositionBits) {
    return makeError(ErrorKind::kUnsupported, "the points span %u bits, Draco's codec takes %u", box.bits,
                     kMaxPositionBits);
  }
  std::vector<std::array<uint32_t, 3>> offsets(points.size());
  std::transform(points.begin(), points.end(), offsets.begin(),
                 [&box](const LatticePoint& point) { return box.offsetOf(point); });
  std::sort(offsets.begin(), offsets.end());
  draco::EncoderBuffer buffer;
  draco::DynamicIntegerPointsKdTreeEncoder<kDracoLevel> encoder(3);
  if (!encoder.EncodePoints(offsets.begin(), offsets.end(), std::max(box.bits, 1u), &buffer)) {
    return makeError(ErrorKind::kUnsupported, "Draco refuses %zu points", points.size());
  }
  const uint32_t header[2] = {static_cast<uint32_t>(points.size()), static_cast<uint32_t>(buffer.size())};
  append(stored, header, sizeof(header));
  append(stored, box.least.data(), sizeof(box.least));
  append(stored, buffer.data(), buffer.size());
  return {};
}

Result<std::vector<uint8_t>> encodeRuns(std::span<const LatticePoint> points, std::span<const uint32_t> runs) {
  std::vector<uint8_t> stored;
  for (const uint32_t run : runs) {
    if (run == 0) continue;
    if (Status status = appendRun(points.first(run), stored); !status) return status.error();
    points = points.subspan(run);
  }
  return stored;
}

Result<std::vector<LatticePoint>> decodeRuns(std::span<const uint8_t> stored, size_t count) {
  std::vector<LatticePoint> points(count);
  const std::span<uint8_t> raw{reinterpret_cast<uint8_t*>(points.data()), count * sizeof(LatticePoint)};
  if (Status status = readDracoPositions(stored, raw, "positions"); !status) return status.error();
  return points;
}

std::vector<uint32_t> sortedIndices(std::span<const LatticePoint> points) {
  std::vector<uint32_t> indices(points.size());
  std::iota(indices.begin(), indices.end(), 0u);
  std::stable_sort(indices.begin(), indices.end(), [points](uint32_t a, uint32_t b) { return points[a] < points[b]; });
  return indices;
}

}  // namespace

Result<std::vector<uint8_t>> writeDracoPositions(std::span<const LatticePoint> points, std::span<const uint32_t> runs) {
  Result<std::vector<uint8_t>> stored = encodeRuns(points, runs);
  if (!stored) return stored;
  const Result<std::vector<LatticePoint>> decoded = decodeRuns(*stored, points.size());
  if (!decoded) return decoded.error();
  if (!std::equal(points.begin(), points.end(), decoded->begin())) {
    return makeError(ErrorKind::kUnsupported, "the points do not lie in Draco's order");
  }
  return stored;
}

Result<std::vector<uint32_t>> dracoOrder(std::span<const LatticePoint> points) {
  const uint32_t run = static_cast<uint32_t>(points.size());
  const Result<std::vector<uint8_t>> stored = encodeRuns(points, {&run, 1});
  if (!stored) return stored.error();
  const Result<std::vector<LatticePoint>> decoded = decodeRuns(*stored, points.size());
  if (!decoded) return decoded.error();
  // The n-th point in sorted order is the same point in both lists.
  const std::vector<uint32_t> sourceOf = sortedIndices(points), placeOf = sortedIndices(*decoded);
  std::vector<uint32_t> order(points.size());
  for (size_t i = 0; i < order.size(); ++i) order[placeOf[i]] = sourceOf[i];
  return order;
}

}  // namespace froth
