#include "format/section.h"

namespace froth {

const char* sectionName(uint32_t type) {
  switch (static_cast<SectionType>(type)) {
    case SectionType::kSites:
      return "sites";
    case SectionType::kRadii:
      return "radii";
    case SectionType::kNeighbourOffsets:
      return "neighbour_offsets";
    case SectionType::kNeighbours:
      return "neighbours";
    case SectionType::kAlphaCounts:
      return "alpha_counts";
    case SectionType::kDensities:
      return "densities";
    case SectionType::kOrientations:
      return "orientations";
    case SectionType::kDetailSites:
      return "detail_sites";
    case SectionType::kDetailHeights:
      return "detail_heights";
    case SectionType::kLobeAxes:
      return "lobe_axes";
    case SectionType::kLobeColours:
      return "lobe_colours";
  }
  return nullptr;
}

uint64_t sectionWords(SectionType type, const ChunkCounts& counts, uint32_t detailCount, uint32_t lobeCount) {
  const uint64_t details = counts.live * detailCount;
  switch (type) {
    case SectionType::kSites:
      return counts.cells * 3;
    case SectionType::kRadii:
      return counts.cells;
    case SectionType::kNeighbourOffsets:
      return counts.cells + 1;
    case SectionType::kNeighbours:
      return counts.neighbours;
    case SectionType::kAlphaCounts:
      return counts.live;
    case SectionType::kDensities:
      return counts.live;
    case SectionType::kOrientations:
      return counts.live * 4;
    case SectionType::kDetailSites:
      return details * 2;
    case SectionType::kDetailHeights:
      return details;
    case SectionType::kLobeAxes:
      return details * lobeCount * 3;
    case SectionType::kLobeColours:
      return details * lobeCount * 3;
  }
  return 0;
}

std::string sectionPlace(const std::string& file, uint32_t chunk, uint32_t type) {
  const std::string place = file + ": chunk " + std::to_string(chunk) + ", section ";
  const char* name = sectionName(type);
  return name ? place + "'" + name + "'" : place + "of type " + std::to_string(type);
}

}  // namespace froth
