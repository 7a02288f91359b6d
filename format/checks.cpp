#include "format/checks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/float_span.h"
#include "base/text.h"
#include "format/lattice.h"
#include "format/level_checks.h"
#include "format/limits.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "bake the scene again";
constexpr uint32_t kMaxDetails = 32, kMaxLobes = 32, kMaxLocalBits = 32, kMaxCodebook = 65536;
constexpr uint64_t kMaxCells = std::numeric_limits<uint32_t>::max();
constexpr uint64_t kMaxPairs = uint64_t{1} << 31;  // so that rows have 32-bit offsets

using ull = unsigned long long;

Status checkRange(const std::string& place, const char* field, uint64_t value, uint64_t least, uint64_t most) {
  if (value >= least && value <= most) return {};
  return makeError(ErrorKind::kBadInput, "%s: %s is %llu, not in %llu..%llu; %s", place.c_str(), field, ull{value},
                   ull{least}, ull{most}, kRemedy);
}

Status checkNotNegative(const std::string& file, const char* field, double value, double most) {
  if (value >= 0 && value <= most) return {};
  return makeError(ErrorKind::kBadInput, "%s: %s is %g, not in 0..%g; %s", file.c_str(), field, value, most, kRemedy);
}

bool isWithin(double value, double most) {
  return std::abs(value) <= most;  // false for NaN
}

Status checkText(const std::string& file, const char* field, const std::string& text) {
  if (isUtf8(text)) return {};
  return makeError(ErrorKind::kBadInput, "%s: %s '%.80s' is no UTF-8; %s", file.c_str(), field, printable(text).c_str(),
                   kRemedy);
}

Status checkTexts(const AssetContents& asset, const std::string& file) {
  if (Status status = checkText(file, "preset", asset.preset); !status) return status;
  if (Status status = checkText(file, "source", asset.source); !status) return status;
  for (const AttributeError& error : asset.errors) {
    for (const std::string& text : {error.name, error.unit}) {
      if (Status status = checkText(file, "errors", text); !status) return status;
    }
  }
  return {};
}

// Steps are powers of two so that products with small integers are exact.
Status checkStep(const std::string& file, const char* field, double step) {
  constexpr int kMaxExponent = 60;
  int exponent = 0;
  const bool isPower = std::isfinite(step) && std::frexp(step, &exponent) == 0.5;  // step = 2^(exponent - 1)
  if (step == 0 || (isPower && std::abs(exponent - 1) <= kMaxExponent)) return {};
  return makeError(ErrorKind::kBadInput, "%s: quantization: %s is %g, not 0 or a power of two in 2^-60..2^60; %s",
                   file.c_str(), field, step, kRemedy);
}

Status checkQuantization(const std::string& file, const Quantization& q) {
  if (Status status = checkRange(file, "radius_bits", q.radiusBits, 1, 23); !status) return status;
  if (Status status = checkRange(file, "density_bits", q.densityBits, 1, 23); !status) return status;
  if (q.normalBits != 0) {
    if (Status status = checkRange(file, "normal_bits", q.normalBits, 4, 15); !status) return status;
  }
  const std::pair<const char*, double> steps[] = {{"position_step", q.positionStep},
                                                  {"detail_site_step", q.detailSiteStep},
                                                  {"height_step", q.heightStep},
                                                  {"colour_step", q.colourStep},
                                                  {"lobe_axis_step", q.lobeAxisStep}};
  for (const auto& [field, step] : steps) {
    if (Status status = checkStep(file, field, step); !status) return status;
  }
  return {};
}

// No number of pairs above this keeps the sum of the squared degrees within its limit: it is least where all sites have
// the mean degree, 2 pairs / sites.
uint64_t mostPairs(uint64_t siteCount) {
  const double most =
      0.5 * std::sqrt(static_cast<double>(siteCount) * static_cast<double>(mostSquaredDegrees(siteCount)));
  return std::min(static_cast<uint64_t>(most), kMaxPairs - 1);
}

Status checkCamera(const std::string& file, const char* field, const StoredCamera& camera) {
  for (const double value : camera.worldFromCamera) {
    if (!isWithin(value, kMaxNumber)) {
      return makeError(ErrorKind::kBadInput, "%s: %s: matrix holds %g, not within +-2^50; %s", file.c_str(), field,
                       value, kRemedy);
    }
  }
  if (!(camera.tanHalfFovY > 0) || !isWithin(camera.tanHalfFovY, kMaxNumber)) {
    return makeError(ErrorKind::kBadInput, "%s: %s: tan_half_fov_y is %g, not above 0 and within 2^50; %s",
                     file.c_str(), field, camera.tanHalfFovY, kRemedy);
  }
  return {};
}

Status checkOrigin(const ChunkIndex& chunk, double step, const std::string& place) {
  constexpr double kMostSteps = 0x1p52;  // so that origin + step * index is exact in double
  for (const double value : chunk.origin) {
    if (!isWithin(value, kMaxNumber)) {
      return makeError(ErrorKind::kBadInput, "%s: origin holds %g, not within +-2^50; %s", place.c_str(), value,
                       kRemedy);
    }
    if (step > 0 && (std::fmod(value, step) != 0 || std::abs(value / step) > kMostSteps)) {
      return makeError(ErrorKind::kBadInput, "%s: origin %.17g is no multiple of the position step %g; %s",
                       place.c_str(), value, step, kRemedy);
    }
  }
  return {};
}

Status checkBox(const Box& box, const char* field, double most, const std::string& place) {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!isWithin(box.min[axis], most) || !isWithin(box.max[axis], most) || box.min[axis] > box.max[axis]) {
      return makeError(ErrorKind::kBadInput, "%s: %s: %g..%g is no interval within +-2^%d; %s", place.c_str(), field,
                       box.min[axis], box.max[axis], std::ilogb(most), kRemedy);
    }
  }
  return {};
}

Status checkEyes(const EyeRegion& eyes, const std::string& file) {
  for (const Box& box : eyes.boxes) {
    if (Status status = checkBox(box, "eyes", kMaxNumber, file); !status) return status;
  }
  const std::pair<const char*, double> numbers[] = {
      {"eyes: radius", eyes.radius}, {"eyes: worst_psnr", eyes.worstPsnr}, {"eyes: mean_psnr", eyes.meanPsnr}};
  for (const auto& [field, value] : numbers) {
    if (Status status = checkNotNegative(file, field, value, kMaxNumber); !status) return status;
  }
  return {};
}

// Lengths and ranges of a chunk's arrays. Remembers the first that is wrong.
class ArrayCheck {
 public:
  explicit ArrayCheck(const std::string& place) : place_(place) {}

  // Numbers of floats lie within +-most.
  template <class Element>
  void required(const char* name, const std::vector<Element>& array, uint64_t length, float most = kMaxNumber) {
    if (!status_) return;
    if (array.size() != length) {
      status_ = makeError(ErrorKind::kBadInput, "%s: %s: %zu entries instead of %llu; %s", place_.c_str(), name,
                          array.size(), ull{length}, kRemedy);
    }
    if constexpr (!std::is_integral_v<Element>) checkNumbers(name, floatsOf(array), most);
  }

  template <class Element>
  void optional(const char* name, const std::vector<Element>& array, uint64_t length) {
    if (!array.empty()) required(name, array, length);
  }

  const Status& status() const { return status_; }

 private:
  void checkNumbers(const char* name, std::span<const float> numbers, float most) {
    const auto bad = std::find_if_not(numbers.begin(), numbers.end(), [most](float x) { return isWithin(x, most); });
    if (!status_ || bad == numbers.end()) return;
    status_ = makeError(ErrorKind::kBadInput, "%s: %s: number %zu is %g, not within +-2^%d; %s", place_.c_str(), name,
                        static_cast<size_t>(bad - numbers.begin()), *bad, std::ilogb(most), kRemedy);
  }

  const std::string& place_;
  Status status_;
};

// The number of lobes that the counts add up to; an error if one exceeds M.
Result<uint64_t> countLobes(const AssetContents& asset, const ChunkContents& chunk, const std::string& place) {
  const uint64_t details = uint64_t{chunk.liveCount} * asset.detailCount;
  if (chunk.lobeCounts.empty()) return details * asset.lobeCount;
  uint64_t sum = 0;
  for (const uint8_t count : chunk.lobeCounts) {
    if (count > asset.lobeCount) {
      return makeError(ErrorKind::kBadInput, "%s: lobe_counts: %u lobes at a detail site, more than %u; %s",
                       place.c_str(), count, asset.lobeCount, kRemedy);
    }
    sum += count;
  }
  return sum;
}

Status checkArrays(const AssetContents& asset, const ChunkContents& chunk, const std::string& place) {
  const uint64_t cells = chunk.cellCount, live = chunk.liveCount, sites = cells + chunk.ghostCount;
  const uint64_t details = live * asset.detailCount;
  ArrayCheck arrays(place);
  arrays.required("sites", chunk.sites, sites);
  arrays.required("radii", chunk.radii, sites);
  arrays.required("ghost_refs", chunk.ghostRefs, chunk.ghostCount);
  arrays.required("neighbour_offsets", chunk.neighbourOffsets, cells + 1);
  arrays.required("alpha_counts", chunk.alphaCounts, live);
  arrays.required("densities", chunk.densities, live, kMaxDensity);
  arrays.required("orientations", chunk.orientations, live);
  arrays.optional("cell_colours", chunk.cellColours, live);
  arrays.optional("cell_heights", chunk.cellHeights, live);
  arrays.optional("solid_balls", chunk.solidBalls, live);
  arrays.required("detail_sites", chunk.detailSites, details);
  arrays.optional("detail_heights", chunk.detailHeights, details);
  arrays.optional("base_colours", chunk.baseColours, details);
  arrays.optional("detail_scales", chunk.detailScales, live);
  arrays.optional("colour_scales", chunk.colourScales, live);
  arrays.optional("lobe_counts", chunk.lobeCounts, details);
  if (!arrays.status()) return arrays.status();
  const Result<uint64_t> lobes = countLobes(asset, chunk, place);
  if (!lobes) return lobes.error();
  arrays.required("lobe_axes", chunk.lobeAxes, *lobes);
  arrays.required("lobe_colours", chunk.lobeColours, *lobes);
  return arrays.status();
}

bool isSolidBall(uint32_t bytes) {
  for (uint32_t shift = 0; shift < 32; shift += 8) {
    if ((bytes >> shift & 0xff) > kMaxSolidByte) return false;
  }
  return true;
}

Status checkCells(const ChunkContents& chunk, const std::string& place) {
  const auto radius = std::find_if_not(chunk.radii.begin(), chunk.radii.end(), [](float r) { return r > 0; });
  if (radius != chunk.radii.end()) {
    return makeError(ErrorKind::kBadInput, "%s: cell %zu has radius %g, not > 0; %s",
                     sectionPlace(place, SectionType::kRadii).c_str(),
                     static_cast<size_t>(radius - chunk.radii.begin()), *radius, kRemedy);
  }
  const auto density =
      std::find_if(chunk.densities.begin(), chunk.densities.end(), [](float d) { return std::signbit(d); });
  if (density != chunk.densities.end()) {
    return makeError(ErrorKind::kBadInput, "%s: cell %zu has density %g, not +0 or more; %s",
                     sectionPlace(place, SectionType::kDensities).c_str(),
                     static_cast<size_t>(density - chunk.densities.begin()), *density, kRemedy);
  }
  const auto frame = std::find_if_not(chunk.orientations.begin(), chunk.orientations.end(), isUnitQuaternion);
  if (frame != chunk.orientations.end()) {
    return makeError(ErrorKind::kBadInput, "%s: cell %zu has (%g, %g, %g, %g), no unit quaternion; %s",
                     sectionPlace(place, SectionType::kOrientations).c_str(),
                     static_cast<size_t>(frame - chunk.orientations.begin()), frame->x, frame->y, frame->z, frame->w,
                     kRemedy);
  }
  for (const auto& [type, scales] : {std::pair(SectionType::kDetailScales, std::span(chunk.detailScales)),
                                     std::pair(SectionType::kColourScales, std::span(chunk.colourScales))}) {
    const auto scale = std::find_if(scales.begin(), scales.end(), [](uint8_t s) { return s > kMaxScale; });
    if (scale != scales.end()) {
      return makeError(ErrorKind::kBadInput, "%s: cell %zu has scale %u, more than %u; %s",
                       sectionPlace(place, type).c_str(), static_cast<size_t>(scale - scales.begin()), *scale,
                       kMaxScale, kRemedy);
    }
  }
  const auto ball = std::find_if_not(chunk.solidBalls.begin(), chunk.solidBalls.end(), isSolidBall);
  if (ball != chunk.solidBalls.end()) {
    return makeError(ErrorKind::kBadInput, "%s: cell %zu has bytes %08x, one of them more than %u; %s",
                     sectionPlace(place, SectionType::kSolidBalls).c_str(),
                     static_cast<size_t>(ball - chunk.solidBalls.begin()), *ball, kMaxSolidByte, kRemedy);
  }
  const auto ghost = std::adjacent_find(chunk.ghostRefs.begin(), chunk.ghostRefs.end(), std::greater_equal<CellRef>());
  if (ghost != chunk.ghostRefs.end()) {
    return makeError(ErrorKind::kBadInput, "%s: %u follows %u, references must ascend; %s",
                     sectionPlace(place, SectionType::kGhostRefs).c_str(), ghost[1], ghost[0], kRemedy);
  }
  return {};
}

Status checkRows(const ChunkContents& chunk, const std::string& place) {
  const std::vector<uint32_t>& offsets = chunk.neighbourOffsets;
  if (offsets.front() != 0 || offsets.back() != chunk.neighbours.size()) {
    return makeError(ErrorKind::kBadInput, "%s: neighbour_offsets run from %u to %u, not from 0 to %zu; %s",
                     place.c_str(), offsets.front(), offsets.back(), chunk.neighbours.size(), kRemedy);
  }
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    if (offsets[cell] > offsets[cell + 1]) {
      return makeError(ErrorKind::kBadInput, "%s: neighbour_offsets: cell %u: %u > %u, offsets must not fall; %s",
                       place.c_str(), cell, offsets[cell], offsets[cell + 1], kRemedy);
    }
  }
  for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
    if (chunk.alphaCounts[cell] > offsets[cell + 1] - offsets[cell]) {
      return makeError(ErrorKind::kBadInput, "%s: cell %u: %u alpha neighbours in a row of %u; %s", place.c_str(), cell,
                       chunk.alphaCounts[cell], offsets[cell + 1] - offsets[cell], kRemedy);
    }
  }
  const uint64_t sites = uint64_t{chunk.cellCount} + chunk.ghostCount;
  for (const uint32_t neighbour : chunk.neighbours) {
    if (neighbour >= sites) {
      return makeError(ErrorKind::kBadInput, "%s: neighbour %u >= %llu; %s", place.c_str(), neighbour, ull{sites},
                       kRemedy);
    }
  }
  return {};
}

}  // namespace

Status checkParameters(const AssetContents& asset, const std::string& file) {
  if (Status status = checkRange(file, "detail_count", asset.detailCount, 1, kMaxDetails); !status) return status;
  if (Status status = checkRange(file, "lobe_count", asset.lobeCount, 0, kMaxLobes); !status) return status;
  if (Status status = checkRange(file, "local_bits", asset.localBits, 1, kMaxLocalBits); !status) return status;
  if (Status status = checkCodebookSize(asset, asset.axisCodebook.size(), file); !status) return status;
  for (const float number : floatsOf(asset.axisCodebook)) {
    if (!isWithin(number, kMaxNumber)) {
      return makeError(ErrorKind::kBadInput, "%s: axis codebook holds %g, not within +-2^50; %s", file.c_str(), number,
                       kRemedy);
    }
  }
  if (Status status = checkQuantization(file, asset.quantization); !status) return status;
  if (Status status = checkTexts(asset, file); !status) return status;
  if (Status status = checkNotNegative(file, "detail_sharpness", asset.detailSharpness, kMaxSharpness); !status) {
    return status;
  }
  if (Status status = checkNotNegative(file, "near_ratio", asset.nearRatio, kMaxNearRatio); !status) return status;
  if (Status status = checkNotNegative(file, "near_depth", asset.nearDepth, kMaxNumber); !status) return status;
  if (asset.hasStartView) {
    if (Status status = checkCamera(file, "start_view", asset.startView); !status) return status;
  }
  for (const StoredCamera& camera : asset.flightPath) {
    if (Status status = checkCamera(file, "flight_path", camera); !status) return status;
  }
  return checkEyes(asset.eyes, file);
}

Status checkCodebookSize(const AssetContents& asset, uint64_t size, const std::string& file) {
  return checkRange(file, "codebook_size", size, 0, asset.lobeCount > 0 ? kMaxCodebook : 0);
}

Status checkChunkIndex(const AssetContents& asset, const ChunkIndex& chunk, const std::string& place) {
  const ChunkCounts& counts = chunk.counts;
  const uint64_t mostCells = std::min(uint64_t{1} << asset.localBits, kMaxCells);
  if (Status status = checkRange(place, "cell_count", counts.cells, 1, mostCells); !status) return status;
  if (Status status = checkRange(place, "live_count", counts.live, 0, counts.cells); !status) return status;
  if (Status status = checkRange(place, "ghost_count", counts.ghosts, 0, kMaxCells - counts.cells); !status) {
    return status;
  }
  if (Status status = checkRange(place, "pair_count", counts.pairs, 0, mostPairs(counts.cells + counts.ghosts));
      !status) {
    return status;
  }
  const uint64_t mostLobes = counts.live * asset.detailCount * asset.lobeCount;
  if (Status status = checkRange(place, "lobe_count", counts.lobes, 0, mostLobes); !status) return status;
  if (Status status = checkOrigin(chunk, asset.quantization.positionStep, place); !status) return status;
  return checkBox(chunk.liveBounds, "live_bounds", 2.0 * kMaxNumber, place);
}

Status checkChunkIndices(const AssetContents& asset, std::span<const ChunkIndex> chunks, const std::string& file) {
  const uint64_t mostChunks = uint64_t{1} << (kMaxLocalBits - asset.localBits);
  if (Status status = checkRange(file, "number of chunks", chunks.size(), 1, mostChunks); !status) return status;
  for (uint32_t i = 0; i < chunks.size(); ++i) {
    if (Status status = checkChunkIndex(asset, chunks[i], chunkPlace(file, i)); !status) return status;
  }
  return checkLevels(asset, chunks, file);
}

Status checkChunk(const AssetContents& asset, const ChunkContents& chunk, const std::string& place) {
  if (Status status = checkArrays(asset, chunk, place); !status) return status;
  if (Status status = checkCells(chunk, place); !status) return status;
  if (Status status = checkBorders(chunk, place); !status) return status;
  return checkRows(chunk, place);
}

Status checkReferences(const AssetContents& asset, std::span<const ChunkIndex> chunks, uint32_t index,
                       std::span<const CellRef> ghosts, std::span<const uint32_t> borders, const std::string& place) {
  if (!asset.levels.empty()) {
    Status status = checkBorderRange(asset, ghosts, sectionPlace(place, SectionType::kGhostRefs));
    return status ? checkBorderRange(asset, borders, sectionPlace(place, SectionType::kBorderNumbers)) : status;
  }
  for (const CellRef ghost : ghosts) {
    const uint32_t other = chunkOf(ghost, asset.localBits), local = localOf(ghost, asset.localBits);
    const bool isOther = other < chunks.size() && other != index;
    if (isOther && local < chunks[other].counts.cells) continue;
    return makeError(ErrorKind::kBadInput, "%s: a ghost lives in cell %u of chunk %u, which is %s; %s",
                     sectionPlace(place, SectionType::kGhostRefs).c_str(), local, other,
                     other == index ? "its own" : "not there", kRemedy);
  }
  return {};
}

Box liveBoundsOf(const ChunkContents& chunk) {
  if (chunk.liveCount == 0) return {};
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
      const double site = chunk.sites[cell][axis], radius = chunk.radii[cell];
      least = std::min(least, site - radius);
      most = std::max(most, site + radius);
    }
    box.min[static_cast<size_t>(axis)] = least;
    box.max[static_cast<size_t>(axis)] = most;
  }
  return box;
}

}  // namespace froth
