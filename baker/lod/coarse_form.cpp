#include "baker/lod/coarse_form.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "baker/cells/snap_cells.h"
#include "baker/graph/graph.h"
#include "baker/lod/form_distance.h"
#include "foam/append_cells.h"
#include "foam/site_tree.h"

namespace froth {
namespace {

// A group with more live cells left than this share of them is not worth its bytes.
constexpr double kWorthwhileShare = 0.85;
constexpr uint32_t kNoCluster = 0xffffffff;

class Coarsening {
 public:
  Coarsening(const LevelSource& source, const FineForm& fine, const MergePlan& plan)
      : source_(source),
        fine_(fine),
        plan_(plan),
        faced_(gatherFaced(source, fine)),
        mergedCells_(snapCells(plan.merged, source.lattices)),
        isUndone_(plan.clusters.size(), 0),
        clusterOf_(fine.count(), kNoCluster) {
    for (uint32_t cluster = 0; cluster < plan.clusters.size(); ++cluster) {
      for (const uint32_t cell : plan.clusters[cluster]) clusterOf_[*fine.placeOf(cell)] = cluster;
    }
  }

  Result<CoarseForm> run();

 private:
  bool isSteiner(uint32_t i) const { return source_.cells.sources[fine_.cells[i]] == kNoSource; }
  void dropOthers();
  void dropSteiner(std::vector<uint32_t>& steiner);
  void listCells();
  Status triangulate();
  bool undoFaults();
  bool dropHidden();
  Status checkBorder() const;
  void fillRows();
  void measure();

  uint32_t ownCount() const { return static_cast<uint32_t>(kept_.size() + standing_.size()); }
  // What a cell of the triangulation is called in the rows of the fine form; only of kept cells and the ring.
  uint32_t sceneCellOf(uint32_t local) const {
    return local < kept_.size() ? fine_.cells[kept_[local]] : fine_.ring[local - ownCount()];
  }

  const LevelSource& source_;
  const FineForm& fine_;
  CoarseForm form_;

  const MergePlan& plan_;
  const FacedCells faced_;
  const BakeCells mergedCells_;      // of the plan, on the lattices
  std::vector<uint8_t> isUndone_;    // [clusters]
  std::vector<uint32_t> clusterOf_;  // [fine cells] kNoCluster: merges with no other
  std::vector<uint8_t> isDropped_;   // [fine cells]

  // Of the triangulation: kept cells of the fine form, merged cells, the ring.
  std::vector<uint32_t> kept_, standing_;  // indices of the fine form; of clusters
  std::vector<glm::vec3> sites_;
  std::vector<float> radii_;
  RegularTriangulation triangulation_;
};

// Cells that are not live and cut no live one leave no trace in an image.
void Coarsening::dropOthers() {
  isDropped_.assign(fine_.count(), 0);
  std::vector<uint8_t> isFaced(fine_.count(), 0);
  for (const uint32_t i : faced_.cells) isFaced[i] = 1;
  std::vector<uint32_t> steiner;
  for (uint32_t i = 0; i < fine_.count(); ++i) {
    if (fine_.isLocked[i] || isFaced[i]) continue;
    if (isSteiner(i)) {
      steiner.push_back(i);
    } else {
      isDropped_[i] = 1;
    }
  }
  dropSteiner(steiner);
}

// The smaller half of the Steiner cells, for walks take half as many steps too; and those that would cut a merged cell.
void Coarsening::dropSteiner(std::vector<uint32_t>& steiner) {
  const auto radiusOf = [&](uint32_t i) { return source_.cells.radii[fine_.cells[i]]; };
  std::stable_sort(steiner.begin(), steiner.end(), [&](uint32_t a, uint32_t b) { return radiusOf(a) > radiusOf(b); });
  std::vector<uint32_t> all(plan_.clusters.size());
  std::iota(all.begin(), all.end(), 0u);
  const SiteTree tree(mergedCells_.sites, mergedCells_.radii, all);
  for (size_t k = 0; k < steiner.size(); ++k) {
    const uint32_t i = steiner[k];
    const glm::dvec3 site(source_.cells.sites[fine_.cells[i]]);
    isDropped_[i] = k >= (steiner.size() + 1) / 2 || tree.findNearestBall(site).value < radiusOf(i);
  }
}

void Coarsening::listCells() {
  kept_.clear();
  standing_.clear();
  sites_.clear();
  radii_.clear();
  const auto addCell = [&](uint32_t cell) {
    sites_.push_back(source_.cells.sites[cell]);
    radii_.push_back(source_.cells.radii[cell]);
  };
  for (uint32_t i = 0; i < fine_.count(); ++i) {
    if (isDropped_[i] || (clusterOf_[i] != kNoCluster && !isUndone_[clusterOf_[i]])) continue;
    kept_.push_back(i);
    addCell(fine_.cells[i]);
  }
  for (uint32_t k = 0; k < plan_.clusters.size(); ++k) {
    if (isUndone_[k]) continue;
    standing_.push_back(k);
    sites_.push_back(mergedCells_.sites[k]);
    radii_.push_back(mergedCells_.radii[k]);
  }
  for (const uint32_t cell : fine_.ring) addCell(cell);
}

Status Coarsening::triangulate() {
  listCells();
  ++form_.rounds;
  Result<RegularTriangulation> found = triangulateRegular(sites_, radii_);
  if (!found) return found.error();
  triangulation_ = std::move(*found);
  return {};
}

// Merges whose cell reaches a cell outside or covers a live one, for what that one shows would be lost. Where a merged
// cell has no power cell, what covers it is at fault: one giant may cover all others. False: there are none.
bool Coarsening::undoFaults() {
  if (standing_.empty()) return false;
  std::vector<uint32_t> faulty;  // clusters
  const SiteTree tree(mergedCells_.sites, mergedCells_.radii, standing_);
  for (uint32_t local = 0; local < ownCount(); ++local) {
    const bool isMerged = local >= kept_.size();
    if (triangulation_.isHidden[local]) {
      if (!isMerged && !fine_.isLive[kept_[local]]) continue;
      faulty.push_back(tree.findLeastPower(glm::dvec3(sites_[local])).site);
    } else if (isMerged) {
      const std::span<const uint32_t> row = neighboursOf(triangulation_.graph, local);
      // rows ascend, and the ring comes last
      if (!row.empty() && row.back() >= ownCount()) faulty.push_back(standing_[local - kept_.size()]);
    }
  }
  std::sort(faulty.begin(), faulty.end());
  faulty.erase(std::unique(faulty.begin(), faulty.end()), faulty.end());
  for (const uint32_t cluster : faulty) isUndone_[cluster] = 1;
  form_.undone += static_cast<uint32_t>(faulty.size());
  return !faulty.empty();
}

// Kept cells that merged ones cover; they are not live. False: there are none.
bool Coarsening::dropHidden() {
  bool isAny = false;
  for (size_t local = 0; local < kept_.size(); ++local) {
    if (!triangulation_.isHidden[local]) continue;
    isDropped_[kept_[local]] = 1;
    isAny = true;
  }
  return isAny;
}

// The pairs of neighbours across the border are those of the fine form.
Status Coarsening::checkBorder() const {
  std::vector<std::pair<uint32_t, uint32_t>> before, after;
  for (uint32_t i = 0; i < fine_.count(); ++i) {
    if (!fine_.isLocked[i]) continue;
    for (const uint32_t neighbour : neighboursOf(fine_.rows.walk, i)) {
      if (!fine_.placeOf(neighbour)) before.emplace_back(fine_.cells[i], neighbour);
    }
  }
  for (uint32_t local = 0; local < kept_.size(); ++local) {
    for (const uint32_t neighbour : neighboursOf(triangulation_.graph, local)) {
      if (neighbour >= ownCount()) after.emplace_back(sceneCellOf(local), sceneCellOf(neighbour));
    }
  }
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  if (before == after) return {};
  const auto differing = std::ranges::mismatch(before, after);
  const auto [cell, neighbour] = differing.in1 != before.end() ? *differing.in1 : *differing.in2;
  return makeError(ErrorKind::kUnsupported,
                   "levels: the pair of cells %u and %u across the border of a group is not the same when it gets "
                   "coarser; this is a fault of the baker, please report it with the input",
                   cell, neighbour);
}

// Faces across the border are what they were, so their pairs of the alpha-complex keep what is known of them.
void Coarsening::fillRows() {
  AlphaComplex alpha = computeAlphaComplex(sites_, radii_, triangulation_, {}, ownCount());
  form_.isEmpty.assign(alpha.isEmpty.begin(), alpha.isEmpty.begin() + ownCount());
  form_.rows = {{{0}, {}}, {{0}, {}}};
  const auto endRow = [](CellGraph& rows) { rows.offsets.push_back(static_cast<uint32_t>(rows.neighbours.size())); };
  for (uint32_t local = 0; local < ownCount(); ++local) {
    CellRows& rows = form_.rows;
    const std::span<const uint32_t> walk = neighboursOf(triangulation_.graph, local);
    rows.walk.neighbours.insert(rows.walk.neighbours.end(), walk.begin(), walk.end());
    endRow(rows.walk);
    for (const uint32_t neighbour : neighboursOf(alpha.graph, local)) {
      if (neighbour < ownCount()) rows.alpha.neighbours.push_back(neighbour);
    }
    if (local < kept_.size() && !form_.isEmpty[local]) {
      for (const uint32_t neighbour : neighboursOf(fine_.rows.alpha, kept_[local])) {
        if (fine_.placeOf(neighbour)) continue;
        const auto outside = std::lower_bound(fine_.ring.begin(), fine_.ring.end(), neighbour);
        rows.alpha.neighbours.push_back(ownCount() + static_cast<uint32_t>(outside - fine_.ring.begin()));
      }
    }
    endRow(rows.alpha);
  }
}

void Coarsening::measure() {
  std::vector<uint32_t> unmerged;
  for (uint32_t k = 0; k < faced_.cells.size(); ++k) {
    const uint32_t i = faced_.cells[k];
    if (!isDropped_[i] && (clusterOf_[i] == kNoCluster || isUndone_[clusterOf_[i]])) unmerged.push_back(k);
  }
  Foam coarse;
  appendCells(faced_.faces, unmerged, coarse);
  appendCells(plan_.merged, standing_, coarse);
  form_.distance = measureFormDistance(faced_.faces, coarse);
}

Result<CoarseForm> Coarsening::run() {
  form_.liveCount = fine_.liveCount;
  form_.lockedLive = fine_.lockedLive;
  dropOthers();
  // Each round undoes a merge or drops a cell, so this ends; without any merge all borders are right.
  do {
    if (Status status = triangulate(); !status) return status.error();
  } while (undoFaults() || dropHidden());

  size_t liveLeft = form_.liveCount;
  for (const uint32_t k : standing_) liveLeft -= plan_.clusters[k].size() - 1;
  form_.isWorthwhile = static_cast<double>(liveLeft) <= kWorthwhileShare * form_.liveCount;
  if (!form_.isWorthwhile) return std::move(form_);
  if (Status status = checkBorder(); !status) return status.error();
  fillRows();
  measure();
  for (const uint32_t i : kept_) form_.kept.push_back(fine_.cells[i]);
  appendCells(plan_.merged, standing_, form_.merged);
  for (const uint32_t k : standing_) form_.members.push_back(plan_.clusters[k]);
  if (plan_.contributions.empty()) return std::move(form_);
  for (const uint32_t k : standing_) form_.contributions.push_back(plan_.contributions[k]);
  return std::move(form_);
}

}  // namespace

Result<CoarseForm> makeCoarseForm(const LevelSource& source, const FineForm& fine, const MergePlan& plan) {
  return Coarsening(source, fine, plan).run();
}

}  // namespace froth
