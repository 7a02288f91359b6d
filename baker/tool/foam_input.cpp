#include "baker/tool/foam_input.h"

#include <utility>

#include "baker/bake/bake.h"
#include "baker/checkpoint/checkpoint.h"
#include "format/asset_reader.h"
#include "format/asset_writer.h"

namespace froth {
namespace {

Result<FoamInput> loadFoamOfAsset(const std::filesystem::path& path) {
  Result<AssetContents> contents = readAsset(path);
  if (!contents) return contents.error();
  Result<Foam> foam = foamFromAsset(*contents);
  if (!foam) return foam.error();
  return FoamInput{std::move(*foam), contents->nearRatio, contents->nearDepth, contents->detailSharpness};
}

}  // namespace

bool isAssetPath(const std::filesystem::path& path) {
  return path.extension() == ".froth";
}

Result<FoamInput> loadFoam(const std::filesystem::path& path, const Progress& progress) {
  if (isAssetPath(path)) return loadFoamOfAsset(path);
  Result<Foam> foam = importCheckpoint(path, progress);
  if (!foam) return foam.error();
  FoamInput input;
  input.foam = std::move(*foam);
  return input;
}

Result<AssetInput> loadAsset(const std::filesystem::path& path, const Progress& progress) {
  AssetInput input;
  input.path = path;
  if (isAssetPath(path)) return input;

  const Result<Foam> foam = importCheckpoint(path, progress);
  if (!foam) return foam.error();
  BakeOptions options;
  options.source = path.filename().string();
  const Result<BakeResult> baked = bakeFoam(*foam, options, progress);
  if (!baked) return baked.error();
  Result<std::vector<uint8_t>> bytes = encodeAsset(baked->contents);
  if (!bytes) return bytes.error();
  input.bytes = std::move(*bytes);
  return input;
}

}  // namespace froth
