// From a file's bytes to its eight tensors.
#pragma once

#include <array>

#include "baker/checkpoint/bad_input.h"
#include "baker/checkpoint/parameters.h"
#include "baker/checkpoint/tensor.h"
#include "baker/progress.h"
#include "format/result.h"

namespace froth {

using CheckpointViews = std::array<TensorView, kParameterCount>;  // by Parameter

// Reads archive and pickle, compares the checksums of the pickle and of the eight tensors' storages. The
// views point into `file`. Shapes are as found: only that each view lies inside its storage is certain. Other
// tensors are not looked at.
Result<CheckpointViews> viewCheckpoint(const NamedBytes& file, const Progress& progress = {});

}  // namespace froth
