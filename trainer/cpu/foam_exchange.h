// Between a foam in memory and one in training.
#pragma once

#include "foam/foam.h"
#include "trainer/cpu/foam_storage.h"

namespace froth {

// Raw parameters of a foam with the same number of lobes everywhere and no base colours; moments, if it has any, and
// means are 0.
template <class Real>
FoamStorage<Real> storeFoam(const Foam& foam, AdamMoments moments = AdamMoments::kKept);

// The foam that is trained, in the same order. Waiting parameters are as they stand (catchUpAll in trainer/loop/).
template <class Real>
Foam activateFoam(const FoamStorage<Real>& storage);

}  // namespace froth
