// Small foams for tests: each exercises one thing, and none looks like anything.
#pragma once

#include "baker/synth/synth.h"
#include "base/result.h"
#include "foam/foam.h"

namespace froth {

// One cell of radius 1/2 at (0, 0, 2), facing the origin. K = 1, M = 1.
Result<Foam> synthesizeOne(const SynthOptions& options);

// Two overlapping cells at z = 2, side by side along x, facing the origin. K = 1, M = 1.
Result<Foam> synthesizeTwo(const SynthOptions& options);

// n^3 cells of varied frames and densities on a unit lattice around (0, 0, n + 2); n = 4 unless cellCount, a
// cube, says otherwise. K = 2, M = 2.
Result<Foam> synthesizeGrid(const SynthOptions& options, const Progress& progress);

// A sphere of radius 2 around the origin tiled by cells that face it; the default is 1000. K = 4, M = 2.
Result<Foam> synthesizeShell(const SynthOptions& options, const Progress& progress);

// Cells of random place, radius, frame, density (a tenth are empty), relief and lobes in [-1, 1]^3 + (0, 0,
// 3); the default is 500. K = 8, M = 8.
Result<Foam> synthesizeRandom(const SynthOptions& options, const Progress& progress);

}  // namespace froth
