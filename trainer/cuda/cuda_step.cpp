#include "trainer/cuda/cuda_step.h"

#include <algorithm>

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

// The first guess of a view's entries; more make it grow.
constexpr uint32_t kFirstEntries = 1u << 20;

}  // namespace

CudaStep::~CudaStep() {
  if (stream_) cudaStreamDestroy(stream_);
}

Status CudaStep::start() {
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
  arrays_.pairs = {offsets_.data(), neighbours_.data(), reverses_.data()};
  arrays_.seen = {0, seenCells_.data(), planes_.data(), details_.data(), rankOf_.data()};
  arrays_.counters = counters_.data();
  arrays_.sums = {cellSums_.data(), detailSums_.data(), pairSums_.data(), nullptr};
  arrays_.pixels = {rendered_.data(), logTransmittances_.data(), ends_.data(), gradients_.data(), wanted_.data()};
  uint32_t** const byCell[kArraysByCell] = {&arrays_.powerKeys,   &arrays_.sortedKeys, &arrays_.cells,
                                            &arrays_.sortedCells, &arrays_.tileCounts, &arrays_.planesBegin,
                                            &arrays_.entriesBegin};
  for (size_t i = 0; i < kArraysByCell; ++i) *byCell[i] = byCell_[i].data();
  uint32_t** const byEntry[kArraysByEntry] = {&arrays_.entryTiles, &arrays_.sortedTiles, &arrays_.entryRanks,
                                              &arrays_.sortedRanks};
  for (size_t i = 0; i < kArraysByEntry; ++i) *byEntry[i] = byEntry_[i].data();
  arrays_.tileCones = tileCones_.data();
  arrays_.tilesBegin = tilesBegin_.data();
  arrays_.entryCapacity = static_cast<uint32_t>(byEntry_[0].size());
}

Status CudaStep::upload(const FoamStorage<float>& foam) {
  const size_t cells = foam.shape.cellCount, details = cells * foam.shape.detailCount;
  Status status;
  for (size_t i = 0; i < kParameterCount && status; ++i) {
    const char* name = kParameterKeys[i].data();
    status = inTurn([&] { return tensors_[i].values.upload(foam.values[i], name, stream_); },
                    [&] { return tensors_[i].firstMoments.upload(foam.firstMoments[i], name, stream_); },
                    [&] { return tensors_[i].secondMoments.upload(foam.secondMoments[i], name, stream_); });
  }
  for (size_t i = 0; i < kArraysByCell && status; ++i) status = byCell_[i].resize(cells, "numbers of cells");
  if (!status) return status;
  status = inTurn(
      [&] { return lastSteps_.upload(foam.lastSteps, "last steps", stream_); },
      [&] { return contributions_.upload(foam.contributions, "contributions", stream_); },
      [&] { return errors_.upload(foam.errors, "errors", stream_); }, [&] { return balls_.resize(cells, "balls"); },  //
      [&] { return seenCells_.resize(cells, "seen cells"); }, [&] { return rankOf_.resize(cells, "ranks"); },
      [&] { return cellSums_.resize(cells, "sums of cells"); },
      [&] { return details_.resize(details, "seen details"); },
      [&] { return detailSums_.resize(details, "sums of details"); }, [&] { return reserveEntries(kFirstEntries); });
  arrays_.foam.shape = foam.shape;
  point();
  return status;
}

Status CudaStep::download(FoamStorage<float>& foam) {
  resizeStorage(foam, arrays_.foam.shape);
  Status status;
  for (size_t i = 0; i < kParameterCount && status; ++i) {
    const char* name = kParameterKeys[i].data();
    status = inTurn([&] { return tensors_[i].values.download(foam.values[i], name, stream_); },
                    [&] { return tensors_[i].firstMoments.download(foam.firstMoments[i], name, stream_); },
                    [&] { return tensors_[i].secondMoments.download(foam.secondMoments[i], name, stream_); });
  }
  if (!status) return status;
  return inTurn([&] { return lastSteps_.download(foam.lastSteps, "last steps", stream_); },
                [&] { return balls_.download(foam.balls, "balls", stream_); },
                [&] { return contributions_.download(foam.contributions, "contributions", stream_); },
                [&] { return errors_.download(foam.errors, "errors", stream_); });
}

Status CudaStep::setPairs(const CellGraph& graph, const std::vector<uint32_t>& reverses) {
  const size_t pairs = graph.neighbours.size();
  const Status status = inTurn([&] { return offsets_.upload(graph.offsets, "offsets of pairs", stream_); },
                               [&] { return neighbours_.upload(graph.neighbours, "pairs", stream_); },
                               [&] { return reverses_.upload(reverses, "reverse pairs", stream_); },
                               [&] { return planes_.resize(pairs, "seen planes"); },
                               [&] { return pairSums_.resize(pairs, "sums of pairs"); });
  point();
  return status;
}

Status CudaStep::reservePixels(size_t pixels, size_t tiles) {
  const Status status = inTurn([&] { return rendered_.resize(pixels, "rendered"); },
                               [&] { return gradients_.resize(pixels, "gradients of pixels"); },
                               [&] { return wanted_.resize(pixels, "wanted pixels"); },
                               [&] { return logTransmittances_.resize(pixels, "transmittances"); },
                               [&] { return ends_.resize(pixels, "ends of rays"); },
                               [&] { return tileCones_.resize(tiles, "cones of tiles"); },
                               [&] { return tilesBegin_.resize(tiles + 1, "lists of tiles"); });
  point();
  return status;
}

Status CudaStep::reserveEntries(uint32_t capacity) {
  Status status;
  for (size_t i = 0; i < kArraysByEntry && status; ++i) status = byEntry_[i].resize(capacity, "entries of tiles");
  point();
  return status;
}

Status CudaStep::mark(Status passed, const char* pass) {
  if (clock_) clock_->mark(pass, stream_);
  return passed;
}

Status CudaStep::activate() { return mark(activateCells(arrays_, stream_), "activate"); }

Status CudaStep::render(const TrainingView<float>& view, const RaySettings<float>& settings,
                        const AdamStep<float>& adam) {
  view_ = view;
  settings_ = settings;
  const size_t tiles = size_t{tilesAlong(view.width)} * tilesAlong(view.height);
  return inTurn([&] { return reservePixels(size_t{view.width} * view.height, tiles); },
                [&] { return mark(cullCells(arrays_, view, stream_), "cull"); },
                [&] { return mark(rankCells(arrays_, scratch_, stream_), "rank"); },
                [&] { return mark(catchUpCells(arrays_, adam, stream_), "catch up"); },
                [&] { return mark(prepareCells(arrays_, view, stream_), "prepare"); },
                [&] { return mark(binTiles(arrays_, view, scratch_, stream_), "bin"); },
                [&] { return mark(renderTiles(arrays_, view, settings, stream_), "render"); });
}

Status CudaStep::uploadLoss(const std::vector<glm::vec4>& gradients, const std::vector<glm::vec4>& wanted) {
  return inTurn([&] { return gradients_.upload(gradients, "gradients of pixels", stream_); },
                [&] { return wanted_.upload(wanted, "wanted pixels", stream_); });
}

Status CudaStep::differentiate() {
  return mark(differentiateTiles(arrays_, view_, settings_, stream_), "differentiate");
}

Status CudaStep::update(const AdamStep<float>& adam, float overlapWeight) {
  return mark(updateCells(arrays_, adam, overlapWeight, stream_), "update");
}

Result<bool> CudaStep::settle() {
  std::vector<StepCounters> counters;
  if (Status read = counters_.download(counters, "counters", stream_); !read) return read.error();
  lastCounters_ = counters[0];
  if (lastCounters_.tileEntries <= arrays_.entryCapacity) return true;
  // A quarter more than this view needs, for others.
  const Status grown = reserveEntries(lastCounters_.tileEntries + lastCounters_.tileEntries / 4);
  if (!grown) return grown.error();
  return false;
}

size_t CudaStep::byteCount() const {
  size_t sum = scratch_.byteCount() + counters_.byteCount();
  const auto add = [&](const auto&... arrays) { sum += (arrays.byteCount() + ...); };
  for (const Tensors& tensors : tensors_) add(tensors.values, tensors.firstMoments, tensors.secondMoments);
  for (const auto& array : byCell_) add(array);
  for (const auto& array : byEntry_) add(array);
  add(lastSteps_, balls_, contributions_, errors_, offsets_, neighbours_, reverses_, seenCells_, planes_, details_);
  add(rankOf_, cellSums_, detailSums_, pairSums_, tileCones_, tilesBegin_, rendered_, gradients_, wanted_);
  add(logTransmittances_, ends_);
  return sum;
}

}  // namespace froth
