// The eyes of `froth bake --eyes`.
#pragma once

#include <string>

#include "baker/bake/bake.h"
#include "base/result.h"

namespace froth {

// "cameras", "cameras+R" or "box:X0,Y0,Z0,X1,Y1,Z1" [scene units].
Result<EyeChoice> parseEyes(const std::string& text);

}  // namespace froth
