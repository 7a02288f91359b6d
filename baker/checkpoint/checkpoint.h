// The published checkpoint `model.pt`: torch.save of one dict of tensors (foam.md "Checkpoint").
#pragma once

#include <filesystem>

#include "baker/foam.h"
#include "baker/progress.h"
#include "format/result.h"

namespace froth {

// Reads, checks and activates (softplus, normalisation; in double, rounded once to float). The pickle is read by an
// interpreter of the few opcodes and globals that such a file needs; everything else is refused by name.
// Refuses NaN, infinity, radii that underflow to 0, counts beyond the file's size.
Result<Foam> importCheckpoint(const std::filesystem::path& path, const Progress& progress = {});

// Writes the layout that published tools load: stored ZIP, protocol-2 pickle, contiguous float32, raw (inverse-activated)
// values, Cech adjacency of the written spheres, `version` and `byteorder` members. Atomic. The same foam gives the same bytes.
Status exportCheckpoint(const std::filesystem::path& path, const Foam& foam, const Progress& progress = {});

}  // namespace froth
