#include "measure/flight/simulated_disk.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/counter_random.h"
#include "format/read/asset_reader.h"

namespace froth {

namespace {

constexpr uint64_t kFailureSeed = 1;

// [bytes] from the start of the file; chunks of the floor come first.
Result<uint64_t> findFloorEnd(const std::filesystem::path& path) {
  const Result<AssetReader> reader = AssetReader::open(path);
  if (!reader) return reader.error();
  const std::vector<ChunkLevel>& levels = reader->manifest().levels;
  uint64_t end = UINT64_MAX;
  for (const SectionRecord& section : reader->sections()) {
    const bool isBehind = section.chunk < levels.size() && levels[section.chunk].in != kNoGroup;
    if (isBehind) end = std::min(end, section.offset);
  }
  return end;
}

}  // namespace

Result<SimulatedDisk> SimulatedDisk::open(const std::filesystem::path& path, const DiskOptions& options) {
  Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  const Result<uint64_t> floorEnd = findFloorEnd(path);
  if (!floorEnd) return floorEnd.error();
  return SimulatedDisk(std::move(*file), *floorEnd, options);
}

FrothReader SimulatedDisk::reader() {
  FrothReader reader{};
  reader.structSize = sizeof(reader);
  reader.user = this;
  reader.name = file_.name().c_str();
  reader.size = file_.size();
  reader.read = [](void* user, uint64_t number, uint64_t offset, uint64_t size, void* destination) {
    static_cast<SimulatedDisk*>(user)->ask(number, offset, size, destination);
  };
  return reader;
}

void SimulatedDisk::ask(uint64_t number, uint64_t offset, uint64_t size, void* destination) {
  const double transfer = options_.bytesPerSecond > 0 ? static_cast<double>(size) / options_.bytesPerSecond : 0;
  freeFrom_ = std::max(freeFrom_, now_ + options_.latency) + transfer;
  requests_.push_back({number, offset, size, destination, freeFrom_});
  if (options_.hasBadRange && badOffset_ == 0 && offset >= floorEnd_) badOffset_ = offset;
}

bool SimulatedDisk::fails(uint64_t offset) {
  if (offset < floorEnd_) return false;
  if (offset == badOffset_) return true;
  const CounterRandom random(kFailureSeed, Purpose::kDisk);
  return random.uniform(offset) < options_.failOnce && failed_.insert(offset).second;
}

Status SimulatedDisk::answer(const Request& request) {
  FrothResult result = FROTH_ERROR_FILE;
  if (!fails(request.offset)) {
    const std::span<uint8_t> bytes(static_cast<uint8_t*>(request.destination), request.size);
    if (Status read = file_.readAt(request.offset, bytes); !read) return read;
    result = FROTH_OK;
    bytesRead_ += request.size;
  }
  if (frothCompleteRead(context_, request.number, result) != FROTH_OK) {
    return makeError(ErrorKind::kUnsupported, "frothCompleteRead refuses read %llu of %s",
                     static_cast<unsigned long long>(request.number), file_.name().c_str());
  }
  return {};
}

Status SimulatedDisk::advance(double now) {
  now_ = now;
  while (!requests_.empty() && requests_.front().end <= now) {
    const Request request = requests_.front();
    requests_.pop_front();
    if (Status answered = answer(request); !answered) return answered;
  }
  return {};
}

void SimulatedDisk::answerAll() {
  for (const Request& request : std::exchange(requests_, {})) {
    frothCompleteRead(context_, request.number, FROTH_ERROR_FILE);
  }
}

}  // namespace froth
