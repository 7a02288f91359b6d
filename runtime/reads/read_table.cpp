#include "runtime/reads/read_table.h"

#include <algorithm>
#include <utility>

namespace froth {
namespace {

// Asked for and not taken, of all assets (froth_reader.h).
constexpr uint64_t kMostBytes = 16u << 20;
constexpr size_t kMostReads = 32;

}  // namespace

bool ReadTable::hasRoom(std::span<const ByteRange> ranges) const {
  uint64_t bytes = 0;
  for (const ByteRange& range : ranges) bytes += range.size;  // disjoint in an asset: no overflow
  const std::lock_guard lock(mutex_);
  const bool fits = heldBytes_ < kMostBytes && bytes <= kMostBytes - heldBytes_;
  return reads_.empty() || (fits && reads_.size() + ranges.size() <= kMostReads);
}

uint64_t ReadTable::begin(const FrothReader& reader, ByteRange range) {
  const auto bytes = std::make_shared_for_overwrite<uint8_t[]>(static_cast<size_t>(range.size));
  const uint64_t request = nextRequest_++;
  {
    const std::lock_guard lock(mutex_);
    reads_.emplace(request, Read{reader, range, bytes});
    heldBytes_ += range.size;
  }
  reader.read(reader.user, request, range.offset, range.size, bytes.get());
  return request;
}

bool ReadTable::isAnswered(uint64_t request) const {
  const std::lock_guard lock(mutex_);
  return reads_.at(request).answer.has_value();
}

ReadTable::Answer ReadTable::take(uint64_t request) {
  const std::lock_guard lock(mutex_);
  const auto found = reads_.find(request);
  Read& read = found->second;
  Answer answer{*read.answer, {read.range, std::move(read.bytes)}};
  heldBytes_ -= read.range.size;
  reads_.erase(found);
  return answer;
}

void ReadTable::drop(uint64_t request) {
  std::unique_lock lock(mutex_);
  const auto found = reads_.find(request);
  Read& read = found->second;
  if (read.answer) {
    heldBytes_ -= read.range.size;
    reads_.erase(found);
    return;
  }
  read.isDropped = true;
  if (!read.isCancelled) cancel(found, std::move(lock));
}

// Once for a read.
void ReadTable::cancel(Reads::iterator read, std::unique_lock<std::mutex> lock) {
  read->second.isCancelled = true;
  const uint64_t request = read->first;
  const FrothReader reader = read->second.reader;
  lock.unlock();
  if (reader.cancel) reader.cancel(reader.user, request);
}

bool ReadTable::cancelAll() {
  const auto isUnanswered = [](const auto& read) { return !read.second.answer; };
  const auto isToCancel = [](const auto& read) { return !read.second.answer && !read.second.isCancelled; };
  for (;;) {
    std::unique_lock lock(mutex_);
    const auto found = std::ranges::find_if(reads_, isToCancel);
    if (found == reads_.end()) return std::ranges::none_of(reads_, isUnanswered);
    cancel(found, std::move(lock));
  }
}

bool ReadTable::complete(uint64_t request, FrothResult result) {
  std::shared_ptr<uint8_t[]> bytes;  // freed behind the lock
  const std::lock_guard lock(mutex_);
  const auto found = reads_.find(request);
  if (found == reads_.end() || found->second.answer) return false;
  Read& read = found->second;
  read.answer = result;
  if (read.isDropped) {
    bytes = std::move(read.bytes);
    heldBytes_ -= read.range.size;
    reads_.erase(found);
  }
  return true;
}

}  // namespace froth
