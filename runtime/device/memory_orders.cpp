#include "runtime/device/memory_orders.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace froth {
namespace {

// More are given back by the frame that frees them: keep() allocates nothing.
constexpr size_t kMostKept = 1024;

bool isSameRequest(const FrothMemoryRequest& a, const FrothMemoryRequest& b) {
  return a.requirements.size == b.requirements.size && a.requirements.alignment == b.requirements.alignment &&
         a.requirements.memoryTypeBits == b.requirements.memoryTypeBits && a.memoryTypeIndex == b.memoryTypeIndex &&
         a.allocateFlags == b.allocateFlags && a.isMapped == b.isMapped;
}

}  // namespace

MemoryOrders::MemoryOrders() { kept_.reserve(kMostKept); }

std::shared_ptr<MemoryOrder> MemoryOrders::find(const FrothMemoryRequest& request, MemoryUse use) const {
  for (const std::shared_ptr<MemoryOrder>& order : orders_) {
    const bool isFree = order->use == MemoryOrder::Use::kUnasked || order->use == MemoryOrder::Use::kPutBack;
    if (!isFree || order->block.use != use || order->purpose != request.purpose) continue;
    if (!isSameRequest(order->request, request)) continue;
    order->use = MemoryOrder::Use::kAsked;
    return order;
  }
  return nullptr;
}

void MemoryOrders::add(const FrothMemoryRequest& request, const MemoryBlock& block) {
  auto order = std::make_shared<MemoryOrder>(
      MemoryOrder{.request = request, .purpose = request.purpose, .block = block, .number = newest_ + 1});
  order->request.purpose = order->purpose.c_str();
  orders_.push_back(std::move(order));
  ++newest_;
}

bool MemoryOrders::putBack(const MemoryBlock& block) {
  const auto found = std::ranges::find_if(orders_, [&](const std::shared_ptr<MemoryOrder>& order) {
    const FrothDeviceMemory &a = order->block.place, &b = block.place;
    return order->use == MemoryOrder::Use::kTaken && a.memory == b.memory && a.offset == b.offset;
  });
  if (found == orders_.end()) return false;
  (*found)->use = MemoryOrder::Use::kPutBack;
  return true;
}

void MemoryOrders::cancelBehind(uint64_t number, MemoryLedger& ledger) {
  std::erase_if(orders_, [&](const std::shared_ptr<MemoryOrder>& order) {
    if (order->number <= number || order->state != MemoryOrder::State::kWaiting) return false;
    ledger.remove(order->block);
    return true;
  });
}

VkDeviceSize MemoryOrders::deviceBytes() const {
  VkDeviceSize bytes = 0;
  for (const std::shared_ptr<MemoryOrder>& order : orders_) {
    const bool isCounted = order->use != MemoryOrder::Use::kTaken && !isHostUse(order->block.use);
    bytes += isCounted ? order->block.granted : 0;
  }
  return bytes;
}

void MemoryOrders::close(MemoryLedger& ledger) {
  isOpen_ = false;
  std::erase_if(orders_, [&](const std::shared_ptr<MemoryOrder>& order) {
    const MemoryOrder::Use use = std::exchange(order->use, MemoryOrder::Use::kUnasked);
    if (use == MemoryOrder::Use::kTaken) return true;
    if (use != MemoryOrder::Use::kUnasked || order->state == MemoryOrder::State::kUnderWay) return false;
    if (order->state == MemoryOrder::State::kDone && order->result == VK_SUCCESS) return keep(order->block);
    ledger.remove(order->block);
    return true;
  });
}

bool MemoryOrders::keep(const MemoryBlock& block) {
  if (isFinished_ || kept_.size() == kept_.capacity()) return false;
  kept_.push_back(block);
  return true;
}

std::vector<MemoryBlock> MemoryOrders::takeKept(MemoryLedger& ledger) {
  std::vector<MemoryBlock> blocks = kept_;
  kept_.clear();
  if (!batch_) return blocks;
  const std::lock_guard lock(batch_->mutex);
  const auto gone = batch_->unused.begin() + static_cast<ptrdiff_t>(batch_->givenBack);
  std::for_each(batch_->unused.begin(), gone, [&](const MemoryBlock& block) { ledger.remove(block); });
  blocks.insert(blocks.end(), gone, batch_->unused.end());
  batch_->unused.clear();
  batch_->givenBack = 0;
  return blocks;
}

std::shared_ptr<MemoryBatch> MemoryOrders::startBatch() {
  const auto isWaiting = [](const auto& order) { return order->state == MemoryOrder::State::kWaiting; };
  if (batch_) return batch_;  // host memory was exhausted before its job began
  if (kept_.empty() && std::ranges::none_of(orders_, isWaiting)) return nullptr;
  auto batch = std::make_shared<MemoryBatch>();
  batch->unused = kept_;
  std::ranges::copy_if(orders_, std::back_inserter(batch->orders), isWaiting);
  for (const std::shared_ptr<MemoryOrder>& order : batch->orders) order->state = MemoryOrder::State::kUnderWay;
  kept_.clear();
  return batch_ = std::move(batch);
}

void MemoryOrders::endBatch(MemoryLedger& ledger) {
  for (const MemoryBlock& block : batch_->unused) ledger.remove(block);
  for (const std::shared_ptr<MemoryOrder>& order : batch_->orders) order->state = MemoryOrder::State::kDone;
  batch_.reset();
}

std::vector<MemoryBlock> MemoryOrders::finish(MemoryLedger& ledger) {
  isFinished_ = true;
  std::vector<MemoryBlock> blocks = takeKept(ledger);
  batch_.reset();
  for (const std::shared_ptr<MemoryOrder>& order : orders_) {
    if (order->block.place.memory) {
      blocks.push_back(order->block);
    } else {
      ledger.remove(order->block);
    }
  }
  orders_.clear();
  return blocks;
}

}  // namespace froth
