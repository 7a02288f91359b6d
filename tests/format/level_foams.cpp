#include "level_foams.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <set>
#include <utility>

namespace froth {
namespace {

using Pair = std::pair<uint32_t, uint32_t>;

LevelFoam triangulate(std::vector<LevelCell> cells) {
  const SiteArrays arrays = arraysOf(cells);
  Result<RegularTriangulation> triangulation = triangulateRegular(arrays.sites, arrays.radii);
  if (!triangulation) std::abort();
  return {std::move(cells), std::move(*triangulation)};
}

// Level 0: quadrants of x and y; level 1: halves of z. So all borders of one level are inside groups of the other.
uint32_t groupOf(const LevelCell& cell, uint32_t level) {
  if (level == 0) return (cell.site.x > 0 ? 1u : 0u) + (cell.site.y > 0 ? 2u : 0u);
  return level == 1 ? kLevelSampleGroups[0] + (cell.site.z > 0 ? 1u : 0u) : kNoGroup;
}

LevelFoam makeFinest(const LevelSampleOptions& options) {
  LevelRandom random(options.seed);
  const float spacing = 2 / std::cbrt(static_cast<float>(options.cellCount));
  std::vector<LevelCell> cells(options.cellCount);
  for (uint32_t i = 0; i < cells.size(); ++i) {
    LevelCell& cell = cells[i];
    cell.site = {random.snapped(), random.snapped(), random.snapped()};
    cell.radius = spacing * (0.4f + 0.4f * random());
    cell.density = i % 7 == 0 ? 0 : 3 / cell.radius;
    cell.colour = {random(), random(), random()};
    cell.in = groupOf(cell, 0);
  }
  const LevelFoam all = triangulate(cells);
  std::vector<LevelCell> kept;
  for (uint32_t i = 0; i < cells.size(); ++i) {
    if (!all.triangulation.isHidden[i]) kept.push_back(cells[i]);
  }
  for (uint32_t i = 0; i < kept.size(); ++i) kept[i].number = i;
  return triangulate(std::move(kept));
}

LevelCell merge(const LevelCell& a, const LevelCell& b, uint32_t number) {
  LevelCell cell;
  cell.number = number;
  for (int axis = 0; axis < 3; ++axis) {
    cell.site[axis] = snapToStep((a.site[axis] + b.site[axis]) / 2, static_cast<float>(kLevelSampleStep));
  }
  cell.radius = 1.05f * std::max(a.radius, b.radius) + 0.3f * glm::length(a.site - b.site);
  cell.density = (a.density + b.density) / 2;
  cell.colour = (a.colour + b.colour) / 2.0f;
  cell.in = a.in;
  return cell;
}

// Makes a level coarser.
class Coarsener {
 public:
  explicit Coarsener(const LevelFoam& fine) : fine_(fine) {
    for (uint32_t i = 0; i < fine_.cells.size(); ++i) firstNumber_ = std::max(firstNumber_, fine_.cells[i].number + 1);
    finePairs_ = crossPairs(fine_);
  }

  LevelFoam coarsen(uint32_t level) {
    choosePairs();
    while (true) {
      LevelFoam coarse = makeCoarse();
      const std::set<uint32_t> bad = findBad(coarse);
      if (bad.empty()) return finish(std::move(coarse), level);
      std::erase_if(merges_, [&](const Pair& pair) { return bad.contains(pair.first); });
    }
  }

 private:
  // Pairs across groups, by the numbers of the cells.
  static std::set<Pair> crossPairs(const LevelFoam& foam) {
    std::set<Pair> pairs;
    for (uint32_t i = 0; i < foam.cells.size(); ++i) {
      for (const uint32_t j : foam.neighbours(i)) {
        if (foam.cells[i].in != foam.cells[j].in) pairs.emplace(foam.cells[i].number, foam.cells[j].number);
      }
    }
    return pairs;
  }

  bool isLocked(uint32_t cell) const {
    const auto row = fine_.neighbours(cell);
    return std::any_of(row.begin(), row.end(), [&](uint32_t j) { return fine_.cells[j].in != fine_.cells[cell].in; });
  }

  // Each free cell with the nearest free neighbour that is left.
  void choosePairs() {
    std::vector<uint8_t> isTaken(fine_.cells.size());
    for (uint32_t i = 0; i < isTaken.size(); ++i) isTaken[i] = isLocked(i) ? 1 : 0;
    const auto distance = [&](uint32_t i, uint32_t j) {
      return glm::length(fine_.cells[i].site - fine_.cells[j].site);
    };
    for (uint32_t i = 0; i < isTaken.size(); ++i) {
      if (isTaken[i]) continue;
      uint32_t best = i;
      for (const uint32_t j : fine_.neighbours(i)) {
        if (!isTaken[j] && (best == i || distance(i, j) < distance(i, best))) best = j;
      }
      if (best == i) continue;
      isTaken[i] = isTaken[best] = 1;
      merges_.emplace_back(i, best);
    }
  }

  // A merged cell's number tells the first of its two.
  LevelFoam makeCoarse() const {
    std::vector<LevelCell> cells;
    std::set<uint32_t> isMerged;
    for (const auto& [a, b] : merges_) isMerged.insert({a, b});
    for (uint32_t i = 0; i < fine_.cells.size(); ++i) {
      if (!isMerged.contains(i)) cells.push_back(fine_.cells[i]);
    }
    for (const auto& [a, b] : merges_) cells.push_back(merge(fine_.cells[a], fine_.cells[b], firstNumber_ + a));
    return triangulate(std::move(cells));
  }

  // First cells of the merges beside a cell of this number.
  void addMergesBeside(uint32_t number, std::set<uint32_t>& bad) const {
    if (number >= firstNumber_) bad.insert(number - firstNumber_);
    for (const auto& [a, b] : merges_) {
      for (const uint32_t end : {a, b}) {
        const auto row = fine_.neighbours(end);
        const auto isIt = [&](uint32_t j) { return fine_.cells[j].number == number; };
        if (std::any_of(row.begin(), row.end(), isIt)) bad.insert(a);
      }
    }
  }

  // First cells of the merges to undo: they hide a cell, or change pairs across groups.
  std::set<uint32_t> findBad(const LevelFoam& coarse) const {
    std::set<uint32_t> bad;
    for (uint32_t i = 0; i < coarse.cells.size(); ++i) {
      if (coarse.triangulation.isHidden[i]) addMergesBeside(coarse.cells[i].number, bad);
    }
    const std::set<Pair> coarsePairs = crossPairs(coarse);
    std::vector<Pair> changed;
    std::set_symmetric_difference(finePairs_.begin(), finePairs_.end(), coarsePairs.begin(), coarsePairs.end(),
                                  std::back_inserter(changed));
    for (const auto& [a, b] : changed) {
      addMergesBeside(a, bad);
      addMergesBeside(b, bad);
    }
    if (bad.empty() && !changed.empty()) {
      for (const Pair& pair : merges_) bad.insert(pair.first);
    }
    return bad;
  }

  static LevelFoam finish(LevelFoam coarse, uint32_t level) {
    for (LevelCell& cell : coarse.cells) {
      cell.madeBy = cell.in;
      cell.in = groupOf(cell, level + 1);
    }
    return coarse;
  }

  const LevelFoam& fine_;
  uint32_t firstNumber_ = 0;  // of merged cells
  std::set<Pair> finePairs_;
  std::vector<Pair> merges_;
};

}  // namespace

SiteArrays arraysOf(const std::vector<LevelCell>& cells) {
  SiteArrays arrays;
  for (const LevelCell& cell : cells) {
    arrays.sites.push_back(cell.site);
    arrays.radii.push_back(cell.radius);
  }
  return arrays;
}

std::vector<LevelFoam> makeLevelFoams(const LevelSampleOptions& options) {
  std::vector<LevelFoam> levels{makeFinest(options)};
  for (uint32_t level = 0; level < std::size(kLevelSampleGroups); ++level) {
    LevelFoam coarse = Coarsener(levels.back()).coarsen(level);
    levels.push_back(std::move(coarse));
  }
  return levels;
}

}  // namespace froth
