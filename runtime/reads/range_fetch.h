// Ranges of an asset on their way through its reader.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "format/read/byte_source.h"
#include "runtime/reads/read_table.h"

namespace froth {

// Dropped where it is destroyed, without waiting. One thread at a time.
class RangeFetch {
 public:
  RangeFetch() = default;
  RangeFetch(const RangeFetch&) = delete;
  RangeFetch& operator=(const RangeFetch&) = delete;
  ~RangeFetch() { drop(); }

  // It must not be under way; the table must have room and outlive it.
  void start(ReadTable& table, const FrothReader& reader, std::span<const ByteRange> ranges);

  bool isUnderWay() const { return table_ != nullptr; }  // started, and its bytes were not taken
  bool hasEnded() const;                                 // all ranges are answered

  // It must have ended. `name` is the asset's, for messages. The bytes are those of the ranges alone.
  Result<std::shared_ptr<const ByteSource>> take(const std::string& name);

  void drop();

 private:
  ReadTable* table_ = nullptr;
  std::vector<uint64_t> requests_;
};

}  // namespace froth
