#include "baker/input/foam_input.h"

#include <utility>

#include "baker/bake/bake.h"
#include "base/text.h"
#include "foam/checkpoint/checkpoint.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"

namespace froth {
namespace {

Result<FoamInput> loadFoamOfAsset(const std::filesystem::path& path, uint32_t layers) {
  Result<AssetContents> contents = readAsset(path, static_cast<Layer>(layers - 1));
  if (!contents) return asBadInput(contents.error());
  Result<Foam> foam = foamFromAsset(*contents);
  if (!foam) return foam.error();
  return FoamInput{std::move(*foam), contents->nearRatio, contents->nearDepth, contents->detailSharpness};
}

}  // namespace

bool isAssetPath(const std::filesystem::path& path) { return path.extension() == ".froth"; }

Status checkLayers(const std::filesystem::path& path, uint32_t layers) {
  if (layers == kAllLayers || isAssetPath(path)) return {};
  return makeError(ErrorKind::kUsage, "--layers %u: %s has no layers; bake it and name the .froth", layers,
                   path.c_str());
}

Result<FoamInput> loadFoam(const std::filesystem::path& path, const Progress& progress, uint32_t layers) {
  if (isAssetPath(path)) return loadFoamOfAsset(path, layers);
  Result<Foam> foam = importCheckpoint(path, progress);
  if (!foam) return foam.error();
  FoamInput input;
  input.foam = std::move(*foam);
  return input;
}

Result<AssetInput> loadAsset(const std::filesystem::path& path, const Progress& progress, uint32_t layers) {
  AssetInput input;
  input.path = path;
  input.layers = layers;
  if (isAssetPath(path)) return input;

  const Result<Foam> foam = importCheckpoint(path, progress);
  if (!foam) return foam.error();
  BakeOptions options;
  options.source = printable(path.filename().string());
  const Result<BakeResult> baked = bakeFoam(*foam, options, progress);
  if (!baked) return baked.error();
  Result<std::vector<uint8_t>> bytes = encodeAsset(baked->contents);
  if (!bytes) return bytes.error();
  input.bytes = std::move(*bytes);
  return input;
}

}  // namespace froth
