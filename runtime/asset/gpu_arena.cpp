#include "runtime/asset/gpu_arena.h"

#include <algorithm>

namespace froth {
namespace {

// A shared block has at least this part of what is held: so the number of blocks grows by a logarithm, whatever is
// asked for.
constexpr VkDeviceSize kLeastShare = 16;
// [bytes] What is larger has a block of its own: a few of these in a shared one would leave much of it empty.
constexpr VkDeviceSize kMostAmongOthers = GpuArena::kMostShared / 4;

}  // namespace

GpuArena::~GpuArena() {
  for (GpuBuffer& block : blocks_) device_.destroyBuffer(block);
}

// Under a tight budget blocks hold no more than what is asked for.
VkDeviceSize GpuArena::chooseBlockSize(VkDeviceSize size, VkDeviceSize more) const {
  if (size > kMostAmongOthers) return size;
  const VkDeviceSize wanted = std::max(size + std::min(more, kMostShared), heldBytes_ / kLeastShare);
  const VkDeviceSize room = limit_ == Limit::kBudget ? device_.roomBytes() / 2 : kMostShared;
  const VkDeviceSize most = std::min({kMostShared, device_.largestBuffer(), room});
  return std::max(size, std::min(wanted, most));
}

Result<GpuArena::Place> GpuArena::allocate(VkDeviceSize size, VkDeviceSize more, const char* purpose) {
  if (const VkDeviceSize room = roomLeft(); size > room) {
    blocks_.reserve(blocks_.size() + 1);  // so that what is made has its place
    const VkDeviceSize blockSize = orderedSize_ != 0 ? orderedSize_ : chooseBlockSize(size, more);
    const BufferWish wish{blockSize, purpose};
    GpuBuffer block;
    const Status status = device_.createBuffers(MemoryUse::kAssets, BufferKind::kUploaded, purpose, {&wish, 1},
                                                {&block, 1}, limit_ == Limit::kNone);
    orderedSize_ = isOrdered(status) ? blockSize : 0;
    if (!status) return status.error();
    blocks_.push_back(block);
    heldBytes_ += block.memory.granted;
    if (blocks_.size() > 1 && blockSize - size < room) return Place{block.buffer, 0, block.address};
    open_ = blocks_.size() - 1;
    used_ = 0;
  }
  const GpuBuffer& block = blocks_[open_];
  const Place place{block.buffer, used_, block.address + used_};
  used_ = std::min(block.size, used_ + (size + kAlignment - 1) / kAlignment * kAlignment);
  return place;
}

}  // namespace froth
