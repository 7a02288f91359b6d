// Inputs of the commands: a `.froth` file is an asset, every other name a checkpoint.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"

namespace froth {

bool isAssetPath(const std::filesystem::path& path);

// A file that this build cannot read is bad input, whether it is damaged or newer: the same exit code from every
// command.
inline Error asBadInput(Error error) {
  if (error.kind == ErrorKind::kUnsupported) error.kind = ErrorKind::kBadInput;
  return error;
}

// A foam and how it wants to be rendered.
struct FoamInput {
  Foam foam;
  float nearRatio = 4.0f;  // defaults of a bare checkpoint (docs/FOAM.md "Near cells")
  float nearDepth = 0.0f;
  float detailSharpness = 10.0f;
};

// Layers of an asset that are loaded [1..3]: the first shows one colour per cell, the second detail without view
// dependence.
inline constexpr uint32_t kAllLayers = 3;
// A checkpoint has no layers.
Status checkLayers(const std::filesystem::path& path, uint32_t layers);

Result<FoamInput> loadFoam(const std::filesystem::path& path, const Progress& progress, uint32_t layers = kAllLayers);

// An asset for the runtime: a file, or a checkpoint that was baked in memory.
struct AssetInput {
  std::filesystem::path path;
  std::vector<uint8_t> bytes;  // empty: read `path`
  uint32_t layers = kAllLayers;
};

Result<AssetInput> loadAsset(const std::filesystem::path& path, const Progress& progress, uint32_t layers = kAllLayers);

}  // namespace froth
