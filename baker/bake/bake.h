// From a foam to an asset: snap to lattices -> Steiner cells -> triangulate -> mark -> alpha-complex -> chunk ->
// coarser levels -> encode.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "baker/appearance/appearance.h"
#include "baker/cells/cells.h"
#include "baker/graph/graph.h"
#include "baker/lod/level_report.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "format/asset_contents.h"
#include "reference/camera/camera.h"

namespace froth {

// How exactly values are kept. Steps as bits, where a range is known: the position step is the scene's largest extent
// over 2^positionBits, rounded down to a power of two.
struct BakeKnobs {
  uint32_t positionBits = 0;     // [10..22]; 0: float32 as it is, in world coordinates
  uint32_t radiusBits = 23;      // mantissa bits [4..23]
  uint32_t densityBits = 23;     // mantissa bits [1..23]
  uint32_t frameBits = 0;        // bits per axis of the octahedral normal [4..15]; 0: quaternions of floats
  uint32_t detailSiteBits = 0;   // step 2^-bits radii [1..16]; 0: float32 as it is
  uint32_t heightBits = 0;       // step 2^-bits radii [1..16]; 0: float32 as it is
  bool compressColours = false;  // false: all lobes as they are
  AppearanceOptions appearance;  // with compressColours
};

// "exact", "high", "default", "small"; kUsage for any other name.
Result<BakeKnobs> presetKnobs(const std::string& preset);

// Eyes to bake for, beside those of the cameras.
struct EyeChoice {
  double aroundCameras = 0;  // all eyes within this distance of a camera's [scene units]; 0: none
  std::optional<Box> box;    // all eyes in it, instead of around cameras
};

struct BakeOptions {
  std::string preset = "exact";  // name only; what counts are the knobs
  BakeKnobs knobs;
  float nearRatio = 4.0f;  // defaults of the asset's near tests
  float nearDepth = 0.0f;  // [scene units]
  bool walkGraph = true;
  bool steiner = true;          // ignored without walk graph
  float cullUnseen = 0;         // drops live cells whose largest T alpha in all cameras is not above this; 0: none
  uint32_t chunkCells = 16384;  // most live cells of a chunk; half of that is good for levels
  bool levels = false;          // levels of detail (docs/STREAMING.md); they need the walk graph
  uint64_t memoryLimit = 0;     // of the triangulation, beside the input [bytes]; 0: none. Else in pieces
  uint64_t seed = 1;
  bool measure = true;                 // PSNR of a lossy asset on sample views
  std::string source;                  // name shown by `froth info`
  const CameraSet* cameras = nullptr;  // start view, flight path, and what is seen; may be null
  EyeChoice eyes;
};

struct StageReport {
  std::string stage;
  double seconds = 0;
  uint64_t items = 0;
  uint64_t peakBytes = 0;  // of the process so far, resident
};

// Something that the scene does not need and the asset does not hold.
struct LeftOut {
  std::string what;         // "displacement", "lobes that no direction needs", ...
  uint64_t savedBytes = 0;  // uncompressed
};

struct BakeResult {
  AssetContents contents;  // `chunks` hold origins and counts; with their arrays only if they were asked for
  std::vector<StageReport> stages;
  std::vector<LeftOut> leftOut;
  std::vector<LevelReport> levels;  // from level 0 on; none: a bake without levels, or nothing gets coarser
  ValidityReport validity;
  // mean steps per ray without and with Steiner cells; 0: none placed
  double walkLengthBefore = 0, walkLengthAfter = 0;
  // [cells in the asset, chunk after chunk] index in the input foam; kNoSource: Steiner or merged
  std::vector<uint32_t> sourceCells;
};

// Takes what a bake makes: first the header (all but chunks, statistics and errors), then the chunks in order.
struct ChunkSink {
  std::function<Status(const AssetContents& header)> begin;
  std::function<Status(std::vector<ChunkContents>&& batch)> append;  // some chunks at a time, in order
};

// The same foam and options give the same chunks, on any number of threads, with any memory limit.
Result<BakeResult> bakeFoam(const Foam& foam, const BakeOptions& options, const ChunkSink& sink,
                            const Progress& progress = {});
// The same into memory.
Result<BakeResult> bakeFoam(const Foam& foam, const BakeOptions& options, const Progress& progress = {});

// The foam that an asset shows, of levels the finest: sites in world coordinates (rounded to float if the origin is not
// 0); cells in asset order; cells that are not live get density 0 and grey details, so that any renderer of foams draws
// the asset.
Result<Foam> foamFromAsset(const AssetContents& contents);

}  // namespace froth
