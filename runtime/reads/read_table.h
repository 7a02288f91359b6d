// What the caller's readers have been asked for, and their answers.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "format/read/byte_source.h"
#include "froth/froth_reader.h"

namespace froth {

// A range of an asset and its bytes.
struct ReadBytes {
  ByteRange range;
  std::shared_ptr<const uint8_t[]> bytes;
};

// A read is here from begin() until it is answered and was taken or dropped: so its bytes stay as long as somebody may
// write them. complete() may run on any thread; all else on one thread at a time, that of the frame. The caller's
// functions run outside the lock, for they may answer.
class ReadTable {
 public:
  // Whether these may begin, beside those that are here.
  bool hasRoom(std::span<const ByteRange> ranges) const;
  // Asks the reader; gives the number of the request.
  uint64_t begin(const FrothReader& reader, ByteRange range);

  struct Answer {
    FrothResult result;
    ReadBytes read;
  };
  bool isAnswered(uint64_t request) const;
  Answer take(uint64_t request);  // of one that is answered
  void drop(uint64_t request);    // cancels one that is not

  // Cancels all that are not answered. True: there are none any more.
  bool cancelAll();

  // False: there is no such read, or it is answered; nothing changes.
  bool complete(uint64_t request, FrothResult result);

 private:
  struct Read {
    FrothReader reader;
    ByteRange range;
    std::shared_ptr<uint8_t[]> bytes;
    std::optional<FrothResult> answer{};
    bool isDropped = false, isCancelled = false;
  };
  using Reads = std::map<uint64_t, Read>;

  void cancel(Reads::iterator read, std::unique_lock<std::mutex> lock);

  mutable std::mutex mutex_;
  Reads reads_;  // by request; guarded by mutex_
  uint64_t heldBytes_ = 0;
  uint64_t nextRequest_ = 1;
};

}  // namespace froth
