// The published checkpoint `model.pt`: torch.save of one dict of tensors (docs/FOAM.md "Checkpoint").
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"

namespace froth {

// Reads, checks and activates (softplus, normalisation; in double, rounded once to float). The pickle is read
// by an interpreter of the few opcodes and globals that such a file needs; everything else is refused by
// name. Refuses NaN, infinity, denormal numbers, radii that activate to less than a normal float (such densities are
// 0), quaternions of length 0, counts beyond the file's size (expanded tensors may make the foam 256 times as large as
// the file, not more).
Result<Foam> importCheckpoint(const std::filesystem::path& path, const Progress& progress = {});

// The same from memory; messages call the bytes `name`. Any bytes give a foam or an error.
Result<Foam> importCheckpointBytes(std::span<const uint8_t> bytes, const std::string& name,
                                   const Progress& progress = {});

// Writes the layout that published tools load: stored ZIP, protocol-2 pickle, contiguous float32, raw
// (inverse-activated) values, Cech adjacency of the written spheres, `version` and `byteorder` members.
// Atomic. The same foam gives the same bytes.
Status exportCheckpoint(const std::filesystem::path& path, const Foam& foam, const Progress& progress = {});

// The same without adjacency and without a look at the values: files that must be refused, NaN and all, are made with
// it. The array lengths match the counts.
Status exportUnchecked(const std::filesystem::path& path, const Foam& foam);

}  // namespace froth
