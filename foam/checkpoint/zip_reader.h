// The ZIP archive that torch.save writes: stored members, zip64 where large.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "foam/checkpoint/bad_input.h"

namespace froth {

struct ZipMember {
  std::string_view name;
  std::span<const uint8_t> bytes;
  uint32_t crc32 = 0;  // as the archive states it, not yet compared
};

// Members in the order of the archive's directory; views into the archive's bytes.
struct ZipArchive {
  std::vector<ZipMember> members;

  const ZipMember* find(std::string_view name) const;  // nullptr: there is none
};

// Accepts any bytes. Every member of the result lies inside the archive, none overlaps another, names are
// unique. Refuses compressed, encrypted and split archives by name. Thread-safe.
Result<ZipArchive> readZipArchive(const NamedBytes& archive);

// Compares the member's checksum with its bytes: reads all of them. Progress is the place in the archive.
Status checkZipMember(const NamedBytes& archive, const ZipMember& member, const Progress& progress = {});

}  // namespace froth
