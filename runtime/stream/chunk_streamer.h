// Which chunks of all assets of a context are wanted, read, kept and drawn, frame by frame, within one budget.
//
// A frame: the owner reports what has come of its reads and evictions, sets eyes and budgets, and calls update(). What
// update() answers is done, as far as this class is concerned: the owner begins the reads and evictions and draws the
// chunks that are shown. No files, no GPU, no threads, no time but frames, so the same calls give the same answers.
//
//   wanted   the groups that eyes want refined, as far as bytes and cells reach (Selection). Without groups that would
//            draw a chunk that failed for good
//   refined  the groups whose fine form is drawn: the finest cut of resident chunks inside of what is wanted or refined
//            already, then the coarsest of those cuts that refines all of the wanted groups that it can (cuts.h). The
//            floor is resident while an instance of the asset exists, so there is always a cut, never a hole
//   needed   chunks of the wanted cut that are not drawn, and fine forms of wanted groups that are not refined, so that
//            the picture sharpens a level at a time
//
// Why the wanted cut is reached: it leaves room for the coarse form of any one group. While `refined` lies inside
// `wanted`, it and the fine form of the next group fit, and all else may be evicted. While it does not and there is no
// room, groups that are not wanted are given up for the finest resident form in the wanted cut (mustShed_). A chunk
// above the finest level that failed for good can ask for room of several groups at once; if that is not there, the
// floor is drawn until the wanted cut is in (isDirect): together they always fit.
//
// Calls are for one thread at a time. No update allocates.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "runtime/stream/residency.h"
#include "runtime/stream/selection.h"

namespace froth {

struct StreamOptions {
  uint32_t keepFrames = 16;   // a chunk stays for so long after it was drawn or came, though its room is needed
  uint32_t retryFrames = 30;  // from a failure to the next attempt; four times as long after each further one
};

// What the owner does now. Valid until the next update.
struct StreamActions {
  std::vector<ChunkId> reads;      // begin; most wanted first
  std::vector<ChunkId> evictions;  // drop what there is of them, read or resident; then completeEviction
  std::vector<ChunkId> shown;      // drawn from now on. All are resident
  std::vector<ChunkId> hidden;     // no longer drawn
};

struct StreamStatistics {
  StateTotals states[kChunkStates]{};
  uint64_t usedBytes = 0;
  uint64_t excessBytes = 0;                           // above the budget, since it was lowered
  uint32_t oldestRequest = 0;                         // for how long a needed chunk has been waited for [frames]
  uint32_t floorHits = 0;                             // chunks of the floor that are drawn where a finer form is wanted
  uint64_t evictions = 0, retries = 0, failures = 0;  // since the beginning
};

class ChunkStreamer {
 public:
  static constexpr uint32_t kMostRetries = 3;

  explicit ChunkStreamer(const StreamOptions& options = {}) : options_(options) {}

  // Refused if it is less than the floors of placed assets. A lower budget than what is used evicts over next frames.
  Status setBudget(uint64_t bytes);
  // Most live cells of the wanted cuts together. Floors count first and are drawn though they have more.
  void setCellBudget(uint64_t cells) { cellBudget_ = cells; }
  // What views may need for the cells of the wanted cuts, floors first; and how much that is for a cell of an asset.
  void setViewBudget(uint64_t bytes) { viewBudget_ = bytes; }
  void setViewPrice(uint32_t asset, uint64_t bytesPerCell) { demands_[asset].viewBytesPerCell = bytesPerCell; }

  uint32_t addAsset(LevelGraph graph);  // its number: the least that is free. Not placed, no eyes
  // The asset has an instance from now on. Refused if the budget does not hold its floor and those of others.
  Status placeAsset(uint32_t asset);
  // It has none: nothing of it is drawn, and its chunks stay only while no other needs the room.
  void unplaceAsset(uint32_t asset);
  // All of it is evicted. The number is free when that is complete.
  void removeAsset(uint32_t asset);
  bool hasAsset(uint32_t asset) const { return asset < assets_.size() && assets_[asset].graph != nullptr; }
  bool isPlaced(uint32_t asset) const { return assets_[asset].isPlaced; }
  // Leave out instances that no view shows. Without eyes the floor is wanted.
  void setEyes(uint32_t asset, std::span<const StreamEye> eyes);

  // The owner's reports, in any order between updates. After an eviction was asked for, only that it is complete.
  void advance(ChunkId id, ChunkState to);  // DECODING, READY, UPLOADING or RESIDENT; states may be left out
  void fail(ChunkId id, bool mayPass);      // a chunk on its way, of which the owner holds nothing any more
  void completeEviction(ChunkId id);        // the owner holds nothing of it any more

  // readRoom: most reads to begin now.
  const StreamActions& update(uint32_t readRoom);

  // As of the last update.
  bool isSettled() const;                                                    // of all placed assets
  bool isSettled(uint32_t asset) const { return assets_[asset].isSettled; }  // what is wanted is drawn
  bool isShown(uint32_t asset) const { return assets_[asset].isShown; }      // its floor is in
  bool isDrawn(ChunkId id) const { return residency_.isDrawn(id); }
  const GroupSet& refined(uint32_t asset) const { return assets_[asset].refined; }
  const GroupSet& wanted(uint32_t asset) const { return demands_[asset].wanted; }
  ChunkState state(ChunkId id) const { return residency_.state(id); }
  StreamStatistics statistics() const;

 private:
  struct Asset {
    std::unique_ptr<const LevelGraph> graph;  // null: the number is free
    bool isPlaced = false, isShown = false, isSettled = false, isLeaving = false;
    bool isDirect = false;  // until it is settled
    uint32_t failedChunks = 0, failedFloorChunks = 0;
    GroupSet refined, next;
  };
  enum class NeedKind : uint8_t { kFloor, kCoarser, kFiner };  // kCoarser: stands for a group that is not wanted
  struct Need {
    ChunkId id;
    NeedKind kind;
  };

  void reserveForAll();
  void forgetLeft();

  // Steps of an update, in order.
  void selectGroups();
  void updateCut(uint32_t asset);
  void listNeeds();
  void orderNeeds();
  void readAndMakeRoom(uint32_t readRoom);

  bool isFloorResident(uint32_t asset) const;
  void refine(uint32_t asset, bool keepsUnwanted);
  void showChanges(uint32_t asset);
  void showOrHide(uint32_t asset, uint32_t chunk);
  void evictAllOf(uint32_t asset);
  void addNeed(ChunkId id, NeedKind kind);
  void needGroup(GroupId id);
  bool isToRead(ChunkId id) const;
  uint64_t shortageFor(uint64_t bytes) const;
  bool evictSpare(uint64_t bytes);
  void evict(ChunkId id);
  void resolveStandstill(size_t firstBlocked, uint64_t bytes);

  StreamOptions options_;
  uint64_t budget_ = 0, cellBudget_ = UINT64_MAX, viewBudget_ = UINT64_MAX;
  uint64_t floorBytes_ = 0;  // of placed assets
  uint32_t frame_ = 0;       // of the last update; what is reported between updates belongs to the next
  std::vector<Asset> assets_;
  std::vector<AssetDemand> demands_;  // [assets] without a graph: takes no part
  Selection selection_;
  Residency residency_;
  std::vector<Need> needs_, ordered_;
  std::vector<uint32_t> scratch_;  // groups
  bool mustShed_ = false;          // in the next update
  StreamActions actions_;
  uint64_t evictions_ = 0, retries_ = 0, failures_ = 0;
  uint32_t oldestRequest_ = 0, floorHits_ = 0;
};

}  // namespace froth
