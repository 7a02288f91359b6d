// Cells for what photos show and no other first cell covers.
#pragma once

#include <span>
#include <vector>

#include "trainer/start/start_cells.h"

namespace froth {

// Points stand on texture, so bare walls and what lies far away begin without a ball. A ray that meets none shows the
// background and pulls no ball there, and radii learn slowly, so such gaps would stay. Here balls of 8 % of an image's
// height cover them, view by view, as deep as the farthest cells around the gap in that view.
//
// `cells` have the radii [cells, > 0] and are seen but for those nearer than 4 radii. At most `most` cells; none for
// pixels whose photo's alpha is below a half or that a mask ignores, and none without photos. The same input gives the
// same cells, on any number of threads.
std::vector<StartCell> cellsInGaps(const StartScene& scene, std::span<const StartCell> cells,
                                   std::span<const float> radii, uint32_t most);

}  // namespace froth
