// Encodes what section_codec_read.h decodes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "format/section.h"
#include "format/section_codec.h"

namespace froth {

struct EncodedSection {
  SectionCodec codec = SectionCodec::kStored;
  std::vector<uint8_t> stored;
};

// In a codec that suits the numbers, and never longer than they are. `raw` is whole entries, at least one.
Result<EncodedSection> encodeSection(std::span<const uint8_t> raw, SectionShape shape);

// The same for positions (kPositionShape), which have codecs of their own. The points are runs that follow
// each other (live cells, other cells); `runs` holds their lengths, which add up to the number of points.
// Morton-delta suits any order, best the Morton order within each run; Draco is tried only where every run
// lies in its order (format/position_order.h).
Result<EncodedSection> encodePositions(std::span<const uint8_t> raw, std::span<const uint32_t> runs);

}  // namespace froth
