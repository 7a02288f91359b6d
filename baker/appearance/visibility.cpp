#include "baker/appearance/visibility.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

#include "foam/cech_pairs.h"
#include "foam/site_tree.h"
#include "reference/render/ray.h"
#include "reference/render/view_cells.h"

namespace froth {
namespace {

constexpr uint32_t kDefaultPixels = 80'000;
constexpr double kCutoff = 1e-3;        // of the runtime
constexpr double kFixedPoint = 0x1p28;  // sums are integers: their order does not matter

// The foam without its colours: reduced views of large foams should not pay for lobes.
Foam copyGeometry(const Foam& foam) {
  Foam geometry;
  geometry.cellCount = foam.cellCount;
  geometry.detailCount = foam.detailCount;
  geometry.sites = foam.sites;
  geometry.radii = foam.radii;
  geometry.densities = foam.densities;
  geometry.orientations = foam.orientations;
  geometry.detailSites = foam.detailSites;
  geometry.detailHeights = foam.detailHeights;
  return geometry;
}

View reduceView(const View& view, uint32_t maxPixels) {
  const double pixels = double(view.width) * view.height;
  const double scale = std::min(1.0, std::sqrt(maxPixels / pixels));
  const auto reduce = [&](uint32_t size) { return std::max(1u, static_cast<uint32_t>(std::lround(size * scale))); };
  return resizeView(view, reduce(view.width), reduce(view.height));
}

// Balls that may show in the view: at least partly before the eye and inside the pyramid of its image. Other lenses
// than a pinhole may see all.
std::vector<uint32_t> findCellsInFrustum(const Foam& foam, std::span<const uint32_t> cells, const View& view) {
  if (view.lens.kind != LensKind::kPinhole) return {cells.begin(), cells.end()};
  const auto& m = view.worldFromCamera;
  const glm::dvec3 eye = eyeOf(view);
  const glm::dvec3 right(m[0], m[4], m[8]), down(m[1], m[5], m[9]), forward(m[2], m[6], m[10]);
  const std::array<glm::dvec3, 5> inward = {forward, glm::normalize(right * view.fx + forward * view.cx),
                                            glm::normalize(-right * view.fx + forward * (view.width - view.cx)),
                                            glm::normalize(down * view.fy + forward * view.cy),
                                            glm::normalize(-down * view.fy + forward * (view.height - view.cy))};
  std::vector<uint32_t> inside;
  for (uint32_t cell : cells) {
    const glm::dvec3 centre = glm::dvec3(foam.sites[cell]) - eye;
    bool isInside = true;
    for (const glm::dvec3& normal : inward) isInside &= glm::dot(normal, centre) > -double(foam.radii[cell]);
    if (isInside) inside.push_back(cell);
  }
  return inside;
}

void raise(float& value, float other) {
  std::atomic_ref<float> largest(value);
  for (float seen = largest; seen < other && !largest.compare_exchange_weak(seen, other);) {
  }
}

// What one view sees.
struct ViewSums {
  std::vector<uint64_t> details;     // [drawn cells * K] sum of squared shares, fixed point
  std::vector<float> contributions;  // [drawn cells] largest T alpha
};

class ViewMeasurer {
 public:
  ViewMeasurer(const View& view, const ViewCells<float>& cells, const SiteTree& tree, double sharpness,
               std::vector<uint64_t>& products)
      : view_(view), rays_(view), cells_(cells), tree_(tree), products_(products), sources_(cells.cells.size()) {
    for (uint32_t cell = 0; cell < cells.rankOf.size(); ++cell) {
      if (cells.rankOf[cell] != ViewCells<float>::kNotDrawn) sources_[cells.rankOf[cell]] = cell;
    }
    settings_ = {float(kCutoff), -std::numeric_limits<float>::infinity(), float(sharpness)};
    sums_.details.resize(cells.cells.size() * cells.detailCount);
    sums_.contributions.resize(cells.cells.size());
  }

  ViewSums measure() {
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, view_.height), [&](const tbb::blocked_range<uint32_t>& rows) {
      std::vector<BallHit<float>> hits;
      std::vector<float> shares(cells_.detailCount);
      for (uint32_t y = rows.begin(); y < rows.end(); ++y) {
        for (uint32_t x = 0; x < view_.width; ++x) measurePixel(x, y, hits, shares);
      }
    });
    return std::move(sums_);
  }

 private:
  void measurePixel(uint32_t x, uint32_t y, std::vector<BallHit<float>>& hits, std::span<float> shares) {
    const std::optional<ViewRay> exact = rays_.ofPixel(x, y);
    if (!exact) return;
    const PrimaryRay<float> primary{exact->offset, exact->direction};
    hits.clear();
    tree_.searchRay(eyeOf(view_) + exact->offset, exact->direction, [&](uint32_t source) {
      BallHit<float> hit{cells_.rankOf[source], 0, 0};
      if (hit.rank == ViewCells<float>::kNotDrawn) return;
      const ViewCell<float>& cell = cells_.cells[hit.rank];
      if (foam::intersectBall(cell.centre - primary.offset, cell.radius, primary.direction, hit.tNear, hit.tFar)) {
        hits.push_back(hit);
      }
    });
    compositeHits(cells_, primary, settings_, hits,
                  [&](const RaySegment<float>& segment) { addSegment(segment, shares); });
  }

  void addSegment(const RaySegment<float>& segment, std::span<float> shares) {
    const auto details = cells_.detailsOf(segment.rank);
    float sum = 0;
    for (size_t k = 0; k < shares.size(); ++k) {
      shares[k] = foam::detailWeight(segment.query, details[k].place, settings_.sharpness);
      sum += shares[k];
    }
    const float scale = segment.weight / foam::flooredWeightSum(sum);
    for (float& share : shares) share *= scale;
    uint64_t* const squares = sums_.details.data() + segment.rank * shares.size();
    uint64_t* const products = products_.data() + sources_[segment.rank] * (shares.size() * (shares.size() - 1) / 2);
    for (size_t k = 0, pair = 0; k < shares.size(); ++k) {
      addProduct(squares[k], shares[k], shares[k]);
      for (size_t l = k + 1; l < shares.size(); ++l, ++pair) addProduct(products[pair], shares[k], shares[l]);
    }
    raise(sums_.contributions[segment.rank], segment.weight);
  }

  static void addProduct(uint64_t& sum, float a, float b) {
    const auto added = static_cast<uint64_t>(kFixedPoint * a * b);
    if (added > 0) std::atomic_ref<uint64_t>(sum).fetch_add(added, std::memory_order_relaxed);
  }

  const View& view_;
  const ViewRays rays_;
  const ViewCells<float>& cells_;
  const SiteTree& tree_;
  std::vector<uint64_t>& products_;  // [foam cells * K(K-1)/2] of all views
  std::vector<uint32_t> sources_;    // [drawn cells] index in the foam
  RaySettings<float> settings_;
  ViewSums sums_;
};

// Seen detail sites of one view, in no useful order.
struct ViewEntries {
  std::vector<uint64_t> details;
  std::vector<float> weights;  // [full-size pixels]
};

void addEntries(const ViewCells<float>& cells, const ViewSums& sums, double pixelsPerSample, ViewEntries& entries,
                std::vector<float>& contributions, std::vector<uint64_t>& squares) {
  const uint32_t K = cells.detailCount;
  for (size_t cell = 0; cell < cells.rankOf.size(); ++cell) {
    const uint32_t rank = cells.rankOf[cell];
    if (rank == ViewCells<float>::kNotDrawn) continue;
    contributions[cell] = std::max(contributions[cell], sums.contributions[rank]);
    for (uint32_t k = 0; k < K; ++k) {
      const uint64_t sum = sums.details[uint64_t{rank} * K + k];
      if (sum == 0) continue;
      squares[cell * K + k] += sum;
      entries.details.push_back(cell * K + k);
      entries.weights.push_back(static_cast<float>(sum / kFixedPoint * pixelsPerSample));
    }
  }
}

// Products of shares, divided by the roots of the squares.
void correlate(uint32_t detailCount, const std::vector<uint64_t>& squares, const std::vector<uint64_t>& products,
               std::vector<float>& overlaps) {
  overlaps.resize(products.size());
  size_t pair = 0;
  for (size_t first = 0; first < squares.size(); first += detailCount) {
    for (uint32_t k = 0; k < detailCount; ++k) {
      for (uint32_t l = k + 1; l < detailCount; ++l, ++pair) {
        const double norm = std::sqrt(double(squares[first + k]) * double(squares[first + l]));
        overlaps[pair] = norm > 0 ? static_cast<float>(std::min(products[pair] / norm, 1.0)) : 0.0f;
      }
    }
  }
}

void gatherRows(const std::vector<ViewEntries>& views, Visibility& visibility) {
  auto& offsets = visibility.offsets;
  for (const ViewEntries& view : views) {
    for (uint64_t detail : view.details) ++offsets[detail + 1];
  }
  for (size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  visibility.views.resize(offsets.back());
  visibility.weights.resize(offsets.back());
  std::vector<uint64_t> next(offsets.begin(), offsets.end() - 1);
  for (size_t v = 0; v < views.size(); ++v) {
    for (size_t i = 0; i < views[v].details.size(); ++i) {
      const uint64_t place = next[views[v].details[i]]++;
      visibility.views[place] = static_cast<uint16_t>(v);
      visibility.weights[place] = views[v].weights[i];
    }
  }
}

}  // namespace

Result<Visibility> measureVisibility(const Foam& foam, std::span<const View> views, const VisibilityOptions& options,
                                     const Progress& progress) {
  if (views.size() > std::numeric_limits<uint16_t>::max()) {
    return makeError(ErrorKind::kUsage, "cameras: found %zu views; give at most 65535", views.size());
  }
  const Foam geometry = copyGeometry(foam);
  const std::vector<uint32_t> visible = findVisibleCells(geometry);
  const CellGraph pairs = findCechPairs(geometry.sites, geometry.radii, progress);
  if (pairs.offsets.empty()) return stoppedOnRequest("visibility");
  const SiteTree tree(geometry.sites, geometry.radii, visible);

  Visibility visibility;
  visibility.offsets.assign(uint64_t{foam.cellCount} * foam.detailCount + 1, 0);
  visibility.contributions.assign(foam.cellCount, 0.0f);
  const uint32_t K = foam.detailCount;
  std::vector<uint64_t> squares(uint64_t{foam.cellCount} * K), products(uint64_t{foam.cellCount} * (K * (K - 1) / 2));
  std::vector<ViewEntries> entries(views.size());
  for (size_t v = 0; v < views.size(); ++v) {
    if (!report(progress, "visibility", v, views.size())) return stoppedOnRequest("visibility");
    const View view = reduceView(views[v], options.maxPixelsPerView > 0 ? options.maxPixelsPerView : kDefaultPixels);
    ReferenceOptions reference;
    reference.nearRatio = views[v].nearRatio.value_or(options.nearRatio);
    reference.nearDepth = views[v].nearDepth.value_or(options.nearDepth);
    const auto candidates = findCellsInFrustum(geometry, visible, view);
    const auto cells = prepareViewCells<float>(geometry, pairs, candidates, view, reference);
    const ViewSums sums = ViewMeasurer(view, cells, tree, options.detailSharpness, products).measure();
    const double pixels = double(views[v].width) * views[v].height;
    const double pixelsPerSample = pixels / (double(view.width) * view.height);
    addEntries(cells, sums, pixelsPerSample, entries[v], visibility.contributions, squares);
    visibility.eyes.push_back(eyeOf(view));
    visibility.pixels.push_back(pixels);
  }
  gatherRows(entries, visibility);
  correlate(K, squares, products, visibility.overlaps);
  return visibility;
}

std::vector<double> sumCellWeights(const Foam& foam, const Visibility& visibility) {
  std::vector<double> sums(foam.cellCount, 0);
  for (size_t detail = 0; detail + 1 < visibility.offsets.size(); ++detail) {
    for (uint64_t entry = visibility.offsets[detail]; entry < visibility.offsets[detail + 1]; ++entry) {
      sums[detail / foam.detailCount] += visibility.weights[entry];
    }
  }
  return sums;
}

}  // namespace froth
