#include "trainer/cuda/cuda_step.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "trainer/step/tiles.h"

namespace froth {
namespace {

// Runs calls until one fails.
template <class... Calls>
Status inTurn(const Calls&... calls) {
  Status status;
  (void)((status = calls(), static_cast<bool>(status)) && ...);
  return status;
}

template <size_t kCount>
Status resizeAll(DeviceArray<uint32_t> (&arrays)[kCount], size_t size, const char* name) {
  Status status;
  for (size_t i = 0; i < kCount && status; ++i) status = arrays[i].resize(size, name);
  return status;
}

// The first guess of a view's entries; more make it grow.
constexpr uint32_t kFirstEntries = 1u << 20;

}  // namespace

CudaStep::~CudaStep() {
  if (stream_) cudaStreamDestroy(stream_);
}

Status CudaStep::start(bool isDeterministic) {
  isDeterministic_ = isDeterministic;
  return inTurn(
      [&] { return checkCuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "cudaStreamCreate"); },
      [&] { return counters_.upload({StepCounters{}}, "counters", stream_); });
}

void CudaStep::point() {
  TrainedFoam<float>& foam = arrays_.foam;
  for (size_t i = 0; i < kParameterCount; ++i) {
    foam.values.tensors[i] = tensors_[i].values.data();
    foam.firstMoments.tensors[i] = tensors_[i].firstMoments.data();
    foam.secondMoments.tensors[i] = tensors_[i].secondMoments.data();
  }
  foam.lastSteps = lastSteps_.data();
  foam.balls = balls_.data();
  foam.contributions = contributions_.data();
  foam.errors = errors_.data();
  arrays_.foundBalls = foundBalls_.data();
  arrays_.slacks = slacks_.data();
  arrays_.pairs = {offsets_.data(), neighbours_.data(), reverses_.data()};
  arrays_.seen = {0, seenCells_.data(), planes_.data(), details_.data(), rankOf_.data()};
  arrays_.pairOfPlane = pairOfPlane_.data();
  arrays_.counters = counters_.data();
  arrays_.sums = {cellSums_.data(), detailSums_.data(), pairSums_.data(), nullptr};
  arrays_.fixedSums = {fixedCellSums_.data(), fixedDetailSums_.data(), fixedPairSums_.data(),
                       fixedCellSums_.size(), fixedDetailSums_.size(), fixedPairSums_.size()};
  arrays_.pixels = {rendered_.data(), logTransmittances_.data(), ends_.data(), gradients_.data(), wanted_.data()};
  uint32_t** const byCell[kArraysByCell] = {&arrays_.powerKeys,   &arrays_.sortedKeys, &arrays_.cells,
                                            &arrays_.sortedCells, &arrays_.tileCounts, &arrays_.planesBegin,
                                            &arrays_.entriesBegin};
  for (size_t i = 0; i < kArraysByCell; ++i) *byCell[i] = byCell_[i].data();
  uint32_t** const byEntry[kArraysByEntry] = {&arrays_.entryTiles, &arrays_.sortedTiles, &arrays_.entryRanks,
                                              &arrays_.sortedRanks};
  for (size_t i = 0; i < kArraysByEntry; ++i) *byEntry[i] = byEntry_[i].data();
  uint32_t** const byTile[kArraysByTile] = {&arrays_.tileLengths, &arrays_.sortedTileLengths, &arrays_.tiles,
                                            &arrays_.tileOrder};
  for (size_t i = 0; i < kArraysByTile; ++i) *byTile[i] = byTile_[i].data();
  arrays_.tileCones = tileCones_.data();
  arrays_.groupCones = groupCones_.data();
  arrays_.tilesBegin = tilesBegin_.data();
  arrays_.metEntries = metEntries_.data();
  arrays_.entryCapacity = static_cast<uint32_t>(byEntry_[0].size());
}

Status CudaStep::upload(const FoamStorage<float>& foam) {
  Status status;
  for (size_t i = 0; i < kParameterCount && status; ++i) {
    const char* name = kParameterKeys[i].data();
    status = inTurn([&] { return tensors_[i].values.upload(foam.values[i], name, stream_); },
                    [&] { return tensors_[i].firstMoments.upload(foam.firstMoments[i], name, stream_); },
                    [&] { return tensors_[i].secondMoments.upload(foam.secondMoments[i], name, stream_); });
    if (status && foam.averagedSteps > 0) {
      status = tensors_[i].meanValues.upload(foam.meanValues[i], name, stream_);
    }
  }
  if (!status) return status;
  averagedSteps_ = foam.averagedSteps;
  hasPairs_ = false;
  return inTurn([&] { return lastSteps_.upload(foam.lastSteps, "last steps", stream_); },
                [&] { return contributions_.upload(foam.contributions, "contributions", stream_); },
                [&] { return errors_.upload(foam.errors, "errors", stream_); },
                [&] { return reserveCells(foam.shape); }, [&] { return reserveEntries(kFirstEntries); });
}

Status CudaStep::reserveCells(const FoamShape& shape) {
  const size_t cells = shape.cellCount, details = cells * shape.detailCount;
  const Status status = inTurn(
      [&] { return resizeAll(byCell_, cells, "numbers of cells"); }, [&] { return balls_.resize(cells, "balls"); },
      [&] { return foundBalls_.resize(cells, "balls of pairs"); },
      [&] { return enlargedBalls_.resize(cells, "enlarged balls"); }, [&] { return slacks_.resize(cells, "slacks"); },
      [&] { return boxes_.resize(size_t{2} * blocksOfCells(cells), "boxes of cells"); },
      [&] { return offsets_.resize(cells + 1, "offsets of pairs"); },
      [&] { return seenCells_.resize(cells, "seen cells"); }, [&] { return rankOf_.resize(cells, "ranks"); },
      [&] { return cellSums_.resize(cells, "sums of cells"); },
      [&] { return details_.resize(details, "seen details"); },
      [&] { return detailSums_.resize(details, "sums of details"); });
  arrays_.foam.shape = shape;
  return inTurn([&] { return status; }, [&] { return clearFixedSums(); });
}

// As many numbers as the floats have, all 0.
Status CudaStep::clearFixedSums() {
  const auto clear = [&](DeviceArray<FixedNumber>& fixed, const auto& sums) {
    const size_t numbers = sums.size() * (sizeof(*sums.data()) / sizeof(float));
    return inTurn([&] { return fixed.resize(numbers, "sums of whole numbers"); },
                  [&] {
                    const size_t bytes = numbers * sizeof(FixedNumber);
                    return checkCuda(cudaMemsetAsync(fixed.data(), 0, bytes, stream_), "sums of whole numbers");
                  });
  };
  Status status;
  if (isDeterministic_) {
    status =
        inTurn([&] { return clear(fixedCellSums_, cellSums_); }, [&] { return clear(fixedDetailSums_, detailSums_); },
               [&] { return clear(fixedPairSums_, pairSums_); });
  }
  point();
  return status;
}

Status CudaStep::download(FoamStorage<float>& foam) {
  resizeStorage(foam, arrays_.foam.shape);
  foam.meanValues = {};
  foam.averagedSteps = averagedSteps_;
  Status status;
  for (size_t i = 0; i < kParameterCount && status; ++i) {
    const char* name = kParameterKeys[i].data();
    status = inTurn([&] { return tensors_[i].values.download(foam.values[i], name, stream_); },
                    [&] { return tensors_[i].firstMoments.download(foam.firstMoments[i], name, stream_); },
                    [&] { return tensors_[i].secondMoments.download(foam.secondMoments[i], name, stream_); });
    if (status && averagedSteps_ > 0) status = tensors_[i].meanValues.download(foam.meanValues[i], name, stream_);
  }
  if (!status) return status;
  return inTurn([&] { return lastSteps_.download(foam.lastSteps, "last steps", stream_); },
                [&] { return balls_.download(foam.balls, "balls", stream_); },
                [&] { return contributions_.download(foam.contributions, "contributions", stream_); },
                [&] { return errors_.download(foam.errors, "errors", stream_); });
}

Status CudaStep::downloadFacts(FoamStorage<float>& foam, std::vector<uint32_t>& overlaps) {
  constexpr auto kQuaternions = static_cast<size_t>(Parameter::kOrientations);
  DeviceArray<uint32_t> counts;
  return inTurn(
      [&] { return counts.resize(cellCount(), "overlaps"); },
      [&] { return countCellOverlaps(arrays_, counts.data(), stream_); },
      [&] { return counts.download(overlaps, "overlaps", stream_); },
      [&] { return tensors_[kQuaternions].values.download(foam.values[kQuaternions], "orientations", stream_); },
      [&] { return balls_.download(foam.balls, "balls", stream_); },
      [&] { return contributions_.download(foam.contributions, "contributions", stream_); },
      [&] { return errors_.download(foam.errors, "errors", stream_); });
}

Status CudaStep::downloadPairs(CellGraph& graph, std::vector<uint32_t>& reverses) {
  return inTurn([&] { return offsets_.download(graph.offsets, "offsets of pairs", stream_); },
                [&] { return neighbours_.download(graph.neighbours, "pairs", stream_); },
                [&] { return reverses_.download(reverses, "reverse pairs", stream_); },
                [&]() -> Status {
                  graph.neighbours.resize(graph.offsets.back());  // behind them is room
                  reverses.resize(graph.offsets.back());
                  return {};
                });
}

Status CudaStep::rearrange(const CellPlan& plan) {
  FoamShape shape = arrays_.foam.shape;
  shape.cellCount = static_cast<uint32_t>(plan.sources.size());
  DeviceArray<uint32_t> sources;
  DeviceArray<CellChange> changes;
  const auto gather = [&](auto& array, uint32_t width, const char* name) -> Status {
    std::remove_reference_t<decltype(array)> next;
    if (Status made = next.resize(size_t{shape.cellCount} * width, name); !made) return made;
    const Status gathered = gatherRows(array.data(), next.data(), sources.data(), shape.cellCount, width, stream_);
    std::swap(array, next);
    return gathered;
  };
  Status status =
      inTurn([&] { return sources.upload(plan.sources, "sources of cells", stream_); },
             [&] { return changes.upload(plan.changes, "changes of cells", stream_); },
             [&] { return gather(lastSteps_, 1, "last steps"); },
             [&] { return gather(contributions_, 1, "contributions"); }, [&] { return gather(errors_, 1, "errors"); });
  for (size_t i = 0; i < kParameterCount && status; ++i) {
    const uint32_t width = widthOf(static_cast<Parameter>(i), shape);
    const char* name = kParameterKeys[i].data();
    status = inTurn([&] { return gather(tensors_[i].values, width, name); },
                    [&] { return gather(tensors_[i].firstMoments, width, name); },
                    [&] { return gather(tensors_[i].secondMoments, width, name); });
  }
  hasPairs_ = false;
  averagedSteps_ = 0;
  return inTurn([&] { return status; }, [&] { return reserveCells(shape); },
                [&] { return changeCells(arrays_, changes.data(), stream_); },
                [&] { return checkCuda(cudaStreamSynchronize(stream_), "rearrangement of cells"); });
}

Status CudaStep::average() {
  ParameterRows<float> means{};
  for (size_t i = 0; i < kParameterCount; ++i) {
    DeviceArray<float>& tensor = tensors_[i].meanValues;
    if (Status made = tensor.resize(tensors_[i].values.size(), "mean values"); !made) return made;
    means.tensors[i] = tensor.data();
  }
  return mark(averageValues(arrays_.foam, means, ++averagedSteps_, stream_), "average");
}

Status CudaStep::takeMeans() {
  if (averagedSteps_ == 0) return {};
  for (Tensors& tensors : tensors_) {
    tensors.values = std::exchange(tensors.meanValues, {});
    const DeviceArray<float>& moments = tensors.firstMoments;
    const Status cleared =
        checkCuda(cudaMemsetAsync(moments.data(), 0, moments.size() * sizeof(float), stream_), "first moments");
    if (!cleared) return cleared;
  }
  averagedSteps_ = 0;
  hasPairs_ = false;
  point();
  return {};
}

Status CudaStep::findPairs(float leastSkin) {
  PairLists lists{enlargedBalls_.data(), boxes_.data(), offsets_.data(), nullptr, nullptr};
  if (Status counted = countPairs(arrays_, lists, leastSkin, scratch_, stream_); !counted) return counted;
  uint32_t pairs = 0;
  const Status read = inTurn(
      [&] {
        return checkCuda(cudaMemcpyAsync(&pairs, offsets_.data() + arrays_.foam.shape.cellCount, sizeof(pairs),
                                         cudaMemcpyDeviceToHost, stream_),
                         "number of pairs");
      },
      [&] { return checkCuda(cudaStreamSynchronize(stream_), "number of pairs"); });
  if (!read) return read;
  // A quarter more than there are, for those of later steps.
  const size_t room = pairs > neighbours_.size() ? pairs + pairs / 4 : neighbours_.size();
  const Status reserved = inTurn(
      [&] { return neighbours_.resize(room, "pairs"); }, [&] { return reverses_.resize(room, "reverse pairs"); },
      [&] { return planes_.resize(room, "seen planes"); }, [&] { return pairOfPlane_.resize(room, "pairs of planes"); },
      [&] { return pairSums_.resize(room, "sums of pairs"); }, [&] { return clearFixedSums(); });
  if (!reserved) return reserved;
  lists.neighbours = neighbours_.data();
  lists.reverses = reverses_.data();
  hasPairs_ = true;
  return listPairs(arrays_, lists, stream_);
}

Status CudaStep::reservePixels(size_t pixels, size_t tiles) {
  const Status status = inTurn([&] { return rendered_.resize(pixels, "rendered"); },
                               [&] { return gradients_.resize(pixels, "gradients of pixels"); },
                               [&] { return lossFields_.resize(9 * pixels, "fields of the loss"); },
                               [&] { return wanted_.resize(pixels, "wanted pixels"); },
                               [&] { return logTransmittances_.resize(pixels, "transmittances"); },
                               [&] { return ends_.resize(pixels, "ends of rays"); },
                               [&] { return groupCones_.resize(tiles, "cones of groups"); },
                               [&] { return tileCones_.resize(tiles, "cones of tiles"); },
                               [&] { return resizeAll(byTile_, tiles, "numbers of tiles"); },
                               [&] { return tilesBegin_.resize(tiles + 1, "lists of tiles"); },
                               [&] {
                                 const size_t words = metEntriesOf(arrays_.entryCapacity, tiles);
                                 return metEntries_.resize(words, "entries that rays met");
                               });
  point();
  return status;
}

Status CudaStep::reserveEntries(uint32_t capacity) {
  const Status status = resizeAll(byEntry_, capacity, "entries of tiles");
  point();
  return status;
}

Status CudaStep::mark(Status passed, const char* pass) {
  if (clock_) clock_->mark(pass, stream_);
  return passed;
}

Status CudaStep::activate(float leastSkin) {
  if (Status waited = mark({}, "wait"); hasPairs_) return waited;  // update() left balls that fit them
  return inTurn([&] { return mark(activateCells(arrays_, hasPairs_, stream_), "activate"); },
                [&] { return mark(findPairs(leastSkin), "find pairs"); });
}

Status CudaStep::render(const TrainingView<float>& view, const PixelSettings<float>& settings,
                        const AdamStep<float>& adam) {
  view_ = view;
  settings_ = settings;
  const size_t tiles = size_t{tilesAlong(view.width)} * tilesAlong(view.height);
  return inTurn([&] { return reservePixels(size_t{view.width} * view.height, tiles); },
                [&] { return mark(cullCells(arrays_, view, stream_), "cull"); },
                [&] { return mark(rankCells(arrays_, scratch_, stream_), "rank"); },
                [&] { return mark(prepareCells(arrays_, view, adam, stream_), "prepare"); },
                [&] { return mark(prepareDetails(arrays_, adam, stream_), "prepare details"); },
                [&] { return mark(binTiles(arrays_, view, scratch_, stream_), "bin"); },
                [&] { return mark(renderTiles(arrays_, view, settings, stream_), "render"); });
}

Status CudaStep::uploadLoss(const std::vector<glm::vec4>& gradients, const std::vector<glm::vec4>& wanted) {
  return inTurn([&] { return gradients_.upload(gradients, "gradients of pixels", stream_); },
                [&] { return wanted_.upload(wanted, "wanted pixels", stream_); });
}

Status CudaStep::differentiateImage(const ImageTarget& target, const LossTerms& terms) {
  return mark(differentiateLoss(arrays_.pixels, wanted_.data(), target, terms, lossFields_.data(), stream_), "loss");
}

Status CudaStep::differentiate() {
  return mark(differentiateTiles(arrays_, view_, settings_, stream_), "differentiate");
}

Status CudaStep::update(const AdamStep<float>& adam, float overlapWeight) {
  return inTurn([&] { return mark(updateShownCells(arrays_, adam, stream_), "update"); },
                [&] { return mark(updateBalls(arrays_, adam, overlapWeight, stream_), "update balls"); },
                [&] { return mark(activateCells(arrays_, hasPairs_, stream_), "activate"); });
}

Status CudaStep::keepGradients(uint32_t view, uint32_t viewCount, const AdamStep<float>& adam, float overlapWeight) {
  const size_t bytes = bytesOfView();
  if (Status made = keptViews_.resize(bytes * viewCount, "gradients of views"); !made) return made;
  const KeptView kept = keptViewAt(keptViews_.data() + bytes * view, arrays_.foam.shape, view_.eye);
  return mark(froth::keepGradients(arrays_, adam, overlapWeight, kept, stream_), "keep");
}

Status CudaStep::updateByViews(const std::vector<glm::vec3>& eyes, const AdamStep<float>& adam, bool countsBad) {
  KeptViews kept{};
  for (const glm::vec3& eye : eyes) {
    const KeptView view = keptViewAt(keptViews_.data() + bytesOfView() * kept.count, arrays_.foam.shape, eye);
    kept.headers[kept.count] = view.header;
    kept.gradients[kept.count++] = view.gradients;
  }
  return inTurn([&] { return mark({}, "exchange"); },  // with what other GPUs sent
                [&] { return mark(updateShownByViews(arrays_, adam, kept, countsBad, stream_), "update"); },
                [&] { return mark(updateBallsByViews(arrays_, adam, kept, countsBad, stream_), "update balls"); },
                [&] { return mark(activateCells(arrays_, hasPairs_, stream_), "activate"); });
}

Result<bool> CudaStep::settle() {
  std::vector<StepCounters> counters;
  if (Status read = counters_.download(counters, "counters", stream_); !read) return read.error();
  lastCounters_ = counters[0];
  if (lastCounters_.cellsOutOfSkin > 0) hasPairs_ = false;
  if (lastCounters_.tileEntries <= arrays_.entryCapacity) return true;
  // A quarter more than this view needs, for others.
  const Status grown = reserveEntries(lastCounters_.tileEntries + lastCounters_.tileEntries / 4);
  if (!grown) return grown.error();
  return false;
}

size_t CudaStep::byteCount() const {
  size_t sum = scratch_.byteCount() + counters_.byteCount() + keptViews_.byteCount();
  const auto add = [&](const auto&... arrays) { sum += (arrays.byteCount() + ...); };
  for (const Tensors& tensors : tensors_) {
    add(tensors.values, tensors.firstMoments, tensors.secondMoments, tensors.meanValues);
  }
  add(pairOfPlane_);
  for (const auto& array : byCell_) add(array);
  add(groupCones_);
  for (const auto& array : byEntry_) add(array);
  for (const auto& array : byTile_) add(array);
  add(lastSteps_, balls_, contributions_, errors_, offsets_, neighbours_, reverses_, seenCells_, planes_, details_);
  add(rankOf_, cellSums_, detailSums_, pairSums_, tileCones_, tilesBegin_, metEntries_, rendered_, gradients_, wanted_);
  add(fixedCellSums_, fixedDetailSums_, fixedPairSums_);
  add(logTransmittances_, ends_, lossFields_, foundBalls_, enlargedBalls_, slacks_, boxes_);
  return sum;
}

}  // namespace froth
