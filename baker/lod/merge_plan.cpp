#include "baker/lod/merge_plan.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "baker/lod/choose_pairs.h"
#include "foam/append_cells.h"

namespace froth {
namespace {

constexpr uint32_t kRoundPart = 4;         // pairs of a round of merges, at most, of the live cells of the fine form
constexpr uint32_t kLeastRoundPart = 256;  // a round with fewer is the last
// Merges of all rounds, at most, of the live cells that are not locked: three become one. With more the middle of a
// small group is much coarser than its borders.
constexpr double kMostMerged = 2.0 / 3;

bool cutsLive(const FineForm& fine, uint32_t i) {
  // A live cell outside has no row here, and locks this one anyway.
  return std::ranges::any_of(neighboursOf(fine.rows.alpha, i), [&](uint32_t neighbour) {
    const std::optional<uint32_t> place = fine.placeOf(neighbour);
    return place && fine.isLive[*place];
  });
}

MergedFoam beginRounds(const LevelSource& source, const FineForm& fine, std::span<const uint8_t> staysApart) {
  FacedCells faced = gatherFaced(source, fine);
  MergedFoam begun{std::move(faced.faces), std::move(faced.contributions), {}, {}};
  for (const uint32_t i : faced.cells) {
    begun.isLocked.push_back(fine.isLocked[i] || !fine.isLive[i] || staysApart[fine.cells[i]]);
    begun.members.push_back({fine.cells[i]});
  }
  return begun;
}

MergePlan collectPlan(MergedFoam& foam) {
  MergePlan plan;
  std::vector<uint32_t> merged;
  for (uint32_t cell = 0; cell < foam.cells.cellCount; ++cell) {
    if (foam.members[cell].size() < 2) continue;
    merged.push_back(cell);
    plan.clusters.push_back(std::move(foam.members[cell]));
    if (!foam.contributions.empty()) plan.contributions.push_back(foam.contributions[cell]);
  }
  appendCells(foam.cells, merged, plan.merged);
  return plan;
}

}  // namespace

FacedCells gatherFaced(const LevelSource& source, const FineForm& fine) {
  FacedCells faced;
  std::vector<uint32_t> cells;
  std::vector<uint8_t> isLive;
  for (uint32_t i = 0; i < fine.count(); ++i) {
    const uint32_t row = source.cells.sources[fine.cells[i]];
    if (row == kNoSource || !(fine.isLive[i] || cutsLive(fine, i))) continue;
    faced.cells.push_back(i);
    cells.push_back(fine.cells[i]);
    isLive.push_back(fine.isLive[i]);
    if (!source.contributions.empty()) faced.contributions.push_back(source.contributions[row]);
  }
  faced.faces = gatherSnapped(source, cells, isLive);
  return faced;
}

MergedFoam mergeRound(MergedFoam& before, std::span<const CellPair> pairs, std::span<const glm::vec3> eyes) {
  const Foam merged = mergePairs(before.cells, pairs, before.contributions, eyes);
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

// In rounds: cells that show little merge again, and fewer of the others have to.
MergePlan planMerges(const LevelSource& source, const FineForm& fine, std::span<const uint8_t> staysApart) {
  const size_t live = fine.liveCount;
  MergedFoam round = beginRounds(source, fine, staysApart);
  const auto most = static_cast<size_t>(kMostMerged * (fine.liveCount - fine.lockedLive));
  for (size_t left = std::min(live / 2, most); left > 0;) {
    const size_t ofRound = std::min(left, live / kRoundPart);
    const std::vector<CellPair> pairs =
        choosePairs(round.cells, round.isLocked, round.contributions, ofRound, source.eyes);
    if (pairs.size() < live / kLeastRoundPart + 1) break;
    round = mergeRound(round, pairs, source.eyes);
    left -= pairs.size();
  }
  return collectPlan(round);
}

}  // namespace froth
