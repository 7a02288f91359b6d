// Where the colours of a bake come from: the input's own, or compressed ones. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "baker/appearance/appearance.h"
#include "baker/bake/attribute_errors.h"
#include "baker/bake/bake.h"
#include "baker/cells/slices.h"
#include "baker/lod/levels.h"
#include "foam/foam.h"
#include "format/asset_contents.h"

namespace froth {

class ColourSource {
 public:
  // Keeps references to foam, visibility (null: all directions are alike) and the merged cells of levels.
  static Result<ColourSource> create(const Foam& foam, const Levels& levels, const Visibility* visibility,
                                     const BakeOptions& options, const Progress& progress);

  // Most lobes of a detail site; 0: nothing looks different from different sides.
  uint32_t lobeCount() const { return lobeCount_; }
  std::vector<glm::vec3> codebook() const { return coder_ ? coder_->codebook() : std::vector<glm::vec3>{}; }
  // Detail sites have base colours, and lobes of their own number.
  bool isCompressed() const { return coder_.has_value(); }

  // Fills the colours and detail scales of a chunk with the live cells `sources` (BakeCells); `faces` holds the same
  // cells. False: asked to stop.
  bool fill(std::span<const uint32_t> sources, const Foam& faces, const StageProgress& stage, ChunkContents& chunk,
            AttributeErrors& errors) const;

 private:
  uint32_t inputCount_ = 0;
  uint32_t lobeCount_ = 0;
  std::optional<AppearanceCoder> coder_, mergedCoder_;
};

}  // namespace froth
