// A stiff case as a file: JSON that a person can read and shorten, and every number of which comes back with the same
// bits.
//
// {"name", "what", "analysis": texts, "moved": [x, y, z], "imported": flag, "most_lobes": M,
//  "known": [{"preset", "renderer", "kind", "cause": texts, "factor": number}],
//  "places": [{"position": [x, y, z], "rotation": [w, x, y, z], "scale"}], of instances: at most 4; none: one, as it is
//  "ends": [[rows of numbers, or "never"]], an image for each view: where each ray ends; none: nowhere
//  "jitter": [x, y], "layers": 1 to 3, "chunk_cells": 0 (as always) to 1048576,
//  "cells": [{"site": [x, y, z], "radius", "density", "orientation": [w, x, y, z],
//             "details": [{"place": [u, v], "height", "base": [r, g, b] or absent, "lobes": [[axis x, y, z, colour r,
//             g, b]]}]}],
//  "views": as in cameras.json (docs/CAMERAS.md), so that the file serves as one}
//
// "places", "ends", "jitter", "layers" and "chunk_cells" may be absent: StiffCase has their defaults.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "measure/stability/cases/stiff_case.h"

namespace froth {

inline constexpr const char* kNeverInCaseFile = "never";  // where a ray ends that has no end: JSON has no infinity

// Every number is checked to be finite, every array to have its length, rotations to be of unit length and scales to be
// above 0; errors name file and field. Memory is bounded by the file's size.
Result<StiffCase> readCase(const std::filesystem::path& path);
// The same from memory; `file` stands for it in messages.
Result<StiffCase> parseCase(std::span<const uint8_t> bytes, const std::string& file);

// Fails with kUsage for a case that readCase would refuse, as one that StiffCase::refusal is about: the message says
// why. A view's ray map is named, not written.
Status writeCase(const std::filesystem::path& path, const StiffCase& stiffCase);

}  // namespace froth
