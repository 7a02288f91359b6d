#include "format/section.h"

#include <array>

namespace froth {
namespace {

using Counts = const ChunkCounts&;
using Lattices = const Quantization&;

// What a chunk's sections depend on.
struct Demand {
  const AssetContents& asset;  // but for its chunks
  bool hasCodebook;
  const ChunkCounts& counts;
};

Presence requiredIf(bool condition) { return condition ? Presence::kRequired : Presence::kForbidden; }
Presence optionalIf(bool condition) { return condition ? Presence::kOptional : Presence::kForbidden; }

// Entries of a chunk.
uint64_t ofCells(Counts counts, uint64_t) { return counts.cells; }
uint64_t ofSites(Counts counts, uint64_t) { return counts.cells + counts.ghosts; }
uint64_t ofGhosts(Counts counts, uint64_t) { return counts.ghosts; }
uint64_t ofPairs(Counts counts, uint64_t) { return counts.pairs; }
uint64_t ofPairBits(Counts counts, uint64_t) { return (counts.pairs + 7) / 8; }
uint64_t ofLive(Counts counts, uint64_t) { return counts.live; }
uint64_t ofDetails(Counts counts, uint64_t detailCount) { return counts.live * detailCount; }
uint64_t ofLobes(Counts counts, uint64_t) { return counts.lobes; }
uint64_t ofBorders(Counts counts, uint64_t) { return counts.borders; }
uint64_t none(Counts, uint64_t) { return 0; }

// Whether numbers lie on a lattice; else they are floats.
bool always(Lattices) { return true; }
bool never(Lattices) { return false; }
bool ifPositions(Lattices q) { return q.positionStep > 0; }
bool ifRadii(Lattices q) { return q.radiusBits < 23; }
bool ifDensities(Lattices q) { return q.densityBits < 23; }
bool ifNormals(Lattices q) { return q.normalBits > 0; }
bool ifDetails(Lattices q) { return q.detailSiteStep > 0; }
bool ifHeights(Lattices q) { return q.heightStep > 0; }
bool ifColours(Lattices q) { return q.colourStep > 0; }
bool ifAxes(Lattices q) { return q.lobeAxisStep > 0; }

// Presence where there are entries.
Presence required(const Demand&) { return Presence::kRequired; }
Presence optional(const Demand&) { return Presence::kOptional; }
Presence ofAGraph(const Demand& demand) { return requiredIf(demand.counts.pairs > 0); }
Presence ofAWalkGraph(const Demand& demand) { return requiredIf(demand.asset.hasWalkGraph); }
Presence ofColourLattices(const Demand& demand) { return optionalIf(ifColours(demand.asset.quantization)); }
Presence ofDetailLattices(const Demand& demand) {
  return optionalIf(ifDetails(demand.asset.quantization) && ifHeights(demand.asset.quantization));
}
Presence ofUnequalCounts(const Demand& demand) {
  return requiredIf(demand.counts.lobes > 0 &&
                    demand.counts.lobes < demand.counts.live * demand.asset.detailCount * demand.asset.lobeCount);
}
Presence ofACodebook(const Demand& demand) { return requiredIf(demand.hasCodebook); }
Presence besideACodebook(const Demand& demand) {
  return demand.hasCodebook ? optionalIf(ifAxes(demand.asset.quantization)) : Presence::kRequired;
}

// All that a type of section is.
struct SectionInfo {
  SectionType type;
  const char* name;
  Layer layer;
  uint64_t (*entries)(Counts, uint64_t detailCount);
  uint32_t components, componentsOnLattice;
  ElementKind kind;  // on its lattice
  bool (*isOnLattice)(Lattices);
  Presence (*presence)(const Demand&);
};

// clang-format off
constexpr std::array kSections = {
    SectionInfo{SectionType::kSites, "sites", Layer::kGeometry, ofCells, 3, 3, ElementKind::kInt32, ifPositions, required},
    SectionInfo{SectionType::kGhostSites, "ghost_sites", Layer::kGeometry, ofGhosts, 3, 3, ElementKind::kInt32, ifPositions, required},
    SectionInfo{SectionType::kRadii, "radii", Layer::kGeometry, ofSites, 1, 1, ElementKind::kUnsigned, ifRadii, required},
    SectionInfo{SectionType::kGhostRefs, "ghost_refs", Layer::kGeometry, ofGhosts, 1, 1, ElementKind::kUint32, always, required},
    SectionInfo{SectionType::kGraphCounts, "graph_counts", Layer::kGeometry, ofCells, 1, 1, ElementKind::kGraph, always, ofAGraph},
    SectionInfo{SectionType::kGraphDeltas, "graph_deltas", Layer::kGeometry, ofPairs, 1, 1, ElementKind::kGraph, always, required},
    SectionInfo{SectionType::kGraphAlphaBits, "graph_alpha_bits", Layer::kGeometry, ofPairBits, 1, 1, ElementKind::kByte, always, ofAWalkGraph},
    SectionInfo{SectionType::kDensities, "densities", Layer::kGeometry, ofLive, 1, 1, ElementKind::kUnsigned, ifDensities, required},
    SectionInfo{SectionType::kOrientations, "orientations", Layer::kGeometry, ofLive, 4, 2, ElementKind::kUnsigned, ifNormals, required},
    SectionInfo{SectionType::kCellColours, "cell_colours", Layer::kGeometry, ofLive, 3, 3, ElementKind::kByte, always, optional},
    SectionInfo{SectionType::kCellHeights, "cell_heights", Layer::kGeometry, ofLive, 1, 1, ElementKind::kSigned, ifHeights, optional},
    SectionInfo{SectionType::kSolidBalls, "solid_balls", Layer::kGeometry, ofLive, 4, 4, ElementKind::kByte, always, optional},
    SectionInfo{SectionType::kBorderCells, "border_cells", Layer::kGeometry, ofBorders, 1, 1, ElementKind::kUint32, always, required},
    SectionInfo{SectionType::kBorderNumbers, "border_numbers", Layer::kGeometry, ofBorders, 1, 1, ElementKind::kUint32, always, required},
    SectionInfo{SectionType::kDetailSites, "detail_sites", Layer::kDetails, ofDetails, 2, 2, ElementKind::kSigned, ifDetails, optional},
    SectionInfo{SectionType::kDetailHeights, "detail_heights", Layer::kDetails, ofDetails, 1, 1, ElementKind::kSigned, ifHeights, optional},
    SectionInfo{SectionType::kColourScales, "colour_scales", Layer::kDetails, ofLive, 1, 1, ElementKind::kByte, always, ofColourLattices},
    SectionInfo{SectionType::kBaseColours, "base_colours", Layer::kDetails, ofDetails, 3, 3, ElementKind::kSigned, ifColours, optional},
    SectionInfo{SectionType::kDetailScales, "detail_scales", Layer::kDetails, ofLive, 1, 1, ElementKind::kByte, always, ofDetailLattices},
    SectionInfo{SectionType::kLobeCounts, "lobe_counts", Layer::kViewDependence, ofDetails, 1, 1, ElementKind::kByte, always, ofUnequalCounts},
    SectionInfo{SectionType::kLobeLabels, "lobe_labels", Layer::kViewDependence, ofLobes, 1, 1, ElementKind::kUnsigned, always, ofACodebook},
    SectionInfo{SectionType::kLobeAxes, "lobe_axes", Layer::kViewDependence, ofLobes, 3, 3, ElementKind::kSigned, ifAxes, besideACodebook},
    SectionInfo{SectionType::kLobeColours, "lobe_colours", Layer::kViewDependence, ofLobes, 3, 3, ElementKind::kSigned, ifColours, required},
    SectionInfo{SectionType::kAxisCodebook, "axis_codebook", Layer::kViewDependence, none, 3, 3, ElementKind::kFloat, never, required},
};
// clang-format on

constexpr auto kTypes = [] {
  std::array<SectionType, kSections.size()> types{};
  for (size_t i = 0; i < types.size(); ++i) types[i] = kSections[i].type;
  return types;
}();

const SectionInfo* findInfo(uint32_t type) {
  for (const SectionInfo& info : kSections) {
    if (static_cast<uint32_t>(info.type) == type) return &info;
  }
  return nullptr;
}

const SectionInfo& infoOf(SectionType type) { return *findInfo(static_cast<uint32_t>(type)); }

}  // namespace

std::span<const SectionType> allSectionTypes() { return kTypes; }

const char* sectionName(uint32_t type) {
  const SectionInfo* info = findInfo(type);
  return info ? info->name : nullptr;
}

Layer sectionLayer(SectionType type) { return infoOf(type).layer; }

uint32_t sectionComponents(SectionType type, const Quantization& quantization) {
  const SectionInfo& info = infoOf(type);
  return info.isOnLattice(quantization) ? info.componentsOnLattice : info.components;
}

ElementKind sectionKind(SectionType type, const Quantization& quantization) {
  const SectionInfo& info = infoOf(type);
  return info.isOnLattice(quantization) ? info.kind : ElementKind::kFloat;
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
  return infoOf(type).entries(counts, detailCount);
}

Presence sectionPresence(SectionType type, const AssetContents& asset, bool hasCodebook, const ChunkCounts& counts) {
  if (sectionEntries(type, counts, asset.detailCount) == 0) return Presence::kForbidden;
  return infoOf(type).presence({asset, hasCodebook, counts});
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
