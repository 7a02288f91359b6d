// Who reads, uploads and evicts for a ChunkStreamer in tests: with random delays and failures. Watches the invariants.
#pragma once

#include <cstdint>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "runtime/stream/chunk_streamer.h"

namespace froth {

inline void PrintTo(ChunkId id, std::ostream* out) { *out << id.asset << '.' << id.chunk; }  // for GoogleTest

}  // namespace froth

namespace froth::test {

struct OwnerOptions {
  uint64_t seed = 1;
  uint32_t mostDelay = 4;     // of each step of a chunk [frames]
  double failureShare = 0.1;  // of the steps before a chunk is resident; such failures pass
  uint32_t readsInFlight = 8;
  StreamOptions stream{4, 3};
  bool checksCuts = true;  // in each frame; takes time for each chunk
};

// A streamer and its owner. Assets must stay as long as this.
class SimulatedOwner {
 public:
  explicit SimulatedOwner(const OwnerOptions& options)
      : streamer(options.stream), options_(options), random_(options.seed) {}

  uint32_t addAsset(const LevelGraph& graph);
  void breakChunk(ChunkId id) { chunk(id).isBroken = true; }  // it will fail for good
  void setBudget(uint64_t bytes);
  void runFrame();
  // Until all is settled; the number of frames, or mostFrames.
  uint32_t settle(uint32_t mostFrames);

  uint32_t frames() const { return frame_; }
  double updateSeconds() const { return updateSeconds_; }  // of the last frame, processor time
  uint64_t heldBytes() const { return heldBytes_; }
  std::vector<ChunkId> drawnChunks() const;
  uint64_t digest() const { return digest_; }                  // of all actions so far
  const std::string& violation() const { return violation_; }  // the first one; empty: none

  ChunkStreamer streamer;

 private:
  struct Chunk {
    uint64_t bytes = 0;
    bool isBroken = false, isResident = false, isDrawn = false, isEvicting = false, isHeld = false;
    uint32_t failures = 0;    // since it was resident
    uint32_t sinceFrame = 0;  // when it was hidden, came, or its read began
  };
  struct Task {
    ChunkId id;
    ChunkState reached;  // when it is due
    uint32_t dueFrame = 0;
  };

  Chunk& chunk(ChunkId id) { return chunks_[id.asset][id.chunk]; }
  uint32_t delay() { return std::uniform_int_distribution<uint32_t>(0, options_.mostDelay)(random_); }
  void expect(bool isTrue, const char* what, ChunkId id = {});
  void finishTasks();
  bool finish(const Task& task);  // whether another task follows
  void take(const StreamActions& actions);
  void checkCuts();
  void checkCut(uint32_t asset);

  OwnerOptions options_;
  std::mt19937_64 random_;
  std::vector<const LevelGraph*> graphs_;
  std::vector<std::vector<Chunk>> chunks_;
  std::vector<Task> tasks_;
  uint32_t frame_ = 0;
  uint64_t budget_ = 0, heldBytes_ = 0, digest_ = 0;
  double updateSeconds_ = 0;
  std::string violation_;
};

}  // namespace froth::test
