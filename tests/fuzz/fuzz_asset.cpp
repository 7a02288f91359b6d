// Any bytes as an asset, its first layer and all of it: no crash, no leak, no hang, no allocation beyond the limit that
// libFuzzer sets.
#include <span>

#include "format/read/asset_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  for (const froth::Layer last : {froth::Layer::kGeometry, froth::Layer::kViewDependence}) {
    froth::Result<froth::AssetReader> reader = froth::AssetReader::openBytes({data, size}, "fuzz.froth", last);
    if (!reader) return 0;
    for (uint32_t chunk = 0; chunk < reader->manifest().chunks.size(); ++chunk) (void)reader->readChunk(chunk);
  }
  return 0;
}
