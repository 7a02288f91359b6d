// Device memory that a job takes from the driver and gives back to it: either takes longer than a frame should wait.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/device/device_memory.h"

namespace froth {

// An allocation that a job makes. The ledger is charged with it from the beginning.
struct MemoryOrder {
  enum class State { kWaiting, kUnderWay, kDone };
  enum class Use { kUnasked, kAsked, kTaken, kPutBack };  // put back: another may ask for it

  FrothMemoryRequest request;  // its `purpose` is that of this order
  std::string purpose;
  MemoryBlock block;  // without a place until it is done
  VkResult result = VK_NOT_READY;
  uint64_t number;
  State state = State::kWaiting;
  Use use = Use::kAsked;  // in this update
};

// What one job does: gives back, then takes.
struct MemoryBatch {
  std::mutex mutex;                 // held while a block is given back
  std::vector<MemoryBlock> unused;  // guarded by `mutex`, as
  size_t givenBack = 0;             // how many of them are gone
  std::vector<std::shared_ptr<MemoryOrder>> orders;
};

// Who wants memory orders it, and asks again in every update until it is there; what nobody asks for goes back. One
// thread at a time; a job touches nothing but its batch.
class MemoryOrders {
 public:
  MemoryOrders();

  // Between these two allocations are ordered instead of made.
  void open() { isOpen_ = true; }
  void close(MemoryLedger& ledger);
  bool isOpen() const { return isOpen_; }

  // An order like this one that was not asked for since open(); null: there is none.
  std::shared_ptr<MemoryOrder> find(const FrothMemoryRequest& request, MemoryUse use) const;
  void add(const FrothMemoryRequest& request, const MemoryBlock& block);
  // Makes a block of an order that was taken since open() one that can be asked for again. False: it is of none.
  bool putBack(const MemoryBlock& block);
  // Takes back those that were added behind `number`, and that no job has.
  uint64_t newest() const { return newest_; }
  VkDeviceSize deviceBytes() const;  // of all orders that nobody has taken, without host memory
  void cancelBehind(uint64_t number, MemoryLedger& ledger);

  // Blocks to be given back; the ledger is charged until that is done. False: there is no room.
  bool keep(const MemoryBlock& block);
  // Those that no job is giving back at this moment. Removes from the ledger what is given back meanwhile, but them.
  std::vector<MemoryBlock> takeKept(MemoryLedger& ledger);

  // No job is under way. Null: there is nothing to be done.
  std::shared_ptr<MemoryBatch> startBatch();
  void endBatch(MemoryLedger& ledger);
  bool isGivingBack() const { return !kept_.empty() || (batch_ && !batch_->unused.empty()); }

  // For good: no job has the batch any more. Returns what is to be given back at once; keep() refuses from now on.
  std::vector<MemoryBlock> finish(MemoryLedger& ledger);

 private:
  bool isOpen_ = false, isFinished_ = false;
  uint64_t newest_ = 0;
  std::vector<std::shared_ptr<MemoryOrder>> orders_;
  std::vector<MemoryBlock> kept_;
  std::shared_ptr<MemoryBatch> batch_;
};

}  // namespace froth
