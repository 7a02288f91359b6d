// What an asset will hold, found without a device.
#pragma once

#include <cstdint>

#include "base/result.h"
#include "runtime/asset/asset_source.h"

namespace froth {

struct AssetMeasure {
  GpuAsset gpu;              // without addresses
  uint64_t deviceBytes = 0;  // of its arrays
  uint64_t hostBytes = 0;    // of QueryFoam
};

// prepared: kPreparedNothing..., with keepsForWalks. Decodes and checks the asset chunk by chunk, as loading does, and
// keeps nothing but what queries would keep.
Result<AssetMeasure> measureAsset(const AssetSource& source, bool keepsForQueries, bool keepsForWalks,
                                  uint32_t prepared);

}  // namespace froth
