// The same foam without something, or with something that it does not have: what a feature costs is the difference.
#pragma once

#include <cstdint>

#include "foam/foam.h"

namespace froth {

// Every detail site looks the same from everywhere: its mean colour over the hemisphere before its face. One lobe per
// site.
Foam withoutViewDependence(const Foam& foam);

// Plain faces: all heights zero.
Foam withoutDisplacement(const Foam& foam);

// The `count` detail sites of each cell that are nearest over the largest shares of its face [1..K], in their order.
Foam withFewerDetailSites(const Foam& foam, uint32_t count);

// Little of what the foam lacks, and as much as the coarsest preset still keeps. Each wants a foam of plain faces, of
// one detail site, of one lobe.
Foam withSomeDisplacement(const Foam& foam);
Foam withSomeDetailSites(const Foam& foam);     // K = 2
Foam withSomeViewDependence(const Foam& foam);  // M = 2

}  // namespace froth
