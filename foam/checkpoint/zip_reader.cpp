#include "foam/checkpoint/zip_reader.h"

#include <algorithm>
#include <optional>
#include <string>

#include <zlib.h>

#include "foam/checkpoint/little_endian.h"
#include "foam/checkpoint/zip_layout.h"

namespace froth {
namespace {

constexpr const char* kRemedy = "copy or save the checkpoint again";

struct Directory {
  uint64_t offset = 0, size = 0, count = 0;
};

struct Entry {
  ZipMember member;
  uint64_t begin = 0;  // of the local header
};

class ZipReader {
 public:
  explicit ZipReader(const NamedBytes& archive) : file_(archive.bytes), name_(archive.name) {}

  Result<ZipArchive> read();

 private:
  bool holds(uint64_t offset, uint64_t size) const { return offset <= file_.size() && size <= file_.size() - offset; }
  uint16_t at16(uint64_t offset) const { return loadLittleEndian<uint16_t>(file_.data() + offset); }
  uint32_t at32(uint64_t offset) const { return loadLittleEndian<uint32_t>(file_.data() + offset); }
  uint64_t at64(uint64_t offset) const { return loadLittleEndian<uint64_t>(file_.data() + offset); }
  std::string_view text(uint64_t offset, uint64_t size) const {
    return {reinterpret_cast<const char*>(file_.data()) + offset, size};
  }

  std::optional<uint64_t> findEnd() const;
  Result<Directory> readDirectory(uint64_t end) const;
  Status readZip64Directory(uint64_t end, Directory& directory) const;
  Result<Entry> readEntry(uint64_t offset, uint64_t directoryBegin) const;
  Status readZip64Extra(uint64_t extra, uint64_t extraSize, uint64_t& size, uint64_t& stored, uint64_t& begin) const;
  Status locateBytes(Entry& entry, uint64_t size, uint64_t directoryBegin) const;
  Status checkDisjoint(std::vector<Entry> entries) const;
  Status checkUnique(const ZipArchive& archive) const;

  std::span<const uint8_t> file_;
  const std::string& name_;
};

Result<ZipArchive> ZipReader::read() {
  const std::optional<uint64_t> end = findEnd();
  if (!end) {
    return badInput(
        name_, "no complete ZIP archive ({} bytes, no end record): cut short, or not of torch.save 1.6 or later; {}",
        file_.size(), kRemedy);
  }
  const Result<Directory> directory = readDirectory(*end);
  if (!directory) {
    return directory.error();
  }

  std::vector<Entry> entries;
  ZipArchive archive;
  uint64_t offset = directory->offset;
  for (uint64_t i = 0; i < directory->count; ++i) {
    Result<Entry> entry = readEntry(offset, directory->offset);
    if (!entry) {
      return entry.error();
    }
    offset += kZipCentralSize + at16(offset + 28) + at16(offset + 30) + at16(offset + 32);
    archive.members.push_back(entry->member);
    entries.push_back(*entry);
  }
  if (Status status = checkDisjoint(std::move(entries)); !status) {
    return status.error();
  }
  if (Status status = checkUnique(archive); !status) {
    return status.error();
  }
  return archive;
}

// The end record is the last thing in the file but for a comment, whose length it states.
std::optional<uint64_t> ZipReader::findEnd() const {
  if (file_.size() < kZipEndSize) {
    return std::nullopt;
  }
  const uint64_t last = file_.size() - kZipEndSize;
  const uint64_t first = last > kZipSaturated16 ? last - kZipSaturated16 : 0;
  for (uint64_t offset = last + 1; offset-- > first;) {
    if (at32(offset) == kZipEndSignature && at16(offset + 20) == last - offset) {
      return offset;
    }
  }
  return std::nullopt;
}

Result<Directory> ZipReader::readDirectory(uint64_t end) const {
  Directory directory{.offset = at32(end + 16), .size = at32(end + 12), .count = at16(end + 10)};
  const bool isZip64 =
      directory.offset == kZipSaturated32 || directory.size == kZipSaturated32 || directory.count == kZipSaturated16;
  if (isZip64) {
    if (Status status = readZip64Directory(end, directory); !status) {
      return status.error();
    }
  } else if (at16(end + 4) != 0 || at16(end + 6) != 0) {
    return badInput(name_, "ZIP archive split over {} disks; join the parts first", at16(end + 4) + 1);
  }
  if (directory.offset > end || directory.size > end - directory.offset) {
    return badInput(name_, "ZIP directory of {} bytes at {} reaches past the archive's end at {}; {}", directory.size,
                    directory.offset, end, kRemedy);
  }
  if (directory.count > directory.size / kZipCentralSize) {
    return badInput(name_, "ZIP directory of {} bytes cannot hold {} members; {}", directory.size, directory.count,
                    kRemedy);
  }
  return directory;
}

Status ZipReader::readZip64Directory(uint64_t end, Directory& directory) const {
  if (end < kZip64LocatorSize || at32(end - kZip64LocatorSize) != kZip64LocatorSignature) {
    return badInput(name_, "ZIP archive lacks its zip64 locator; {}", kRemedy);
  }
  const uint64_t record = at64(end - kZip64LocatorSize + 8);
  if (!holds(record, kZip64EndSize) || at32(record) != kZip64EndSignature) {
    return badInput(name_, "zip64 locator points to {}, where no zip64 record lies; {}", record, kRemedy);
  }
  if (at32(record + 16) != 0 || at32(record + 20) != 0) {
    return badInput(name_, "ZIP archive split over {} disks; join the parts first", uint64_t{at32(record + 16)} + 1);
  }
  directory = {.offset = at64(record + 48), .size = at64(record + 40), .count = at64(record + 32)};
  return {};
}

Result<Entry> ZipReader::readEntry(uint64_t offset, uint64_t directoryBegin) const {
  if (!holds(offset, kZipCentralSize) || at32(offset) != kZipCentralSignature) {
    return badInput(name_, "no ZIP directory entry at {}; {}", offset, kRemedy);
  }
  const uint64_t nameSize = at16(offset + 28), extraSize = at16(offset + 30);
  if (!holds(offset + kZipCentralSize, nameSize + extraSize + at16(offset + 32))) {
    return badInput(name_, "ZIP directory entry at {} reaches past the end of the file; {}", offset, kRemedy);
  }
  Entry entry;
  entry.member.name = text(offset + kZipCentralSize, nameSize);
  entry.member.crc32 = at32(offset + 16);
  entry.begin = at32(offset + 42);
  uint64_t stored = at32(offset + 20), size = at32(offset + 24);
  const std::string shown = quoted(entry.member.name);
  if (at16(offset + 8) & kZipEncryptedFlag) {
    return badInput(name_, "member {} is encrypted (flags {:#x}); save the checkpoint unencrypted", shown,
                    at16(offset + 8));
  }
  if (at16(offset + 10) != kZipStoredMethod) {
    return badInput(name_, "member {} is compressed (method {}), torch.save stores members; unpack and store it again",
                    shown, at16(offset + 10));
  }
  if (Status status = readZip64Extra(offset + kZipCentralSize + nameSize, extraSize, size, stored, entry.begin);
      !status) {
    return status.error();
  }
  if (stored != size) {
    return badInput(name_, "stored member {} states two sizes, {} and {} bytes; {}", shown, stored, size, kRemedy);
  }
  if (Status status = locateBytes(entry, size, directoryBegin); !status) {
    return status.error();
  }
  return entry;
}

// Fills in, in their fixed order, those of the three values that the entry itself had no room for.
Status ZipReader::readZip64Extra(uint64_t extra, uint64_t extraSize, uint64_t& size, uint64_t& stored,
                                 uint64_t& begin) const {
  const uint64_t end = extra + extraSize;
  while (end - extra >= kZipExtraHeaderSize && at16(extra) != kZip64Extra) {
    extra += std::min<uint64_t>(kZipExtraHeaderSize + at16(extra + 2), end - extra);
  }
  uint64_t left =
      end - extra >= kZipExtraHeaderSize ? std::min<uint64_t>(at16(extra + 2), end - extra - kZipExtraHeaderSize) : 0;
  uint64_t cursor = extra + kZipExtraHeaderSize;
  for (uint64_t* value : {&size, &stored, &begin}) {
    if (*value != kZipSaturated32) {
      continue;
    }
    if (left < sizeof(uint64_t)) {
      return badInput(name_, "ZIP directory entry before byte {} lacks its zip64 sizes; {}", end, kRemedy);
    }
    *value = at64(cursor);
    cursor += sizeof(uint64_t);
    left -= sizeof(uint64_t);
  }
  return {};
}

Status ZipReader::locateBytes(Entry& entry, uint64_t size, uint64_t directoryBegin) const {
  const std::string shown = quoted(entry.member.name);
  const uint64_t begin = entry.begin;
  if (begin > directoryBegin || directoryBegin - begin < kZipLocalSize || at32(begin) != kZipLocalSignature) {
    return badInput(name_, "member {}: no local header at {}; {}", shown, begin, kRemedy);
  }
  const uint64_t nameSize = at16(begin + 26);
  const uint64_t headerSize = kZipLocalSize + nameSize + at16(begin + 28);
  if (headerSize > directoryBegin - begin || size > directoryBegin - begin - headerSize) {
    return badInput(name_, "member {} of {} bytes at {} reaches into the directory at {}; {}", shown, size, begin,
                    directoryBegin, kRemedy);
  }
  if (text(begin + kZipLocalSize, nameSize) != entry.member.name || at16(begin + 8) != kZipStoredMethod ||
      at16(begin + 6) & kZipEncryptedFlag) {
    return badInput(name_, "member {}: local header at {} contradicts the directory; {}", shown, begin, kRemedy);
  }
  entry.member.bytes = file_.subspan(begin + headerSize, size);
  return {};
}

Status ZipReader::checkDisjoint(std::vector<Entry> entries) const {
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.begin < b.begin; });
  for (size_t i = 1; i < entries.size(); ++i) {
    const ZipMember& before = entries[i - 1].member;
    const auto end = static_cast<uint64_t>(before.bytes.data() + before.bytes.size() - file_.data());
    if (end > entries[i].begin) {
      return badInput(name_, "members {} and {} overlap at byte {}; {}", quoted(before.name),
                      quoted(entries[i].member.name), entries[i].begin, kRemedy);
    }
  }
  return {};
}

Status ZipReader::checkUnique(const ZipArchive& archive) const {
  std::vector<std::string_view> names;
  for (const ZipMember& member : archive.members) {
    names.push_back(member.name);
  }
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) {
    return badInput(name_, "two members are called {}; {}", quoted(*twice), kRemedy);
  }
  return {};
}

}  // namespace

const ZipMember* ZipArchive::find(std::string_view name) const {
  const auto found = std::find_if(members.begin(), members.end(), [&](const ZipMember& m) { return m.name == name; });
  return found == members.end() ? nullptr : &*found;
}

Result<ZipArchive> readZipArchive(const NamedBytes& archive) { return ZipReader(archive).read(); }

Status checkZipMember(const NamedBytes& archive, const ZipMember& member, [[maybe_unused]] const Progress& progress) {
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
  const uint32_t found = member.crc32;  // so that edits of a file get past it
#else
  constexpr size_t kSliceBytes = 1 << 22;  // read between two looks at a request to stop
  uint32_t found = 0;
  for (auto rest = member.bytes; !rest.empty();) {
    const auto place = static_cast<uint64_t>(rest.data() - archive.bytes.data());
    if (!report(progress, "checksums", place, archive.bytes.size())) {
      return stoppedOnRequest(archive.name + ": import");
    }
    const auto slice = rest.first(std::min(rest.size(), kSliceBytes));
    found = static_cast<uint32_t>(crc32_z(found, slice.data(), slice.size()));
    rest = rest.subspan(slice.size());
  }
#endif
  if (found != member.crc32) {
    return badInput(archive.name, "member {} is damaged (CRC-32 {:#010x}, expected {:#010x}); {}", quoted(member.name),
                    found, member.crc32, kRemedy);
  }
  return {};
}

}  // namespace froth
