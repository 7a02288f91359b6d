// A stiff case as a file: JSON that a person can read and shorten, and every number of which comes back with the same bits.
//
// {"name", "what", "analysis": texts, "moved": [x, y, z], "imported": flag, "most_lobes": M,
//  "known": [{"preset", "renderer", "kind", "cause": texts, "factor": number}],
//  "cells": [{"site": [x, y, z], "radius", "density", "orientation": [w, x, y, z],
//             "details": [{"place": [u, v], "height", "base": [r, g, b] or absent, "lobes": [[axis x, y, z, colour r, g, b]]}]}],
//  "views": as in cameras.json (docs/CAMERAS.md), so that the file serves as one}
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "measure/stability/cases/stiff_case.h"

namespace froth {

// Every number is checked to be finite, every array to have its length; errors name file and field. Memory is bounded by the
// file's size.
Result<StiffCase> readCase(const std::filesystem::path& path);
// The same from memory; `file` stands for it in messages.
Result<StiffCase> parseCase(std::span<const uint8_t> bytes, const std::string& file);

// Fails with kUsage for a case that readCase would refuse, as one that StiffCase::refusal is about: the message says why. A view's ray map is named, not written.
Status writeCase(const std::filesystem::path& path, const StiffCase& stiffCase);

}  // namespace froth
