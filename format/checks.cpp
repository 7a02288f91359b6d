#include "format/checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "format/section.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "bake the scene again";
constexpr uint32_t kMaxDetails = 32, kMaxLobes = 32, kMaxLocalBits = 32;

Status checkRange(const std::string& file, const char* field, uint64_t value, uint64_t least, uint64_t most) {
  if (value >= least && value <= most) return {};
  return makeError(ErrorKind::kBadInput, "%s: %s is %llu, not in %llu..%llu; %s", file.c_str(), field,
                   static_cast<unsigned long long>(value), static_cast<unsigned long long>(least),
                   static_cast<unsigned long long>(most), kRemedy);
}

Status checkNotNegative(const std::string& file, const char* field, double value) {
  if (std::isfinite(value) && value >= 0) return {};
  return makeError(ErrorKind::kBadInput, "%s: %s is %g, not a finite number >= 0; %s", file.c_str(), field,
                   value, kRemedy);
}

Status checkCamera(const std::string& file, const char* field, const StoredCamera& camera) {
  for (const double value : camera.worldFromCamera)
    if (!std::isfinite(value))
      return makeError(ErrorKind::kBadInput, "%s: %s: matrix holds %g; %s", file.c_str(), field, value,
                       kRemedy);
  if (!std::isfinite(camera.tanHalfFovY) || camera.tanHalfFovY <= 0)
    return makeError(ErrorKind::kBadInput, "%s: %s: tan_half_fov_y is %g, not a finite number > 0; %s",
                     file.c_str(), field, camera.tanHalfFovY, kRemedy);
  return {};
}

Status checkCounts(const std::string& file, const AssetContents& asset, size_t index) {
  const ChunkContents& chunk = asset.chunks[index];
  const std::string place = file + ": chunk " + std::to_string(index);
  const uint64_t most =
      std::min(uint64_t{1} << asset.localBits, uint64_t{std::numeric_limits<uint32_t>::max()});
  if (Status status = checkRange(place, "cell_count", chunk.cellCount, 1, most); !status) return status;
  if (Status status = checkRange(place, "live_count", chunk.liveCount, 0, chunk.cellCount); !status)
    return status;
  for (const double value : chunk.origin)
    if (!std::isfinite(value))
      return makeError(ErrorKind::kBadInput, "%s: origin holds %g; %s", place.c_str(), value, kRemedy);
  return {};
}

// The numbers of any array of floats or float vectors.
template <class Vector>
std::span<const float> floatsOf(const std::vector<Vector>& array) {
  static_assert(sizeof(Vector) % sizeof(float) == 0);
  return {reinterpret_cast<const float*>(array.data()), array.size() * (sizeof(Vector) / sizeof(float))};
}

// Lengths and finite numbers of a chunk's arrays.
class ArrayCheck {
 public:
  ArrayCheck(const AssetContents& asset, uint32_t index, const ChunkContents& chunk, const std::string& file)
      : asset_(asset),
        index_(index),
        file_(file),
        counts_{chunk.cellCount, chunk.liveCount, chunk.neighbours.size()} {}

  template <class Element>
  void operator()(SectionType type, const std::vector<Element>& array) {
    if (!status_) return;
    const uint64_t expected = sectionWords(type, counts_, asset_.detailCount, asset_.lobeCount);
    const uint64_t found = array.size() * (sizeof(Element) / kWordSize);
    const bool isAbsent = type == SectionType::kDetailHeights && array.empty();
    if (found != expected && !isAbsent)
      status_ = makeError(ErrorKind::kBadInput, "%s: %llu numbers instead of %llu; %s", placeOf(type).c_str(),
                          static_cast<unsigned long long>(found), static_cast<unsigned long long>(expected),
                          kRemedy);
    if constexpr (!std::is_same_v<Element, uint32_t>) checkFinite(type, floatsOf(array));
  }

  const Status& status() const { return status_; }

 private:
  void checkFinite(SectionType type, std::span<const float> numbers) {
    const auto bad =
        std::find_if_not(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); });
    if (!status_ || bad == numbers.end()) return;
    status_ = makeError(ErrorKind::kBadInput, "%s: number %zu is %g; %s", placeOf(type).c_str(),
                        static_cast<size_t>(bad - numbers.begin()), *bad, kRemedy);
  }

  std::string placeOf(SectionType type) const {
    return sectionPlace(file_, index_, static_cast<uint32_t>(type));
  }

  const AssetContents& asset_;
  uint32_t index_;
  const std::string& file_;
  ChunkCounts counts_;
  Status status_;
};

Status checkCells(const ChunkContents& chunk, uint32_t index, const std::string& file) {
  const auto radius = std::find_if_not(chunk.radii.begin(), chunk.radii.end(), [](float r) { return r > 0; });
  if (radius != chunk.radii.end())
    return makeError(ErrorKind::kBadInput, "%s: cell %zu has radius %g, not > 0; %s",
                     sectionPlace(file, index, static_cast<uint32_t>(SectionType::kRadii)).c_str(),
                     static_cast<size_t>(radius - chunk.radii.begin()), *radius, kRemedy);
  const auto density =
      std::find_if(chunk.densities.begin(), chunk.densities.end(), [](float d) { return d < 0; });
  if (density != chunk.densities.end())
    return makeError(ErrorKind::kBadInput, "%s: cell %zu has density %g, not >= 0; %s",
                     sectionPlace(file, index, static_cast<uint32_t>(SectionType::kDensities)).c_str(),
                     static_cast<size_t>(density - chunk.densities.begin()), *density, kRemedy);
  return {};
}

Status checkRows(const ChunkContents& chunk, uint32_t index, const std::string& file) {
  const std::string place = sectionPlace(file, index, static_cast<uint32_t>(SectionType::kNeighbourOffsets));
  const std::vector<uint32_t>& offsets = chunk.neighbourOffsets;
  if (offsets.front() != 0)
    return makeError(ErrorKind::kBadInput, "%s: starts with %u, not 0; %s", place.c_str(), offsets.front(),
                     kRemedy);
  if (offsets.back() != chunk.neighbours.size())
    return makeError(ErrorKind::kBadInput, "%s: ends with %u, not with the %zu neighbours there are; %s",
                     place.c_str(), offsets.back(), chunk.neighbours.size(), kRemedy);
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell)
    if (offsets[cell] > offsets[cell + 1])
      return makeError(ErrorKind::kBadInput, "%s: cell %u: %u > %u, offsets must not fall; %s", place.c_str(),
                       cell, offsets[cell], offsets[cell + 1], kRemedy);
  for (uint32_t cell = 0; cell < chunk.liveCount; ++cell)
    if (chunk.alphaCounts[cell] > offsets[cell + 1] - offsets[cell])
      return makeError(ErrorKind::kBadInput, "%s: cell %u: %u alpha neighbours in a row of %u; %s",
                       sectionPlace(file, index, static_cast<uint32_t>(SectionType::kAlphaCounts)).c_str(),
                       cell, chunk.alphaCounts[cell], offsets[cell + 1] - offsets[cell], kRemedy);
  return {};
}

Status checkReferences(const AssetContents& asset, const ChunkContents& chunk, uint32_t index,
                       const std::string& file) {
  for (const CellRef neighbour : chunk.neighbours) {
    const uint32_t other = chunkOf(neighbour, asset.localBits), local = localOf(neighbour, asset.localBits);
    const bool isChunk = other < asset.chunks.size();
    if (isChunk && local < asset.chunks[other].cellCount) continue;
    const std::string place = sectionPlace(file, index, static_cast<uint32_t>(SectionType::kNeighbours));
    if (!isChunk)
      return makeError(ErrorKind::kBadInput, "%s: chunk %u >= %zu; %s", place.c_str(), other,
                       asset.chunks.size(), kRemedy);
    return makeError(ErrorKind::kBadInput, "%s: cell %u of chunk %u >= %u; %s", place.c_str(), local, other,
                     asset.chunks[other].cellCount, kRemedy);
  }
  return {};
}

}  // namespace

Status checkParameters(const AssetContents& asset, const std::string& file) {
  if (Status status = checkRange(file, "detail_count", asset.detailCount, 1, kMaxDetails); !status)
    return status;
  if (Status status = checkRange(file, "lobe_count", asset.lobeCount, 1, kMaxLobes); !status) return status;
  if (Status status = checkRange(file, "local_bits", asset.localBits, 1, kMaxLocalBits); !status)
    return status;
  const uint64_t mostChunks = uint64_t{1} << (kMaxLocalBits - asset.localBits);
  if (Status status = checkRange(file, "number of chunks", asset.chunks.size(), 1, mostChunks); !status)
    return status;
  if (Status status = checkNotNegative(file, "detail_sharpness", asset.detailSharpness); !status)
    return status;
  if (Status status = checkNotNegative(file, "near_ratio", asset.nearRatio); !status) return status;
  if (Status status = checkNotNegative(file, "near_depth", asset.nearDepth); !status) return status;
  if (asset.hasStartView)
    if (Status status = checkCamera(file, "start_view", asset.startView); !status) return status;
  for (const StoredCamera& camera : asset.flightPath)
    if (Status status = checkCamera(file, "flight_path", camera); !status) return status;
  for (size_t i = 0; i < asset.chunks.size(); ++i)
    if (Status status = checkCounts(file, asset, i); !status) return status;
  return {};
}

Status checkChunk(const AssetContents& asset, uint32_t index, const ChunkContents& chunk,
                  const std::string& file) {
  ArrayCheck arrays(asset, index, chunk, file);
  visitSections(chunk, arrays);
  if (!arrays.status()) return arrays.status();
  if (Status status = checkCells(chunk, index, file); !status) return status;
  if (Status status = checkRows(chunk, index, file); !status) return status;
  return checkReferences(asset, chunk, index, file);
}

Box liveBoundsOf(const ChunkContents& chunk) {
  if (chunk.liveCount == 0) return {};
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[static_cast<size_t>(axis)] = std::numeric_limits<double>::infinity();
    box.max[static_cast<size_t>(axis)] = -std::numeric_limits<double>::infinity();
    for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
      const double site = chunk.sites[cell][axis], radius = chunk.radii[cell];
      box.min[static_cast<size_t>(axis)] = std::min(box.min[static_cast<size_t>(axis)], site - radius);
      box.max[static_cast<size_t>(axis)] = std::max(box.max[static_cast<size_t>(axis)], site + radius);
    }
  }
  return box;
}

}  // namespace froth
