// How far the coarse form of a group lies from its fine form.
#pragma once

#include "foam/foam.h"

namespace froth {

// The RMS distance of the fine cells from the nearest coarse ones [scene units]: what the error of a group is guessed
// from where no view sees it (baker/lod/level_errors.h).
double measureFormDistance(const Foam& fine, const Foam& coarse);

}  // namespace froth
