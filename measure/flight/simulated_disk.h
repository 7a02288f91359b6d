// A disk that answers late, slowly, or not at all: a FrothReader over a file, in the time of a flight.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <set>
#include <utility>

#include "base/input_file.h"
#include "base/result.h"
#include "froth/froth_reader.h"

namespace froth {

struct DiskOptions {
  double latency = 0;         // [s] from the request to the first byte; requests wait side by side
  double bytesPerSecond = 0;  // of all requests, one after the other; 0: at once
  double failOnce = 0;        // [0..1] share of the ranges behind the floor whose first read fails
  bool hasBadRange = false;   // the first of these ranges that is asked for fails for ever
};

// One thread at a time. It lives until its context is destroyed, and does not move.
class SimulatedDisk {
 public:
  static Result<SimulatedDisk> open(const std::filesystem::path& path, const DiskOptions& options);

  FrothReader reader();  // whose callbacks mean this object
  void answerTo(FrothContext* context) { context_ = context; }
  // Answers what has come by `now` [s].
  Status advance(double now);
  void answerAll();  // whatever the time is

  uint64_t bytesRead() const { return bytesRead_; }

 private:
  SimulatedDisk(InputFile file, uint64_t floorEnd, const DiskOptions& options)
      : file_(std::move(file)), floorEnd_(floorEnd), options_(options) {}
  struct Request {
    uint64_t number, offset, size;
    void* destination;
    double end;  // [s]
  };
  void ask(uint64_t number, uint64_t offset, uint64_t size, void* destination);
  bool fails(uint64_t offset);
  Status answer(const Request& request);

  InputFile file_;
  uint64_t floorEnd_;  // what lies before it never fails: an asset without its floor is none
  DiskOptions options_;
  FrothContext* context_ = nullptr;
  std::deque<Request> requests_;  // `end` ascends
  std::set<uint64_t> failed_;     // offsets of ranges that failed once
  uint64_t badOffset_ = 0;        // 0: none yet
  uint64_t bytesRead_ = 0;
  double now_ = 0, freeFrom_ = 0;  // [s] when the last byte that was asked for is there
};

}  // namespace froth
