#include "baker/bake/sample_views.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "baker/bake/eye_region.h"
#include "baker/lod/shrink_view.h"
#include "base/image/mean_square.h"
#include "reference/render/reference.h"

namespace froth {
namespace {

constexpr size_t kSampleViews = 4;
constexpr uint32_t kDrawnViews = 8;
constexpr uint64_t kOtherViews = uint64_t{1} << 63;  // of a seed: other views than those that weighed errors
constexpr double kSamplePixels = 160 * 120;

std::vector<View> chooseViews(const Foam& foam, const BakeOptions& options) {
  if (!options.cameras || options.cameras->views.empty()) return viewsAround(foam);
  const std::vector<View>& all = options.cameras->views;
  const size_t count = std::min(kSampleViews, all.size());
  std::vector<View> views;
  for (size_t k = 0; k < count; ++k) views.push_back(shrinkView(all[k * all.size() / count], kSamplePixels));
  return views;
}

double psnrOf(double meanSquare) { return std::min(kMaxPsnr, decibels(meanSquare)); }

class Comparison {
 public:
  Comparison(const Foam& input, const Foam& baked, const BakeOptions& options, const Progress& progress)
      : input_(input, progress), baked_(baked, progress), options_(options), progress_(progress) {}

  // The mean squared error of each view.
  Result<std::vector<double>> measure(const std::vector<View>& views) const {
    std::vector<double> errors;
    for (const View& view : views) {
      ReferenceOptions reference;
      reference.precision = Precision::kFloat;
      reference.nearRatio = view.nearRatio.value_or(options_.nearRatio);
      reference.nearDepth = view.nearDepth.value_or(options_.nearDepth);
      const Result<RenderedImages> expected = input_.render(view, reference, progress_);
      if (!expected) return expected.error();
      const Result<RenderedImages> found = baked_.render(view, reference, progress_);
      if (!found) return found.error();
      errors.push_back(meanSquare(expected->colour, found->colour));
    }
    return errors;
  }

 private:
  const ReferenceRenderer input_, baked_;
  const BakeOptions& options_;
  const Progress& progress_;
};

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

Result<SampledPsnr> measurePsnr(const Foam& input, const Foam& baked, const EyeRegion& eyes, const BakeOptions& options,
                                const Progress& progress) {
  const Comparison comparison(input, baked, options, progress);
  const Result<std::vector<double>> given = comparison.measure(chooseViews(input, options));
  if (!given) return given.error();
  SampledPsnr psnr{.given = psnrOf(meanOf(*given))};
  if (!hasChosenEyes(options)) return psnr;
  std::vector<View> views = drawViews(eyes, options.cameras, kDrawnViews, options.seed ^ kOtherViews);
  for (View& view : views) view = shrinkView(view, kSamplePixels);
  const Result<std::vector<double>> drawn = comparison.measure(views);
  if (!drawn) return drawn.error();
  psnr.drawn = psnrOf(meanOf(*drawn));
  psnr.worstDrawn = psnrOf(*std::ranges::max_element(*drawn));
  return psnr;
}

}  // namespace froth
