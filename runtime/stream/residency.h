// Where each chunk of each asset is on its way to the GPU and back, and the bytes that are taken for it.
//
//   ABSENT -> READING -> DECODING -> READY -> UPLOADING -> RESIDENT -> EVICTING -> ABSENT
//                  \________\__________\_________\___________________/^      evicted on the way: the owner lets it be
//                   \________\__________\_________\-> RETRY -> READING       a failure that may pass
//                                                  \> FAILED                 for good
//
// Bytes are taken before a read begins and given back when an eviction is complete or the chunk has failed.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/stream/level_graph.h"

namespace froth {

enum class ChunkState : uint8_t {
  kAbsent,
  kReading,
  kDecoding,
  kReady,  // decoded; waits for room in the frame's uploads
  kUploading,
  kResident,
  kEvicting,  // frames on the GPU may still read it
  kRetry,     // failed; is read again after some frames
  kFailed,    // for good
};
inline constexpr size_t kChunkStates = 9;

struct ChunkId {
  uint32_t asset = 0, chunk = 0;
  auto operator<=>(const ChunkId&) const = default;
};

struct StateTotals {
  uint64_t chunks = 0;
  uint64_t bytes = 0;
};

// Chunks that hold bytes, are not drawn and are not part of a pinned floor are the spare ones: a list, the one that is
// spare for the longest first. No call but addAsset allocates.
class Residency {
 public:
  // Ends of the list.
  static constexpr ChunkId kNone{UINT32_MAX, UINT32_MAX};

  void addAsset(uint32_t asset, const LevelGraph& graph);  // asset: the next number, or one that was removed
  void removeAsset(uint32_t asset);                        // it holds no bytes

  ChunkState state(ChunkId id) const { return states_[id.asset][id.chunk]; }
  std::span<const ChunkState> states(uint32_t asset) const { return states_[asset]; }
  bool holdsBytes(ChunkId id) const;
  uint64_t bytesOf(ChunkId id) const { return graphs_[id.asset]->chunk(id.chunk).bytes; }
  bool isDrawn(ChunkId id) const { return record(id).isDrawn; }

  // Of a chunk on its way: kReading < `to` <= kResident, and not back.
  void advance(ChunkId id, ChunkState to, uint32_t frame);
  void beginRead(ChunkId id, uint32_t frame);  // ABSENT or RETRY
  void evict(ChunkId id);                      // a spare one
  void completeEviction(ChunkId id);           // EVICTING
  // Of a chunk on its way. `dueFrame`: of the next attempt.
  void retryLater(ChunkId id, uint32_t dueFrame);
  void failForGood(ChunkId id);
  bool isDue(ChunkId id, uint32_t frame) const;  // a chunk in RETRY
  uint32_t failedAttempts(ChunkId id) const { return record(id).failedAttempts; }

  void setDrawn(ChunkId id, bool isDrawn, uint32_t frame);
  void setPinned(ChunkId id, bool isPinned, uint32_t frame);

  // Notes that the chunk is needed in this frame. Returns for how many frames it has been, without a pause.
  uint32_t noteNeed(ChunkId id, uint32_t frame);
  bool isNeeded(ChunkId id, uint32_t frame) const { return record(id).neededFrame == frame; }

  ChunkId firstSpare() const { return first_; }
  ChunkId nextSpare(ChunkId id) const { return record(id).next; }
  uint32_t spareSince(ChunkId id) const { return record(id).spareFrame; }

  const StateTotals& totals(ChunkState state) const { return totals_[static_cast<size_t>(state)]; }
  uint64_t usedBytes() const;       // of all states that hold bytes
  uint64_t chunksOnTheWay() const;  // READING to UPLOADING
  uint64_t bytesOfAsset(uint32_t asset) const { return assetBytes_[asset]; }

 private:
  // Frames are compared by their distance from now, so that their numbers may wrap.
  struct Record {
    bool isDrawn = false, isPinned = false;
    uint8_t failedAttempts = 0;
    uint32_t spareFrame = 0;
    uint32_t dueFrame = 0;
    uint32_t neededFrame = UINT32_MAX, neededSince = 0;
    ChunkId previous = kNone, next = kNone;
  };
  Record& record(ChunkId id) { return records_[id.asset][id.chunk]; }
  const Record& record(ChunkId id) const { return records_[id.asset][id.chunk]; }
  void setState(ChunkId id, ChunkState to);
  bool isSpare(ChunkId id) const;
  void link(ChunkId id, uint32_t frame);  // as the last one
  void unlink(ChunkId id);

  std::vector<const LevelGraph*> graphs_;        // [assets]
  std::vector<std::vector<ChunkState>> states_;  // [assets][chunks]
  std::vector<std::vector<Record>> records_;     // [assets][chunks]
  std::vector<uint64_t> assetBytes_;             // [assets]
  std::array<StateTotals, kChunkStates> totals_{};
  ChunkId first_ = kNone, last_ = kNone;
};

}  // namespace froth
