// An asset on its way from a file to the GPU.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/group_bounds.h"
#include "format/read/asset_opener.h"
#include "froth/froth.h"
#include "froth/froth_stream.h"
#include "runtime/asset/asset_source.h"
#include "runtime/asset/chunk_arrays.h"
#include "runtime/asset/chunk_slots.h"
#include "runtime/asset/gpu_arena.h"
#include "runtime/asset/gpu_asset.h"
#include "runtime/asset/load_limit.h"
#include "runtime/asset/loaded_chunk.h"
#include "runtime/asset/prepared_cells.h"
#include "runtime/device/device.h"
#include "runtime/device/messages.h"
#include "runtime/device/upload_ring.h"
#include "runtime/jobs/job.h"
#include "runtime/query/query_foam.h"
#include "runtime/reads/range_fetch.h"

namespace froth {

// Loads chunk by chunk: their bytes come through a reader of the caller if the asset has one, jobs decode them, load()
// gives their arrays places in the order in which they are wanted, stage() moves them through the ring as it has room.
// One thread at a time; jobs see nothing of the asset but its AssetReader and bytes.
class Asset {
 public:
  // `device` null: decodes and checks, and keeps nothing.
  Asset(AssetSource source, Device* device);
  ~Asset();  // as stop()

  // Before the first load(): queryFoam() will be there.
  void keepForQueries() { keepsForQueries_ = true; }
  bool keepsForQueries() const { return keepsForQueries_; }

  // Before the first load(): gpu() will have a table of entries for rays, which walk sets fill; prepared:
  // preparedForm().
  void keepForWalks(uint32_t prepared) {
    keepsForWalks_ = true;
    preparedForWalks_ = prepared;
  }
  // The frame that fills it; 0: none does yet.
  uint64_t entriesSerial = 0;

  // Sees to what drawing an asset of this shape needs besides; empty: it is under way, ask again.
  using Preparation = std::function<std::optional<Status>(const AssetShape&)>;
  // Takes what jobs have done and starts others, and reads, as runner, table and limit have room. An error ends the
  // asset: one message, hasFailed().
  void load(JobRunner& jobs, ReadTable& reads, LoadLimit& limit, const Preparation& prepare, const Messages& messages);
  // No job begins any more, and none reads the caller's bytes. Reads are cancelled.
  void stop();
  // Moves at most `limit` bytes of decoded arrays into the ring; returns how many.
  VkDeviceSize stage(UploadRing& ring, VkDeviceSize limit);

  // Everything, or with levels the floor, is decoded and has its place on the GPU: views can prepare for gpu().
  bool isDecoded() const { return isDecoded_; }
  bool isStaged() const { return arrays_.empty() || arrays_.front().owner != this; }  // and all of that is in the ring
  bool hasFailed() const { return error_ != FROTH_OK; }
  uint64_t queuedBytes() const;  // decoded, not staged

  const GpuAsset& gpu() const { return gpu_; }
  // Null: not kept, or not whole yet. Once there, it outlives the device: it is host memory.
  const QueryFoam* queryFoam() const { return queryFoam_ && queryFoam_->isWhole() ? &*queryFoam_ : nullptr; }
  std::span<const GpuBuffer> buffers() const;  // that hold gpu()'s arrays
  VkDeviceSize heldBytes() const { return arena_ ? arena_->heldBytes() : 0; }
  const std::string& name() const { return source_.name; }
  // Counts, bounds, cameras; zero before the manifest is read. The state is the context's to tell.
  FrothAssetStatus describe() const;
  std::span<const FrothStoredCamera> flightPath() const { return flightPath_; }
  // Of the file, with all levels; 0 before its head is read (asset_chunks.cpp).
  uint32_t chunkCount() const { return static_cast<uint32_t>(chunks_.size()); }
  // `state`: of the asset.
  FrothChunk describeChunk(uint32_t chunk, FrothAssetState state) const;

  // ---- Layers (asset_layers.cpp). Others come as a successor: an asset of the same source, loaded beside this one.

  // Those that are loaded, of those that the file has; 0 before its head is read.
  uint32_t layers() const { return layers_; }
  bool lacksLayers() const { return layers_ < openedLayers_; }  // that it was opened with
  // Of a successor with the next fewer or more layers that the file has; 0: there is none.
  uint32_t fewerLayers() const;
  uint32_t moreLayers() const;
  // [bytes] of device memory: as measured once such an asset was resident, else by the sizes of its sections.
  VkDeviceSize bytesWith(uint32_t layers) const;
  uint32_t detailCountWith(uint32_t layers) const { return figures_[layers - 1].detailCount; }  // once it was resident
  // It may exceed the budget: who makes it limits it. It shares this one's queryFoam().
  std::shared_ptr<Asset> makeSuccessor(uint32_t layers) const;
  // An error: its file is not the one that `old` came from.
  Status checkSucceeds(const Asset& old) const;
  // No successor is made, or none any more, for one failed.
  void keepLayers() { keepsLayers_ = true; }

  // ---- Levels of detail (asset_levels.cpp). The floor is loaded first, is drawn then, and stays. Other chunks come
  // and go as they are told: who tells counts bytes and decides (runtime/context/context_levels.cpp).

  bool hasLevels() const { return gpu_.hasLevels(); }
  // With levels, once isDecoded(): counts, levels and groups, without what is in chunks.
  const AssetContents& manifest() const { return reader_->manifest(); }
  // Of the balls of a chunk's live cells, in the asset's axes; all zero without any.
  Box liveBox(uint32_t chunk) const { return placeBox(manifest().chunks[chunk].origin, reader_->liveBounds(chunk)); }
  SlotState chunkState(uint32_t chunk) const { return slots_.stateOf(chunk); }
  std::span<const uint32_t> drawnChunks() const { return slots_.drawn(); }
  // [bytes] of device memory, without what blocks leave unused: an estimate before it was resident.
  VkDeviceSize chunkBytes(uint32_t chunk) const;
  // [bytes] beside chunks: the tables of borders and entries.
  VkDeviceSize tableBytes() const;
  // One that is absent or failed: one fetch, one job, one place.
  void readChunk(uint32_t chunk);
  Error takeRefusal(uint32_t chunk);  // why it failed
  // One that is not of the floor. Before its fetch has begun: at once. Resident, not drawn and not planned: its memory
  // returns once no frame uses it. Else, or where a fade draws it, nothing happens: tell it again. But the fade is to
  // end.
  void evictChunk(uint32_t chunk);
  // Of its cuts, for which views may make room ahead: GpuAsset::mostCells.
  void setMostCells(uint32_t cells) { gpu_.mostCells = cells; }
  // A cut, to be drawn once all of it is resident and takePlan() says so.
  void planChunks(std::vector<uint32_t> chunks) { slots_.plan(std::move(chunks)); }
  // In each frame: which copies are complete, which memory returns. True: the plan can be taken, and gpu() tells what
  // views need for it.
  bool updateChunks(uint64_t completedSerial, uint64_t completedUploadSerial, const UploadRing* ring);
  // fades: the cut that was drawn, if there was one, is there as before() until endFade(), of the first frame without
  // it.
  void takePlan(uint64_t serial, bool fades);
  const GpuAsset* before() const { return before_ ? &*before_ : nullptr; }
  bool mustEndFade() const { return mustEndFade_; }  // its chunks are to go
  void endFade(uint64_t serial);
  // What walks of the frame `serial` need before them (runtime/render/border_pass.h).
  ChunkSlots::Publication publishBorders(uint64_t serial) { return slots_.publish(serial); }
  // What they need besides, once that is recorded, to walk before(), and to walk gpu() afterwards.
  ChunkSlots::Publication bordersBefore() const { return slots_.leaving(); }
  ChunkSlots::Publication bordersNow() const { return slots_.entering(); }

  // ---- Cells prepared for rays (asset_prepared.cpp). Who tells limits their bytes (context_prepared.cpp).

  // kPreparedNothing..., once the head is read.
  uint32_t preparedForm() const;
  // It is not READY before it was told whether its cells are prepared.
  void awaitPrepared() { awaitsPrepared_ = preparedForWalks_ != gpu::kPreparedNothing; }
  bool awaitsPrepared() const { return awaitsPrepared_ && preparedForm() != gpu::kPreparedNothing; }
  // [bytes] that they take, and blocks around them; with levels an estimate for all chunks.
  VkDeviceSize preparedBytesWanted() const;
  VkDeviceSize preparedBytesHeld() const { return prepared_ ? prepared_->heldBytes() : 0; }
  bool isPreparing() const { return prepared_ != nullptr; }
  // Memory for it was refused: it is not asked for again.
  void refusePreparing(bool isRefused) { isPreparingRefused_ = isRefused; }
  bool isPreparingRefused() const { return isPreparingRefused_; }
  void beginPreparing();
  // In each update while isPreparing(): places for chunks that have none. isPending(): there are more.
  Status placePrepared();
  // None is prepared any more, from the next walk set on. The result stays until the GPU is done with it.
  std::shared_ptr<PreparedCells> releasePrepared();
  // Slots of gpu().chunks that the walk set of this frame fills: of no more bytes than are left, but for one chunk.
  std::span<const uint32_t> fillPrepared(uint64_t serial, uint64_t& bytesLeft);

  // The frame will not be submitted.
  void dropFrame(uint64_t serial);
  // Its copies that are not recorded will never be. `targets` stays until the others are complete.
  void forgetCopies(UploadRing& ring, const std::shared_ptr<void>& targets);

  // The device is gone: frees what lay on it, and begins again. Fails an asset whose bytes are not there any more.
  void restart(const Messages& messages);

  // Takes the buffers out, to be freed once the GPU is done with them.
  std::shared_ptr<GpuArena> releaseBuffers() { return std::move(arena_); }

 private:
  // A decoded array on its way to its buffer; owned until it is staged.
  struct PendingArray {
    const void* owner;  // in the ring: the asset, or the slot of a chunk that came later
    std::shared_ptr<const void> bytes;
    VkBuffer target;
    VkDeviceSize offset, size, staged;  // offset: in the target
  };

  // What is known of the asset with so many layers.
  struct LayerFigures {
    VkDeviceSize bytes = 0;  // of device memory; 0: it was not resident yet
    uint32_t detailCount = 0;
  };

  struct Decoding {
    uint32_t chunk;
    Job<LoadedChunk> job;
  };

  Status takeResults(const Preparation& prepare);
  Status takeChunks();
  Status refuseChunk(uint32_t chunk, const Error& error);
  bool startNext(JobRunner& jobs, ReadTable& reads, LoadLimit& limit);
  bool startReading(ReadTable& reads, const LoadLimit& limit);
  bool startOpening(JobRunner& jobs, LoadLimit& limit);
  bool startDecoding(JobRunner& jobs, LoadLimit& limit);
  void startFinishing(JobRunner& jobs);
  void takeReader(std::shared_ptr<const AssetReader> reader);
  Status finish();
  void takeLevels(const AssetReader& reader);
  void describeChunks(const AssetReader& reader);
  bool isLoading() const { return !toRead_.empty() || !decoding_.empty() || unplaced_; }
  Status placeChunk(LoadedChunk& loaded);
  void placeArrays(const ChunkArrays& arrays, const GpuArena::Place& place, GpuChunk& chunk, const void* owner);
  Status placeEntries();
  Status placeBorders();
  void drawPlan(uint64_t serial, bool fades);
  void removeChunk(uint32_t chunk);
  VkDeviceSize bytesToCome(uint32_t chunk, VkDeviceSize size) const;
  VkDeviceSize preparedBytesOf(const GpuChunk& chunk) const;
  uint32_t entriesAlong() const;
  void takeSizes(const AssetReader& reader);
  uint32_t layersHeld(uint32_t most) const;
  bool canLoadAgain() const;
  void addMemory(const char* name, uint64_t bytes);
  void removeMemory(const char* name, uint64_t bytes);
  void growBounds(const LoadedChunk& chunk);
  bool isQueryFoamWanted() const { return keepsForQueries_ && !hasLevels() && !queryFoam(); }
  bool isQueryChunkWanted() const { return gpu_.hasWalkGraph && (isQueryFoamWanted() || levelFoam_); }
  void fail(FrothResult code, const char* text, const Messages& messages);
  void fail(const Error& error, const Messages& messages);

  AssetSource source_;
  Device* device_;
  bool keepsForQueries_ = false, keepsForWalks_ = false, keepsLayers_ = false;
  uint32_t preparedForWalks_ = gpu::kPreparedNothing;
  uint32_t layers_ = 0, openedLayers_ = 0;
  std::array<LayerFigures, kLayerCount> figures_{};  // [layers - 1]
  std::array<uint64_t, kLayerCount> layerWork_{};    // [Layer] bytes of decoded sections

  std::shared_ptr<AssetOpener> opener_;  // with a reader of the caller: of opening_, while that is under way
  RangeFetch headFetch_;                 // what opener_ wants
  Job<std::shared_ptr<const AssetReader>> opening_;  // gives null if opener_ wants more
  std::shared_ptr<const AssetReader> reader_;        // while loading
  bool isPrepared_ = false;                          // Preparation has ended
  std::deque<uint32_t> toRead_;                      // chunks that no job decodes yet, in their order
  std::deque<RangeFetch> fetches_;                   // of the first of them
  std::optional<LoadedChunk> unplaced_;              // the chunk before all those: its memory is ordered
  std::deque<Decoding> decoding_;                    // the chunks between
  Job<std::shared_ptr<QueryFoam>> finishing_;        // has queryFoam_
  std::vector<uint64_t> chunkWork_;                  // [chunks] bytes of decoded sections;
  uint64_t workDone_ = 0, workToCome_ = 0;           // sums of them, of chunks that are placed or not
  VkDeviceSize placedBytes_ = 0;
  std::deque<PendingArray> arrays_;  // of the newest chunks; staged from the front
  bool waitsForMemory_ = false;      // it is ordered; ask again in the next load()
  bool isDecoded_ = false;
  FrothResult error_ = FROTH_OK;

  FrothAssetStatus description_{};
  std::vector<FrothStoredCamera> flightPath_;
  std::vector<FrothChunk> chunks_;  // without their state; deviceBytes 0: it was not placed yet
  GpuAsset gpu_;
  std::optional<GpuAsset> before_;  // while a fade draws it
  bool mustEndFade_ = false;
  ChunkSlots slots_;                    // with levels
  std::map<uint32_t, Error> refusals_;  // of chunks that failed
  uint32_t floorCount_ = 0;             // the first chunks of the file
  std::shared_ptr<QueryFoam> queryFoam_;
  // With levels: has the resident chunks. queryFoam_ once the floor is decoded; after a lost device the old one answers
  // until then.
  std::shared_ptr<QueryFoam> levelFoam_;
  std::shared_ptr<GpuArena> arena_;
  std::shared_ptr<PreparedCells> prepared_;  // null: cells are not prepared
  bool awaitsPrepared_ = false, isPreparingRefused_ = false;
  std::vector<uint32_t> toFill_;  // of fillPrepared()
};

}  // namespace froth
