#include "runtime/reads/range_fetch.h"

#include <algorithm>
#include <utility>

namespace froth {
namespace {

class FetchedBytes final : public ByteSource {
 public:
  explicit FetchedBytes(std::vector<ReadBytes> reads) : reads_(std::move(reads)) {}

  Result<std::span<const uint8_t>> view(ByteRange range, std::vector<uint8_t>&) const override {
    for (const auto& [read, bytes] : reads_) {
      if (range.offset < read.offset || range.size > read.size) continue;
      const uint64_t first = range.offset - read.offset;
      if (first > read.size - range.size) continue;
      return std::span(bytes.get() + first, static_cast<size_t>(range.size));
    }
    return makeError(ErrorKind::kUsage, "%llu bytes at byte %llu were not fetched",
                     static_cast<unsigned long long>(range.size), static_cast<unsigned long long>(range.offset));
  }

 private:
  std::vector<ReadBytes> reads_;
};

Error failedRead(const std::string& name, ByteRange range, FrothResult result) {
  return makeError(result == FROTH_ERROR_MEMORY ? ErrorKind::kMemory : ErrorKind::kIo,
                   "%s: %llu bytes at byte %llu: the reader answered %s; close the asset, and open it again when they "
                   "can be read",
                   name.c_str(), static_cast<unsigned long long>(range.size),
                   static_cast<unsigned long long>(range.offset), frothResultName(result));
}

}  // namespace

void RangeFetch::start(ReadTable& table, const FrothReader& reader, std::span<const ByteRange> ranges) {
  requests_.reserve(ranges.size());
  table_ = &table;
  for (const ByteRange& range : ranges) requests_.push_back(table.begin(reader, range));
}

bool RangeFetch::hasEnded() const {
  return table_ && std::ranges::all_of(requests_, [&](uint64_t request) { return table_->isAnswered(request); });
}

Result<std::shared_ptr<const ByteSource>> RangeFetch::take(const std::string& name) {
  std::vector<ReadBytes> reads;
  reads.reserve(requests_.size());
  for (auto request = requests_.begin(); request != requests_.end(); ++request) {
    ReadTable::Answer answer = table_->take(*request);
    if (answer.result != FROTH_OK) {
      requests_.erase(requests_.begin(), request + 1);
      drop();
      return failedRead(name, answer.read.range, answer.result);
    }
    reads.push_back(std::move(answer.read));
  }
  requests_.clear();
  table_ = nullptr;
  return std::shared_ptr<const ByteSource>(std::make_shared<FetchedBytes>(std::move(reads)));
}

void RangeFetch::drop() {
  for (const uint64_t request : requests_) table_->drop(request);
  requests_.clear();
  table_ = nullptr;
}

}  // namespace froth
