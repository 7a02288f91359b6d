#include "baker/lod/coarse_form.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "baker/cells/snap_cells.h"
#include "baker/graph/graph.h"
#include "baker/lod/choose_pairs.h"
#include "baker/lod/form_distance.h"
#include "baker/lod/gather_cells.h"
#include "baker/lod/merge_cells.h"
#include "foam/append_cells.h"
#include "foam/site_tree.h"

namespace froth {
namespace {

// A group with more live cells left than this share of them is not worth its bytes.
constexpr double kWorthwhileShare = 0.85;
constexpr uint32_t kNoCluster = 0xffffffff;
constexpr uint32_t kRoundPart = 4;         // pairs of a round of merges, at most, of the live cells of the fine form
constexpr uint32_t kLeastRoundPart = 256;  // a round with fewer is the last
// Merges of all rounds, at most, of the live cells that are not locked: three become one. With more the middle of a
// small group is much coarser than its borders.
constexpr double kMostMerged = 2.0 / 3;

class Coarsening {
 public:
  Coarsening(const LevelSource& source, const FineForm& fine) : source_(source), fine_(fine) {}

  Result<CoarseForm> run();

 private:
  bool isSteiner(uint32_t i) const { return source_.cells.sources[fine_.cells[i]] == kNoSource; }
  bool cutsLive(uint32_t i) const;
  void gatherFaces();
  void merge();
  // Between rounds of merges.
  struct MergedFoam {
    Foam cells;
    std::vector<double> contributions;           // [cells] or empty
    std::vector<uint8_t> isLocked;               // [cells]
    std::vector<std::vector<uint32_t>> members;  // [cells] of faced_
  };
  MergedFoam beginRound() const;
  MergedFoam mergeRound(MergedFoam& before, std::span<const CellPair> pairs) const;
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

  // Cells with faces: live ones, and those that only cut live ones.
  std::vector<uint32_t> faced_;        // indices of the fine form
  Foam faces_;                         // on the lattices
  std::vector<double> contributions_;  // [faced_] or empty

  std::vector<std::vector<uint32_t>> clusters_;  // cells that become one, of faced_
  Foam merged_;                                  // [clusters_]
  BakeCells mergedCells_;                        // the same on the lattices
  std::vector<uint8_t> isUndone_;                // [clusters_]
  std::vector<uint32_t> clusterOf_;              // [fine cells] kNoCluster: merges with no other
  std::vector<uint8_t> isDropped_;               // [fine cells]

  // Of the triangulation: kept cells of the fine form, merged cells, the ring.
  std::vector<uint32_t> kept_, standing_;  // indices of the fine form; of clusters_
  std::vector<glm::vec3> sites_;
  std::vector<float> radii_;
  RegularTriangulation triangulation_;
};

bool Coarsening::cutsLive(uint32_t i) const {
  // A live cell outside has no row here, and locks this one anyway.
  return std::ranges::any_of(neighboursOf(fine_.rows.alpha, i), [&](uint32_t neighbour) {
    const std::optional<uint32_t> place = fine_.placeOf(neighbour);
    return place && fine_.isLive[*place];
  });
}

void Coarsening::gatherFaces() {
  std::vector<uint32_t> sources;
  for (uint32_t i = 0; i < fine_.count(); ++i) {
    if (isSteiner(i) || !(fine_.isLive[i] || cutsLive(i))) continue;
    faced_.push_back(i);
    sources.push_back(source_.cells.sources[fine_.cells[i]]);
  }
  faces_ = gatherCells(source_.input, source_.merged, sources);
  for (size_t k = 0; k < faced_.size(); ++k) {
    const uint32_t cell = fine_.cells[faced_[k]];
    faces_.sites[k] = source_.cells.sites[cell];
    faces_.radii[k] = source_.cells.radii[cell];
    faces_.densities[k] = fine_.isLive[faced_[k]] ? source_.cells.densities[cell] : 0;
    if (!source_.contributions.empty()) contributions_.push_back(source_.contributions[sources[k]]);
  }
}

// In rounds: cells that show little merge again, and fewer of the others have to.
void Coarsening::merge() {
  MergedFoam round = beginRound();
  const auto most = static_cast<size_t>(kMostMerged * (form_.liveCount - form_.lockedLive));
  for (size_t left = std::min<size_t>(form_.liveCount / 2, most); left > 0;) {
    const size_t ofRound = std::min<size_t>(left, form_.liveCount / kRoundPart);
    const std::vector<CellPair> pairs =
        choosePairs(round.cells, round.isLocked, round.contributions, ofRound, source_.eyes);
    if (pairs.size() < form_.liveCount / kLeastRoundPart + 1) break;
    round = mergeRound(round, pairs);
    left -= pairs.size();
  }
  std::vector<uint32_t> merged;
  clusterOf_.assign(fine_.count(), kNoCluster);
  for (uint32_t cell = 0; cell < round.cells.cellCount; ++cell) {
    if (round.members[cell].size() < 2) continue;
    for (const uint32_t member : round.members[cell]) clusterOf_[faced_[member]] = static_cast<uint32_t>(merged.size());
    merged.push_back(cell);
    clusters_.push_back(std::move(round.members[cell]));
  }
  appendCells(round.cells, merged, merged_);
  mergedCells_ = snapCells(merged_, source_.lattices);
  isUndone_.assign(clusters_.size(), 0);
}

Coarsening::MergedFoam Coarsening::beginRound() const {
  MergedFoam round{faces_, contributions_, {}, {}};
  for (uint32_t k = 0; k < faced_.size(); ++k) {
    round.isLocked.push_back(fine_.isLocked[faced_[k]] || !fine_.isLive[faced_[k]]);
    round.members.push_back({k});
  }
  return round;
}

// Cells in no pair stay, in order; the merged ones come behind them.
Coarsening::MergedFoam Coarsening::mergeRound(MergedFoam& before, std::span<const CellPair> pairs) const {
  const Foam merged = mergePairs(before.cells, pairs, before.contributions, source_.eyes);
  std::vector<uint8_t> isPaired(before.cells.cellCount, 0);
  for (const CellPair& pair : pairs) isPaired[pair.first] = isPaired[pair.second] = 1;
  MergedFoam after;
  std::vector<uint32_t> kept, all(merged.cellCount);
  for (uint32_t cell = 0; cell < before.cells.cellCount; ++cell) {
    if (isPaired[cell]) continue;
    kept.push_back(cell);
    after.isLocked.push_back(before.isLocked[cell]);
    after.members.push_back(std::move(before.members[cell]));
    if (!before.contributions.empty()) after.contributions.push_back(before.contributions[cell]);
  }
  for (const CellPair& pair : pairs) {
    std::vector<uint32_t>& members = after.members.emplace_back(std::move(before.members[pair.first]));
    members.insert(members.end(), before.members[pair.second].begin(), before.members[pair.second].end());
    after.isLocked.push_back(0);
    if (before.contributions.empty()) continue;
    after.contributions.push_back(before.contributions[pair.first] + before.contributions[pair.second]);
  }
  std::iota(all.begin(), all.end(), 0u);
  appendCells(before.cells, kept, after.cells);
  appendCells(merged, all, after.cells);
  return after;
}

// Cells that are not live and cut no live one leave no trace in an image.
void Coarsening::dropOthers() {
  isDropped_.assign(fine_.count(), 0);
  std::vector<uint8_t> isFaced(fine_.count(), 0);
  for (const uint32_t i : faced_) isFaced[i] = 1;
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
  std::vector<uint32_t> all(clusters_.size());
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
  for (uint32_t k = 0; k < clusters_.size(); ++k) {
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
  std::vector<uint32_t> faulty;  // of clusters_
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
  for (uint32_t k = 0; k < faced_.size(); ++k) {
    const uint32_t i = faced_[k];
    if (!isDropped_[i] && (clusterOf_[i] == kNoCluster || isUndone_[clusterOf_[i]])) unmerged.push_back(k);
  }
  Foam coarse;
  appendCells(faces_, unmerged, coarse);
  appendCells(merged_, standing_, coarse);
  form_.distance = measureFormDistance(faces_, coarse);
}

Result<CoarseForm> Coarsening::run() {
  for (uint32_t i = 0; i < fine_.count(); ++i) {
    form_.liveCount += fine_.isLive[i];
    form_.lockedLive += fine_.isLive[i] && fine_.isLocked[i];
  }
  gatherFaces();
  merge();
  dropOthers();
  // Each round undoes a merge or drops a cell, so this ends; without any merge all borders are right.
  do {
    if (Status status = triangulate(); !status) return status.error();
  } while (undoFaults() || dropHidden());

  size_t liveLeft = form_.liveCount;
  for (const uint32_t k : standing_) liveLeft -= clusters_[k].size() - 1;
  form_.isWorthwhile = static_cast<double>(liveLeft) <= kWorthwhileShare * form_.liveCount;
  if (!form_.isWorthwhile) return std::move(form_);
  if (Status status = checkBorder(); !status) return status.error();
  fillRows();
  measure();
  for (const uint32_t i : kept_) form_.kept.push_back(fine_.cells[i]);
  appendCells(merged_, standing_, form_.merged);
  if (contributions_.empty()) return std::move(form_);
  for (const uint32_t k : standing_) {
    double& sum = form_.contributions.emplace_back(0);
    for (const uint32_t member : clusters_[k]) sum += contributions_[member];
  }
  return std::move(form_);
}

}  // namespace

Result<CoarseForm> makeCoarseForm(const LevelSource& source, const FineForm& fine) {
  return Coarsening(source, fine).run();
}

}  // namespace froth
