// The first step of a bake: whether input and knobs are what the other steps take for granted. Internal to baker/bake.
#pragma once

#include "baker/bake/bake.h"
#include "base/result.h"
#include "foam/foam.h"

namespace froth {

Status checkFoam(const Foam& foam);
Status checkOptions(const BakeOptions& options);

}  // namespace froth
