#include "runtime/asset/gpu_arena.h"

#include <algorithm>
#include <utility>

namespace froth {
namespace {

// A shared block has at least this part of what is held: so the number of blocks grows by a logarithm, whatever is
// asked for.
constexpr VkDeviceSize kLeastShare = 16;
// [bytes] What is larger has a block of its own: a few of these in a shared one would leave much of it empty.
constexpr VkDeviceSize kMostAmongOthers = GpuArena::kMostShared / 4;

VkDeviceSize aligned(VkDeviceSize size) {
  return (size + GpuArena::kAlignment - 1) / GpuArena::kAlignment * GpuArena::kAlignment;
}

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
  Place place;
  if (takeGap(size, place)) {
    orderedSize_ = 0;  // a place was given back meanwhile: nobody asks for the block any more
    return place;
  }
  if (const Status status = addBlock(size, more, purpose); !status) return status.error();
  takeGap(size, place);
  return place;
}

Status GpuArena::addBlock(VkDeviceSize size, VkDeviceSize more, const char* purpose) {
  blocks_.reserve(blocks_.size() + 1);  // so that what is made has its place
  gaps_.reserve(gaps_.size() + 1);
  const VkDeviceSize blockSize = orderedSize_ != 0 ? orderedSize_ : chooseBlockSize(size, more);
  Gaps whole{{0, blockSize}};
  const BufferWish wish{blockSize, purpose};
  GpuBuffer block;
  const Status status = device_.createBuffers(MemoryUse::kAssets, BufferKind::kUploaded, purpose, {&wish, 1},
                                              {&block, 1}, limit_ == Limit::kNone);
  orderedSize_ = isOrdered(status) ? blockSize : 0;
  if (!status) return status;
  blocks_.push_back(block);
  gaps_.push_back(std::move(whole));
  heldBytes_ += block.memory.granted;
  return {};
}

// The smallest gap that fits, the first of such: where places of many sizes come and go, that leaves least unused
// (GpuArena.GivesPlacesThatDoNotOverlapAndTakesThemBack tells how much). False: there is none.
bool GpuArena::takeGap(VkDeviceSize size, Place& place) {
  size_t block = blocks_.size(), index = 0;
  VkDeviceSize least = UINT64_MAX;
  for (size_t i = 0; i < blocks_.size(); ++i) {
    for (size_t k = 0; k < gaps_[i].size(); ++k) {
      const VkDeviceSize found = gaps_[i][k].size;
      if (found < size || found >= least) continue;
      least = found;
      block = i;
      index = k;
    }
  }
  if (block == blocks_.size()) return false;
  Gap& gap = gaps_[block][index];
  place = {blocks_[block].buffer, gap.offset, blocks_[block].address + gap.offset};
  const VkDeviceSize taken = std::min(gap.size, aligned(size));
  gap.offset += taken;
  gap.size -= taken;
  if (gap.size == 0) gaps_[block].erase(gaps_[block].begin() + static_cast<std::ptrdiff_t>(index));
  return true;
}

void GpuArena::free(const Place& place, VkDeviceSize size) {
  const auto isIt = [&](const GpuBuffer& block) { return block.buffer == place.buffer; };
  const auto block = std::find_if(blocks_.begin(), blocks_.end(), isIt);
  const auto gaps = gaps_.begin() + (block - blocks_.begin());
  const Gap freed{place.offset, std::min(aligned(size), block->size - place.offset)};
  const auto isBehind = [&](const Gap& gap) { return gap.offset > freed.offset; };
  auto gap = gaps->insert(std::find_if(gaps->begin(), gaps->end(), isBehind), freed);
  const auto joinNext = [&](Gaps::iterator first) {
    const auto next = first + 1;
    if (next == gaps->end() || first->offset + first->size != next->offset) return;
    first->size += next->size;
    gaps->erase(next);
  };
  joinNext(gap);
  if (gap != gaps->begin()) joinNext(gap - 1);
  if (gaps->front().size < block->size) return;
  heldBytes_ -= block->memory.granted;
  device_.destroyBuffer(*block);
  blocks_.erase(block);
  gaps_.erase(gaps);
}

}  // namespace froth
