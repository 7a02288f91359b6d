#include "reference/render/reference.h"

#include "reference/camera/ray_map.h"
#include "reference/render/reference_state.h"

namespace froth {
namespace {

template <class Real>
class ImageRenderer {
 public:
  ImageRenderer(const SiteTree& tree, const ViewCells<Real>& cells, const View& view, const ReferenceOptions& options)
      : tree_(tree),
        cells_(cells),
        view_(view),
        rays_(view),
        options_(options),
        settings_{Real(options.cutoff), Real(std::log(options.quantile)), Real(options.detailSharpness),
                  Real(options.leastShare)} {
    images_ = emptyImages(view);
    sources_.resize(cells.cells.size());
    for (uint32_t cell = 0; cell < cells.rankOf.size(); ++cell) {
      if (cells.rankOf[cell] != ViewCells<Real>::kNotDrawn) sources_[cells.rankOf[cell]] = cell;
    }
  }

  Result<RenderedImages> render(const Progress& progress) {
    const Status done = renderRows(view_.height, progress, [&](uint32_t y) {
      std::vector<BallHit<Real>> hits;
      for (uint32_t x = 0; x < view_.width; ++x) renderPixel(x, y, hits);
    });
    if (!done) return done.error();
    return std::move(images_);
  }

 private:
  void renderPixel(uint32_t x, uint32_t y, std::vector<BallHit<Real>>& hits) {
    const std::optional<ViewRay> exact = rays_.ofPixel(x, y);
    if (!exact) return;
    const PrimaryRay<Real> primary{exact->offset, exact->direction};
    gatherHits(tree_, cells_, eyeOf(view_) + exact->offset, primary, Real(endOfRay(options_, *exact, x, y)), hits);
    const RayResult<Real> ray = compositeHits(cells_, primary, settings_, hits);
    writePixel(ray, x, y, images_);
    if (ray.rank != UINT32_MAX) images_.cells[size_t{y} * view_.width + x] = sources_[ray.rank];
  }

  const SiteTree& tree_;
  const ViewCells<Real>& cells_;
  const View& view_;
  const ViewRays rays_;
  const ReferenceOptions& options_;
  const RaySettings<Real> settings_;
  std::vector<uint32_t> sources_;  // [rank] the foam's cell
  RenderedImages images_;
};

template <class Real>
Result<RenderedImages> renderFoam(const ReferenceRenderer::State& foam, const View& view,
                                  const ReferenceOptions& options, const Progress& progress) {
  if (foam.cechPairs.offsets.empty()) return stoppedOnRequest("render");
  const ViewCells<Real> cells = prepareViewCells<Real>(foam.foam, foam.cechPairs, foam.visible, view, options);
  return ImageRenderer<Real>(foam.tree, cells, view, options).render(progress);
}

}  // namespace

ReferenceRenderer::ReferenceRenderer(const Foam& foam, const Progress& progress)
    : state_(std::make_unique<State>(foam, progress)) {}
ReferenceRenderer::~ReferenceRenderer() = default;

Result<RenderedImages> ReferenceRenderer::render(const View& view, const ReferenceOptions& options,
                                                 const Progress& progress) const {
  if (const Status status = checkRender(view, options); !status) return status.error();
  return options.precision == Precision::kFloat ? renderFoam<float>(*state_, view, options, progress)
                                                : renderFoam<double>(*state_, view, options, progress);
}

}  // namespace froth
