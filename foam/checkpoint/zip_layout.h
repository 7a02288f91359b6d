// Records of a ZIP archive (APPNOTE.TXT 4.3), for its reader and its writer: signatures, sizes, values.
#pragma once

#include <cstdint>

namespace froth {

inline constexpr uint32_t kZipLocalSignature = 0x04034b50, kZipDescriptorSignature = 0x08074b50;
inline constexpr uint32_t kZipCentralSignature = 0x02014b50, kZipEndSignature = 0x06054b50;
inline constexpr uint32_t kZip64LocatorSignature = 0x07064b50, kZip64EndSignature = 0x06064b50;

// Without names, extra fields and comments [bytes].
inline constexpr uint64_t kZipLocalSize = 30, kZipCentralSize = 46, kZipEndSize = 22;
inline constexpr uint64_t kZip64LocatorSize = 20, kZip64EndSize = 56;

inline constexpr uint64_t kZipExtraHeaderSize = 4;  // id and size of an extra field
inline constexpr uint16_t kZip64Extra = 1;
inline constexpr uint16_t kZipEncryptedFlag = 1;
inline constexpr uint16_t kZipStoredMethod = 0;
inline constexpr uint16_t kZipSaturated16 = 0xffff;
inline constexpr uint32_t kZipSaturated32 = 0xffffffff;  // the true value is in a zip64 record

}  // namespace froth
