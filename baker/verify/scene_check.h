// What `froth verify` does beyond format/read/asset_reader.h's verifyAsset: whether graph, alpha-complex and solid
// balls are those of the cells. The graphs are sampled as in a bake, each solid ball is bounded again. Of levels of
// detail the finest cells are sampled, the coarsest, and a mixture.
#pragma once

#include <cstdint>

#include "baker/graph/graph.h"
#include "base/progress.h"
#include "base/result.h"
#include "format/asset_contents.h"

namespace froth {

// `contents` holds all its chunks and has passed verifyAsset. With levels, each of them is checked as a scene of its
// own. Fails with kBadInput and the first thing that is wrong, with kUnsupported if the scene cannot be sampled, and
// with kCancelled. On all cores, the same result on any number of them.
Result<ValidityReport> checkScene(const AssetContents& contents, const Progress& progress = {});

}  // namespace froth
