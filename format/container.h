// The outermost bytes of a .froth file. docs/FORMAT.md is normative.
//
//   0                64                       64 + manifestSize                              fileSize
//   | FileHeader     | manifest (FlatBuffers) | section | section | ...                             |
//
// All numbers are little-endian. Hashes are XXH3-64 with seed 0.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace froth {

static_assert(std::endian::native == std::endian::little, "the format's integers are copied as they lie");

// The first byte is no text, and a transfer that rewrites line ends breaks the seventh or eighth.
inline constexpr std::array<uint8_t, 8> kFileMagic = {0x89, 'F', 'R', 'O', 'T', 'H', '\r', '\n'};
inline constexpr uint16_t kVersionMajor = 3;  // a newer one is refused
inline constexpr uint16_t kOldestMajor = 2;   // an older one is refused
inline constexpr uint16_t kVersionMinor = 0;  // a newer minor version only adds what may be ignored
inline constexpr char kColourSpace[] = "sRGB";

struct FileHeader {                // size (offset)
  std::array<uint8_t, 8> magic{};  // 8 (0)
  uint16_t versionMajor = 0;       // 2 (8)
  uint16_t versionMinor = 0;       // 2 (10)
  uint32_t reserved0 = 0;          // 4 (12) zero
  uint64_t fileSize = 0;           // 8 (16) [bytes]
  uint64_t manifestOffset = 0;     // 8 (24) 64
  uint64_t manifestSize = 0;       // 8 (32) [bytes]
  uint64_t manifestHash = 0;       // 8 (40)
  uint64_t reserved1 = 0;          // 8 (48) zero
  uint64_t headerHash = 0;         // 8 (56) of bytes 0..55
};
static_assert(sizeof(FileHeader) == 64 && offsetof(FileHeader, versionMajor) == 8);
static_assert(offsetof(FileHeader, fileSize) == 16 && offsetof(FileHeader, manifestOffset) == 24);
static_assert(offsetof(FileHeader, manifestHash) == 40 && offsetof(FileHeader, headerHash) == 56);

// FlatBuffers offsets are 31 bits wide.
inline constexpr uint64_t kMaxManifestSize = (uint64_t{1} << 31) - 1;

uint64_t hashBytes(std::span<const uint8_t> bytes);
uint64_t hashHeader(const FileHeader& header);  // of all but the last field

// Whether `expected` is the hash of `bytes`. Always true in the fuzz targets, so that they get past it.
bool hashMatches(std::span<const uint8_t> bytes, uint64_t expected);

}  // namespace froth
