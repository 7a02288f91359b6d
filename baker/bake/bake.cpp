#include "baker/bake/bake.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "baker/bake/asset_foam.h"
#include "baker/bake/attribute_errors.h"
#include "baker/bake/check_foam.h"
#include "baker/bake/chunk_attributes.h"
#include "baker/bake/chunk_geometry.h"
#include "baker/bake/colour_source.h"
#include "baker/bake/cull_unseen.h"
#include "baker/bake/eye_region.h"
#include "baker/bake/lattices.h"
#include "baker/bake/left_out.h"
#include "baker/bake/sample_views.h"
#include "baker/bake/solid_balls.h"
#include "baker/bake/sort_details.h"
#include "baker/bake/stage_recorder.h"
#include "baker/cells/chunk_plan.h"
#include "baker/cells/mark_cells.h"
#include "baker/cells/snap_cells.h"
#include "baker/lod/gather_cells.h"
#include "baker/lod/levels.h"
#include "baker/steiner/crowded_cells.h"
#include "baker/steiner/steiner.h"

namespace froth {
namespace {

StoredCamera storeCamera(const View& view) {
  StoredCamera camera{.worldFromCamera = view.worldFromCamera};
  if (view.lens.kind == LensKind::kPinhole) camera.tanHalfFovY = 0.5 * view.height / view.fy;
  return camera;
}

void storeCameras(const CameraSet& cameras, AssetContents& contents) {
  for (const View& view : cameras.flight) contents.flightPath.push_back(storeCamera(view));
  contents.hasStartView = !cameras.flight.empty() || !cameras.views.empty();
  if (contents.hasStartView) {
    contents.startView = storeCamera(cameras.flight.empty() ? cameras.views.front() : cameras.flight.front());
  }
}

// That show a box of eyes; each takes about half a second.
constexpr uint32_t kMostSplits = 4;  // rounds in which crowded cells are split
constexpr uint32_t kViewsOfBox = 96;

// Whether the asset can look different from the input.
bool isLossy(const BakeOptions& options) {
  const BakeKnobs& knobs = options.knobs;
  return knobs.positionBits > 0 || knobs.radiusBits < 23 || knobs.densityBits < 23 || knobs.frameBits > 0 ||
         knobs.detailSiteBits > 0 || knobs.heightBits > 0 || knobs.compressColours || options.cullUnseen > 0;
}

// One bake: its steps in the order of run(), and what they hand on.
class Bake {
 public:
  Bake(const Foam& foam, const BakeOptions& options, const ChunkSink& sink, const Progress& progress)
      : foam_(foam), options_(options), sink_(sink), progress_(progress) {}

  Status run();
  BakeResult take() { return std::move(result_); }

 private:
  std::vector<View> knownViews() const;
  Status lookThroughCameras();
  Status snap();
  bool hasSteiner() const { return options_.steiner && options_.walkGraph; }
  SteinerOptions steinerOptions() const;
  void addSteinerCells(const SteinerCells& added);
  Status placeSteiner();
  Status triangulate();
  Status mark();
  Status check();
  Status makeCoarser();
  Status prepareColours();
  void fillHeader();
  Status makeChunks();
  Status measure();

  Result<ChunkContents> makeChunk(uint32_t index, AttributeErrors& errors);
  bool hasLevels() const { return !levels_.groups.empty(); }
  // Level 0 is the foam; statistics and measures know nothing of the others.
  bool isLevel0(uint32_t chunk) const { return !hasLevels() || levels_.places[chunk].level == 0; }
  void keepCounts(const ChunkContents& chunk);
  void countStored(const ChunkContents& chunk);

  const Foam& foam_;
  const BakeOptions& options_;
  const ChunkSink& sink_;
  const Progress& progress_;

  BakeResult result_;
  StageRecorder recorder_{result_.stages};
  AssetContents& contents_ = result_.contents;
  uint64_t unseenCulled_ = 0;
  std::optional<Visibility> visibility_;
  BakeCells cells_;
  size_t realCount_ = 0;  // cells before the Steiner cells
  RegularTriangulation triangulation_;
  AlphaComplex alpha_;
  ChunkPlan plan_;
  Levels levels_;  // none: empty
  ColourSource colours_;
  StoredCounts stored_;                    // of level 0
  uint64_t doneLive_ = 0, liveCount_ = 0;  // live cells of chunks: finished ones, all
  std::optional<FoamAssembler> baked_;     // for measuring
};

Status Bake::run() {
  if (Status status = checkFoam(foam_); !status) return status;
  if (Status status = checkOptions(options_); !status) return status;

  // 1. What the cameras see weighs errors and tells which cells can go.
  if (Status status = lookThroughCameras(); !status) return status;
  // 2. Snap, then everything else: the graphs belong to the numbers that a reader will have.
  if (Status status = snap(); !status) return status;
  // 3. Cells in empty space, for walks.
  if (Status status = placeSteiner(); !status) return status;
  // 4. All sites are triangulated: cells that nobody sees still cut their neighbours. Then the pairs that
  // rasterization needs, and the cells without a bounded cell.
  if (Status status = triangulate(); !status) return status;
  // 5. Cells get their chunks and places; hidden ones none.
  if (Status status = mark(); !status) return status;
  // 6. The graphs against brute force.
  if (Status status = check(); !status) return status;
  // 7. Coarser levels, group by group.
  if (Status status = makeCoarser(); !status) return status;
  // 8. How colours will be stored; a codebook is shared, so it goes first.
  if (Status status = prepareColours(); !status) return status;
  fillHeader();
  if (Status status = sink_.begin(contents_); !status) return status;
  // 9. Chunk after chunk into the sink: memory holds a few of them.
  if (Status status = makeChunks(); !status) return status;
  // 10. What the asset looks like beside the input.
  return measure();
}

// From where the scene will be seen, as far as the options say.
std::vector<View> Bake::knownViews() const {
  std::vector<View> views;
  if (options_.cameras) views = options_.cameras->views;
  if (options_.eyes.box) {
    const std::vector<View> drawn = drawViews(makeEyeRegion(options_), options_.cameras, kViewsOfBox, options_.seed);
    views.insert(views.end(), drawn.begin(), drawn.end());
  }
  return views;
}

Status Bake::lookThroughCameras() {
  if (isLossy(options_)) contents_.eyes = makeEyeRegion(options_);
  if (!options_.knobs.compressColours && options_.cullUnseen <= 0) return {};
  const std::vector<View> views = knownViews();
  if (views.empty()) return {};
  const VisibilityOptions visibility{.nearRatio = options_.nearRatio, .nearDepth = options_.nearDepth};
  Result<Visibility> measured = measureVisibility(foam_, views, visibility, progress_);
  if (!measured) return measured.error();
  visibility_ = std::move(*measured);
  recorder_.finish("visibility", views.size());
  return {};
}

Status Bake::snap() {
  contents_.quantization = makeLattices(foam_, options_.knobs);
  cells_ = snapCells(foam_, contents_.quantization);
  recorder_.finish("snap", foam_.cellCount);
  if (options_.cullUnseen <= 0) return {};
  if (!visibility_) return makeError(ErrorKind::kUsage, "culling unseen cells needs cameras; give some with views");
  unseenCulled_ = cullUnseenCells(cells_, visibility_->contributions, options_.cullUnseen, progress_);
  if (!report(progress_, "cull", unseenCulled_, unseenCulled_)) return stoppedOnRequest("bake");
  recorder_.finish("cull", unseenCulled_);
  return {};
}

SteinerOptions Bake::steinerOptions() const {
  const Quantization& lattices = contents_.quantization;
  return {options_.seed,      options_.cameras,      options_.nearRatio,
          options_.nearDepth, lattices.positionStep, lattices.radiusBits};
}

void Bake::addSteinerCells(const SteinerCells& added) {
  cells_.sites.insert(cells_.sites.end(), added.sites.begin(), added.sites.end());
  cells_.radii.insert(cells_.radii.end(), added.radii.begin(), added.radii.end());
  cells_.densities.resize(cells_.sites.size(), 0);
  cells_.sources.resize(cells_.sites.size(), kNoSource);
}

Status Bake::placeSteiner() {
  if (!hasSteiner()) return {};
  realCount_ = cells_.count();
  const Result<SteinerCells> added =
      placeSteinerCells(cells_.sites, cells_.radii, cells_.densities, steinerOptions(), progress_);
  if (!added) return added.error();
  addSteinerCells(*added);
  result_.walkLengthBefore = added->walkLengthBefore;
  result_.walkLengthAfter = added->walkLengthAfter;
  recorder_.finish("steiner", added->sites.size());
  return {};
}

Status Bake::triangulate() {
  for (uint32_t round = 0;; ++round) {
    Result<RegularTriangulation> triangulation =
        triangulateWithin(options_.memoryLimit, cells_.sites, cells_.radii, progress_);
    if (!triangulation) return triangulation.error();
    triangulation_ = std::move(*triangulation);
    if (!hasSteiner() || round == kMostSplits) break;
    const SteinerCells more =
        splitCrowdedCells(cells_.sites, cells_.radii, realCount_, triangulation_.graph, steinerOptions(), round);
    if (more.sites.empty()) break;
    addSteinerCells(more);
  }
  recorder_.finish("triangulate", cells_.count());
  alpha_ = computeAlphaComplex(cells_.sites, cells_.radii, triangulation_, progress_);
  if (alpha_.graph.offsets.empty()) return stoppedOnRequest("bake");
  recorder_.finish("alpha-complex", triangulation_.graph.neighbours.size() / 2);
  return {};
}

Status Bake::mark() {
  const std::vector<CellState> states = markCells(cells_, triangulation_, alpha_, options_.walkGraph);
  contents_.statistics = countCells(cells_, states, triangulation_, alpha_);
  contents_.statistics.inputCells = foam_.cellCount;
  contents_.statistics.unseenCulled = unseenCulled_;
  Result<ChunkPlan> plan = planChunks(cells_, states, triangulation_.graph, options_.chunkCells,
                                      contents_.quantization.positionStep, progress_);
  if (!plan) return plan.error();
  plan_ = std::move(*plan);
  recorder_.finish("chunks", plan_.chunks.size());
  return {};
}

Status Bake::check() {
  result_.validity = checkGraphs(cells_.sites, cells_.radii, triangulation_, alpha_, options_.seed, progress_);
  if (!report(progress_, "check", 1, 1)) return stoppedOnRequest("bake");
  recorder_.finish("check", result_.validity.pointsChecked + result_.validity.raysChecked);
  if (result_.validity.faults.empty()) return {};
  return makeError(ErrorKind::kUnsupported, "graphs: %s; this is a fault of the baker, please report it with the input",
                   result_.validity.faults.front().c_str());
}

Status Bake::makeCoarser() {
  if (!options_.levels) return {};
  std::vector<View> views = knownViews();
  const bool fitsViews = !views.empty();
  if (!fitsViews) views = viewsAround(foam_);
  const LevelInput input{foam_,
                         triangulation_.graph,
                         alpha_.graph,
                         plan_,
                         contents_.quantization,
                         options_.chunkCells,
                         visibility_ ? &*visibility_ : nullptr,
                         std::move(views),
                         options_.nearRatio,
                         options_.nearDepth,
                         fitsViews};
  Result<Levels> levels = makeLevels(input, cells_, progress_);
  if (!levels) return levels.error();
  levels_ = std::move(*levels);
  recorder_.finish("levels", levels_.merged.cellCount);
  if (!hasLevels()) return {};
  plan_ = std::move(levels_.plan);
  triangulation_ = {};  // the levels have rows of their own
  alpha_ = {};
  result_.levels = levels_.reports;
  return {};
}

Status Bake::prepareColours() {
  Result<ColourSource> colours =
      ColourSource::create(foam_, levels_, visibility_ ? &*visibility_ : nullptr, options_, progress_);
  if (!colours) return colours.error();
  colours_ = std::move(*colours);
  recorder_.finish("codebook", colours_.codebook().size());
  return {};
}

void Bake::fillHeader() {
  contents_.detailCount = foam_.detailCount;
  contents_.lobeCount = colours_.lobeCount();
  contents_.localBits = plan_.localBits;
  contents_.hasWalkGraph = options_.walkGraph;
  contents_.nearRatio = options_.nearRatio;
  contents_.nearDepth = options_.nearDepth;
  contents_.preset = options_.preset;
  contents_.source = options_.source;
  contents_.axisCodebook = colours_.codebook();
  contents_.levels = levels_.places;
  contents_.groups = levels_.groups;
  contents_.borderCount = levels_.borderCount;
  if (options_.cameras) storeCameras(*options_.cameras, contents_);
}

Result<ChunkContents> Bake::makeChunk(uint32_t index, AttributeErrors& errors) {
  const PlannedChunk& planned = plan_.chunks[index];
  const std::span<const uint32_t> live(planned.cells.data(), planned.liveCount);
  std::vector<uint32_t> sources;
  for (const uint32_t cell : live) sources.push_back(cells_.sources[cell]);
  const Foam faces = gatherCells(foam_, levels_.merged, sources);
  const CellRows rows =
      hasLevels() ? std::move(levels_.rows[index]) : gatherRows(triangulation_.graph, alpha_.graph, planned.cells);
  ChunkContents chunk = makeChunkGeometry(cells_, planned, rows, plan_.refs,
                                          {options_.walkGraph, hasLevels(), contents_.quantization.positionStep});
  const StageProgress stage{progress_, "colours", doneLive_, liveCount_};
  if (!colours_.fill(sources, faces, stage, chunk, errors)) return stoppedOnRequest("bake");
  fillFaces(faces, cells_, live, contents_.quantization, chunk, errors);
  chunk.solidBalls = makeSolidBalls(chunk, contents_.detailCount);
  if (contents_.quantization.detailSiteStep > 0) sortDetails(contents_.detailCount, chunk);
  return chunk;
}

// What the result keeps of a chunk that goes to the sink.
void Bake::keepCounts(const ChunkContents& chunk) {
  ChunkContents& counts = contents_.chunks.emplace_back();
  counts.origin = chunk.origin;
  counts.cellCount = chunk.cellCount;
  counts.liveCount = chunk.liveCount;
  counts.ghostCount = chunk.ghostCount;
  doneLive_ += chunk.liveCount;
}

void Bake::countStored(const ChunkContents& chunk) {
  stored_.cells += chunk.cellCount;
  stored_.live += chunk.liveCount;
  stored_.detailHeights += chunk.detailHeights.size();
  stored_.lobes += chunk.lobeColours.size();
}

Status Bake::makeChunks() {
  if (options_.measure && isLossy(options_)) {
    baked_.emplace(contents_.detailCount, contents_.lobeCount, true, colours_.isCompressed());
  }
  for (const PlannedChunk& chunk : plan_.chunks) liveCount_ += chunk.liveCount;
  AttributeErrors errors, errorsOfOthers;
  const size_t batchSize = static_cast<size_t>(tbb::this_task_arena::max_concurrency());
  std::vector<ChunkContents> batch;
  for (uint32_t index = 0; index < plan_.chunks.size(); ++index) {
    Result<ChunkContents> chunk = makeChunk(index, isLevel0(index) ? errors : errorsOfOthers);
    if (!chunk) return chunk.error();
    keepCounts(*chunk);
    if (isLevel0(index)) {
      countStored(*chunk);
      if (baked_) baked_->append(*chunk);
    }
    for (const uint32_t cell : plan_.chunks[index].cells) {
      result_.sourceCells.push_back(cells_.sources[cell] < foam_.cellCount ? cells_.sources[cell] : kNoSource);
    }
    batch.push_back(std::move(*chunk));
    if (batch.size() < batchSize && index + 1 < plan_.chunks.size()) continue;
    if (Status status = sink_.append(std::exchange(batch, {})); !status) return status;
  }
  contents_.errors = errors.list();
  result_.leftOut = listLeftOut(foam_, contents_, stored_);
  recorder_.finish("arrays and encoding", stored_.cells);
  return {};
}

Status Bake::measure() {
  if (!baked_) return {};
  const Foam baked = baked_->take();
  const Result<SampledPsnr> psnr = measurePsnr(foam_, baked, contents_.eyes, options_, progress_);
  if (!psnr) return psnr.error();
  contents_.psnr = psnr->given;
  contents_.eyes.worstPsnr = psnr->worstDrawn;
  contents_.eyes.meanPsnr = psnr->drawn;
  recorder_.finish("measure", baked.cellCount);
  return {};
}

}  // namespace

Result<BakeResult> bakeFoam(const Foam& foam, const BakeOptions& options, const ChunkSink& sink,
                            const Progress& progress) {
  Bake bake(foam, options, sink, progress);
  if (Status status = bake.run(); !status) return status.error();
  return bake.take();
}

Result<BakeResult> bakeFoam(const Foam& foam, const BakeOptions& options, const Progress& progress) {
  std::vector<ChunkContents> chunks;
  ChunkSink sink;
  sink.begin = [](const AssetContents&) { return Status{}; };
  sink.append = [&chunks](std::vector<ChunkContents>&& batch) {
    chunks.insert(chunks.end(), std::make_move_iterator(batch.begin()), std::make_move_iterator(batch.end()));
    return Status{};
  };
  Result<BakeResult> result = bakeFoam(foam, options, sink, progress);
  if (result) result->contents.chunks = std::move(chunks);
  return result;
}

}  // namespace froth
