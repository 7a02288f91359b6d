// Device memory: within the budget, from the driver or the caller, at once or by a job.
#include <utility>

#include "runtime/device/device.h"

namespace froth {
namespace {

std::optional<uint32_t> findMemoryType(const VkPhysicalDeviceMemoryProperties& memory, uint32_t allowedTypes,
                                       const MemoryWish& wish) {
  for (const VkMemoryPropertyFlags wanted : {wish.required | wish.preferred, wish.required}) {
    for (uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
      const bool isAllowed = (allowedTypes >> type & 1) != 0;
      if (isAllowed && (memory.memoryTypes[type].propertyFlags & wanted) == wanted) {
        return type;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

VkDeviceSize Device::roomBytes() const {
  return budget == 0 ? UINT64_MAX : budget - std::min(budget, ledger.deviceBytes());
}

VkDeviceSize Device::excessBytes() const {
  const VkDeviceSize held = ledger.deviceBytes();
  return budget != 0 && held > budget ? held - budget : 0;
}

Status Device::checkBudget(VkDeviceSize size, const MemoryWish& wish) {
  if (isHostUse(wish.use) || wish.mayExceedBudget) {
    return {};
  }
  if (size > roomBytes() && orders && orders->isGivingBack()) {
    if (orders->isOpen()) return makeRoomToCome();
    giveBackNow(orders->takeKept(ledger));
  }
  const VkDeviceSize held = ledger.deviceBytes(), room = roomBytes();
  if (size <= room) {
    return {};
  }
  ++budgetRefusals;
  return makeError(ErrorKind::kMemory,
                   "%s: %llu bytes do not fit the device budget: %llu of %llu bytes are in use; raise "
                   "FrothContextInfo::deviceBudget by %llu bytes (frothSetBudget), or close another asset or view",
                   wish.purpose, asPrinted(size), asPrinted(held), asPrinted(budget), asPrinted(size - room));
}

Result<MemoryBlock> Device::allocate(const VkMemoryRequirements& requirements, VkDeviceSize used,
                                     const MemoryWish& wish) {
  const std::optional<uint32_t> type = findMemoryType(memory, requirements.memoryTypeBits, wish);
  if (!type) {
    return makeError(ErrorKind::kDevice, "%s: no memory type of this device fits (allowed types 0x%x)", wish.purpose,
                     requirements.memoryTypeBits);
  }
  FrothMemoryRequest request{};
  request.structSize = sizeof(request);
  request.requirements = requirements;
  request.memoryTypeIndex = *type;
  request.allocateFlags = wish.flags;
  request.isMapped = isHostUse(wish.use);
  request.purpose = wish.purpose;
  const bool isDeferred = orders && orders->isOpen();
  if (const auto order = isDeferred ? orders->find(request, wish.use) : nullptr) {
    return takeOrdered(*order);
  }
  if (const Status status = checkBudget(requirements.size, wish); !status) {
    return status.error();
  }
  MemoryBlock block{.place = {}, .granted = requirements.size, .used = used, .use = wish.use};
  if (isDeferred) {
    orders->add(request, block);
    ledger.add(block);
    return makeOrdered();
  }
  const VkResult result = takeMemory(request, block.place);
  if (result != VK_SUCCESS) {
    return explainAllocation(result, block, wish.purpose);
  }
  ledger.add(block);
  return block;
}

Result<MemoryBlock> Device::takeOrdered(MemoryOrder& order) {
  if (order.state != MemoryOrder::State::kDone) {
    return makeOrdered();
  }
  order.use = MemoryOrder::Use::kTaken;
  if (order.result == VK_SUCCESS) {
    return order.block;
  }
  ledger.remove(order.block);
  return explainAllocation(order.result, order.block, order.purpose.c_str());
}

Error Device::explainAllocation(VkResult result, const MemoryBlock& block, const char* purpose) {
  return explain(result, "%s: %s of %llu bytes, with %llu bytes in use and %u allocations (the device has at most %u),",
                 purpose, callbacks.allocate ? "FrothContextInfo::allocateMemory" : "vkAllocateMemory",
                 asPrinted(block.granted), asPrinted(ledger.deviceBytes()), ledger.count(),
                 properties.limits.maxMemoryAllocationCount);
}

VkResult Device::takeMemory(const FrothMemoryRequest& request, FrothDeviceMemory& place) const {
  return callbacks.allocate ? callbacks.allocate(callbacks.user, &request, &place) : allocateOwn(request, place);
}

VkResult Device::allocateOwn(const FrothMemoryRequest& request, FrothDeviceMemory& place) const {
  VkMemoryAllocateFlagsInfo flags{};
  flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
  flags.flags = request.allocateFlags;
  VkMemoryAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocation.pNext = &flags;
  allocation.allocationSize = request.requirements.size;
  allocation.memoryTypeIndex = request.memoryTypeIndex;
  VkResult result = table.vkAllocateMemory(device, &allocation, nullptr, &place.memory);
  if (result != VK_SUCCESS) {
    return result;
  }
  nameObject(VK_OBJECT_TYPE_DEVICE_MEMORY, place.memory, request.purpose);
  if (request.isMapped) {
    result = table.vkMapMemory(device, place.memory, 0, VK_WHOLE_SIZE, 0, &place.mapped);
    if (result != VK_SUCCESS) {
      table.vkFreeMemory(device, place.memory, nullptr);
      place = {};
    }
  }
  return result;
}

void Device::giveBack(const FrothDeviceMemory& place) const {
  if (callbacks.free) {
    callbacks.free(callbacks.user, &place);
  } else {
    table.vkFreeMemory(device, place.memory, nullptr);  // unmaps
  }
}

void Device::release(MemoryBlock& block) {
  if (!block.place.memory) {
    return;
  }
  const bool isKept = orders && (orders->putBack(block) || orders->keep(block));
  if (!isKept) {
    ledger.remove(block);
    giveBack(block.place);
  }
  block = {};
}

void Device::run(MemoryBatch& batch) const {
  for (bool isLast = false; !isLast;) {
    const std::lock_guard lock(batch.mutex);
    isLast = batch.givenBack == batch.unused.size();
    if (!isLast) giveBack(batch.unused[batch.givenBack++].place);
  }
  for (const std::shared_ptr<MemoryOrder>& order : batch.orders) {
    order->result = takeMemory(order->request, order->block.place);
    if (order->result != VK_SUCCESS) order->block.place = {};
  }
}

void Device::giveBackNow(const std::vector<MemoryBlock>& blocks) {
  for (const MemoryBlock& block : blocks) {
    ledger.remove(block);
    giveBack(block.place);
  }
}

void Device::finishOrders() {
  if (orders) {
    giveBackNow(orders->finish(ledger));
  }
}

}  // namespace froth
