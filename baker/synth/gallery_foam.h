// The gallery as a foam.
#pragma once

#include <cstdint>

#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"

namespace froth {

struct GallerySize {
  uint32_t cells = 200000;   // at most; surfaces take whole rows of cells, so it is a few percent less
  uint32_t detailSites = 8;  // K [1..32]
  uint32_t lobes = 8;        // M [1..32]
};

// Fails with kUsage below the number of cells that the thinnest parts need.
Result<Foam> synthesizeGallery(const GallerySize& size, uint64_t seed, const Progress& progress);

}  // namespace froth
