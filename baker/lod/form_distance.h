// How far the coarse form of a group lies from its fine form.
#pragma once

#include "foam/foam.h"

namespace froth {

// The RMS distance of the fine cells from the nearest coarse ones [scene units]. Errors of groups are this distance:
// what images show of them (baker/lod/group_error.h) is no useful threshold yet, see docs/notes/levels.md.
double measureFormDistance(const Foam& fine, const Foam& coarse);

}  // namespace froth
