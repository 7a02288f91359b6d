// Inputs of the commands: a `.froth` file is an asset, every other name a checkpoint.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "baker/foam.h"
#include "baker/progress.h"
#include "format/result.h"

namespace froth {

bool isAssetPath(const std::filesystem::path& path);

// A foam and how it wants to be rendered.
struct FoamInput {
  Foam foam;
  float nearRatio = 4.0f;  // defaults of a bare checkpoint (foam.md "Near cells")
  float nearDepth = 0.0f;
  float detailSharpness = 10.0f;
};

Result<FoamInput> loadFoam(const std::filesystem::path& path, const Progress& progress);

// An asset for the runtime: a file, or a checkpoint that was baked in memory.
struct AssetInput {
  std::filesystem::path path;
  std::vector<uint8_t> bytes;  // empty: read `path`
};

Result<AssetInput> loadAsset(const std::filesystem::path& path, const Progress& progress);

}  // namespace froth
