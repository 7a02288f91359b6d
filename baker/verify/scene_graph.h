// The cells of all chunks of an asset as one power diagram with its graphs. Internal to baker/verify.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "baker/graph/graph.h"
#include "base/progress.h"
#include "base/result.h"
#include "format/asset_contents.h"

namespace froth {

// Cells in the order of the chunks. Rows of `alpha` are those of the asset for live cells, and all of the
// triangulation's for the others, of which the asset keeps none.
struct SceneGraph {
  std::vector<glm::vec3> sites;  // [cells] relative to the first chunk's origin [scene units]
  std::vector<float> radii;      // [cells] [scene units]
  RegularTriangulation triangulation;
  AlphaComplex alpha;
};

// `contents` holds all its chunks and has passed the reader's checks. Without a walk graph the cells are triangulated
// again. Fails with kUnsupported if a site is no float relative to the first origin, which no bake makes: rounding
// would move the planes.
Result<SceneGraph> joinChunks(const AssetContents& contents, const Progress& progress);

}  // namespace froth
