// The regular triangulation region by region.
//
// A region's own sites are triangulated first alone, then with ever more sites around them. A cell of such a
// local triangulation is a cell of the whole one if no other site conflicts with it; CGAL breaks ties by a
// symbolic perturbation of weights that depends on the places of sites alone, so this holds for degenerate
// sites too. Each cell next to an own site is proven by a search over all sites for one that conflicts, or
// that may conflict as far as double can tell. If there is one it is added, and the cells that this makes are
// looked at again. In the end the stars of the own sites are those of the whole triangulation. Hidden sites
// need no proof: what some sites hide, more sites hide too.
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "baker/graph/local_triangulation.h"
#include "baker/graph/orthosphere.h"
#include "baker/graph/site_tree.h"

namespace froth {
namespace {

using Triangulation = LocalTriangulation::Triangulation;

// A region that needs more sites than this around it is no region: the scene is triangulated as a whole.
// Trained foams need a few tenths of their own.
constexpr size_t kMaxSitesPerOwn = 16, kMaxExtraSites = 1 << 15;

// Measured, with some reserve. [bytes]
constexpr uint64_t kBytesPerCell = 1000;  // in one piece
constexpr uint64_t kRegionBytesPerCell =
    1200;  // of a region's own cells: CGAL's for them and those around them
constexpr uint64_t kSharedBytesPerCell =
    200;  // tree and order, rows of all regions and the graph made of them
// Smaller regions are mostly halo; larger ones leave the caches and gain nothing.
constexpr uint64_t kMinRegionCells = 4096, kMaxRegionCells = 1 << 17;

constexpr uint32_t kCellsPerLook = 1024;  // at the progress

class Region {
 public:
  // The region owns some places.
  Region(const PlacedSites& sites, const SiteTree& tree, SiteTree::Range own)
      : sites_(sites),
        tree_(tree),
        begin_(own.begin),
        end_(own.end),
        isLocal_(sites.order.size()),
        local_(sites) {}

  enum class Outcome { kDone, kStopped, kNeedsTheWhole };
  // `simplex`: places of four sites that lie in no plane, so that the local triangulation has all dimensions.
  Outcome triangulate(std::span<const uint32_t> simplex, InsertionProgress& progress);

  RowBlock collectRows(InsertionProgress& progress) const {
    return local_.collectRows(begin_, end_, progress);
  }

 private:
  bool isOwn(uint32_t place) const { return place >= begin_ && place < end_; }
  bool touchesOwn(Triangulation::Cell_handle cell) const;
  bool findConflicts(std::vector<uint32_t>& places, InsertionProgress& progress);
  std::optional<uint32_t> findConflict(Triangulation::Cell_handle cell) const;
  std::optional<uint32_t> findInSphere(const PowerForm& sphere) const;
  std::optional<uint32_t> findBeyond(const PowerForm& beyond, const PowerForm& sphere) const;

  Ball ballAt(Triangulation::Vertex_handle vertex) const {
    const uint32_t cell = sites_.order[vertex->info()];
    return {glm::dvec3(sites_.sites[cell]), sites_.radii[cell]};
  }
  PowerForm::Bounds boundsAt(const PowerForm& form, uint32_t place) const {
    return form.at(sites_.sites[sites_.order[place]], sites_.radii[sites_.order[place]]);
  }

  const PlacedSites& sites_;
  const SiteTree& tree_;
  uint32_t begin_, end_;
  std::vector<bool> isLocal_;  // places that are in, or about to be
  LocalTriangulation local_;
};

Region::Outcome Region::triangulate(std::span<const uint32_t> simplex, InsertionProgress& progress) {
  std::vector<uint32_t> places(end_ - begin_);
  std::iota(places.begin(), places.end(), begin_);
  std::fill(isLocal_.begin() + begin_, isLocal_.begin() + end_, true);
  if (!local_.insert(places, progress, true)) return Outcome::kStopped;

  places.assign(simplex.begin(), simplex.end());
  std::erase_if(places, [&](uint32_t place) { return isOwn(place); });
  for (const uint32_t place : places) isLocal_[place] = true;
  size_t localCount = end_ - begin_;
  do {
    localCount += places.size();
    if (localCount > kMaxSitesPerOwn * (end_ - begin_) + kMaxExtraSites) return Outcome::kNeedsTheWhole;
    if (!local_.insert(places, progress, false)) return Outcome::kStopped;
    places.clear();
    if (!findConflicts(places, progress)) return Outcome::kStopped;
  } while (!places.empty());
  return Outcome::kDone;
}

// Looks at all cells next to own sites that are not proven yet; appends a conflicting site for each that has
// one. False: stopped.
bool Region::findConflicts(std::vector<uint32_t>& places, InsertionProgress& progress) {
  uint32_t looked = 0;
  for (const Triangulation::Cell_handle cell : local_.cgal().all_cell_handles()) {
    if (cell->info().isProven || !touchesOwn(cell)) continue;
    if (++looked % kCellsPerLook == 0 && !progress.add(0)) return false;
    const std::optional<uint32_t> conflict = findConflict(cell);
    cell->info().isProven = !conflict;
    if (!conflict || isLocal_[*conflict]) continue;
    isLocal_[*conflict] = true;
    places.push_back(*conflict);
  }
  return true;
}

bool Region::touchesOwn(Triangulation::Cell_handle cell) const {
  for (int k = 0; k < 4; ++k) {
    const Triangulation::Vertex_handle vertex = cell->vertex(k);
    if (vertex != local_.cgal().infinite_vertex() && isOwn(vertex->info())) return true;
  }
  return false;
}

// A site that is not in yet and may conflict with a cell.
std::optional<uint32_t> Region::findConflict(Triangulation::Cell_handle cell) const {
  int infinite;
  if (!cell->has_vertex(local_.cgal().infinite_vertex(), infinite)) {
    return findInSphere(PowerForm::ofTetrahedron({ballAt(cell->vertex(0)), ballAt(cell->vertex(1)),
                                                  ballAt(cell->vertex(2)), ballAt(cell->vertex(3))}));
  }
  // An infinite cell's sphere is the half-space beyond its facet; sites in the facet's plane conflict if they
  // do with the facet's own sphere.
  const bool isOdd = infinite % 2 == 1;
  const std::array<Ball, 3> facet = {ballAt(cell->vertex((infinite + (isOdd ? 1 : 2)) & 3)),
                                     ballAt(cell->vertex((infinite + (isOdd ? 2 : 1)) & 3)),
                                     ballAt(cell->vertex((infinite + 3) & 3))};
  return findBeyond(PowerForm::beyondTriangle(facet), PowerForm::ofTriangle(facet));
}

// The site deepest in conflict.
std::optional<uint32_t> Region::findInSphere(const PowerForm& sphere) const {
  std::optional<uint32_t> found;
  double limit = 0;
  const auto bound = [&](const SiteTree::Node& node) {
    return isOwn(node.begin) && isOwn(node.end - 1) ? INFINITY : sphere.lowerOver(node.box);
  };
  tree_.search(limit, bound, [&](uint32_t place) {
    if (isLocal_[place]) return;
    const double lower = boundsAt(sphere, place).lower;
    if (lower > limit) return;
    limit = lower;
    found = place;
  });
  return found;
}

// The site next to the facet of all that lie beyond it.
std::optional<uint32_t> Region::findBeyond(const PowerForm& beyond, const PowerForm& sphere) const {
  std::optional<uint32_t> found;
  double limit = std::numeric_limits<double>::max();
  const auto bound = [&](const SiteTree::Node& node) {
    const bool isOut = (isOwn(node.begin) && isOwn(node.end - 1)) || beyond.lowerOver(node.box) > 0;
    return isOut ? INFINITY : sphere.lowerOver(node.box);
  };
  tree_.search(limit, bound, [&](uint32_t place) {
    if (isLocal_[place]) return;
    const PowerForm::Bounds side = boundsAt(beyond, place);
    const double lower = boundsAt(sphere, place).lower;
    if (side.lower > 0 || (side.upper >= 0 && lower > 0) || lower > limit) return;
    limit = lower;
    found = place;
  });
  return found;
}

// Places of four sites that lie in no plane; fewer if all lie in one.
std::vector<uint32_t> findSimplex(const PlacedSites& sites) {
  using Point = LocalTriangulation::Kernel::Point_3;
  std::vector<uint32_t> simplex;
  std::vector<Point> corners;
  for (uint32_t place = 0; place < sites.order.size() && simplex.size() < 4; ++place) {
    const glm::vec3& p = sites.sites[sites.order[place]];
    const Point point(p.x, p.y, p.z);
    if (simplex.size() == 2 && CGAL::collinear(corners[0], corners[1], point)) continue;
    if (simplex.size() == 3 && CGAL::coplanar(corners[0], corners[1], corners[2], point)) continue;
    simplex.push_back(place);
    corners.push_back(point);
  }
  return simplex;
}

}  // namespace

uint64_t triangulationBytes(uint64_t cells) {
  return kBytesPerCell * cells;
}

uint32_t regionCellsWithin(uint64_t cells, uint64_t bytes) {
  const uint64_t shared = kSharedBytesPerCell * cells, own = bytes > shared ? bytes - shared : 0;
  const auto threads = static_cast<uint64_t>(tbb::this_task_arena::max_concurrency());
  return static_cast<uint32_t>(
      std::clamp<uint64_t>(own / (kRegionBytesPerCell * threads), kMinRegionCells, kMaxRegionCells));
}

Result<RegularTriangulation> triangulateRegions(std::span<const glm::vec3> sites,
                                                std::span<const float> radii, std::span<const uint32_t> order,
                                                uint32_t regionCells, const Progress& progress) {
  if (Status status = checkFinite(sites, radii); !status) return status.error();
  const auto cancelled = [] { return makeError(ErrorKind::kCancelled, "triangulation stopped on request"); };
  if (!report(progress, "sort sites", 0, order.size())) return cancelled();
  std::vector<uint32_t> distinct = dropDuplicates(sites, radii, order);
  if (!report(progress, "sort sites", order.size() / 2, order.size())) return cancelled();
  const SiteTree tree(sites, radii, std::move(distinct));
  const PlacedSites placed{sites, radii, tree.order()};
  const auto placeCount = static_cast<uint32_t>(placed.order.size());
  const std::vector<uint32_t> simplex = findSimplex(placed);
  if (placeCount <= regionCells || simplex.size() < 4) return triangulateRegular(sites, radii, progress);

  // Regions are nodes of the tree: compact, and skipped by a search in one step.
  uint32_t depth = 0;
  while (depth < tree.depth() && placeCount >> depth > regionCells) ++depth;
  const uint32_t regionCount = 1u << depth;
  std::vector<RowBlock> blocks(regionCount);
  InsertionProgress insertion(progress, "triangulate regions", placeCount);
  std::atomic<bool> needsTheWhole = false;
  tbb::parallel_for(
      tbb::blocked_range<uint32_t>(0, regionCount, 1),
      [&](const tbb::blocked_range<uint32_t>& range) {
        Region region(placed, tree, tree.rangeAt(depth, range.begin()));
        const Region::Outcome outcome = region.triangulate(simplex, insertion);
        if (outcome == Region::Outcome::kDone) blocks[range.begin()] = region.collectRows(insertion);
        if (outcome == Region::Outcome::kNeedsTheWhole) {
          needsTheWhole = true;
          insertion.stop();
        }
      },
      tbb::simple_partitioner());
  if (needsTheWhole) return triangulateRegular(sites, radii, progress);
  if (!insertion.add(0)) return cancelled();
  return assembleRows(placed, std::move(blocks));
}

}  // namespace froth
