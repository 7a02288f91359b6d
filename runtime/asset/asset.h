// An asset on its way from a file to the GPU.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/read/asset_reader.h"
#include "froth/froth.h"
#include "runtime/asset/chunk_arrays.h"
#include "runtime/asset/gpu_arena.h"
#include "runtime/asset/gpu_asset.h"
#include "runtime/device/device.h"
#include "runtime/device/messages.h"
#include "runtime/device/upload_ring.h"
#include "runtime/query/query_foam.h"

namespace froth {

// What is decoded in one frothUpdate, of all assets together [bytes of decoded sections]: it ends behind the chunk that
// exceeds this. A chunk counts as kLeastChunkWork at least.
inline constexpr uint64_t kWorkPerUpdate = 4u << 20, kLeastChunkWork = 16u << 10;

// Loads chunk by chunk: decode some, give their arrays places, stage them through the ring as it has room, then the
// next. One thread at a time.
class Asset {
 public:
  // `path` empty: the asset is `bytes`, which the caller keeps until loading has ended; if they stay for as long as the
  // asset, it can be loaded again. Layers behind `lastLayer` are not read. `device` null: decodes and checks, and keeps
  // nothing.
  Asset(std::string path, std::span<const uint8_t> bytes, Layer lastLayer, Device* device, bool bytesStay = false);

  // Before the first load(): queryFoam() will be there.
  void keepForQueries() { keepsForQueries_ = true; }
  bool keepsForQueries() const { return keepsForQueries_; }

  // Before the first load(): gpu() will have a table of entries for rays, which walk sets fill.
  void keepForWalks() { keepsForWalks_ = true; }
  // The frame that fills it; 0: none does yet.
  uint64_t entriesSerial = 0;

  // Makes what drawing an asset of this shape needs besides; part of loading it.
  using Preparation = std::function<Status(const GpuAsset&)>;
  // Decodes chunks while there is work left, and takes off what they cost. An error ends the asset: one message,
  // hasFailed().
  void load(const Preparation& prepare, const Messages& messages, uint64_t& workLeft);
  // Moves at most `limit` bytes of decoded arrays into the ring; returns how many.
  VkDeviceSize stage(UploadRing& ring, VkDeviceSize limit);

  // Everything is decoded and has its place on the GPU: views can prepare for gpu().
  bool isDecoded() const { return isDecoded_; }
  bool hasFailed() const { return error_ != FROTH_OK; }
  uint64_t queuedBytes() const;  // decoded, not staged

  const GpuAsset& gpu() const { return gpu_; }
  // Null: not kept, or not whole yet. Once there, it outlives the device: it is host memory.
  const QueryFoam* queryFoam() const { return queryFoam_ && queryFoam_->isWhole() ? &*queryFoam_ : nullptr; }
  std::span<const GpuBuffer> buffers() const;  // that hold gpu()'s arrays
  const std::string& name() const { return name_; }
  // Counts, bounds, cameras; zero before the manifest is read. The state is the context's to tell.
  FrothAssetStatus describe() const;
  std::span<const FrothStoredCamera> flightPath() const { return flightPath_; }

  // The device is gone: frees what lay on it, and begins again. Fails an asset whose bytes are not there any more.
  void restart(const Messages& messages);

  // Takes the buffers out, to be freed once the GPU is done with them.
  std::shared_ptr<GpuArena> releaseBuffers() { return std::move(arena_); }

 private:
  // A decoded array on its way to its buffer; owned until it is staged.
  struct PendingArray {
    std::shared_ptr<const void> bytes;
    VkBuffer target;
    VkDeviceSize offset, size, staged;  // offset: in the target
  };

  Status openReader();
  Status loadChunk();
  Status finish(const Preparation& prepare);
  Status placeChunk(CodedChunk&& coded);
  Status placeArrays(const ChunkArrays& arrays);
  Status placeEntries();
  VkDeviceSize bytesToCome(VkDeviceSize size) const;
  uint32_t entriesAlong() const;
  void addMemory(const char* name, uint64_t bytes);
  void growBounds(const ChunkContents& contents);
  bool isQueryFoamWanted() const { return keepsForQueries_ && !queryFoam(); }
  void fail(FrothResult code, const char* text, const Messages& messages);
  void fail(const Error& error, const Messages& messages);

  bool isFile_;
  std::string name_;
  std::span<const uint8_t> bytes_;
  Layer lastLayer_;
  Device* device_;
  bool bytesStay_;
  bool keepsForQueries_ = false, keepsForWalks_ = false;

  std::optional<AssetReader> reader_;       // while loading
  std::vector<uint64_t> chunkWork_;         // [chunks] bytes of decoded sections;
  uint64_t workDone_ = 0, workToCome_ = 0;  // sums of them
  uint32_t nextChunk_ = 0;
  VkDeviceSize placedBytes_ = 0;
  std::deque<PendingArray> arrays_;  // of the newest chunks; staged from the front
  bool isDecoded_ = false;
  FrothResult error_ = FROTH_OK;

  FrothAssetStatus description_{};
  std::vector<FrothStoredCamera> flightPath_;
  GpuAsset gpu_;
  std::optional<QueryFoam> queryFoam_;
  std::shared_ptr<GpuArena> arena_;
};

}  // namespace froth
