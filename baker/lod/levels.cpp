#include "baker/lod/levels.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include <tbb/task_arena.h>

#include "baker/cells/slices.h"
#include "baker/cells/snap_cells.h"
#include "baker/lod/border_numbers.h"
#include "baker/lod/chunk_groups.h"
#include "baker/lod/coarse_form.h"
#include "baker/lod/fine_form.h"
#include "baker/lod/fit_views.h"
#include "baker/lod/group_balls.h"
#include "baker/lod/level_errors.h"
#include "baker/lod/level_fit.h"
#include "baker/lod/level_front.h"
#include "baker/lod/level_step.h"
#include "baker/lod/merge_plan.h"
#include "baker/lod/merge_review.h"
#include "baker/lod/sights.h"
#include "baker/lod/split_form.h"
#include "foam/append_cells.h"
#include "reference/camera/view_rays.h"

namespace froth {
namespace {

constexpr uint32_t kGroupChunks = 4;  // full ones, of a group

class LevelMaker {
 public:
  LevelMaker(const LevelInput& input, BakeCells& cells, const Progress& progress)
      : input_(input),
        cells_(cells),
        progress_(progress),
        contributions_(input.visibility ? sumCellWeights(input.foam, *input.visibility) : std::vector<double>{}),
        errors_(input.views, {input.nearRatio, input.nearDepth}),
        fit_(input.fitsViews ? std::span<const View>(input.views) : std::span<const View>(),
             {input.nearRatio, input.nearDepth}) {
    for (const View& view : input.views) eyes_.emplace_back(eyeOf(view));
    if (input.visibility) levels_.sights = beginSights(*input.visibility, input.foam.detailCount);
  }

  Result<Levels> run();

 private:
  Status takeLevel0();
  bool isFloor() const;
  Status makeLevel();
  Status makeSteps(std::vector<LevelStep>& steps);
  void listGroups(std::vector<std::vector<uint32_t>> groups, std::vector<LevelStep>& steps) const;
  LevelSource source() const;
  bool planSteps(std::vector<LevelStep>& steps);
  Status reviewMerges(std::vector<LevelStep>& steps);
  bool keepApart(std::span<const uint32_t> merges, std::vector<LevelStep>& steps);
  bool makeForms(std::vector<LevelStep>& steps);
  static std::vector<uint32_t> findFailed(const std::vector<LevelStep>& steps);
  bool forEachStep(std::vector<LevelStep>& steps, const std::function<void(LevelStep&)>& work);
  Status addMergedCells(std::vector<LevelStep>& steps);
  void addSights(std::span<std::vector<uint32_t>> members);
  void splitStep(LevelStep& step) const;
  void addGroup(LevelStep& step);
  Status fitFront(LevelFront& front);
  Status measureFront(uint32_t firstGroup);
  std::vector<GroupBounds> findBounds() const;
  Levels collect();

  const LevelInput& input_;
  BakeCells& cells_;
  const Progress& progress_;
  std::vector<double> contributions_;  // [input cells, merged cells] or empty
  std::vector<glm::vec3> eyes_;        // of the views
  LevelErrors errors_;
  LevelFit fit_;

  std::vector<LevelChunk> chunks_;
  std::vector<uint32_t> front_;      // chunks that may get coarser
  uint32_t level_ = 0;               // of the front
  std::vector<uint8_t> staysApart_;  // [cells] 1: merges with none of this level
  Levels levels_;
};

Status LevelMaker::takeLevel0() {
  std::vector<uint32_t> owners(input_.foam.cellCount, kNoOwner);
  for (const PlannedChunk& planned : input_.plan.chunks) {
    const auto chunk = static_cast<uint32_t>(chunks_.size());
    for (const uint32_t cell : planned.cells) {
      if (cells_.sources[cell] != kNoSource) owners[cells_.sources[cell]] = chunk;
    }
    front_.push_back(chunk);
    chunks_.push_back({planned, gatherRows(input_.walk, input_.alpha, planned.cells), {}});
  }
  if (!errors_.isMeasuring() || isFloor()) return {};
  if (Status status = fit_.takeFinest(input_.foam, progress_); !status) return status;
  return errors_.takeFinest(input_.foam, owners, progress_);
}

// The floor is what a first image waits for, and stays resident: so it does not grow with the scene.
bool LevelMaker::isFloor() const {
  uint64_t live = 0;
  for (const uint32_t chunk : front_) live += chunks_[chunk].planned.liveCount;
  return front_.size() <= 1 || live <= input_.chunkCells;
}

// False: asked to stop.
bool LevelMaker::forEachStep(std::vector<LevelStep>& steps, const std::function<void(LevelStep&)>& work) {
  const StageProgress stage{progress_, "levels", 0, steps.size()};
  return forEachSlice(static_cast<uint32_t>(steps.size()), 1, stage, [&](uint32_t index) {
    // A thread that waits inside a group begins no other: memory holds as many groups as there are threads.
    tbb::this_task_arena::isolate([&] { work(steps[index]); });
  });
}

LevelSource LevelMaker::source() const {
  return {input_.foam, levels_.merged, cells_, contributions_, eyes_, input_.lattices};
}

// A group that is among the steps keeps what it has.
void LevelMaker::listGroups(std::vector<std::vector<uint32_t>> groups, std::vector<LevelStep>& steps) const {
  std::vector<LevelStep> before = std::exchange(steps, {});
  for (std::vector<uint32_t>& group : groups) {
    const auto same = std::ranges::find(before, group, &LevelStep::group);
    steps.push_back(same != before.end() ? std::move(*same) : LevelStep{std::move(group)});
  }
}

// Of steps without merges and form. False: asked to stop.
bool LevelMaker::planSteps(std::vector<LevelStep>& steps) {
  return forEachStep(steps, [&](LevelStep& step) {
    if (!step.merges && !step.form) step.merges = planMerges(source(), makeFineForm(chunks_, step.group), staysApart_);
  });
}

// Of steps without a form. False: asked to stop.
bool LevelMaker::makeForms(std::vector<LevelStep>& steps) {
  return forEachStep(steps, [&](LevelStep& step) {
    if (step.form) return;
    FineForm fine = makeFineForm(chunks_, step.group);
    step.form = makeCoarseForm(source(), fine, *step.merges);
    step.merges.reset();
    step.ring = std::move(fine.ring);
  });
}

// Cells whose merges stand out in pictures merge with none, and others do, for as long as all pictures gain by it.
Status LevelMaker::reviewMerges(std::vector<LevelStep>& steps) {
  uint64_t& reviews = levels_.reports.back().reviews;
  double before = std::numeric_limits<double>::infinity();
  std::vector<uint8_t> apartBefore;
  for (; errors_.isMeasuring() && reviews < kReviews; ++reviews) {
    std::vector<const MergePlan*> plans;
    for (const LevelStep& step : steps) plans.push_back(&*step.merges);
    const Result<LevelErrors::OwnerErrors> errors = drawPlans(source(), chunks_, plans, errors_, fit_, progress_);
    if (!errors) return errors.error();
    if (errors->ofAll > kKeptByReview * before) {
      for (LevelStep& step : steps) step.takeBack();
      staysApart_ = apartBefore;
      --reviews;
      break;
    }
    const std::vector<uint32_t> outliers = findOutliers(errors->ofOwners);
    if (outliers.empty()) break;
    before = errors->ofAll;
    apartBefore = staysApart_;
    if (!keepApart(outliers, steps)) return stoppedOnRequest("bake");
  }
  for (LevelStep& step : steps) step.replaced.reset();
  return {};
}

// Cells of the listed merges, numbered through the steps, ascending; their steps are planned again. False: asked to
// stop.
bool LevelMaker::keepApart(std::span<const uint32_t> merges, std::vector<LevelStep>& steps) {
  uint32_t first = 0;
  auto next = merges.begin();
  for (LevelStep& step : steps) {
    const auto count = static_cast<uint32_t>(step.merges->clusters.size());
    const bool isAny = next != merges.end() && *next < first + count;
    for (; next != merges.end() && *next < first + count; ++next) {
      for (const uint32_t cell : step.merges->clusters[*next - first]) staysApart_[cell] = 1;
    }
    step.replaced = isAny ? std::exchange(step.merges, std::nullopt) : std::nullopt;
    first += count;
  }
  return planSteps(steps);
}

// Indices of those whose form is not worth its bytes.
std::vector<uint32_t> LevelMaker::findFailed(const std::vector<LevelStep>& steps) {
  std::vector<uint32_t> failed;
  for (uint32_t index = 0; index < steps.size(); ++index) {
    const Result<CoarseForm>& form = *steps[index].form;
    if (form && !form->isWorthwhile) failed.push_back(index);
  }
  return failed;
}

// Chunks that do not get coarser lock what is beside them on all levels above, and stay in the floor: so a group that
// fails merges what it kept apart, and if that is not enough its chunks go to the groups around it.
Status LevelMaker::makeSteps(std::vector<LevelStep>& steps) {
  const uint64_t groupLive = uint64_t{kGroupChunks} * input_.chunkCells;
  const std::vector<std::vector<uint32_t>> groups = groupChunks(chunks_, front_, cells_.count(), groupLive);
  staysApart_.assign(cells_.count(), 0);
  listGroups(groups, steps);
  if (!planSteps(steps)) return stoppedOnRequest("bake");
  if (Status status = reviewMerges(steps); !status) return status;
  if (!makeForms(steps)) return stoppedOnRequest("bake");
  for (const uint32_t index : findFailed(steps)) {
    for (const uint32_t chunk : groups[index]) {
      for (const uint32_t cell : chunks_[chunk].planned.cells) staysApart_[cell] = 0;
    }
    steps[index] = {groups[index]};
  }
  if (!planSteps(steps) || !makeForms(steps)) return stoppedOnRequest("bake");
  const std::vector<uint32_t> failed = findFailed(steps);
  if (failed.empty()) return {};
  listGroups(dissolveGroups(chunks_, groups, failed, cells_.count(), groupLive), steps);
  return planSteps(steps) && makeForms(steps) ? Status() : Status(stoppedOnRequest("bake"));
}

Status LevelMaker::makeLevel() {
  levels_.reports.emplace_back();
  std::vector<LevelStep> steps;
  if (Status status = makeSteps(steps); !status) return status;
  if (Status status = addMergedCells(steps); !status) return status;
  if (!forEachStep(steps, [&](LevelStep& step) { splitStep(step); })) return stoppedOnRequest("bake");
  front_.clear();
  const auto firstGroup = static_cast<uint32_t>(levels_.groups.size());
  for (LevelStep& step : steps) {
    if (!step.status) return step.status;
    if ((*step.form)->isWorthwhile) addGroup(step);
  }
  ++level_;
  return measureFront(firstGroup);
}

// In the order of groups, so that each cell's number is the same on any number of threads.
Status LevelMaker::addMergedCells(std::vector<LevelStep>& steps) {
  LevelReport& report = levels_.reports.back();
  for (LevelStep& step : steps) {
    if (!*step.form) return step.form->error();
    CoarseForm& form = **step.form;
    report.live += form.liveCount;
    report.locked += form.lockedLive;
    report.undone += form.undone;
    report.rounds += form.rounds;
    ++(form.isWorthwhile ? report.groups : report.failed);
    if (!form.isWorthwhile) continue;
    report.merges += form.merged.cellCount;
    step.firstMerged = cells_.count();
    addSights(form.members);
    const BakeCells snapped = snapCells(form.merged, input_.lattices);
    cells_.sites.insert(cells_.sites.end(), snapped.sites.begin(), snapped.sites.end());
    cells_.radii.insert(cells_.radii.end(), snapped.radii.begin(), snapped.radii.end());
    cells_.densities.insert(cells_.densities.end(), snapped.densities.begin(), snapped.densities.end());
    const uint32_t firstSource = input_.foam.cellCount + levels_.merged.cellCount;
    for (const uint32_t row : snapped.sources) cells_.sources.push_back(firstSource + row);
    appendCells(form.merged, snapped.sources, levels_.merged);
    contributions_.insert(contributions_.end(), form.contributions.begin(), form.contributions.end());
    form.merged = {};
    form.members = {};
  }
  return {};
}

// Of the merged cells of a form.
void LevelMaker::addSights(std::span<std::vector<uint32_t>> members) {
  if (!levels_.sights) return;
  for (std::vector<uint32_t>& cells : members) {
    for (uint32_t& cell : cells) cell = cells_.sources[cell];
    appendSights(*input_.visibility, input_.foam.cellCount, cells, *levels_.sights);
  }
}

void LevelMaker::splitStep(LevelStep& step) const {
  if (!(*step.form)->isWorthwhile) return;
  Result<std::vector<LevelChunk>> made =
      splitForm(**step.form, step.ring, step.firstMerged, cells_, input_.chunkCells, input_.lattices.positionStep);
  step.status = made ? Status() : Status(made.error());
  if (made) step.made = std::move(*made);
}

// Its ball holds those of the groups that made its chunks.
void LevelMaker::addGroup(LevelStep& step) {
  const auto number = static_cast<uint32_t>(levels_.groups.size());
  std::vector<GroupBall> balls;
  for (const uint32_t index : step.group) {
    LevelChunk& chunk = chunks_[index];
    chunk.place.in = number;
    addLiveBalls(cells_, chunk.planned, balls);
    if (chunk.place.madeBy == kNoGroup) continue;
    const LevelGroup& finer = levels_.groups[chunk.place.madeBy];
    balls.push_back({{finer.centre[0], finer.centre[1], finer.centre[2]}, finer.radius});
  }
  for (LevelChunk& chunk : step.made) {
    chunk.place = {level_ + 1, number, kNoGroup};
    addLiveBalls(cells_, chunk.planned, balls);
    front_.push_back(static_cast<uint32_t>(chunks_.size()));
    chunks_.push_back(std::move(chunk));
  }
  const GroupBall bound = boundBalls(balls);
  levels_.groups.push_back(
      {{bound.centre.x, bound.centre.y, bound.centre.z}, bound.radius, (*step.form)->distance, level_});
}

// The merged cells of the newest level descend towards the views; finer levels have all others.
Status LevelMaker::fitFront(LevelFront& front) {
  const auto newest = static_cast<uint32_t>(levels_.reports.back().merges);
  const uint32_t firstNew = input_.foam.cellCount + levels_.merged.cellCount - newest;
  std::vector<uint8_t> isFree;
  for (const uint32_t cell : front.cells) isFree.push_back(cells_.sources[cell] >= firstNew ? 1 : 0);
  if (Status status = fit_.fit(front.foam, isFree, kFitViews, progress_); !status) return status;
  for (uint32_t k = 0; k < front.foam.cellCount; ++k) {
    if (!isFree[k]) continue;
    float& density = front.foam.densities[k];
    density = roundMantissa(density, input_.lattices.densityBits);
    if (density > 0) cells_.densities[front.cells[k]] = density;
    copyFittedFace(front.foam, k, levels_.merged, cells_.sources[front.cells[k]] - input_.foam.cellCount);
  }
  return {};
}

Status LevelMaker::measureFront(uint32_t firstGroup) {
  const auto groupCount = static_cast<uint32_t>(levels_.groups.size());
  if (!errors_.isMeasuring() || firstGroup == groupCount) return {};
  LevelFront front = gatherFront(source(), chunks_);
  if (Status status = fit_.isFitting() ? fitFront(front) : Status(); !status) return status;
  return errors_.addLevel(front.foam, front.owners, chunks_, firstGroup, groupCount, progress_);
}

std::vector<GroupBounds> LevelMaker::findBounds() const {
  std::vector<ChunkLevel> places;
  std::vector<Box> boxes;
  for (const LevelChunk& chunk : chunks_) {
    places.push_back(chunk.place);
    boxes.push_back(boxAroundLive(cells_, chunk.planned));
  }
  return boundGroups(places, levels_.groups, boxes);
}

Levels LevelMaker::collect() {
  if (levels_.groups.empty()) return {};
  if (levels_.sights) normaliseSights(levels_.reports, *levels_.sights);
  errors_.finish(chunks_, findBounds(), levels_.groups);
  const auto rank = [&](uint32_t chunk) {
    const ChunkLevel& place = chunks_[chunk].place;
    return std::pair(place.in != kNoGroup, -int64_t{place.level});
  };
  std::vector<uint32_t> order(chunks_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return rank(a) < rank(b); });
  for (const uint32_t index : order) {
    LevelChunk& chunk = chunks_[index];
    levels_.plan.chunks.push_back(std::move(chunk.planned));
    levels_.rows.push_back(std::move(chunk.rows));
    levels_.places.push_back(chunk.place);
  }
  levels_.plan.refs = numberBorders(levels_.plan.chunks, levels_.rows, cells_.count(), levels_.borderCount);
  return std::move(levels_);
}

Result<Levels> LevelMaker::run() {
  if (Status status = takeLevel0(); !status) return status.error();
  while (!isFloor()) {
    if (Status status = makeLevel(); !status) return status.error();
  }
  Levels levels = collect();
  if (levels.groups.empty()) return levels;
  const Result<uint32_t> localBits = chooseLocalBits(levels.plan.chunks);
  if (!localBits) return localBits.error();
  levels.plan.localBits = *localBits;
  return levels;
}

}  // namespace

Result<Levels> makeLevels(const LevelInput& input, BakeCells& cells, const Progress& progress) {
  return LevelMaker(input, cells, progress).run();
}

}  // namespace froth
