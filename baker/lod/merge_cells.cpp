#include "baker/lod/merge_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "baker/appearance/lobe_fit.h"
#include "baker/lod/merge_details.h"
#include "baker/lod/merge_shape.h"
#include "foam/cech_pairs.h"
#include "foam/detail_colour.h"

namespace froth {
namespace {

// Where colours are fitted: directions over the hemisphere before a face, and eyes before it. Fewer than lobes leave
// colours undetermined from elsewhere.
constexpr size_t kFitDirections = 12, kMostFitEyes = 12;
constexpr double kMostChange = 2;  // of a density, beyond those of both cells
// A cell that no view shows still counts this part of its partner: two of those have a mean, too.
constexpr double kLeastWeight = 1e-3;

// Fibonacci points: directions in which a face is seen, in its frame (t, b, n).
std::array<glm::dvec3, kFitDirections> directionsToFace() {
  std::array<glm::dvec3, kFitDirections> directions;
  for (size_t i = 0; i < kFitDirections; ++i) {
    const double z = (double(i) + 0.5) / kFitDirections, angle = double(i) * glm::pi<double>() * (3 - std::sqrt(5.0));
    const double radius = std::sqrt(1 - z * z);
    directions[i] = {radius * std::cos(angle), radius * std::sin(angle), -z};
  }
  return directions;
}

// The lobes of one merged detail site.
struct MergedLobes {
  glm::vec3 base{0};
  std::vector<glm::vec3> axes, colours;
};

struct MergedCell {
  MergedShape shape;
  MergedDetails details;
  std::vector<MergedLobes> lobes;  // [K]
};

class PairMerger {
 public:
  PairMerger(const Foam& cells, std::span<const double> contributions, std::span<const glm::vec3> eyes)
      : cells_(cells),
        contributions_(contributions),
        eyes_(eyes),
        pairs_(findCechPairs(cells.sites, cells.radii)),
        sampler_(cells, pairs_),
        keepsPlain_(std::ranges::all_of(cells.detailHeights, [](float height) { return height == 0; })) {}

  MergedCell merge(const CellPair& pair) const {
    MergeParts parts;
    const glm::dvec3 origin(cells_.sites[pair.first]);
    parts[0] = {pair.first, glm::dvec3(0), contributionOf(pair.first), sampler_.sample(pair.first)};
    parts[1] = {pair.second, glm::dvec3(cells_.sites[pair.second]) - origin, contributionOf(pair.second),
                sampler_.sample(pair.second)};
    const double least = std::max(kLeastWeight * std::max(parts[0].weight, parts[1].weight), 1e-12);
    for (MergePart& part : parts) part.weight = std::max(part.weight, least);
    const double sum = parts[0].weight + parts[1].weight;
    for (MergePart& part : parts) part.weight /= sum;
    MergedCell merged;
    merged.shape = mergeShape(cells_, parts, keepsPlain_);
    merged.details = mergeDetails(cells_, parts, merged.shape, keepsPlain_);
    merged.shape.site += origin;
    mergeLobes(parts, merged);
    return merged;
  }

 private:
  double contributionOf(uint32_t cell) const { return contributions_.empty() ? 1 : contributions_[cell]; }

  uint64_t sourceOf(const MergeParts& parts, uint32_t j) const {
    const uint32_t K = cells_.detailCount;
    return uint64_t{parts[j / K].cell} * K + j % K;
  }

  // Directions from which the merged face is seen: from eyes before it, and from all around.
  Observations observe(const MergedShape& shape) const {
    static const std::array<glm::dvec3, kFitDirections> inFrame = directionsToFace();
    Observations seen;
    for (const glm::vec3& eye : eyes_) {
      const glm::dvec3 direction = glm::normalize(shape.site - glm::dvec3(eye));
      if (glm::dot(direction, shape.frame.normal) < 0) seen.directions.emplace_back(direction);
    }
    const size_t before = seen.directions.size();
    for (size_t i = 0; before > kMostFitEyes && i < kMostFitEyes; ++i) {
      seen.directions[i] = seen.directions[i * before / kMostFitEyes];
    }
    seen.directions.resize(std::min(before, kMostFitEyes));
    const FaceFrame<double>& frame = shape.frame;
    for (const glm::dvec3& d : inFrame) {
      seen.directions.emplace_back(d.x * frame.tangent + d.y * frame.bitangent + d.z * frame.normal);
    }
    seen.weights.assign(seen.directions.size(), 1.0f);
    return seen;
  }

  // Axes are those of the heaviest detail site; colours fit the mix along the directions.
  void mergeLobes(const MergeParts& parts, MergedCell& merged) const {
    const uint32_t K = cells_.detailCount;
    Observations seen = observe(merged.shape);
    std::vector<glm::dvec3> colours(seen.size() * 2 * K);
    for (uint32_t j = 0; j < 2 * K; ++j) {
      for (size_t d = 0; d < seen.size(); ++d) {
        colours[d * 2 * K + j] = detailColour(cells_, sourceOf(parts, j), seen.directions[d]);
      }
    }
    for (uint32_t k = 0; k < K; ++k) {
      const uint32_t heaviest = merged.details.heaviest[k];
      seen.colours.clear();  // what the heaviest lacks
      for (size_t d = 0; d < seen.size(); ++d) {
        glm::dvec3 sum = -colours[d * 2 * K + heaviest];
        for (uint32_t j = 0; j < 2 * K; ++j) sum += merged.details.mix[k * 2 * K + j] * colours[d * 2 * K + j];
        seen.colours.emplace_back(sum);
      }
      merged.lobes.push_back(fitLobes(sourceOf(parts, heaviest), seen));
    }
  }

  // Those of `detail`, and colours that make up for `lacks` along its directions: elsewhere the detail site goes on to
  // look like itself.
  MergedLobes fitLobes(uint64_t detail, const Observations& lacks) const {
    const LobeRange range = lobesOf(cells_, detail);
    const glm::dvec3 mean = meanColour(lacks);
    MergedLobes lobes;
    if (!cells_.baseColours.empty()) lobes.base = glm::dvec3(cells_.baseColours[detail]) + mean;
    if (range.count == 0) return lobes;
    const auto first = cells_.lobeAxes.begin() + static_cast<std::ptrdiff_t>(range.first);
    lobes.axes.assign(first, first + range.count);
    std::vector<uint32_t> all(range.count);
    std::iota(all.begin(), all.end(), 0u);
    const std::vector<glm::dvec3> added = LobeEquations(lacks, LobeBasis(lacks, lobes.axes), all, mean).solve();
    const glm::dvec3 offset = cells_.baseColours.empty() ? mean : glm::dvec3(0);
    for (size_t m = 0; m < added.size(); ++m) {
      lobes.colours.emplace_back(glm::dvec3(cells_.lobeColours[range.first + m]) + offset + added[m]);
    }
    return lobes;
  }

  const Foam& cells_;
  const std::span<const double> contributions_;
  const std::span<const glm::vec3> eyes_;
  const CellGraph pairs_;
  const CellSampler sampler_;
  const bool keepsPlain_;
};

// Rows n, t, b.
glm::vec4 orientationOf(const FaceFrame<double>& frame) {
  const glm::dquat q =
      glm::normalize(glm::quat_cast(glm::transpose(glm::dmat3(frame.normal, frame.tangent, frame.bitangent))));
  return {q.w, q.x, q.y, q.z};
}

void append(const MergedCell& merged, Foam& foam, bool hasBases, bool hasOffsets) {
  foam.sites.emplace_back(merged.shape.site);
  foam.radii.push_back(static_cast<float>(merged.shape.radius));
  foam.densities.push_back(0);
  foam.orientations.push_back(orientationOf(merged.shape.frame));
  for (size_t k = 0; k < merged.lobes.size(); ++k) {
    foam.detailSites.emplace_back(merged.details.places[k]);
    foam.detailHeights.push_back(static_cast<float>(merged.details.heights[k]));
    const MergedLobes& lobes = merged.lobes[k];
    foam.lobeAxes.insert(foam.lobeAxes.end(), lobes.axes.begin(), lobes.axes.end());
    foam.lobeColours.insert(foam.lobeColours.end(), lobes.colours.begin(), lobes.colours.end());
    if (hasBases) foam.baseColours.push_back(lobes.base);
    if (hasOffsets) foam.lobeOffsets.push_back(foam.lobeAxes.size());
  }
}

}  // namespace

// The solid parts of merged cells beside all others as they are afterwards [scene units cubed].
std::vector<double> measureVolumes(const Foam& cells, std::span<const CellPair> pairs, const Foam& merged) {
  std::vector<uint8_t> isGone(cells.cellCount, 0);
  for (const CellPair& pair : pairs) isGone[pair.first] = isGone[pair.second] = 1;
  Foam after = merged;
  for (uint32_t cell = 0; cell < cells.cellCount; ++cell) {
    if (isGone[cell]) continue;
    after.sites.push_back(cells.sites[cell]);
    after.radii.push_back(cells.radii[cell]);
  }
  const CellGraph overlaps = findCechPairs(after.sites, after.radii);
  const CellSampler sampler(after, overlaps);
  std::vector<double> volumes(merged.cellCount);
  tbb::parallel_for(uint32_t{0}, merged.cellCount,
                    [&](uint32_t cell) { volumes[cell] = sampler.sample(cell).solidVolume; });
  return volumes;
}

// A merged cell keeps the optical depth of both, as a mean over all directions: density times volume.
void setDensities(const Foam& cells, std::span<const CellPair> pairs, std::span<const MergedCell> merged, Foam& foam) {
  const std::vector<double> volumes = measureVolumes(cells, pairs, foam);
  for (size_t i = 0; i < pairs.size(); ++i) {
    const double a = cells.densities[pairs[i].first], b = cells.densities[pairs[i].second];
    foam.densities[i] = static_cast<float>(std::clamp(merged[i].shape.opticalVolume / volumes[i],
                                                      std::min(a, b) / kMostChange, std::max(a, b) * kMostChange));
  }
}

Foam mergePairs(const Foam& cells, std::span<const CellPair> pairs, std::span<const double> contributions,
                std::span<const glm::vec3> eyes) {
  const PairMerger merger(cells, contributions, eyes);
  std::vector<MergedCell> merged(pairs.size());
  tbb::parallel_for(size_t{0}, pairs.size(), [&](size_t i) { merged[i] = merger.merge(pairs[i]); });
  Foam foam;
  foam.cellCount = static_cast<uint32_t>(pairs.size());
  foam.detailCount = cells.detailCount;
  foam.lobeCount = cells.lobeCount;
  const bool hasOffsets = !cells.lobeOffsets.empty();
  if (hasOffsets) foam.lobeOffsets.push_back(0);
  for (const MergedCell& cell : merged) append(cell, foam, !cells.baseColours.empty(), hasOffsets);
  setDensities(cells, pairs, merged, foam);
  return foam;
}

}  // namespace froth
