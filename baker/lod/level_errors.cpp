#include "baker/lod/level_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/lod/shrink_view.h"
#include "reference/camera/view_rays.h"

namespace froth {
namespace {

constexpr size_t kMostErrorViews = 24;
constexpr double kErrorPixels = 20'000;  // of a view
// Errors are scaled so that, at detail 1, the views differ by this from level 0: all pixels together, and the worst
// view. [dB]; above the 38 and 36 that docs/STREAMING.md states, for views that the bake did not see are worse.
constexpr double kScaledPsnr = 40, kScaledWorstPsnr = 38;
constexpr double kScaleStep = 1.0905077326652577;  // an eighth of an octave
// On top of it: a view that the bake did not see may stand this much nearer to a group, which then must be refined too.
constexpr double kScaleMargin = 1.25;
// What a group is taken for at least, of what its distance lets expect: views may miss the most of it.
constexpr double kUnseenShare = 0.5;
// An error grows at least by this factor from a group to those coarser, so that it does as a float too.
constexpr double kErrorStep = 1 + 0x1p-20;

// The size of a pixel of the view at some distance [scene units].
double pixelSizeAt(const View& view, double distance) {
  if (view.lens.kind == LensKind::kOrthographic) return 1 / view.fx;
  constexpr double kHalfTurn = 3.141592653589793;
  return view.fx > 0 ? distance / view.fx : distance * kHalfTurn / view.width;  // a ray map says no focal length
}

// Errors grow, and are none of them 0. A group's fine chunks stand before its coarse ones.
void growErrors(std::span<const LevelChunk> chunks, std::vector<LevelGroup>& groups) {
  for (LevelGroup& group : groups) group.error = std::max(group.error, group.radius * 0x1p-40);
  for (const LevelChunk& chunk : chunks) {
    if (chunk.place.madeBy == kNoGroup || chunk.place.in == kNoGroup) continue;
    LevelGroup& coarser = groups[chunk.place.in];
    coarser.error = std::max(coarser.error, groups[chunk.place.madeBy].error * kErrorStep);
  }
}

}  // namespace

LevelErrors::LevelErrors(std::span<const View> views, const FrontOptions& options) : options_(options) {
  const size_t count = std::min(kMostErrorViews, views.size());
  for (size_t k = 0; k < count; ++k) {
    const View& full = views[k * views.size() / count];
    SeenView& seen = views_.emplace_back();
    seen.view = shrinkView(full, kErrorPixels);
    seen.pixelScale = double{1} * seen.view.width / full.width;
  }
}

Result<std::vector<FrontImage>> LevelErrors::draw(const Foam& foam, std::span<const uint32_t> owners,
                                                  const Progress& progress) const {
  std::vector<View> views;
  for (const SeenView& seen : views_) views.push_back(seen.view);
  return drawFront(foam, owners, views, options_, progress);
}

Status LevelErrors::takeFinest(const Foam& foam, std::span<const uint32_t> owners, const Progress& progress) {
  Result<std::vector<FrontImage>> images = draw(foam, owners, progress);
  if (!images) return images.error();
  for (size_t v = 0; v < views_.size(); ++v) {
    views_[v].owners = (*images)[v].owners;
    views_[v].finest = std::move((*images)[v]);
  }
  return {};
}

Status LevelErrors::addLevel(const Foam& foam, std::span<const uint32_t> owners, std::span<const LevelChunk> chunks,
                             uint32_t firstGroup, uint32_t groupCount, const Progress& progress) {
  Result<std::vector<FrontImage>> images = draw(foam, owners, progress);
  if (!images) return images.error();
  for (size_t v = 0; v < views_.size(); ++v) {
    SeenView& seen = views_[v];
    seen.squares.resize(chunks.size(), 0);
    seen.areas.resize(groupCount, 0);
    for (size_t pixel = 0; pixel < seen.owners.size(); ++pixel) addPixel(v, pixel, (*images)[v], chunks, firstGroup);
    seen.owners = std::move((*images)[v].owners);
  }
  return {};
}

double LevelErrors::squaredError(const FrontImage& image, const FrontImage& finest, size_t pixel) {
  const glm::dvec3 difference = glm::dvec3(image.colours[pixel]) - glm::dvec3(finest.colours[pixel]);
  return glm::dot(difference, difference) / 3;
}

Result<LevelErrors::OwnerErrors> LevelErrors::sumByOwner(const Foam& foam, std::span<const uint32_t> owners,
                                                         uint32_t ownerCount, const Progress& progress) const {
  const Result<std::vector<FrontImage>> images = draw(foam, owners, progress);
  if (!images) return images.error();
  OwnerErrors sums{std::vector<double>(ownerCount, 0)};
  for (size_t v = 0; v < views_.size(); ++v) {
    const FrontImage& image = (*images)[v];
    for (size_t pixel = 0; pixel < image.owners.size(); ++pixel) {
      const double square = squaredError(image, views_[v].finest, pixel);
      sums.ofAll += square;
      if (image.owners[pixel] != kNoOwner) sums.ofOwners[image.owners[pixel]] += square;
    }
  }
  return sums;
}

// A pixel is a matter of the group whose coarse form it shows, and of the group whose fine form it showed.
void LevelErrors::addPixel(size_t v, size_t pixel, const FrontImage& image, std::span<const LevelChunk> chunks,
                           uint32_t firstGroup) {
  SeenView& seen = views_[v];
  const double square = squaredError(image, seen.finest, pixel);
  const auto isNew = [&](uint32_t group) { return group != kNoGroup && group >= firstGroup; };
  const uint32_t now = image.owners[pixel], before = seen.owners[pixel];
  const uint32_t coarse = now == kNoOwner ? kNoGroup : chunks[now].place.madeBy;
  const uint32_t fine = before == kNoOwner ? kNoGroup : chunks[before].place.in;
  const auto areaAt = [&](float distance) { return std::pow(pixelSizeAt(seen.view, double{distance}), 2); };
  if (isNew(coarse)) {
    seen.squares[now] += square;
    seen.areas[coarse] += square * areaAt(image.distances[pixel]);
  }
  if (!isNew(fine) || fine == coarse) return;
  seen.areas[fine] += square * areaAt(seen.finest.distances[pixel]);
  if (isNew(coarse)) return;
  const auto made = std::ranges::find_if(chunks, [&](const LevelChunk& chunk) { return chunk.place.madeBy == fine; });
  seen.squares[static_cast<size_t>(made - chunks.begin())] += square;
}

// The side of the square that a group gets wrong, in the view that sees most of it. What views do not see is guessed
// from the distance of its forms.
void LevelErrors::measureGroups(std::vector<LevelGroup>& groups) const {
  std::vector<double> measured(groups.size(), 0), ratios;
  for (size_t g = 0; g < groups.size(); ++g) {
    for (const SeenView& seen : views_) measured[g] = std::max(measured[g], std::sqrt(seen.areas[g]));
    if (measured[g] > 0 && groups[g].error > 0) ratios.push_back(measured[g] / groups[g].error);
  }
  if (ratios.empty()) return;
  const auto median = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), median, ratios.end());
  for (size_t g = 0; g < groups.size(); ++g) {
    groups[g].error = std::max(measured[g], kUnseenShare * *median * groups[g].error);
  }
}

// The least factor from which on the cuts that a reader chooses for the views look as level 0 does. No less than lets
// one of the views refine a group: nothing is known from nearer.
double LevelErrors::chooseScale(std::span<const LevelChunk> chunks, std::span<const GroupBounds> bounds,
                                std::span<const LevelGroup> groups) const {
  const auto refinedFrom = [&](const SeenView& seen, uint32_t group) {  // the factor
    const double distance = distanceTo(bounds[group], eyeOf(seen.view));
    return seen.pixelScale * pixelSizeAt(seen.view, distance) / groups[group].error;
  };
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const SeenView& seen : views_) {
    for (uint32_t group = 0; group < groups.size(); ++group) {
      const double factor = refinedFrom(seen, group);
      if (factor > 0) least = std::min(least, factor);
      most = std::max(most, factor);
    }
  }
  if (!(most > 0)) return 1;
  const auto isGood = [&](double scale) {
    double sum = 0, worst = 0;
    for (const SeenView& seen : views_) {
      const auto isRefined = [&](uint32_t group) { return refinedFrom(seen, group) <= scale; };
      double square = 0;
      for (size_t c = 0; c < seen.squares.size(); ++c) {
        const ChunkLevel& place = chunks[c].place;
        if (seen.squares[c] == 0 || isRefined(place.madeBy)) continue;
        if (place.in == kNoGroup || isRefined(place.in)) square += seen.squares[c];
      }
      square /= static_cast<double>(seen.owners.size());
      sum += square;
      worst = std::max(worst, square);
    }
    return sum / static_cast<double>(views_.size()) <= std::pow(10, -kScaledPsnr / 10) &&
           worst <= std::pow(10, -kScaledWorstPsnr / 10);
  };
  double scale = most;
  while (scale / kScaleStep >= least && isGood(scale / kScaleStep)) scale /= kScaleStep;
  return scale;
}

void LevelErrors::finish(std::span<const LevelChunk> chunks, std::span<const GroupBounds> bounds,
                         std::vector<LevelGroup>& groups) const {
  if (isMeasuring()) measureGroups(groups);
  growErrors(chunks, groups);
  if (!isMeasuring()) return;
  const double scale = kScaleMargin * chooseScale(chunks, bounds, groups);
  for (LevelGroup& group : groups) group.error *= scale;
}

}  // namespace froth
