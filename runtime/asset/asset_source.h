// Where an asset comes from: a file, or bytes of the caller.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "format/read/asset_reader.h"
#include "froth/froth.h"
#include "runtime/asset/gpu_asset.h"

namespace froth {

inline constexpr uint32_t kLayerCount = 3;

struct AssetSource {
  std::string name;  // path of a file; for messages
  bool isFile = true;
  std::span<const uint8_t> bytes{};          // of no file: the caller keeps them until loading has ended,
  bool bytesStay = false;                    // or as long as the asset, which can then load again
  Layer lastLayer = Layer::kViewDependence;  // what is behind it is not read
};

// info has been checked.
AssetSource sourceOf(const FrothAssetInfo& info);

Result<AssetReader> openReader(const AssetSource& source);
AssetShape shapeOf(const AssetReader& reader, Layer lastLayer);

}  // namespace froth
