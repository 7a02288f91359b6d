// The lattices of an asset, from the knobs of its bake.
#pragma once

#include <cstdint>

#include "baker/bake/bake.h"
#include "foam/foam.h"
#include "format/quantization.h"

namespace froth {

// 2^-bits; 0 bits: 0.
float stepOfBits(uint32_t bits);

// The lattices that the knobs ask for, fitted to the foam's extent.
Quantization makeLattices(const Foam& foam, const BakeKnobs& knobs);

}  // namespace froth
