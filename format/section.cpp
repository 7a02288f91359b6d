#include "format/section.h"

#include <array>

namespace froth {
namespace {

struct SectionInfo {
  SectionType type;
  const char* name;
  Layer layer;
};

constexpr std::array kSections = {
    SectionInfo{SectionType::kSites, "sites", Layer::kGeometry},
    SectionInfo{SectionType::kGhostSites, "ghost_sites", Layer::kGeometry},
    SectionInfo{SectionType::kRadii, "radii", Layer::kGeometry},
    SectionInfo{SectionType::kGhostRefs, "ghost_refs", Layer::kGeometry},
    SectionInfo{SectionType::kGraphCounts, "graph_counts", Layer::kGeometry},
    SectionInfo{SectionType::kGraphDeltas, "graph_deltas", Layer::kGeometry},
    SectionInfo{SectionType::kGraphAlphaBits, "graph_alpha_bits", Layer::kGeometry},
    SectionInfo{SectionType::kDensities, "densities", Layer::kGeometry},
    SectionInfo{SectionType::kOrientations, "orientations", Layer::kGeometry},
    SectionInfo{SectionType::kCellColours, "cell_colours", Layer::kGeometry},
    SectionInfo{SectionType::kCellHeights, "cell_heights", Layer::kGeometry},
    SectionInfo{SectionType::kSolidBalls, "solid_balls", Layer::kGeometry},
    SectionInfo{SectionType::kDetailSites, "detail_sites", Layer::kDetails},
    SectionInfo{SectionType::kDetailHeights, "detail_heights", Layer::kDetails},
    SectionInfo{SectionType::kColourScales, "colour_scales", Layer::kDetails},
    SectionInfo{SectionType::kBaseColours, "base_colours", Layer::kDetails},
    SectionInfo{SectionType::kDetailScales, "detail_scales", Layer::kDetails},
    SectionInfo{SectionType::kLobeCounts, "lobe_counts", Layer::kViewDependence},
    SectionInfo{SectionType::kLobeLabels, "lobe_labels", Layer::kViewDependence},
    SectionInfo{SectionType::kLobeAxes, "lobe_axes", Layer::kViewDependence},
    SectionInfo{SectionType::kLobeColours, "lobe_colours", Layer::kViewDependence},
    SectionInfo{SectionType::kAxisCodebook, "axis_codebook", Layer::kViewDependence},
};

constexpr auto kTypes = [] {
  std::array<SectionType, kSections.size()> types{};
  for (size_t i = 0; i < types.size(); ++i) types[i] = kSections[i].type;
  return types;
}();

const SectionInfo* findInfo(uint32_t type) {
  for (const SectionInfo& info : kSections)
    if (static_cast<uint32_t>(info.type) == type) return &info;
  return nullptr;
}

ElementKind kindOnLattice(ElementKind kind, bool hasLattice) {
  return hasLattice ? kind : ElementKind::kFloat;
}

}  // namespace

std::span<const SectionType> allSectionTypes() {
  return kTypes;
}

const char* sectionName(uint32_t type) {
  const SectionInfo* info = findInfo(type);
  return info ? info->name : nullptr;
}

Layer sectionLayer(SectionType type) {
  return findInfo(static_cast<uint32_t>(type))->layer;
}

uint32_t sectionComponents(SectionType type, const Quantization& quantization) {
  switch (type) {
    case SectionType::kSites:
    case SectionType::kGhostSites:
    case SectionType::kCellColours:
    case SectionType::kBaseColours:
    case SectionType::kLobeAxes:
    case SectionType::kLobeColours:
    case SectionType::kAxisCodebook:
      return 3;
    case SectionType::kOrientations:
      return quantization.normalBits > 0 ? 2 : 4;
    case SectionType::kSolidBalls:
      return 4;
    case SectionType::kDetailSites:
      return 2;
    default:
      return 1;
  }
}

ElementKind sectionKind(SectionType type, const Quantization& quantization) {
  switch (type) {
    case SectionType::kSites:
    case SectionType::kGhostSites:
      return kindOnLattice(ElementKind::kInt32, quantization.positionStep > 0);
    case SectionType::kRadii:
      return kindOnLattice(ElementKind::kUnsigned, quantization.radiusBits < 23);
    case SectionType::kDensities:
      return kindOnLattice(ElementKind::kUnsigned, quantization.densityBits < 23);
    case SectionType::kOrientations:
      return kindOnLattice(ElementKind::kUnsigned, quantization.normalBits > 0);
    case SectionType::kDetailSites:
      return kindOnLattice(ElementKind::kSigned, quantization.detailSiteStep > 0);
    case SectionType::kCellHeights:
    case SectionType::kDetailHeights:
      return kindOnLattice(ElementKind::kSigned, quantization.heightStep > 0);
    case SectionType::kBaseColours:
    case SectionType::kLobeColours:
      return kindOnLattice(ElementKind::kSigned, quantization.colourStep > 0);
    case SectionType::kLobeAxes:
      return kindOnLattice(ElementKind::kSigned, quantization.lobeAxisStep > 0);
    case SectionType::kGhostRefs:
      return ElementKind::kUint32;
    case SectionType::kGraphCounts:
    case SectionType::kGraphDeltas:
      return ElementKind::kGraph;
    case SectionType::kLobeLabels:
      return ElementKind::kUnsigned;
    case SectionType::kAxisCodebook:
      return ElementKind::kFloat;
    case SectionType::kGraphAlphaBits:
    case SectionType::kCellColours:
    case SectionType::kSolidBalls:
    case SectionType::kColourScales:
    case SectionType::kDetailScales:
    case SectionType::kLobeCounts:
      return ElementKind::kByte;
  }
  return ElementKind::kByte;
}

bool isElementSize(ElementKind kind, uint32_t size) {
  switch (kind) {
    case ElementKind::kFloat:
    case ElementKind::kInt32:
    case ElementKind::kUint32:
      return size == 4;
    case ElementKind::kGraph:
      return size == 2 || size == 4;
    case ElementKind::kByte:
      return size == 1;
    case ElementKind::kUnsigned:
    case ElementKind::kSigned:
      return size == 1 || size == 2 || size == 4;
  }
  return false;
}

uint64_t sectionEntries(SectionType type, const ChunkCounts& counts, uint32_t detailCount) {
  switch (type) {
    case SectionType::kSites:
    case SectionType::kGraphCounts:
      return counts.cells;
    case SectionType::kRadii:
      return counts.cells + counts.ghosts;
    case SectionType::kGhostSites:
    case SectionType::kGhostRefs:
      return counts.ghosts;
    case SectionType::kGraphDeltas:
      return counts.pairs;
    case SectionType::kGraphAlphaBits:
      return (counts.pairs + 7) / 8;
    case SectionType::kDensities:
    case SectionType::kOrientations:
    case SectionType::kCellColours:
    case SectionType::kCellHeights:
    case SectionType::kSolidBalls:
    case SectionType::kColourScales:
    case SectionType::kDetailScales:
      return counts.live;
    case SectionType::kDetailSites:
    case SectionType::kDetailHeights:
    case SectionType::kBaseColours:
    case SectionType::kLobeCounts:
      return counts.live * detailCount;
    case SectionType::kLobeLabels:
    case SectionType::kLobeAxes:
    case SectionType::kLobeColours:
      return counts.lobes;
    case SectionType::kAxisCodebook:
      return 0;
  }
  return 0;
}

Presence sectionPresence(SectionType type, const AssetContents& asset, bool hasCodebook,
                         const ChunkCounts& counts) {
  const auto requiredIf = [](bool condition) {
    return condition ? Presence::kRequired : Presence::kForbidden;
  };
  if (sectionEntries(type, counts, asset.detailCount) == 0) return Presence::kForbidden;
  switch (type) {
    case SectionType::kGraphCounts:
      return requiredIf(counts.pairs > 0);
    case SectionType::kGraphAlphaBits:
      return requiredIf(asset.hasWalkGraph);
    case SectionType::kCellColours:
    case SectionType::kCellHeights:
    case SectionType::kSolidBalls:
    case SectionType::kDetailSites:
    case SectionType::kDetailHeights:
    case SectionType::kBaseColours:
      return Presence::kOptional;
    case SectionType::kColourScales:
      return asset.quantization.colourStep > 0 ? Presence::kOptional : Presence::kForbidden;
    case SectionType::kDetailScales:
      return asset.quantization.detailSiteStep > 0 && asset.quantization.heightStep > 0 ? Presence::kOptional
                                                                                        : Presence::kForbidden;
    case SectionType::kLobeCounts:
      return requiredIf(counts.lobes > 0 && counts.lobes < counts.live * asset.detailCount * asset.lobeCount);
    case SectionType::kLobeLabels:
      return requiredIf(hasCodebook);
    case SectionType::kLobeAxes:
      if (!hasCodebook) return Presence::kRequired;
      return asset.quantization.lobeAxisStep > 0 ? Presence::kOptional : Presence::kForbidden;
    default:
      return Presence::kRequired;
  }
}

std::string chunkPlace(const std::string& file, uint32_t chunk) {
  return chunk == kSharedChunk ? file + ": shared" : file + ": chunk " + std::to_string(chunk);
}

std::string sectionPlace(const std::string& chunkPlace, uint32_t type) {
  const char* name = sectionName(type);
  const std::string place = chunkPlace + ", section ";
  return name ? place + "'" + name + "'" : place + "of type " + std::to_string(type);
}

std::string sectionPlace(const std::string& chunkPlace, SectionType type) {
  return sectionPlace(chunkPlace, static_cast<uint32_t>(type));
}

}  // namespace froth
