// Assets with levels of detail between ChunkStreamer, which decides, and Asset, which brings chunks and lets them go.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "froth/froth.h"
#include "runtime/asset/asset.h"
#include "runtime/context/level_budget.h"
#include "runtime/device/messages.h"
#include "runtime/stream/chunk_streamer.h"

namespace froth {

// In each frame: report() for each asset, setEyes() and setViewPrice(), then setBudget() and decide(). An asset that is
// added is streamed until it is removed, with or without an instance: its floor is resident all the while.
class LevelStreaming {
 public:
  bool has(FrothAsset handle) const { return find(handle) != nullptr; }
  bool isEmpty() const { return streams_.empty() && streamer_.statistics().usedBytes == 0; }

  void add(FrothAsset handle, const Asset& asset);  // one that is decoded
  void remove(FrothAsset handle);                   // nothing of it will come any more
  void clear() { *this = {}; }                      // of all: their device is gone

  // What has become of its chunks since the last frame. A chunk that failed for good is one warning.
  void report(FrothAsset handle, Asset& asset, const Messages& messages);
  void setEyes(FrothAsset handle, std::span<const StreamEye> eyes);
  // What views take for each live cell of an asset that is drawn, and for how many they have room ahead at most.
  void setViewPrice(FrothAsset handle, uint64_t bytesPerCell, uint64_t mostBytes);
  LevelNeeds needs() const;
  // Cells of an asset for which the budget has room in views; as of setBudget().
  uint32_t mostCells(FrothAsset handle) const;
  // Floors are there already, and are not refused: false, if they take more.
  bool setBudget(const LevelShares& shares);
  void setMostCells(uint64_t cells) { streamer_.setCellBudget(cells); }

  using FindAsset = std::function<Asset&(FrothAsset)>;
  void decide(const FindAsset& assetOf);  // and does it

  const ChunkStreamer& streamer() const { return streamer_; }
  uint64_t budgetBytes() const { return budget_.chunkBytes; }  // UINT64_MAX: no limit
  uint64_t floorBytes() const { return floorBytes_; }
  // What is wanted is drawn, and nothing else, of all assets; as of the newest report().
  bool isSettled() const;
  uint32_t drawnChunks() const;

 private:
  struct Stream {
    FrothAsset handle{};
    uint32_t number = 0;  // the streamer's
    LevelNeeds needs;
    uint64_t floorCells = 0, finestCells = 0, viewBytesPerCell = 0;
    bool isNew = false;                     // `drawn`: not planned yet
    std::vector<uint32_t> coming, leaving;  // chunks that the asset was told to bring and to let go
    std::vector<uint32_t> drawn;            // ascending; what the streamer shows
    bool isDrawn = false;                   // `drawn`: by the asset too, and alone
  };
  const Stream* find(FrothAsset handle) const;
  Stream* find(FrothAsset handle);
  Stream* streamOf(uint32_t number);  // null: it was removed
  void reportComing(Stream& stream, Asset& asset, const Messages& messages);
  uint32_t readRoom() const;

  ChunkStreamer streamer_;
  std::vector<Stream> streams_;
  std::vector<ChunkId> gone_;  // told to leave, of assets that were removed
  LevelShares budget_;
  uint64_t floorBytes_ = 0;
};

}  // namespace froth
