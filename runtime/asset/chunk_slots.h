// The resident chunks of an asset with levels of detail, and which of them are drawn (docs/STREAMING.md).
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "runtime/asset/gpu_arena.h"
#include "runtime/asset/gpu_asset.h"

namespace froth {

// What a slot has of a chunk; runtime/stream tells apart more.
enum class SlotState : uint8_t {
  kAbsent,
  kComing,    // read, decoded or uploaded
  kResident,  // may be drawn
  kLeaving,   // frames in flight may still draw it
  kFailed,    // was not to be read; may be tried again
};

// A chunk keeps its slot while it is resident. Copies into its memory name the slot as their owner.
struct ChunkSlot {
  GpuChunk gpu;
  GpuArena::Place place;
  VkDeviceSize size = 0;                                      // of the place
  std::vector<std::pair<const char*, VkDeviceSize>> parts{};  // what FrothAssetStatus::memory counts of it
  bool isTaken = false, isDrawn = false;
  bool isFading = false;         // drawn beside those that are, until endFade()
  uint64_t lastSerial = 0;       // newest frame that may use it, once it is not drawn
  uint64_t publishedSerial = 0;  // frame that told walks where its borders are; 0: none did since it is drawn
};

// Frames have serials. One thread at a time.
class ChunkSlots {
 public:
  static constexpr uint32_t kNoSlot = UINT32_MAX;

  void begin(uint32_t fileChunkCount);

  SlotState stateOf(uint32_t chunk) const { return states_[chunk]; }
  void setState(uint32_t chunk, SlotState state) { states_[chunk] = state; }
  bool isFading(uint32_t chunk) const { return hasSlot(chunk) && slots_[slotOf_[chunk]].isFading; }
  bool isDrawn(uint32_t chunk) const { return hasSlot(chunk) && slots_[slotOf_[chunk]].isDrawn; }
  bool hasSlot(uint32_t chunk) const { return slotOf_[chunk] != kNoSlot; }
  ChunkSlot& slotOf(uint32_t chunk) { return slots_[slotOf_[chunk]]; }
  const ChunkSlot& slotOf(uint32_t chunk) const { return slots_[slotOf_[chunk]]; }

  // The first free slot.
  ChunkSlot& add(const GpuChunk& chunk);
  void remove(uint32_t chunk);  // it becomes kAbsent; the GPU must be done with it

  // What is to be drawn next; it replaces an earlier plan. [not empty]
  void plan(std::vector<uint32_t> chunks) { planned_ = std::move(chunks); }
  std::span<const uint32_t> planned() const { return planned_; }
  bool isPlanned(uint32_t chunk) const;
  bool canTakePlan() const;                 // there is one, and all of it is resident
  void measurePlan(GpuAsset& asset) const;  // one that can be taken: what views need for it
  // From the frame `serial` on the planned chunks are drawn: those that were measured. keepsBefore: those that were
  // drawn are fading, until endFade(), the first frame without them.
  void takePlan(uint64_t serial, GpuAsset& asset, bool keepsBefore);
  void endFade(uint64_t serial);
  std::span<const uint32_t> drawn() const { return drawn_; }

  // Slots that are drawn and whose borders no frame has told yet: now `serial` does. isTableNew: the table has nothing
  // yet, and must be filled with gpu::kNoCell before. Valid until the next call.
  struct Publication {
    std::span<const uint32_t> slots;
    bool isTableNew;
  };
  Publication publish(uint64_t serial);
  // What turns a table that is published into that of the cut before, while it fades, and back.
  Publication leaving() const { return {leaving_, false}; }
  Publication entering() const { return {entering_, false}; }
  void dropFrame(uint64_t serial);

  template <class Visit>
  void forEachTaken(const Visit& visit) {
    for (ChunkSlot& slot : slots_) {
      if (slot.isTaken) visit(slot);
    }
  }

 private:
  std::deque<ChunkSlot> slots_;    // which stay where they are
  std::vector<uint32_t> slotOf_;   // [chunk of the file]
  std::vector<SlotState> states_;  // [chunk of the file]
  std::vector<uint32_t> drawn_, planned_, unpublished_;
  std::vector<uint32_t> leaving_, entering_;  // slots of one of two cuts alone, while the one before fades
  uint64_t tableSerial_ = 0;                  // frame that filled the table of borders; 0: none
};

}  // namespace froth
