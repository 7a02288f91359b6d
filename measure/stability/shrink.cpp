#include "measure/stability/shrink.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <utility>

#include "base/float_span.h"
#include "measure/stability/cases/foam_parts.h"

namespace froth {
namespace {

class Shrinker {
 public:
  Shrinker(const StiffCase& failing, const CaseFault& fault, const CaseJudge& judge, uint32_t mostTries,
           const Progress& progress)
      : judge_(judge), progress_(progress), mostTries_(mostTries), best_{failing, fault, 0} {}

  Result<ShrunkCase> shrink() {
    for (bool isSmaller = true; isSmaller && !isOver();) {
      isSmaller = keepWorstView();
      isSmaller |= cropToWorstPixel();
      isSmaller |= dropParts();
      isSmaller |= dropCells();
      isSmaller |= dropDetails();
      isSmaller |= simplifyFoam();
      isSmaller |= simplifyView();
      isSmaller |= simplifyPlaces();
      isSmaller |= simplifyEnds();
    }
    if (error_) return *error_;
    return std::move(best_);
  }

 private:
  bool isOver() const { return error_ || best_.tries >= mostTries_; }

  // Takes the candidate if it fails in the same way.
  bool attempt(StiffCase candidate) {
    if (isOver()) return false;
    ++best_.tries;
    if (!report(progress_, "shrink", best_.tries, mostTries_)) {
      error_ = stoppedOnRequest("shrink");
      return false;
    }
    Result<std::optional<CaseFault>> fault = judge_(candidate);
    if (!fault) {
      error_ = fault.error();
      return false;
    }
    if (!*fault || (*fault)->kind != best_.fault.kind) return false;
    best_.smallest = std::move(candidate);
    best_.fault = std::move(**fault);
    return true;
  }

  bool keepWorstView() {
    if (best_.smallest.views.size() < 2) return false;
    StiffCase candidate = best_.smallest;
    candidate.views = {best_.smallest.views[best_.fault.view]};
    if (!candidate.ends.empty()) candidate.ends = {best_.smallest.ends[best_.fault.view]};
    return attempt(std::move(candidate));
  }

  // First the pixel alone, then halves and quarters around it.
  bool cropToWorstPixel() {
    bool isSmaller = false;
    for (const uint32_t parts : {UINT32_MAX, 8u, 4u, 2u}) {
      if (best_.smallest.views.size() != 1) break;
      const View& view = best_.smallest.views[0];
      const uint32_t width = std::max(view.width / parts, 1u), height = std::max(view.height / parts, 1u);
      if (view.lens.kind == LensKind::kRayMap || (width == view.width && height == view.height)) continue;
      StiffCase candidate = best_.smallest;
      View& cropped = candidate.views[0];
      const uint32_t left = std::min(best_.fault.x - std::min(best_.fault.x, width / 2), view.width - width);
      const uint32_t top = std::min(best_.fault.y - std::min(best_.fault.y, height / 2), view.height - height);
      cropped.width = width;
      cropped.height = height;
      cropped.cx -= left;
      cropped.cy -= top;
      if (!candidate.ends.empty()) candidate.ends = {cropImage(best_.smallest.ends[0], left, top, width, height)};
      isSmaller |= attempt(std::move(candidate));
    }
    return isSmaller;
  }

  static Image cropImage(const Image& image, uint32_t left, uint32_t top, uint32_t width, uint32_t height) {
    Image cropped{width, height, image.channels, {}};
    for (uint32_t y = 0; y < height; ++y) {
      const float* const row = image.pixel(left, top + y);
      cropped.values.insert(cropped.values.end(), row, row + size_t{width} * image.channels);
    }
    return cropped;
  }

  // What is neither foam nor view: each back to what most cases have.
  bool dropParts() {
    const auto change = [&](const std::function<void(StiffCase&)>& edit) {
      StiffCase candidate = best_.smallest;
      edit(candidate);
      return attempt(std::move(candidate));
    };
    const StiffCase& smallest = best_.smallest;
    bool isSmaller = !smallest.places.empty() && change([](StiffCase& stiff) { stiff.places.clear(); });
    for (size_t i = 0; i < smallest.places.size() && smallest.places.size() > 1;) {
      const bool isDropped =
          change([i](StiffCase& stiff) { stiff.places.erase(stiff.places.begin() + static_cast<ptrdiff_t>(i)); });
      isSmaller |= isDropped;
      if (!isDropped) ++i;
    }
    isSmaller |= !smallest.ends.empty() && change([](StiffCase& stiff) { stiff.ends.clear(); });
    isSmaller |= smallest.jitter != glm::vec2(0) && change([](StiffCase& stiff) { stiff.jitter = glm::vec2(0); });
    isSmaller |=
        smallest.layers != kAllLayersOfCase && change([](StiffCase& stiff) { stiff.layers = kAllLayersOfCase; });
    isSmaller |= smallest.chunkCells != 0 && change([](StiffCase& stiff) { stiff.chunkCells = 0; });
    return isSmaller;
  }

  // Leaves out ever smaller runs of cells.
  bool dropCells() {
    bool isSmaller = false;
    for (uint32_t run = best_.smallest.foam.cellCount / 2; run >= 1; run /= 2) {
      for (uint32_t first = 0; first < best_.smallest.foam.cellCount && !isOver();) {
        const uint32_t count = best_.smallest.foam.cellCount;
        std::vector<uint32_t> kept;
        for (uint32_t i = 0; i < count; ++i) {
          if (i < first || i >= first + run) kept.push_back(i);
        }
        const bool isDropped = !kept.empty() && attempt(withFoam(keepCells(best_.smallest.foam, kept)));
        isSmaller |= isDropped;
        if (!isDropped) first += run;
      }
    }
    return isSmaller;
  }

  bool dropDetails() {
    const auto lower = [&](uint32_t details, uint32_t lobes) {
      return attempt(withFoam(keepDetails(best_.smallest.foam, details, lobes)));
    };
    bool isSmaller = false;
    const Foam& foam = best_.smallest.foam;
    for (const uint32_t details : {1u, foam.detailCount / 2, foam.detailCount - 1}) {
      if (details >= 1 && details < foam.detailCount) isSmaller |= lower(details, foam.lobeCount);
    }
    for (const uint32_t lobes : {0u, 1u, foam.lobeCount / 2, foam.lobeCount - 1}) {
      if (lobes < foam.lobeCount) isSmaller |= lower(foam.detailCount, lobes);
    }
    return isSmaller;
  }

  StiffCase withFoam(Foam foam) const {
    StiffCase candidate = best_.smallest;
    candidate.foam = std::move(foam);
    return candidate;
  }

  bool simplifyFoam() {
    bool isSmaller = simplifyOrientations();
    isSmaller |= simplifyArray([](StiffCase& stiff) { return floatsOf(stiff.foam.lobeColours); });
    isSmaller |= simplifyArray([](StiffCase& stiff) { return floatsOf(stiff.foam.lobeAxes); });
    isSmaller |= simplifyArray([](StiffCase& stiff) { return floatsOf(stiff.foam.baseColours); });
    isSmaller |= simplifyArray([](StiffCase& stiff) { return floatsOf(stiff.foam.detailHeights); });
    isSmaller |= simplifyArray([](StiffCase& stiff) { return floatsOf(stiff.foam.detailSites); });
    isSmaller |= simplifyArray([](StiffCase& stiff) { return floatsOf(stiff.foam.densities); });
    isSmaller |= simplifyArray([](StiffCase& stiff) { return floatsOf(stiff.foam.radii); }, false);
    isSmaller |= simplifyArray([](StiffCase& stiff) { return floatsOf(stiff.foam.sites); });
    return isSmaller;
  }

  // All values at once, then each alone.
  template <class SpanOf>
  bool simplifyArray(SpanOf&& valuesOf, bool canBeZero = true) {
    const size_t count = valuesOf(best_.smallest).size();
    if (count == 0) return false;
    bool isSmaller = simplifyRange(valuesOf, 0, count, canBeZero);
    for (size_t i = 0; count > 1 && i < count && !isOver(); ++i) {
      isSmaller |= simplifyRange(valuesOf, i, i + 1, canBeZero);
    }
    return isSmaller;
  }

  template <class SpanOf>
  bool simplifyRange(SpanOf&& valuesOf, size_t begin, size_t end, bool canBeZero) {
    const auto tryAll = [&](const std::function<float(float)>& simpler) {
      StiffCase candidate = best_.smallest;
      bool isChanged = false;
      const auto values = valuesOf(candidate);
      for (size_t i = begin; i < end; ++i) {
        const float before = values[i];
        values[i] = simpler(before);
        if (!canBeZero && values[i] == 0) values[i] = before;
        isChanged |= values[i] != before;
      }
      return isChanged && attempt(std::move(candidate));
    };
    const auto isSimplest = [&] {
      const auto values = valuesOf(best_.smallest);
      return std::all_of(values.begin() + begin, values.begin() + end, [](float value) { return value == 0; });
    };
    if (canBeZero && !isSimplest() && tryAll([](float) { return 0.0f; })) return true;
    return tryAll([](float value) { return value == 0 ? value : 1.0f; }) ||
           tryAll([](float value) { return std::round(value); }) ||
           tryAll([](float value) { return roundDigits(value, 1); }) ||
           tryAll([](float value) { return roundDigits(value, 3); });
  }

  // To so many significant decimal digits.
  static float roundDigits(float value, int digits) {
    if (value == 0 || std::isinf(value)) return value;
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(double{value}))) + 1 - digits);
    return static_cast<float>(std::round(value / unit) * unit);
  }

  bool simplifyOrientations() {
    bool isSmaller = false;
    for (size_t i = 0; i < best_.smallest.foam.orientations.size() && !isOver(); ++i) {
      const glm::vec4 before = best_.smallest.foam.orientations[i];
      if (before == glm::vec4(1, 0, 0, 0)) continue;
      const glm::vec4 rounded = glm::round(before * 4.0f);
      for (const glm::vec4& simpler : {glm::vec4(1, 0, 0, 0), glm::vec4(0.70710678f, 0, 0.70710678f, 0),
                                       glm::normalize(rounded == glm::vec4(0) ? before : rounded)}) {
        if (simpler == before) break;
        StiffCase candidate = best_.smallest;
        candidate.foam.orientations[i] = simpler;
        if (attempt(std::move(candidate))) {
          isSmaller = true;
          break;
        }
      }
    }
    return isSmaller;
  }

  // Eye and image centre to few digits, the pose to the world's axes.
  bool simplifyView() {
    bool isSmaller = false;
    for (size_t v = 0; v < best_.smallest.views.size(); ++v) {
      const auto change = [&](const std::function<void(View&)>& edit) {
        StiffCase candidate = best_.smallest;
        View& view = candidate.views[v];
        const auto before = std::tuple(view.worldFromCamera, view.cx, view.cy, view.fx, view.fy);
        edit(view);
        return before != std::tuple(view.worldFromCamera, view.cx, view.cy, view.fx, view.fy) &&
               attempt(std::move(candidate));
      };
      isSmaller |= change([](View& view) {
        for (const size_t i : {0, 1, 2, 4, 5, 6, 8, 9, 10}) view.worldFromCamera[i] = i % 5 == 0;
      });
      for (const size_t i : {3, 7, 11}) {
        isSmaller |= change([i](View& view) { view.worldFromCamera[i] = 0; }) ||
                     change([i](View& view) { view.worldFromCamera[i] = std::round(view.worldFromCamera[i]); }) ||
                     change([i](View& view) {
                       view.worldFromCamera[i] = roundDigits(static_cast<float>(view.worldFromCamera[i]), 3);
                     });
      }
      isSmaller |= change([](View& view) { view.cx = view.width / 2.0, view.cy = view.height / 2.0; });
      isSmaller |= change([](View& view) { view.fx = view.fy = std::max(std::round(view.fx), 1.0); });
    }
    return isSmaller;
  }

  bool simplifyPlaces() {
    bool isSmaller = false;
    for (size_t i = 0; i < best_.smallest.places.size(); ++i) {
      const auto change = [&](const std::function<void(CasePlace&)>& edit) {
        StiffCase candidate = best_.smallest;
        edit(candidate.places[i]);
        return candidate.places[i] != best_.smallest.places[i] && attempt(std::move(candidate));
      };
      isSmaller |= change([](CasePlace& place) { place.rotation = glm::quat(1, 0, 0, 0); });
      isSmaller |= change([](CasePlace& place) { place.scale = 1; }) ||
                   change([](CasePlace& place) { place.scale = roundDigits(place.scale, 1); });
      for (const int axis : {0, 1, 2}) {
        isSmaller |= change([axis](CasePlace& place) { place.position[axis] = 0; }) ||
                     change([axis](CasePlace& place) { place.position[axis] = std::round(place.position[axis]); }) ||
                     change([axis](CasePlace& place) {
                       place.position[axis] = roundDigits(static_cast<float>(place.position[axis]), 3);
                     });
      }
    }
    return isSmaller;
  }

  // All pixels at once: mostly there is one left.
  bool simplifyEnds() {
    if (best_.smallest.ends.size() != 1) return false;
    return simplifyRange([](StiffCase& stiff) { return floatsOf(stiff.ends[0].values); }, 0,
                         best_.smallest.ends[0].values.size(), true);
  }

  const CaseJudge& judge_;
  const Progress& progress_;
  const uint32_t mostTries_;
  ShrunkCase best_;
  std::optional<Error> error_;
};

}  // namespace

Result<ShrunkCase> shrinkCase(const StiffCase& failing, const CaseFault& fault, const CaseJudge& judge,
                              uint32_t mostTries, const Progress& progress) {
  return Shrinker(failing, fault, judge, mostTries, progress).shrink();
}

}  // namespace froth
