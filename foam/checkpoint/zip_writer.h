// Writes the ZIP archive of torch.save: stored members at multiples of 64, with their checksums behind them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/atomic_file.h"
#include "base/result.h"

namespace froth {

// Equal calls give equal bytes: no time is stored. An error of the sink is returned and ends the archive.
class ZipWriter {
 public:
  // Sizes and offsets from `zip64From` on go into zip64 records; tests lower it to see some.
  explicit ZipWriter(ByteSink sink, uint64_t zip64From = UINT32_MAX) : sink_(std::move(sink)), zip64From_(zip64From) {}

  // A member of `size` bytes; append() must receive exactly that many, in any number of pieces, before end().
  Status begin(std::string name, uint64_t size);
  Status append(std::span<const uint8_t> bytes);
  Status end();
  Status add(std::string name, std::string_view bytes);  // a whole member

  // The directory. Nothing can be added afterwards.
  Status finish();

 private:
  struct Member {
    std::string name;
    uint64_t size = 0, begin = 0;
    uint32_t crc32 = 0;
  };

  Status emit(std::span<const uint8_t> bytes);
  bool isLarge(uint64_t value) const { return value >= zip64From_; }
  std::string encodeDirectoryEntry(const Member& member) const;

  ByteSink sink_;
  uint64_t zip64From_;
  uint64_t offset_ = 0;
  std::vector<Member> members_;
};

}  // namespace froth
