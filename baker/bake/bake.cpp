#include "baker/bake/bake.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "baker/bake/chunk_arrays.h"
#include "baker/graph/graph.h"

namespace froth {
namespace {

// A cell is dead if its opacity 1 - exp(-2 r sigma) along its longest chord is below this. Such a cell adds
// less than 2^-24 of its colour to a ray and leaves a float transmittance within one rounding: a ray must
// cross 128 of them before a 16-bit channel, of half-step 2^-17, can change.
constexpr double kDeadOpticalDepth = 0x1p-24;

enum class CellState : uint8_t { kLive, kDead, kEmpty, kHidden };

// Closes the stages of a bake, one after the other, with what each took.
class StageRecorder {
 public:
  explicit StageRecorder(std::vector<StageReport>& stages) : stages_(stages) {}

  void finish(const char* stage, uint64_t items) {
    const Clock::time_point now = Clock::now();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    stages_.push_back({stage, std::chrono::duration<double>(now - begin_).count(), items,
                       static_cast<uint64_t>(usage.ru_maxrss) * 1024});
    begin_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<StageReport>& stages_;
  Clock::time_point begin_ = Clock::now();
};

Status checkLength(const char* name, size_t found, size_t expected) {
  if (found == expected) return {};
  return makeError(ErrorKind::kBadInput,
                   "foam: array '%s' has %zu entries, the counts ask for %zu; import it again", name, found,
                   expected);
}

Status checkFoam(const Foam& foam) {
  if (foam.cellCount == 0 || foam.detailCount - 1 >= 32 || foam.lobeCount - 1 >= 32) {
    return makeError(ErrorKind::kBadInput,
                     "foam: %u cells, %u detail sites, %u lobes; needs >= 1, 1..32, 1..32", foam.cellCount,
                     foam.detailCount, foam.lobeCount);
  }
  const size_t cells = foam.cellCount, details = cells * foam.detailCount, lobes = details * foam.lobeCount;
  const std::pair<const char*, std::pair<size_t, size_t>> lengths[] = {
      {"sites", {foam.sites.size(), cells}},
      {"radii", {foam.radii.size(), cells}},
      {"densities", {foam.densities.size(), cells}},
      {"orientations", {foam.orientations.size(), cells}},
      {"detailSites", {foam.detailSites.size(), details}},
      {"detailHeights", {foam.detailHeights.size(), details}},
      {"lobeAxes", {foam.lobeAxes.size(), lobes}},
      {"lobeColours", {foam.lobeColours.size(), lobes}}};
  for (const auto& [name, length] : lengths) {
    if (Status status = checkLength(name, length.first, length.second); !status) return status;
  }
  return {};
}

std::vector<CellState> markCells(const Foam& foam, const RegularTriangulation& triangulation,
                                 const AlphaComplex& alpha) {
  std::vector<CellState> states(foam.cellCount, CellState::kLive);
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    if (triangulation.isHidden[i]) {
      states[i] = CellState::kHidden;
    } else if (alpha.isEmpty[i]) {
      states[i] = CellState::kEmpty;
    } else if (2.0 * foam.radii[i] * foam.densities[i] < kDeadOpticalDepth) {
      states[i] = CellState::kDead;
    }
  }
  return states;
}

// Source cells in the order of the asset: the live ones along a Morton curve, then the dead and empty ones
// along it.
std::vector<uint32_t> orderCells(const Foam& foam, const std::vector<CellState>& states) {
  std::vector<uint32_t> order = mortonOrder(foam.sites);
  std::erase_if(order, [&](uint32_t cell) { return states[cell] == CellState::kHidden; });
  std::stable_partition(order.begin(), order.end(),
                        [&](uint32_t cell) { return states[cell] == CellState::kLive; });
  return order;
}

BakeStatistics countCells(const std::vector<CellState>& states, const RegularTriangulation& triangulation,
                          const AlphaComplex& alpha) {
  const auto count = [&](CellState state) {
    return static_cast<uint64_t>(std::count(states.begin(), states.end(), state));
  };
  BakeStatistics statistics;
  statistics.inputCells = states.size();
  statistics.hiddenDropped = count(CellState::kHidden);
  statistics.duplicatesMerged = triangulation.duplicates;
  statistics.emptyCells = count(CellState::kEmpty);
  statistics.deadCells = count(CellState::kDead);
  statistics.walkPairs = triangulation.graph.neighbours.size() / 2;
  statistics.alphaPairs = alpha.graph.neighbours.size() / 2;
  return statistics;
}

StoredCamera storeCamera(const View& view) {
  return {view.worldFromCamera, 0.5 * view.height / view.fy};
}

void storeCameras(const CameraSet& cameras, AssetContents& contents) {
  for (const View& view : cameras.flight) contents.flightPath.push_back(storeCamera(view));
  contents.hasStartView = !cameras.flight.empty() || !cameras.views.empty();
  if (contents.hasStartView) {
    contents.startView = storeCamera(cameras.flight.empty() ? cameras.views.front() : cameras.flight.front());
  }
}

Error cancelled() {
  return makeError(ErrorKind::kCancelled, "bake stopped on request");
}

}  // namespace

Result<BakeResult> bakeFoam(const Foam& foam, const BakeOptions& options, const ChunkSink& sink,
                            const Progress& progress) {
  Result<BakeResult> result = bakeFoam(foam, options, progress);
  if (!result) return result;
  std::vector<ChunkContents> chunks = std::move(result->contents.chunks);
  result->contents.chunks.clear();
  if (Status begun = sink.begin(result->contents); !begun) return begun.error();
  for (const ChunkContents& chunk : chunks) {
    ChunkContents& counts = result->contents.chunks.emplace_back();
    counts.origin = chunk.origin;
    counts.cellCount = chunk.cellCount;
    counts.liveCount = chunk.liveCount;
    counts.ghostCount = chunk.ghostCount;
  }
  if (Status appended = sink.append(std::move(chunks)); !appended) return appended.error();
  return result;
}

Result<BakeResult> bakeFoam(const Foam& foam, const BakeOptions& options, const Progress& progress) {
  if (Status status = checkFoam(foam); !status) return status.error();
  BakeResult result;
  StageRecorder recorder(result.stages);

  // 1. All sites are triangulated: cells that nobody sees still cut their neighbours.
  Result<RegularTriangulation> triangulation = triangulateRegular(foam.sites, foam.radii, progress);
  if (!triangulation) return triangulation.error();
  recorder.finish("triangulate", foam.cellCount);

  // 2. The pairs that rasterization needs, and the cells without a bounded cell.
  const AlphaComplex alpha = computeAlphaComplex(foam.sites, foam.radii, *triangulation, progress);
  if (alpha.graph.offsets.empty()) return cancelled();
  recorder.finish("alpha-complex", triangulation->graph.neighbours.size() / 2);

  // 3. Cells get their places: live ones first, so that raster lists and colours are prefixes; hidden ones
  // none.
  const std::vector<CellState> states = markCells(foam, *triangulation, alpha);
  result.contents.statistics = countCells(states, *triangulation, alpha);
  result.sourceCells = orderCells(foam, states);
  ChunkContents& chunk = result.contents.chunks.emplace_back();
  chunk.cellCount = static_cast<uint32_t>(result.sourceCells.size());
  chunk.liveCount = static_cast<uint32_t>(std::count(states.begin(), states.end(), CellState::kLive));
  recorder.finish("order", chunk.cellCount);

  // 4. Graph rows, nearest plane first: a ray that misses is mostly told so by the first planes.
  fillGraphRows(foam, triangulation->graph, alpha.graph, result.sourceCells, chunk);
  recorder.finish("rows", chunk.neighbours.size());

  // 5. Attributes. The preset "exact" keeps their bits.
  if (!report(progress, "arrays", 0, chunk.cellCount)) return cancelled();
  fillAttributes(foam, result.sourceCells, chunk);
  AssetContents& contents = result.contents;
  contents.detailCount = foam.detailCount;
  contents.lobeCount = foam.lobeCount;
  contents.nearRatio = options.nearRatio;
  contents.nearDepth = options.nearDepth;
  contents.preset = options.preset;
  contents.source = options.source;
  if (options.cameras) storeCameras(*options.cameras, contents);
  report(progress, "arrays", chunk.cellCount, chunk.cellCount);
  recorder.finish("arrays", chunk.cellCount);
  return result;
}

}  // namespace froth
