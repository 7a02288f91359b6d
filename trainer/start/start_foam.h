// The foam that training starts from.
#pragma once

#include <cstdint>

#include "base/result.h"
#include "foam/foam.h"
#include "trainer/start/start_cells.h"

namespace froth {

struct StartOptions {
  uint32_t cellCount = 0;    // [>= 1]
  uint32_t detailCount = 8;  // K [1..32]
  uint32_t lobeCount = 8;    // M [1..32]
};

struct StartFoam {
  Foam foam;  // in the normalised scene; finite, radii > 0
  // Cells by their origin, in this order in the foam.
  uint32_t points = 0, mixtures = 0, random = 0;
  uint32_t gaps = 0;  // the last cells of the foam, in place of as many of these
};

// Cells on points of structure from motion, spread over all of them; where there are too few, random mixtures of
// neighbours, at most 9 for each point; all others random in the frusta of the cameras. Where photos show what none of
// these covers, cells that do so stand in place of the last, of three quarters at most (cover_views.h).
//
// - radius: the mean distance of the 8 nearest (its own 0 included), at least 1e-4, at most 5 % of an image's height
//   (limitRadii)
// - density: softplus(0.1) per unit (StartScene::eyes), so a cell absorbs about 1 %
// - normal: to the cameras that see it, turned about that at random; unknown: random
// - colours: the point's, or the pixel's, in every direction
// - detail sites normal(0, 0.1^2), heights 0, lobe axes normal(0, 2^2)
//
// The same scene, options and seed give the same bits, on any number of threads.
Result<StartFoam> makeStartFoam(const StartScene& scene, const StartOptions& options);

}  // namespace froth
