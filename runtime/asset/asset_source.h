// Where an asset comes from: a file, bytes of the caller, or a reader of theirs.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "format/read/asset_reader.h"
#include "froth/froth_reader.h"
#include "runtime/asset/gpu_asset.h"

namespace froth {

inline constexpr uint32_t kLayerCount = 3;

enum class SourceKind { kFile, kMemory, kReader };

struct AssetSource {
  SourceKind kind = SourceKind::kFile;
  std::string name;                          // path of a file; for messages
  std::span<const uint8_t> bytes{};          // kMemory: the caller keeps them until loading has ended,
  bool bytesStay = false;                    // or as long as the asset, which can then load again
  FrothReader reader{};                      // kReader; its name is not read
  Layer lastLayer = Layer::kViewDependence;  // what is behind it is not read
};

// info has been checked.
AssetSource sourceOf(const FrothAssetInfo& info);

Result<AssetReader> openReader(const AssetSource& source);  // kFile, kMemory
AssetShape shapeOf(const AssetReader& reader, Layer lastLayer);

}  // namespace froth
