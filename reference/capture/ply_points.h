// The points of a PLY file, as nerfstudio writes one beside transforms.json.
#pragma once

#include <vector>

#include "foam/checkpoint/bad_input.h"
#include "reference/capture/capture.h"

namespace froth {

// Vertices of a file in ASCII or either binary form, whose first element they are: x, y, z, and red, green, blue (or
// diffuse_red ...) as whole numbers up to 255 or as floats up to 1; grey without. All else is skipped. No views are
// said to show them. Any bytes give points or an error.
Result<std::vector<CapturedPoint>> parsePlyPoints(const NamedBytes& file);

}  // namespace froth
