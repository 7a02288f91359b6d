// From a file's bytes to its eight tensors.
#pragma once

#include <array>

#include "base/progress.h"
#include "base/result.h"
#include "foam/checkpoint/bad_input.h"
#include "foam/checkpoint/parameters.h"
#include "foam/checkpoint/tensor.h"

namespace froth {

using CheckpointViews = std::array<TensorView, kParameterCount>;  // by Parameter

// Reads archive and pickle, compares the checksums of the pickle and of the eight tensors' storages. The
// views point into `file`. Shapes are as found: only that each view lies inside its storage is certain. Other
// tensors are not looked at.
Result<CheckpointViews> viewCheckpoint(const NamedBytes& file, const Progress& progress = {});

}  // namespace froth
