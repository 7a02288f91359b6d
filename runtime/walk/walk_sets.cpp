#include "runtime/walk/walk_sets.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "format/to_vector.h"
#include "runtime/render/camera_rays.h"
#include "runtime/render/frame_block.h"
#include "runtime/render/pass_recorder.h"
#include "runtime/render/view_capacity.h"
#include "shaders/gpu/walk_layout.h"

namespace froth {
namespace {

// A slot of the tables: WalkBlock, WalkInstance [most], the same for seeds, ChunkEntry [capacity]; each slot where a
// uniform buffer may begin.
constexpr VkDeviceSize kAlignment = 256;
constexpr VkDeviceSize kInstancesOffset = kAlignment;
constexpr VkDeviceSize kChunksOffset = kInstancesOffset + 2 * FROTH_WALK_MOST_INSTANCES * sizeof(gpu::WalkInstance);
constexpr VkDeviceSize kCountersStride = kAlignment;
constexpr uint32_t kFirstSeed = FROTH_WALK_MOST_INSTANCES;
static_assert(int{FROTH_PREPARE_VISIBILITY} == gpu::kPreparedVisibility &&
              int{FROTH_PREPARE_RADIANCE} == gpu::kPreparedRadiance);
static_assert(kChunksOffset % 16 == 0 && sizeof(gpu::WalkCounters) <= kCountersStride);

gpu::WalkInstance describe(const WalkedInstance& instance, const glm::dvec3& eye, const FrothWalkInfo& info) {
  const RenderInstance& placement = instance.placement;
  const GpuAsset& asset = *placement.asset;
  gpu::WalkInstance entry{};
  const glm::dmat3 rows = glm::transpose(rotationOf(placement.rotation));
  entry.worldX = toFloats(rows[0]);
  entry.worldY = toFloats(rows[1]);
  entry.worldZ = toFloats(rows[2]);
  const glm::dvec3 low = toVector(asset.boundsLow), high = toVector(asset.boundsHigh);
  const glm::dvec3 distance = glm::abs(low - eye) + glm::abs(high - eye);
  entry.boxLow = toFloats(low - eye);
  entry.boxLow[3] = static_cast<float>(1e-5 * std::max({distance.x, distance.y, distance.z}));
  entry.boxSize = toFloats(high - low);
  entry.scale = placement.scale;
  entry.detailSharpness = asset.detailSharpness;
  entry.mask = instance.mask;
  entry.userId = instance.placement.userId;
  entry.chunkCount = static_cast<uint32_t>(asset.chunks.size());
  entry.localBits = asset.localBits;
  entry.maxSteps = info.maxSteps;
  entry.maxNeighbours = info.maxNeighbours;
  entry.detailCount = asset.detailCount;
  entry.lobeCount = asset.lobeCount;
  entry.hasHeights = asset.hasHeights;
  entry.exposure = placement.exposure;
  entry.entriesAlong = asset.walkEntriesAlong;
  entry.entries = asset.walkEntries;
  entry.borders = asset.borders;
  entry.borderCount = asset.borderCount;
  entry.fileChunkCount = asset.fileChunkCount;
  entry.firstSlot = asset.firstSlot;
  entry.prepared = asset.prepared;
  return entry;
}

uint64_t sumOf(const gpu::WalkCounters& counters, uint32_t kind) {
  return counters.work[2 * kind] | uint64_t{counters.work[2 * kind + 1]} << 32;
}

// Of all of them; each form holds what is less.
uint32_t preparedOf(std::span<const WalkedInstance> instances) {
  uint32_t prepared = gpu::kPreparedRadiance;
  for (const WalkedInstance& instance : instances) prepared = std::min(prepared, instance.placement.asset->prepared);
  return prepared;
}

}  // namespace

WalkSets::WalkSets(Device& device, bool countsWork, uint32_t framesInFlight)
    : device_(device), countsWork_(countsWork), slots_(framesInFlight) {}

Result<std::unique_ptr<WalkSets>> WalkSets::create(Device& device, VkPipelineCache cache, const WalkOptions& options,
                                                   uint32_t framesInFlight) {
  std::unique_ptr<WalkSets> sets(new WalkSets(device, options.countsWork, framesInFlight));
  Result<std::unique_ptr<WalkPipelines>> pipelines = WalkPipelines::create(device, cache, options);
  if (!pipelines) return pipelines.error();
  sets->pipelines_ = std::move(*pipelines);
  Result<std::unique_ptr<DescriptorSets>> descriptorSets =
      DescriptorSets::create(device, "walk sets", WalkPipelines::bindings(), framesInFlight);
  if (!descriptorSets) return descriptorSets.error();
  for (uint32_t slot = 0; slot < framesInFlight; ++slot) sets->slots_[slot].set = (**descriptorSets)[slot];
  sets->sets_ = std::move(*descriptorSets);
  // In host memory: they are read every frame, and written only by rays that fail, or for tuning.
  const Result<GpuBuffer> counters = device.createBuffer(MemoryUse::kWalksHost, BufferKind::kReadback,
                                                         framesInFlight * kCountersStride, "counters of walk sets");
  if (!counters) return counters.error();
  sets->counters_ = *counters;
  if (const Status status = sets->grow(0); !status) return status.error();
  return sets;
}

WalkSets::~WalkSets() {
  for (GpuBuffer* buffer : {&tables_, &staging_, &counters_}) device_.destroyBuffer(*buffer);
  for (auto& [serial, buffer] : retired_) device_.destroyBuffer(buffer);
}

// ---- Memory ----

VkDeviceSize WalkSets::stride() const {
  const VkDeviceSize bytes = kChunksOffset + chunkCapacity_ * sizeof(gpu::ChunkEntry);
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

Status WalkSets::grow(uint32_t chunkCount) {
  const uint32_t oldCapacity = chunkCapacity_;
  chunkCapacity_ = chunkCount;
  const VkDeviceSize size = slots_.size() * stride();
  retired_.reserve(retired_.size() + 2);  // so that what is replaced has its place
  Result<GpuBuffer> tables = device_.createBuffer(MemoryUse::kWalks, BufferKind::kDevice, size, "walk sets");
  Result<GpuBuffer> staging =
      device_.createBuffer(MemoryUse::kWalksHost, BufferKind::kStaging, size, "staging of walk sets");
  if (!tables || !staging) {
    if (tables) device_.destroyBuffer(*tables);
    if (staging) device_.destroyBuffer(*staging);
    chunkCapacity_ = oldCapacity;
    return tables ? staging.error() : tables.error();
  }
  if (tables_.buffer) retired_.emplace_back(recordedSerial_, tables_);
  if (staging_.buffer) retired_.emplace_back(recordedSerial_, staging_);
  tables_ = *tables;
  staging_ = *staging;
  return {};
}

Status WalkSets::prepare(uint64_t completedSerial, uint32_t chunkCount) {
  for (Slot& slot : slots_) {
    if (slot.serial == 0 || slot.serial > completedSerial) continue;
    readCounters(slot);
    slot.serial = 0;
  }
  std::erase_if(retired_, [&](auto& retired) {
    if (retired.first > completedSerial) return false;
    device_.destroyBuffer(retired.second);
    return true;
  });
  if (!hasSpaceFor(chunkCount)) {
    if (const Status status = grow(std::max(chunkCount, 2 * chunkCapacity_)); !status) return status;
  }
  return {};
}

void WalkSets::readCounters(const Slot& slot) {
  if (slot.serial <= status_.serial) return;
  const auto number = static_cast<size_t>(&slot - slots_.data());
  gpu::WalkCounters counters;
  std::memcpy(&counters, static_cast<const char*>(counters_.mapped) + number * kCountersStride, sizeof(counters));
  status_.serial = slot.serial;
  status_.stepLimits = counters.stepLimit;
  status_.versions = counters.version;
  status_.indexViolations = counters.violations;
  status_.rays = sumOf(counters, gpu::kRayWorkRays);
  status_.descents = sumOf(counters, gpu::kRayWorkDescents);
  status_.cells = sumOf(counters, gpu::kRayWorkCells);
  status_.neighbours = sumOf(counters, gpu::kRayWorkNeighbours);
  status_.cellsMet = sumOf(counters, gpu::kRayWorkMet);
  status_.detailSites = sumOf(counters, gpu::kRayWorkShaded);
}

void WalkSets::dropFrame(uint64_t serial) {
  for (Slot& slot : slots_) {
    if (slot.serial == serial) slot.serial = 0;
  }
}

// ---- Recording ----

void WalkSets::writeTables(uint32_t slot, const FrothWalkInfo& info, std::span<const WalkedInstance> instances) {
  char* staged = static_cast<char*>(staging_.mapped) + slot * stride();
  const VkDeviceAddress address = tables_.address + slot * stride();
  const glm::dvec3 eye(info.eye[0], info.eye[1], info.eye[2]);
  gpu::WalkBlock block{};
  block.abi = FROTH_WALK_ABI;
  block.instanceCount = static_cast<uint32_t>(instances.size());
  block.logCutoff = info.cutoff > 0 ? std::log(info.cutoff) : -std::numeric_limits<float>::infinity();
  block.logQuantile = std::log(info.quantile);
  block.flags = countsWork_ ? gpu::kWalkCountsWork : 0;
  block.prepared = preparedOf(instances);
  block.instances = address + kInstancesOffset;
  std::memcpy(staged, &block, sizeof(block));
  VkDeviceSize chunks = kChunksOffset;
  const auto write = [&](size_t place, const WalkedInstance& instance, const glm::dvec3& localEye) {
    gpu::WalkInstance entry = describe(instance, localEye, info);
    if (place >= kFirstSeed) entry.prepared = instance.placement.asset->preparing;
    entry.chunks = address + chunks;
    std::memcpy(staged + kInstancesOffset + place * sizeof(entry), &entry, sizeof(entry));
    fillChunks(*instance.placement.asset, localEye, RayPyramid(), reinterpret_cast<gpu::ChunkEntry*>(staged + chunks));
    chunks += entry.chunkCount * sizeof(gpu::ChunkEntry);
  };
  for (size_t i = 0; i < instances.size(); ++i) {
    const GpuAsset& asset = *instances[i].placement.asset;
    write(i, instances[i], assetFromWorld(instances[i].placement, eye));
    // Seeds are for all frames: seen from the middle of the box, and not from an eye that may be far away.
    if (!instances[i].isSeeded || !instances[i].toFill.empty()) {
      write(kFirstSeed + i, instances[i], 0.5 * (toVector(asset.boundsLow) + toVector(asset.boundsHigh)));
    }
  }
}

void WalkSets::updateSet(uint32_t slot) {
  const VkDescriptorBufferInfo buffers[] = {{tables_.buffer, slot * stride(), sizeof(gpu::WalkBlock)},
                                            {counters_.buffer, slot * kCountersStride, sizeof(gpu::WalkCounters)}};
  VkWriteDescriptorSet writes[2]{};
  for (uint32_t binding = 0; binding < 2; ++binding) {
    writes[binding].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[binding].dstSet = slots_[slot].set;
    writes[binding].dstBinding = binding;
    writes[binding].descriptorCount = 1;
    writes[binding].descriptorType =
        binding == gpu::kBindingWalk ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[binding].pBufferInfo = &buffers[binding];
  }
  device_.table.vkUpdateDescriptorSets(device_.device, 2, writes, 0, nullptr);
}

// Uploads of assets, of this frame or earlier, were made visible to compute shaders only.
void WalkSets::recordCopies(VkCommandBuffer commandBuffer, uint32_t slot, VkPipelineStageFlags2 stages) const {
  const DeviceTable& vk = device_.table;
  const VkBufferCopy copy{slot * stride(), slot * stride(), stride()};
  vk.vkCmdCopyBuffer(commandBuffer, staging_.buffer, tables_.buffer, 1, &copy);
  vk.vkCmdFillBuffer(commandBuffer, counters_.buffer, slot * kCountersStride, sizeof(gpu::WalkCounters), 0);
  vk.recordMemoryBarrier(
      commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
      stages | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
      VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

VkDescriptorSet WalkSets::record(VkCommandBuffer commandBuffer, const FrothWalkInfo& info,
                                 std::span<const WalkedInstance> instances, uint64_t serial) {
  const auto isFree = [](const Slot& slot) { return slot.serial == 0; };
  const auto free = std::find_if(slots_.begin(), slots_.end(), isFree);
  current_ = static_cast<uint32_t>(free - slots_.begin());
  free->serial = serial;
  recordedSerial_ = serial;
  instanceCount_ = static_cast<uint32_t>(instances.size());
  prepared_ = std::min(preparedOf(instances), pipelines_->mostPrepared());
  writeTables(current_, info, instances);
  updateSet(current_);
  recordCopies(commandBuffer, current_, info.stages);
  prepareCells(commandBuffer, instances, info.stages);
  seedEntries(commandBuffer, instances, info.stages);
  return free->set;
}

// No frame before reads what is filled here.
void WalkSets::prepareCells(VkCommandBuffer commandBuffer, std::span<const WalkedInstance> instances,
                            VkPipelineStageFlags2 stages) const {
  const auto isFilled = [](const WalkedInstance& instance) { return instance.toFill.empty(); };
  if (std::ranges::all_of(instances, isFilled)) return;
  const DeviceTable& vk = device_.table;
  bind(commandBuffer, kPrepareCells);
  for (uint32_t i = 0; i < instances.size(); ++i) {
    for (const uint32_t slot : instances[i].toFill) {
      // Chunks share no bytes, but a barrier stands between all uses of what one pointer leads to (tests/commands).
      vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                             VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                             VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
      const uint32_t cells = instances[i].placement.asset->chunks[slot].cellCount;
      pushSeed(commandBuffer, {kFirstSeed + i, slot});
      vk.vkCmdDispatch(commandBuffer, std::min(groupsOver(cells, gpu::kRayGroupSize), gpu::kMostGroupsAlong), 1, 1);
    }
  }
  vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                         stages | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
}

// Of assets that are seen for the first time, or with other chunks than before: the entries' cells of all, then the
// marks of all. Frames before may still read those of the chunks before.
void WalkSets::seedEntries(VkCommandBuffer commandBuffer, std::span<const WalkedInstance> instances,
                           VkPipelineStageFlags2 stages) const {
  const auto isNew = [&](const WalkedInstance& instance) {
    const auto isSame = [&](const WalkedInstance& other) { return other.placement.asset == instance.placement.asset; };
    return !instance.isSeeded && &*std::find_if(instances.begin(), instances.end(), isSame) == &instance;
  };
  if (std::none_of(instances.begin(), instances.end(), isNew)) return;
  device_.table.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE,
                                    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_NONE);
  for (const uint32_t pipeline : {kSeedEntries, kMarkEntries}) {
    bind(commandBuffer, pipeline);
    for (uint32_t i = 0; i < instances.size(); ++i) {
      if (isNew(instances[i])) recordSeeds(commandBuffer, pipeline, i, *instances[i].placement.asset);
    }
    device_.table.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                      VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                      stages | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  }
}

void WalkSets::recordSeeds(VkCommandBuffer commandBuffer, uint32_t pipeline, uint32_t instance,
                           const GpuAsset& asset) const {
  const DeviceTable& vk = device_.table;
  pushSeed(commandBuffer, {kFirstSeed + instance, 0});
  if (pipeline == kSeedEntries) {
    const uint32_t along = asset.walkEntriesAlong;
    dispatchGroups(vk, commandBuffer, groupsOver(along * along * along, gpu::kRayGroupSize));
    return;
  }
  const auto chunks = static_cast<uint32_t>(asset.chunks.size());
  const uint32_t rows = groupsOver(chunks, gpu::kMostGroupsAlong);
  vk.vkCmdDispatch(commandBuffer, groupsOver(groupsOver(asset.liveCount, chunks), gpu::kRayGroupSize),
                   groupsOver(chunks, rows), rows);
}

void WalkSets::pushSeed(VkCommandBuffer commandBuffer, const SeedConstants& constants) const {
  device_.table.vkCmdPushConstants(commandBuffer, pipelines_->layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                   sizeof(constants), &constants);
}

void WalkSets::bind(VkCommandBuffer commandBuffer, uint32_t pipeline) const {
  const DeviceTable& vk = device_.table;
  vk.vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, (*pipelines_)[pipeline]);
  vk.vkCmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_->layout(), 0, 1,
                             &slots_[current_].set, 0, nullptr);
}

void WalkSets::recordRays(VkCommandBuffer commandBuffer, VkDeviceAddress rays, VkDeviceAddress hits, uint32_t count,
                          FrothRayKind kind) const {
  const DeviceTable& vk = device_.table;
  const bool isMerged = instanceCount_ > 1 && pipelines_->canMerge();
  bind(commandBuffer, castPipeline({kind, prepared_, isMerged}));
  const CastConstants constants{rays, hits, count, 0};
  vk.vkCmdPushConstants(commandBuffer, pipelines_->layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants),
                        &constants);
  dispatchGroups(vk, commandBuffer, groupsOver(count, gpu::kRayGroupSize));
  vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);  // counters
}

}  // namespace froth
