#include "reference/render/merged_foams.h"

#include <algorithm>

#include "reference/render/reference_state.h"

namespace froth {
namespace {

// In the world's units and axes.
struct Interval {
  double tNear, tFar, density;
  glm::dvec3 colour, normal;
  uint32_t foam;
};

struct MergedRay {
  RayResult<double> ray;
  std::array<uint32_t, 4> quarterFoams{};
};

// A camera in the foam's frame: lengths in it are world units divided by the foam's scale.
View viewFromFoam(const View& view, const PlacedFoam& foam) {
  View local = view;
  const glm::dmat3 foamFromWorld = glm::transpose(glm::mat3_cast(foam.rotation));
  for (int column = 0; column < 4; ++column) {
    glm::dvec3 vector;
    for (int row = 0; row < 3; ++row) vector[row] = view.worldFromCamera[4 * row + column];
    vector = column < 3 ? foamFromWorld * vector : foamFromWorld * (vector - foam.position) / foam.scale;
    for (int row = 0; row < 3; ++row) local.worldFromCamera[4 * row + column] = vector[row];
  }
  if (view.lens.kind == LensKind::kOrthographic) {
    local.fx *= foam.scale;
    local.fy *= foam.scale;
  }
  return local;
}

// Rounding of the eye's place in the foam's frame, by what it is apart from the foam: a difference and a rotation in
// double, whoever does them. Of an eye within that of a site nobody knows from where it sees the site.
constexpr double kEyeRounding = 0x1p-50;

View withRoundedEye(View local, const ReferenceOptions& options) {
  if (options.rounding == 0) return local;
  Rounding rounding(kEyeRounding, options.roundingSeed + 3, UINT32_MAX);
  const double apart = glm::length(eyeOf(local));
  for (const size_t entry : {3, 7, 11}) {
    local.worldFromCamera[entry] = rounding.of(local.worldFromCamera[entry], apart);
  }
  return local;
}

// One foam as a view sees it.
class FoamInView {
 public:
  FoamInView(uint32_t number, const PlacedFoam& placed, const ReferenceRenderer::State& foam, const View& view,
             const ReferenceOptions& options)
      : number_(number),
        foam_(foam),
        view_(withRoundedEye(viewFromFoam(view, placed), options)),
        rays_(view_),
        scale_(placed.scale),
        sharpness_(options.detailSharpness),
        leastShare_(options.leastShare),
        worldFromFoam_(glm::mat3_cast(placed.rotation)) {
    ReferenceOptions local = options;
    local.nearDepth /= placed.scale;
    cells_ = prepareViewCells<double>(foam.foam, foam.cechPairs, foam.visible, view_, local);
  }
  FoamInView(const FoamInView&) = delete;  // rays_ refer to view_

  // Adds what the ray of a pixel meets before `end` [world units].
  void addIntervals(uint32_t x, uint32_t y, double end, std::vector<Interval>& intervals) const {
    const std::optional<ViewRay> ray = rays_.ofPixel(x, y);
    if (!ray) return;
    const PrimaryRay<double> primary{ray->offset, ray->direction};
    std::vector<BallHit<double>> hits;
    gatherHits(foam_.tree, cells_, eyeOf(view_) + ray->offset, primary, end / scale_, hits);
    for (BallHit<double>& hit : hits) {
      const ViewCell<double>& cell = cells_.cells[hit.rank];
      if (!clipByNeighbours(cells_.planesOf(cell), primary, hit)) continue;
      const auto found = shadeCell(cell, cells_.detailsOf(hit.rank), primary, sharpness_, hit, leastShare_);
      if (!(found.tNear < found.tFar)) continue;
      intervals.push_back({found.tNear * scale_, found.tFar * scale_, cell.density / scale_, found.colour,
                           worldFromFoam_ * cell.frame.normal, number_});
    }
  }

 private:
  const uint32_t number_;
  const ReferenceRenderer::State& foam_;
  const View view_;
  const ViewRays rays_;
  const double scale_, sharpness_, leastShare_;
  const glm::dmat3 worldFromFoam_;
  ViewCells<double> cells_;
};

// Between two neighbouring ends of intervals everything is constant. A ray that is cut off ends where its transmittance
// is `cutoff`, also within an interval: a renderer may part intervals anywhere, and end between the parts.
MergedRay mergeIntervals(const std::vector<Interval>& intervals, double cutoff, double logQuantile) {
  std::vector<double> ends;
  for (const Interval& interval : intervals) ends.insert(ends.end(), {interval.tNear, interval.tFar});
  std::sort(ends.begin(), ends.end());
  const double logCutoff = std::log(cutoff);
  MergedRay merged;
  RayResult<double>& ray = merged.ray;
  for (size_t i = 0; i + 1 < ends.size() && ray.logTransmittance > logCutoff; ++i) {
    const double tNear = ends[i];
    double density = 0, most = 0;
    uint32_t densest = 0;
    glm::dvec3 colour(0), normal(0);
    for (const Interval& interval : intervals) {
      if (!(interval.tNear <= tNear && ends[i + 1] <= interval.tFar)) continue;
      density += interval.density;
      colour += interval.density * interval.colour;
      normal += interval.density * interval.normal;
      if (interval.density > most) densest = interval.foam;
      most = std::max(most, interval.density);
    }
    const double cut = foam::quantileDistance(tNear, ray.logTransmittance, logCutoff, density);
    const double tFar = std::min(ends[i + 1], cut);
    if (!(tNear < tFar && density > 0)) continue;
    const std::array<double, 4> before = ray.quarters;
    compositeInterval(tNear, tFar, density, colour / density, normal / density, logQuantile, ray);
    for (size_t q = 0; q < 4; ++q) {
      if (ray.quarters[q] != before[q]) merged.quarterFoams[q] = densest;
    }
  }
  return merged;
}

}  // namespace

Result<RenderedImages> renderMerged(std::span<const PlacedFoam> foams, const View& view,
                                    const ReferenceOptions& options, const Progress& progress) {
  if (const Status status = checkRender(view, options); !status) return status.error();
  constexpr uint64_t kSeedsOfFoam = 4;  // that a render uses, from the one it is given on
  std::vector<std::unique_ptr<FoamInView>> seen;
  ReferenceOptions own = options;
  for (const PlacedFoam& foam : foams) {
    const ReferenceRenderer::State& state = foam.renderer->state();
    if (state.cechPairs.offsets.empty()) return stoppedOnRequest("render");
    const auto number = static_cast<uint32_t>(seen.size());
    seen.push_back(std::make_unique<FoamInView>(number, foam, state, view, own));
    own.roundingSeed += kSeedsOfFoam;  // the same cell errs in each instance by itself
  }
  RenderedImages images = emptyImages(view);
  const ViewRays rays(view);
  const Status done = renderRows(view.height, progress, [&](uint32_t y) {
    std::vector<Interval> intervals;
    for (uint32_t x = 0; x < view.width; ++x) {
      intervals.clear();
      const std::optional<ViewRay> ray = rays.ofPixel(x, y);
      if (!ray) continue;
      const double end = endOfRay(options, *ray, x, y);
      for (const auto& foam : seen) foam->addIntervals(x, y, end, intervals);
      const MergedRay merged = mergeIntervals(intervals, options.cutoff, std::log(options.quantile));
      writePixel(merged.ray, x, y, images);
      images.quarterFoams[size_t{y} * view.width + x] = merged.quarterFoams;
    }
  });
  if (!done) return done.error();
  return images;
}

}  // namespace froth
