// From a foam to the contents of an asset: triangulate -> mark -> alpha-complex -> order -> arrays.
#pragma once

#include <string>
#include <vector>

#include "baker/camera/camera.h"
#include "baker/foam.h"
#include "baker/progress.h"
#include "format/asset_contents.h"
#include "format/result.h"

namespace froth {

struct BakeOptions {
  std::string preset = "exact";  // the float32 bits of the input, world coordinates, one chunk
  float nearRatio = 4.0f;        // defaults of the asset's near tests
  float nearDepth = 0.0f;        // [scene units]
  std::string source;            // name shown by `froth info`
  const CameraSet* cameras = nullptr;  // start view and flight path; may be null
};

struct StageReport {
  std::string stage;
  double seconds = 0;
  uint64_t items = 0;
  uint64_t peakBytes = 0;  // of the process so far, resident
};

struct BakeResult {
  AssetContents contents;
  std::vector<StageReport> stages;
  std::vector<uint32_t> sourceCells;  // [cells in the asset, chunk after chunk] index in the input foam
};

// The same foam and options give the same contents, on any number of threads.
Result<BakeResult> bakeFoam(const Foam& foam, const BakeOptions& options, const Progress& progress = {});

// The foam that an asset shows: sites in world coordinates (rounded to float if the origin is not 0); cells in asset order;
// cells that are not live get density 0 and grey details, so that any renderer of foams draws the asset.
Result<Foam> foamFromAsset(const AssetContents& contents);

}  // namespace froth
