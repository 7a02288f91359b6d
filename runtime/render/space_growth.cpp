#include "runtime/render/space_growth.h"

#include <algorithm>

namespace froth {
namespace {

// Where a part of what is wanted has room: by how much it grows at least, and the steps in which it is found.
constexpr double kLeastGrowth = 1.125, kLessGrowth = 1.0 / 16;

// The largest part of what is wanted that the budget has room for, by halves.
Status growToLess(InstanceSpace& space, const ViewCapacity& wanted) {
  const ViewCapacity least = lessened(wanted, 0);
  for (double factor = 0.5;; factor *= 0.5) {
    const ViewCapacity less = lessened(wanted, factor);
    const Status status = space.buffers.grow(less, space.lastSerial);
    if (status || isPending(status) || less == least) return status;
  }
}

// What is wanted, by parts: each needs room beside what it replaces only.
Status growInParts(InstanceSpace& space, const ViewCapacity& wanted, uint64_t completedSerial) {
  Status result;
  for (const ViewCapacity& part : {ViewCapacity{.cells = wanted.cells, .details = wanted.details},
                                   ViewCapacity{.planes = wanted.planes}, ViewCapacity{.pairs = wanted.pairs}}) {
    const Status status = space.buffers.grow(part, space.lastSerial);
    if (!status && !isPending(result)) result = status;
    space.buffers.freeRetired(completedSerial);
  }
  return result;
}

// What the newest complete frame wanted, or the largest part of it that has room, if it is worth an exchange of
// buffers. Whether that was all.
Result<bool> growToDemand(Device& device, InstanceSpace& space, const GpuAsset& asset, uint64_t completedSerial) {
  const ViewCapacity held = space.buffers.capacity();
  const ViewCapacity needed = largest(held, neededBy(asset, space.demand, asset.detailCount));
  const VkDeviceSize most = bytesOf(held) + device.roomBytes() + device.orderedBytes();
  for (double part = 1; part == 1 || part * needed.cells >= kLeastGrowth * held.cells; part -= kLessGrowth) {
    const ViewCapacity less = largest(held, lessened(needed, part));
    if (bytesOf(less) > most) continue;
    const Status status = growInParts(space, less, completedSerial);
    if (isPending(status)) return status.error();
    if (status) return part == 1;
  }
  return false;
}

// After the budget refused all at once. The refusal is the error, if that is not all either.
Status growToRoom(Device& device, InstanceSpace& space, const GpuAsset* asset, const ViewCapacity& wanted,
                  uint64_t completedSerial, const Status& refusal) {
  if (!space.buffers.areMade() || (asset && !coversAsset(*asset, space.buffers.capacity()))) {
    const Status status = growToLess(space, wanted);
    return isPending(status) ? status : refusal;
  }
  if (asset && !coversNextChunks(*asset, space.buffers.capacity())) {  // chunks wait for so much before they are drawn
    const Status status = space.buffers.grow({.chunks = wanted.chunks, .groups = wanted.groups}, space.lastSerial);
    if (isPending(status)) return status;
    space.buffers.freeRetired(completedSerial);
  }
  if (asset) {
    const Result<bool> isAll = growToDemand(device, space, *asset, completedSerial);
    if (!isAll) return isAll.error();
    if (!*isAll) return refusal;
  }
  const Status status = growInParts(space, wanted, completedSerial);
  return status || isPending(status) ? status : refusal;
}

Status growBuffers(Device& device, InstanceSpace& space, const GpuAsset* asset, const ViewCapacity& wanted,
                   uint64_t completedSerial) {
  if (wanted == space.buffers.capacity()) return {};
  const VkDeviceSize heldBytes = device.ledger.deviceBytes();
  const VkDeviceSize budget = device.budget;
  const auto& refusal = space.refusal;
  const bool coversPlan = !asset || coversNextChunks(*asset, space.buffers.capacity());
  if (refusal && coversPlan && refusal->asset == asset && refusal->budget == budget &&
      heldBytes >= refusal->deviceBytes && largest(wanted, refusal->wanted) == wanted) {
    return refusal->error;
  }
  space.refusal.reset();
  const uint64_t budgetRefusals = device.budgetRefusals;
  const Status status = space.buffers.grow(wanted, space.lastSerial);
  if (device.budgetRefusals == budgetRefusals) return status;
  const Status less = growToRoom(device, space, asset, wanted, completedSerial, status);
  if (!less && !isPending(less)) space.refusal = {asset, wanted, budget, device.ledger.deviceBytes(), less.error()};
  return less;
}

}  // namespace

Status prepareSpace(ViewState& view, InstanceSpace& space, uint64_t completedSerial, const GpuAsset* asset) {
  space.buffers.freeRetired(completedSerial);
  if (const Status status = space.buffers.trim(space.lastSerial, completedSerial); !status) return status;
  ViewCapacity wanted = largest(space.buffers.capacity(), view.leastCapacity);
  const bool isHeldBack = view.device.excessBytes() > 0;  // what views give up now they would take again
  if (asset && !(isHeldBack && coversAsset(*asset, wanted))) {
    coverAsset(*asset, view.reservedCells, wanted);
    coverDemand(*asset, demandOfNext(*asset, space.demand), wanted);
  }
  space.buffers.expectCells(space.demand.cells);
  const VkBuffer oldWalkStart = space.buffers[ViewBuffer::kWalkStart].buffer;
  const Status status = growBuffers(view.device, space, asset, wanted, completedSerial);
  const bool isWalkStartKept = space.buffers[ViewBuffer::kWalkStart].buffer == oldWalkStart;
  if (!isWalkStartKept || space.walkAsset != asset) space.walkAsset = nullptr;
  return status;
}

}  // namespace froth
