#include "baker/bake/colour_source.h"

#include <algorithm>
#include <vector>

#include "baker/bake/chunk_attributes.h"
#include "baker/bake/eye_region.h"
#include "baker/bake/lattices.h"

namespace froth {
namespace {

constexpr uint32_t kSliceCells = 32;  // compressed by one task
// What errors of a merged cell's colours weigh, where those of a cell of level 0 that shows as much have 1. Coarser
// levels are drawn where merging shows little: so does coding that costs somewhat less (docs/notes/levels.md).
constexpr float kMergedWeight = 0.5f;

template <class T>
void append(std::vector<T>& all, const std::vector<T>& values) {
  all.insert(all.end(), values.begin(), values.end());
}

void appendAppearance(const CellAppearance& cells, ChunkContents& chunk, AttributeErrors& errors) {
  append(chunk.cellColours, cells.cellColours);
  append(chunk.baseColours, cells.baseColours);
  append(chunk.colourScales, cells.colourScales);
  append(chunk.detailScales, cells.detailScales);
  append(chunk.lobeCounts, cells.lobeCounts);
  append(chunk.lobeAxes, cells.lobeAxes);
  append(chunk.lobeColours, cells.lobeColours);
  errors.colours.add(cells.squaredError, cells.maxError, cells.weight);
}

// Cells that follow each other in a chunk, all of the input or all merged.
struct Run {
  std::vector<uint32_t> cells;  // in the foam that has them
  bool isMerged = false;
};

std::vector<Run> findRuns(std::span<const uint32_t> sources, uint32_t inputCount) {
  std::vector<Run> runs;
  for (const uint32_t source : sources) {
    const bool isMerged = source >= inputCount;
    if (runs.empty() || runs.back().isMerged != isMerged) runs.push_back({{}, isMerged});
    runs.back().cells.push_back(isMerged ? source - inputCount : source);
  }
  return runs;
}

}  // namespace

Result<ColourSource> ColourSource::create(const Foam& foam, const Levels& levels, const Visibility* visibility,
                                          const BakeOptions& options, const Progress& progress) {
  ColourSource source;
  source.inputCount_ = foam.cellCount;
  if (!options.knobs.compressColours) {
    source.lobeCount_ = isViewDependent(foam) ? foam.lobeCount : 0;
    return source;
  }
  AppearanceOptions appearance = options.knobs.appearance;
  appearance.seed = options.seed;
  if (hasChosenEyes(options)) appearance.eyeRadius = static_cast<float>(options.eyes.aroundCameras);
  if (!isViewDependent(foam)) appearance.lobeLimit = 0;
  const BakeKnobs& knobs = options.knobs;
  if (knobs.heightBits > 0) appearance.detailSiteStep = stepOfBits(knobs.detailSiteBits);  // they share their scales
  Result<AppearanceCoder> coder = AppearanceCoder::create(foam, visibility, appearance, progress);
  if (!coder) return coder.error();
  source.coder_ = std::move(*coder);
  if (levels.merged.cellCount > 0) {
    const Visibility* sights = levels.sights ? &*levels.sights : nullptr;
    source.mergedCoder_ = source.coder_->forFoam(levels.merged, sights, kMergedWeight);
  }
  source.lobeCount_ = std::min(foam.lobeCount, appearance.lobeLimit);
  return source;
}

bool ColourSource::fill(std::span<const uint32_t> sources, const Foam& faces, const StageProgress& stage,
                        ChunkContents& chunk, AttributeErrors& errors) const {
  if (!coder_) {
    fillColours(faces, lobeCount_ > 0, chunk);
    return report(stage.progress, stage.stage, stage.done, stage.total);
  }
  std::vector<std::vector<CellAppearance>> slices((sources.size() + kSliceCells - 1) / kSliceCells);
  const auto compressSlice = [&](uint32_t slice) {
    const size_t first = size_t{slice} * kSliceCells, count = std::min<size_t>(kSliceCells, sources.size() - first);
    for (const Run& run : findRuns(sources.subspan(first, count), inputCount_)) {
      slices[slice].push_back((run.isMerged ? mergedCoder_ : coder_)->compress(run.cells));
    }
  };
  if (!forEachSlice(static_cast<uint32_t>(slices.size()), kSliceCells, stage, compressSlice)) return false;
  for (const std::vector<CellAppearance>& runs : slices) {
    for (const CellAppearance& cells : runs) appendAppearance(cells, chunk, errors);
  }
  return true;
}

}  // namespace froth
