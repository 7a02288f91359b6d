// The regular triangulation region by region.
#include <algorithm>
#include <array>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "baker/graph/region.h"

namespace froth {
namespace {

// Measured, with some reserve. [bytes]
constexpr uint64_t kBytesPerCell = 800;        // in one piece
constexpr uint64_t kLocalBytesPerCell = 800;   // of a region and around it
constexpr uint64_t kSharedBytesPerCell = 150;  // tree and order, rows of all regions and the graph made of them
// Smaller regions are mostly what lies around them; larger ones leave the caches and gain nothing.
constexpr uint64_t kMinLocalCells = 1 << 10, kGoodLocalCells = 1 << 13, kMaxLocalCells = 1 << 18;

double megabytes(uint64_t bytes) { return static_cast<double>(bytes) * 1e-6; }

// All regions of a scene.
class Regions {
 public:
  Regions(const PlacedSites& sites, const SiteTree& tree, std::span<const uint32_t> simplex, const RegionPlan& plan,
          InsertionProgress& progress)
      : sites_(sites), tree_(tree), simplex_(simplex), plan_(plan), progress_(progress) {}

  // Empty when stopped, or when no region is small enough for the plan.
  std::vector<RowBlock> triangulate();
  bool isTooLarge() const { return isTooLarge_; }

 private:
  void triangulateNode(uint32_t depth, uint32_t k, std::vector<RowBlock>& rows);

  const PlacedSites& sites_;
  const SiteTree& tree_;
  std::span<const uint32_t> simplex_;
  const RegionPlan& plan_;
  InsertionProgress& progress_;
  std::atomic<bool> isTooLarge_ = false;
};

// Regions are nodes of the tree: compact, and skipped by a search in one step.
std::vector<RowBlock> Regions::triangulate() {
  uint32_t depth = 0;
  while (depth < tree_.depth() && sites_.order.size() >> depth > plan_.ownCells) ++depth;
  std::vector<std::vector<RowBlock>> found(size_t{1} << depth);
  tbb::task_arena arena(std::min(plan_.threads, tbb::this_task_arena::max_concurrency()));
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<uint32_t>(0, 1u << depth, 1),
        [&](const tbb::blocked_range<uint32_t>& range) { triangulateNode(depth, range.begin(), found[range.begin()]); },
        tbb::simple_partitioner());
  });
  std::vector<RowBlock> rows;
  if (!progress_.add(0)) return rows;
  for (std::vector<RowBlock>& some : found) std::move(some.begin(), some.end(), std::back_inserter(rows));
  return rows;
}

// A region with too many sites around it is done in halves.
void Regions::triangulateNode(uint32_t depth, uint32_t k, std::vector<RowBlock>& rows) {
  const SiteTree::Range own = tree_.rangeAt(depth, k);
  {
    Region region(sites_, tree_, own);
    const Region::Outcome outcome = region.triangulate(simplex_, plan_.localCells, progress_);
    if (outcome == Region::Outcome::kStopped) return;
    if (outcome == Region::Outcome::kDone) {
      rows.push_back(region.collectRows(progress_));
      progress_.add(own.end - own.begin);
      return;
    }
  }
  if (depth == tree_.depth()) {
    isTooLarge_ = true;
    progress_.stop();
    return;
  }
  triangulateNode(depth + 1, 2 * k, rows);
  triangulateNode(depth + 1, 2 * k + 1, rows);
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

Result<RegularTriangulation> triangulateRegions(std::span<const glm::vec3> sites, std::span<const float> radii,
                                                const RegionPlan& plan, const Progress& progress) {
  if (Status status = checkFinite(sites, radii); !status) return status.error();
  Result<std::vector<uint32_t>> distinct = listDistinct(sites, radii, progress);
  if (!distinct) return distinct.error();
  const SiteTree tree(sites, radii, std::move(*distinct));
  const PlacedSites placed{sites, radii, tree.order()};
  const std::vector<uint32_t> simplex = findSimplex(placed);
  if (placed.order.size() <= plan.ownCells || simplex.size() < 4) return triangulateRegular(sites, radii, progress);

  InsertionProgress insertion(progress, "triangulate regions", placed.order.size());
  Regions regions(placed, tree, simplex, plan, insertion);
  std::vector<RowBlock> rows = regions.triangulate();
  if (regions.isTooLarge()) {
    return makeError(ErrorKind::kUnsupported,
                     "triangulation: some cells have more neighbours than the memory limit has room for; in one piece "
                     "it needs %.0f MB beside the input, raise the limit",
                     megabytes(kBytesPerCell * sites.size()));
  }
  if (rows.empty()) return stoppedOnRequest("triangulation");
  return assembleRows(placed, std::move(rows));
}

Result<RegularTriangulation> triangulateWithin(uint64_t memoryLimit, std::span<const glm::vec3> sites,
                                               std::span<const float> radii, const Progress& progress) {
  const uint64_t whole = kBytesPerCell * sites.size();
  if (memoryLimit == 0 || whole <= memoryLimit) return triangulateRegular(sites, radii, progress);
  const uint64_t shared = kSharedBytesPerCell * sites.size(), least = shared + kMinLocalCells * kLocalBytesPerCell;
  if (memoryLimit < least) {
    return makeError(
        ErrorKind::kUsage,
        "memory limit of %.1f MB: to triangulate %zu cells takes %.1f MB beside the input, or %.1f MB in one "
        "piece, which is faster; raise the limit",
        megabytes(memoryLimit), sites.size(), megabytes(std::min(least, whole)), megabytes(whole));
  }
  const uint64_t room = (memoryLimit - shared) / kLocalBytesPerCell;  // cells in all regions at work
  const auto cores = static_cast<uint64_t>(tbb::this_task_arena::max_concurrency());
  RegionPlan plan;
  plan.threads = static_cast<int>(std::clamp<uint64_t>(room / kGoodLocalCells, 1, cores));
  plan.localCells = std::min(room / plan.threads, kMaxLocalCells);
  plan.ownCells = static_cast<uint32_t>(plan.localCells / 2);
  return triangulateRegions(sites, radii, plan, progress);
}

}  // namespace froth
