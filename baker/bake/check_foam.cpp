#include "baker/bake/check_foam.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "baker/bake/eye_region.h"
#include "foam/foam_arrays.h"
#include "format/checks.h"
#include "format/limits.h"

namespace froth {
namespace {

Status checkLength(const char* name, size_t found, size_t expected) {
  if (found == expected) return {};
  return makeError(ErrorKind::kBadInput, "foam: array '%s' has %zu entries, the counts ask for %zu; import it again",
                   name, found, expected);
}

Status checkLengths(const Foam& foam) {
  const size_t cells = foam.cellCount, details = cells * foam.detailCount;
  const size_t lobes = foam.lobeOffsets.empty() ? details * foam.lobeCount : foam.lobeOffsets.back();
  Status status;
  if (!foam.lobeOffsets.empty()) status = checkLength("lobeOffsets", foam.lobeOffsets.size(), details + 1);
  visitArrays([&](const FoamArray& array, auto values) {
    const size_t found = (foam.*values).size();
    if (!status || (found == 0 && array.canBeEmpty)) return;
    status = checkLength(array.name, found,
                         array.index == FoamIndex::kCell   ? cells
                         : array.index == FoamIndex::kLobe ? lobes
                                                           : details);
  });
  return status;
}

bool isWithin(float value) {
  return std::abs(value) <= kMaxNumber;  // false for NaN
}

template <class Vector>
bool areWithin(const Vector& value) {
  for (int axis = 0; axis < Vector::length(); ++axis) {
    if (!isWithin(value[axis])) return false;
  }
  return true;
}

// The first entry out of range of an array of detail sites, or of lobes.
Status checkDetailNumbers(const Foam& foam, const char* name, std::span<const glm::vec3> values, bool areLobes) {
  const auto bad =
      std::find_if_not(values.begin(), values.end(), [](const glm::vec3& value) { return areWithin(value); });
  if (bad == values.end()) return {};
  uint64_t detail = static_cast<uint64_t>(bad - values.begin());
  if (areLobes && foam.lobeOffsets.empty()) detail /= foam.lobeCount;
  if (areLobes && !foam.lobeOffsets.empty()) {
    const auto& offsets = foam.lobeOffsets;
    detail = static_cast<uint64_t>(std::upper_bound(offsets.begin(), offsets.end(), detail) - offsets.begin()) - 1;
  }
  return makeError(ErrorKind::kBadInput,
                   "cell %llu, detail site %llu: array '%s' holds (%g, %g, %g), not within +-2^50; repair the foam",
                   static_cast<unsigned long long>(detail / foam.detailCount),
                   static_cast<unsigned long long>(detail % foam.detailCount), name, double{bad->x}, double{bad->y},
                   double{bad->z});
}

Status checkNumbers(const Foam& foam) {
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const glm::vec3& site = foam.sites[i];
    const float radius = foam.radii[i], density = foam.densities[i];
    if (!areWithin(site)) {
      return makeError(ErrorKind::kBadInput, "cell %u: site (%g, %g, %g) is not within +-2^50; repair the foam", i,
                       double{site.x}, double{site.y}, double{site.z});
    }
    if (!(radius > 0) || !isWithin(radius)) {
      return makeError(ErrorKind::kBadInput, "cell %u: radius %g is not above 0 and within 2^50; repair the foam", i,
                       double{radius});
    }
    if (std::signbit(density) || !(density <= kMaxDensity)) {
      return makeError(ErrorKind::kBadInput, "cell %u: density %g is not in 0..2^100; repair the foam", i,
                       double{density});
    }
    const glm::vec4& q = foam.orientations[i];
    if (!isUnitQuaternion(q)) {
      return makeError(ErrorKind::kBadInput,
                       "cell %u: orientation (%g, %g, %g, %g) is no unit quaternion; repair the foam", i, double{q.x},
                       double{q.y}, double{q.z}, double{q.w});
    }
  }
  for (size_t k = 0; k < foam.detailSites.size(); ++k) {
    if (areWithin(foam.detailSites[k]) && isWithin(foam.detailHeights[k])) continue;
    return makeError(ErrorKind::kBadInput, "cell %zu: a detail site or height is not within +-2^50; repair the foam",
                     k / foam.detailCount);
  }
  Status status = checkDetailNumbers(foam, "baseColours", foam.baseColours, false);
  if (status) status = checkDetailNumbers(foam, "lobeAxes", foam.lobeAxes, true);
  if (status) status = checkDetailNumbers(foam, "lobeColours", foam.lobeColours, true);
  return status;
}

struct KnobRange {
  const char* name;
  uint32_t found, least, most;
  bool canBeOff;  // 0: values are kept as they are
};

}  // namespace

Status checkFoam(const Foam& foam) {
  if (foam.cellCount == 0 || foam.detailCount - 1 >= 32 || foam.lobeCount > 32) {
    return makeError(ErrorKind::kBadInput, "foam: %u cells, %u detail sites, %u lobes; needs >= 1, 1..32, 0..32",
                     foam.cellCount, foam.detailCount, foam.lobeCount);
  }
  if (Status status = checkLengths(foam); !status) return status;
  if (Status status = checkNumbers(foam); !status) return status;
  for (size_t detail = 0; detail + 1 < foam.lobeOffsets.size(); ++detail) {
    if (foam.lobeOffsets[detail + 1] - foam.lobeOffsets[detail] <= foam.lobeCount) continue;
    return makeError(ErrorKind::kBadInput,
                     "foam: array 'lobeOffsets' gives detail site %zu more than %u lobes; import it again", detail,
                     foam.lobeCount);
  }
  return {};
}

Status checkOptions(const BakeOptions& options) {
  const BakeKnobs& knobs = options.knobs;
  const KnobRange ranges[] = {
      {"position bits", knobs.positionBits, 10, 22, true},     {"radius bits", knobs.radiusBits, 4, 23, false},
      {"density bits", knobs.densityBits, 1, 23, false},       {"frame bits", knobs.frameBits, 4, 15, true},
      {"detail site bits", knobs.detailSiteBits, 1, 16, true}, {"height bits", knobs.heightBits, 1, 16, true}};
  for (const KnobRange& range : ranges) {
    if (range.canBeOff && range.found == 0) continue;
    if (range.found >= range.least && range.found <= range.most) continue;
    return makeError(ErrorKind::kUsage, "%s: found %u; give %u to %u%s", range.name, range.found, range.least,
                     range.most, range.canBeOff ? ", or 0 for floats" : "");
  }
  if (!(options.nearRatio >= 0 && options.nearRatio <= kMaxNearRatio) ||
      !(options.nearDepth >= 0 && options.nearDepth <= kMaxNumber)) {
    return makeError(ErrorKind::kUsage, "near limits: found ratio %g, depth %g; give 0 to 2^10 and 0 to 2^50",
                     double{options.nearRatio}, double{options.nearDepth});
  }
  if (options.chunkCells == 0) return makeError(ErrorKind::kUsage, "chunk cells: found 0; give at least 1");
  if (options.levels && !options.walkGraph) {
    return makeError(ErrorKind::kUsage, "levels of detail are made from the walk graph; bake with it");
  }
  return checkEyes(options);
}

}  // namespace froth
