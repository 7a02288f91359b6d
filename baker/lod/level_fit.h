// Merged cells descend towards pictures of level 0 (docs/STREAMING.md "Fit"): colours, densities, detail sites, heights
// and normals. Sites and radii stay, and with them all neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/lod/front_image.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

class LevelFit {
 public:
  // Without views nothing is fitted.
  LevelFit(std::span<const View> views, const FrontOptions& options);

  // All cells of level 0: what the views show.
  Status takeFinest(const Foam& foam, const Progress& progress);
  // Of a foam with base colours or lobes of any number nothing is.
  bool isFitting() const { return !views_.empty(); }
  // All cells of a coarser level; changes those that are free. Through `viewCount` of the views, or all if they are
  // fewer. The same bits on any number of threads. Fails with kCancelled.
  Status fit(Foam& foam, std::span<const uint8_t> isFree, size_t viewCount, const Progress& progress) const;

 private:
  // A pixel of it is a box of rays: a level stands for level 0 where pixels are no smaller than cells.
  struct FitView {
    View view;                      // of the rays
    std::vector<glm::vec4> wanted;  // [boxes] mean of what level 0 shows: colour over black, transmittance
  };
  std::vector<View> given_;
  FrontOptions options_;
  std::vector<FitView> views_;
};

// What a fit changes of a cell, but for its density. Both foams have as many detail sites and lobes.
void copyFittedFace(const Foam& from, uint32_t fromCell, Foam& to, uint32_t toCell);

}  // namespace froth
