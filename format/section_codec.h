// What encoders and decoders of sections share: the codecs, the shape of a section's elements, the limits.
// A section is an array of entries of `components` elements of `elementSize` bytes, little-endian.
#pragma once

#include <array>
#include <cstdint>

namespace froth {

enum class SectionCodec : uint16_t {
  kStored = 0,       // the raw bytes
  kZstd = 1,         // one zstd frame of the raw bytes
  kBytePlanes = 2,   // a zstd frame of byte 0 of every entry, one of byte 1 of every entry, ...
  kDeltaPlanes = 3,  // likewise, of each element's difference to the same component of the entry before
  kMortonDelta = 4,  // positions: zstd frames of byte planes of differences between Morton codes
  kDraco = 5,        // positions: runs of points, each a kd-tree of Draco's, in the order in which that gives them
};
inline constexpr uint16_t kLastSectionCodec = static_cast<uint16_t>(SectionCodec::kDraco);

struct SectionShape {
  uint32_t elementSize = 4;  // [bytes] 1, 2 or 4
  uint32_t components = 1;   // >= 1

  bool operator==(const SectionShape&) const = default;
};

// [bytes]
constexpr uint32_t entrySize(SectionShape shape) { return shape.elementSize * shape.components; }

// Positions are lattice indices; the codecs for positions take no other shape.
using LatticePoint = std::array<int32_t, 3>;
inline constexpr SectionShape kPositionShape = {4, 3};

// The codecs for positions take points whose box spans at most this many bits along each axis.
inline constexpr uint32_t kMaxPositionBits = 21;

// rawSize <= kMaxExpansion * storedSize, so memory is bounded by the file's size. Trained foams reach 1.2
// (colours) to 7 (counts); zstd alone would allow 32768. The writer pads with zeros a section that is
// shorter.
inline constexpr uint64_t kMaxExpansion = 256;

// Draco works harder for a point than zstd for a byte, so its sections expand less (trained foams: 3): no
// small file keeps a decoder busy. A writer offers the codec only below.
inline constexpr uint64_t kMaxDracoExpansion = 16;

// A frame may look back this far, so a decoder's window needs no more. [log2 bytes]
inline constexpr int kMaxWindowLog = 23;

}  // namespace froth
