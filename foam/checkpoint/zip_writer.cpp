#include "foam/checkpoint/zip_writer.h"

#include <utility>

#include <zlib.h>

#include "foam/checkpoint/little_endian.h"
#include "foam/checkpoint/zip_layout.h"

namespace froth {
namespace {

// Checksums follow the bytes (bit 3), names are UTF-8 (bit 11): what torch.save sets.
constexpr uint16_t kFlags = 0x0808;
constexpr uint64_t kAlignment = 64;         // of a member's bytes, as `.storage_alignment` says
constexpr uint16_t kPaddingExtra = 0x4246;  // "FB", the extra field with which torch.save aligns
constexpr uint16_t kZip64Version = 45, kPlainVersion = 0, kMadeBy = 0x031e;

template <class... Numbers>
void appendNumbers(std::string& bytes, Numbers... numbers) {
  (appendLittleEndian(bytes, numbers), ...);
}

std::span<const uint8_t> asBytes(std::string_view text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

uint32_t saturate(uint64_t value, bool isLarge) { return isLarge ? kZipSaturated32 : static_cast<uint32_t>(value); }

}  // namespace

Status ZipWriter::begin(std::string name, uint64_t size) {
  std::string header;
  const uint16_t zip64Size = isLarge(size) ? 2 * sizeof(uint64_t) : 0;
  const uint64_t zip64Bytes = zip64Size ? kZipExtraHeaderSize + zip64Size : 0;
  const uint64_t unpadded = offset_ + kZipLocalSize + name.size() + zip64Bytes + kZipExtraHeaderSize;
  const auto padding = static_cast<uint16_t>((kAlignment - unpadded % kAlignment) % kAlignment);
  appendNumbers(header, kZipLocalSignature, zip64Size ? kZip64Version : kPlainVersion, kFlags, kZipStoredMethod,
                uint32_t{0},                                                  // time and date
                uint32_t{0}, saturate(0, zip64Size), saturate(0, zip64Size),  // checksum and sizes: behind the bytes
                static_cast<uint16_t>(name.size()), static_cast<uint16_t>(zip64Bytes + kZipExtraHeaderSize + padding));
  header += name;
  if (zip64Size) {
    appendNumbers(header, kZip64Extra, zip64Size, size, size);
  }
  appendNumbers(header, kPaddingExtra, padding);
  header.append(padding, 'Z');
  members_.push_back({std::move(name), size, offset_, 0});
  return emit(asBytes(header));
}

Status ZipWriter::append(std::span<const uint8_t> bytes) {
  uint32_t& crc = members_.back().crc32;
  crc = static_cast<uint32_t>(crc32_z(crc, bytes.data(), bytes.size()));
  return emit(bytes);
}

Status ZipWriter::end() {
  const Member& member = members_.back();
  std::string descriptor;
  appendNumbers(descriptor, kZipDescriptorSignature, member.crc32);
  if (isLarge(member.size)) {
    appendNumbers(descriptor, member.size, member.size);
  } else {
    appendNumbers(descriptor, static_cast<uint32_t>(member.size), static_cast<uint32_t>(member.size));
  }
  return emit(asBytes(descriptor));
}

Status ZipWriter::add(std::string name, std::string_view bytes) {
  Status status = begin(std::move(name), bytes.size());
  if (status) status = append(asBytes(bytes));
  if (status) status = end();
  return status;
}

Status ZipWriter::finish() {
  std::string directory;
  for (const Member& member : members_) {
    directory += encodeDirectoryEntry(member);
  }
  const uint64_t begin = offset_, size = directory.size(), end = begin + size, count = members_.size();
  const bool isZip64 = isLarge(begin) || isLarge(size) || count >= kZipSaturated16;
  // The zip64 records are always written, as torch.save does; readers need them only behind saturated values.
  appendNumbers(directory, kZip64EndSignature, uint64_t{kZip64EndSize - 12}, kMadeBy, kZip64Version, uint32_t{0},
                uint32_t{0}, count, count, size, begin);
  appendNumbers(directory, kZip64LocatorSignature, uint32_t{0}, end, uint32_t{1});
  const uint16_t shownCount = isZip64 ? kZipSaturated16 : static_cast<uint16_t>(count);
  appendNumbers(directory, kZipEndSignature, uint32_t{0}, shownCount, shownCount, saturate(size, isZip64),
                saturate(begin, isZip64), uint16_t{0});
  return emit(asBytes(directory));
}

std::string ZipWriter::encodeDirectoryEntry(const Member& member) const {
  std::string zip64;
  if (isLarge(member.size)) {
    appendNumbers(zip64, member.size, member.size);
  }
  if (isLarge(member.begin)) {
    appendNumbers(zip64, member.begin);
  }
  const uint32_t size = saturate(member.size, isLarge(member.size));
  const uint64_t extraSize = zip64.empty() ? 0 : kZipExtraHeaderSize + zip64.size();
  std::string entry;
  appendNumbers(entry, kZipCentralSignature, uint16_t{0}, zip64.empty() ? kPlainVersion : kZip64Version, kFlags,
                kZipStoredMethod, uint32_t{0},  // time and date
                member.crc32, size, size, static_cast<uint16_t>(member.name.size()), static_cast<uint16_t>(extraSize),
                uint16_t{0}, uint16_t{0}, uint16_t{0}, uint32_t{0},  // comment, disk, attributes
                saturate(member.begin, isLarge(member.begin)));
  entry += member.name;
  if (!zip64.empty()) {
    appendNumbers(entry, kZip64Extra, static_cast<uint16_t>(zip64.size()));
    entry += zip64;
  }
  return entry;
}

Status ZipWriter::emit(std::span<const uint8_t> bytes) {
  offset_ += bytes.size();
  return sink_(bytes);
}

}  // namespace froth
