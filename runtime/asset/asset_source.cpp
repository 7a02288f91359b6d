#include "runtime/asset/asset_source.h"

#include <algorithm>

namespace froth {

AssetSource sourceOf(const FrothAssetInfo& info) {
  AssetSource source;
  if (info.path) {
    source.name = info.path;
  } else if (info.reader) {
    source.kind = SourceKind::kReader;
    source.name = info.reader->name ? info.reader->name : "asset of a reader";
    source.reader = *info.reader;
  } else {
    source.kind = SourceKind::kMemory;
    source.name = "asset in memory";
    source.bytes = {static_cast<const uint8_t*>(info.data), info.dataSize};
  }
  source.bytesStay = info.bytesStay != 0;
  source.lastLayer = static_cast<Layer>((info.layers == 0 ? kLayerCount : info.layers) - 1);
  return source;
}

Result<AssetReader> openReader(const AssetSource& source) {
  return source.kind == SourceKind::kFile ? AssetReader::open(source.name, source.lastLayer)
                                          : AssetReader::openBytes(source.bytes, source.name, source.lastLayer);
}

AssetShape shapeOf(const AssetReader& reader, Layer lastLayer) {
  const SectionType heights = lastLayer == Layer::kGeometry ? SectionType::kCellHeights : SectionType::kDetailHeights;
  const auto holdsHeights = [&](const SectionRecord& section) {
    return section.type == static_cast<uint32_t>(heights);
  };
  const AssetContents& manifest = reader.manifest();
  return {manifest.detailCount, manifest.lobeCount, std::ranges::any_of(reader.sections(), holdsHeights)};
}

}  // namespace froth
