// Single passes on the device against the CPU.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "format/checks.h"
#include "runtime/asset/cell_packer.h"
#include "runtime/render/pass_recorder.h"
#include "runtime/render/view_state.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

class Passes : public testing::Test {
 protected:
  Passes()
      : device_(*Device::create(vkGetInstanceProcAddr, sharedHost().instance, sharedHost().physicalDevice,
                                sharedHost().device)),
        pipelines_(std::move(*RenderPipelines::create(device_, VK_NULL_HANDLE, {.checkIndices = true}))) {}

  ~Passes() override {
    for (GpuBuffer& buffer : buffers_) device_.destroyBuffer(buffer);
  }

  // Mapped, and reached by address.
  template <class T>
  GpuBuffer upload(const std::vector<T>& values) {
    Result<GpuBuffer> buffer = device_.createBuffer(MemoryUse::kUploadsHost, BufferKind::kReadback,
                                                    std::max<size_t>(values.size() * sizeof(T), 16), "test");
    EXPECT_TRUE(buffer);
    if (!values.empty()) std::memcpy(buffer->mapped, values.data(), values.size() * sizeof(T));
    buffers_.push_back(*buffer);
    return *buffer;
  }

  template <class T>
  std::vector<T> download(const GpuBuffer& buffer, size_t count) {
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), buffer.mapped, count * sizeof(T));
    return values;
  }

  // What a device buffer of a view holds once the frame is complete.
  template <class T>
  std::vector<T> copyOut(const GpuBuffer& source, size_t count, size_t offset = 0) {
    const GpuBuffer target = upload(std::vector<T>(count));
    submit([&](VkCommandBuffer commandBuffer) {
      const VkBufferCopy copy{offset, 0, count * sizeof(T)};
      if (count > 0) device_.table.vkCmdCopyBuffer(commandBuffer, source.buffer, target.buffer, 1, &copy);
    });
    return download<T>(target, count);
  }

  void submit(const std::function<void(VkCommandBuffer)>& record) {
    const Status status = sharedHost().submit([&](VkCommandBuffer commandBuffer, uint64_t) -> Status {
      record(commandBuffer);
      return {};
    });
    EXPECT_TRUE(status) << status.error().message;
  }

  Device device_;
  std::unique_ptr<RenderPipelines> pipelines_;
  std::vector<GpuBuffer> buffers_;
};

class Sort : public Passes, public testing::WithParamInterface<uint32_t> {};

TEST_P(Sort, OrdersKeysAsAStableSortDoes) {
  const uint32_t count = GetParam();
  std::mt19937 engine(count);
  std::vector<uint32_t> keys(count), values(count);
  for (uint32_t& key : keys) key = (engine() % 97) * 0x01030507u;  // many equal keys, all bytes in use
  std::iota(values.begin(), values.end(), 0u);

  const GpuBuffer keyBuffer = upload(keys), valueBuffer = upload(values);
  const GpuBuffer keySwap = upload(keys), valueSwap = upload(values);
  const uint32_t rounds = sortRoundsOf(count), keysPerGroup = rounds * gpu::kGroupSize;
  const uint32_t groups = groupsOver(count, keysPerGroup);
  // Each group of keys has a row of digits, each kSortGroupsPerSum of these a row of sums before them.
  std::vector<uint32_t> histograms(4 * histogramBytes(std::max(count, 1u), rounds) / sizeof(uint32_t));
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t group = i / keysPerGroup, sum = group / gpu::kSortGroupsPerSum;
    ++histograms[gpu::kSortDigits * (group + sum + 1) + (keys[i] & 255)];
    ++histograms[gpu::kSortDigits * (gpu::kSortGroupsPerSum + 1) * sum + (keys[i] & 255)];
  }
  std::vector<uint32_t> slotTiles(count), tileSums(groupsOver(count, gpu::kCellsPerTileSum));
  for (uint32_t& tiles : slotTiles) tiles = engine() % 50;
  const GpuBuffer tileCountBuffer = upload(slotTiles), tileSumBuffer = upload(tileSums);
  gpu::Counters counters{};
  counters.visibleCells = count;
  counters.cellSortDispatch = {groups, 1, 1, 0};
  Result<GpuBuffer> counterBuffer =
      device_.createBuffer(MemoryUse::kAssets, BufferKind::kDevice, sizeof(counters), "test");
  ASSERT_TRUE(counterBuffer);
  buffers_.push_back(*counterBuffer);
  gpu::FrameBlock block{};
  block.counters = counterBuffer->address;
  block.visibleCapacity = count;
  block.sortRounds = rounds;
  block.slotTiles = upload(slotTiles).address;
  block.tileCounts = tileCountBuffer.address;
  block.tileSums = tileSumBuffer.address;
  const VkDeviceAddress histogramAddress = upload(histograms).address;
  const GpuBuffer blockBuffer = upload(std::vector<gpu::FrameBlock>{block});

  submit([&](VkCommandBuffer commandBuffer) {
    const PassRecorder recorder{.vk = device_.table,
                                .commandBuffer = commandBuffer,
                                .layout = pipelines_->state().layout,
                                .pipelines = &pipelines_->state().common[gpu::kLensClassPinhole],
                                .frame = blockBuffer.address,
                                .counters = counterBuffer->buffer,
                                .countersOffset = 0};
    device_.table.vkCmdUpdateBuffer(commandBuffer, counterBuffer->buffer, 0, sizeof(counters), &counters);
    VkMemoryBarrier2 memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    memory.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    memory.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    memory.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
    memory.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &memory;
    device_.table.vkCmdPipelineBarrier2(commandBuffer, &dependency);
    const SortArrays arrays = {keyBuffer.address,
                               valueBuffer.address,
                               keySwap.address,
                               valueSwap.address,
                               counterBuffer->address + offsetof(gpu::Counters, visibleCells),
                               histogramAddress,
                               std::max(count, 1u),
                               rounds,
                               offsetof(gpu::Counters, cellSortDispatch)};
    for (uint32_t digit = 0; digit < kCellKeyDigits; ++digit) {
      const bool isLast = digit + 1 == kCellKeyDigits;
      recordSortDigit(recorder, arrays, digit, isLast ? gpu::kSortTakeTileCounts : gpu::kSortCountNextDigit);
      recorder.wait();
    }
  });

  std::vector<uint32_t> order = values;
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  std::vector<uint32_t> sortedKeys;
  for (const uint32_t index : order) sortedKeys.push_back(keys[index]);
  std::vector<uint32_t> tileCounts;
  for (const uint32_t index : order) tileCounts.push_back(slotTiles[index]);
  for (uint32_t i = 0; i < count; ++i) tileSums[i / gpu::kCellsPerTileSum] += tileCounts[i];
  EXPECT_EQ(download<uint32_t>(keyBuffer, count), sortedKeys);
  EXPECT_EQ(download<uint32_t>(valueBuffer, count), order);
  EXPECT_EQ(download<uint32_t>(tileCountBuffer, count), tileCounts);
  EXPECT_EQ(download<uint32_t>(tileSumBuffer, tileSums.size()), tileSums);
  EXPECT_EQ(copyOut<gpu::Counters>(*counterBuffer, 1)[0].violations, 0u);
}

INSTANTIATE_TEST_SUITE_P(Counts, Sort, testing::Values(0u, 1u, 255u, 256u, 257u, 1025u, 100000u, 1000003u),
                         testing::PrintToStringParamName());

// Balls alone: no neighbours, K = M = 1.
class Bin : public Passes {
 protected:
  GpuAsset uploadBalls(const Foam& foam) {
    const auto count = static_cast<size_t>(foam.cellCount);
    std::vector<glm::vec4> siteRadius;
    for (size_t i = 0; i < count; ++i) siteRadius.emplace_back(foam.sites[i], foam.radii[i]);
    GpuAsset asset;
    asset.detailCount = asset.lobeCount = 1;
    asset.liveCount = asset.cellCount = foam.cellCount;
    GpuChunk chunk;
    chunk.cellCount = chunk.siteCount = chunk.liveCount = foam.cellCount;
    chunk.siteRadius = upload(siteRadius).address;
    chunk.neighbourOffsets = upload(std::vector<uint32_t>(count + 1)).address;
    chunk.neighbours = upload(std::vector<uint32_t>(1)).address;
    chunk.alphaCounts = upload(std::vector<uint32_t>(count)).address;
    ChunkContents contents;
    contents.cellCount = contents.liveCount = foam.cellCount;
    contents.sites = foam.sites;
    contents.radii = foam.radii;
    const Box live = liveBoundsOf(contents);
    chunk.liveLow = live.min;
    chunk.liveHigh = live.max;
    contents.densities = foam.densities;
    contents.orientations = foam.orientations;
    contents.detailSites = foam.detailSites;
    contents.lobeAxes = foam.lobeAxes;
    contents.lobeColours = foam.lobeColours;
    AssetContents shape;
    shape.detailCount = shape.lobeCount = 1;
    const PackedCells cells = *packCells(contents, {}, shape);
    chunk.cellStarts = upload(cells.starts).address;
    chunk.cellWords = upload(cells.words).address;
    chunk.cellWordCount = static_cast<uint32_t>(cells.words.size());
    chunk.code = cells.code;
    asset.chunks = {chunk};
    return asset;
  }

  // What the passes before the pixels leave behind.
  struct Lists {
    gpu::Counters counters;
    std::vector<gpu::uvec4> visible;               // [slot]
    std::vector<uint32_t> order;                   // [visible cell] slot
    std::vector<std::vector<uint32_t>> tileSlots;  // [tile] front to back
  };

  Lists listCells(const GpuAsset& asset, const View& camera) {
    EXPECT_TRUE(pipelines_->prepareFor(asset.shape()));
    const VkExtent2D extent{camera.width, camera.height};
    ViewState view{.device = device_,
                   .spaces = {},
                   .images = std::move(*OutputImages::create(device_, kRecordingsPerFrame)),
                   .timer = nullptr,
                   .slots = std::vector<FrameSlot>(1)};
    ViewCapacity capacity;
    capacity.tiles = tilesOf({{0, 0}, extent});
    capacity.cells = asset.liveCount;
    capacity.details = asset.liveCount;
    capacity.pairs = 1 << 19;
    coverAsset(asset, UINT32_MAX, capacity);
    view.parts.reserve(1);
    InstanceSpace& space = *view.spaces.emplace_back(std::make_unique<InstanceSpace>(device_, kRecordingsPerFrame));
    EXPECT_TRUE(space.buffers.grow(capacity, 0));

    HostImage image = *sharedHost().createImage(VK_FORMAT_R16G16B16A16_SFLOAT, extent);
    FrothRenderInfo info = infoOf(camera);
    info.colour = sharedHost().describe(image);
    info.camera.scissor = {{0, 0}, extent};
    info.quantile = 0.5f;
    info.maxEntries = 65536;
    const RenderInstance instance{.asset = &asset, .position = {}, .rotation = {0, 0, 0, 1}, .scale = 1};
    submit([&](VkCommandBuffer commandBuffer) {
      const Recording recording =
          beginRecording(view, pipelines_->state(), commandBuffer, RenderMethod::kRaster, info, 1);
      addPart(recording, space, &instance, *pipelines_->state().find(asset.shape(), gpu::kLensClassPinhole));
      startPasses(recording);
      recordRasterPasses(recording);
      endRecording(recording);
    });
    sharedHost().destroyImage(image);
    return readLists(space, capacity.tiles);
  }

  // The cells of each tile.
  std::vector<std::vector<uint32_t>> listByTile(const Foam& foam, const View& camera) {
    Lists lists = listCells(uploadBalls(foam), camera);
    for (std::vector<uint32_t>& slots : lists.tileSlots) {
      for (uint32_t& slot : slots) slot = lists.visible[slot][1];
    }
    return lists.tileSlots;
  }

 private:
  Lists readLists(const InstanceSpace& space, uint32_t tiles) {
    Lists lists;
    lists.counters = readCounters(space, 0);
    EXPECT_EQ(lists.counters.violations, 0u);
    EXPECT_EQ(lists.counters.pairsKept, lists.counters.pairs);
    const uint32_t cells = lists.counters.visibleCells;
    lists.order = copyOut<uint32_t>(space.buffers[ViewBuffer::kOrder], cells);
    lists.visible = copyOut<gpu::uvec4>(space.buffers[ViewBuffer::kVisibleCells], cells);
    const ViewBuffer last = tileDigits(tiles) % 2 != 0 ? ViewBuffer::kPairCellsSwap : ViewBuffer::kPairCells;
    const auto pairs = copyOut<uint32_t>(space.buffers[last], lists.counters.pairs);
    const auto tileLists = copyOut<gpu::uvec4>(space.buffers[ViewBuffer::kTileLists], tiles);
    lists.tileSlots.resize(tiles);
    std::vector<bool> isListed(tiles);
    uint32_t shortest = UINT32_MAX, longest = 0;
    for (uint32_t place = 0; place < tiles; ++place) {
      const auto& [tile, begin, end, padding] = tileLists[place];
      EXPECT_FALSE(isListed.at(tile)) << "tile " << tile << " twice";
      isListed[tile] = true;
      EXPECT_LE(end - begin, 2 * uint64_t{shortest}) << "after a list of half the length";
      shortest = std::min(shortest, end - begin);
      if (place >= lists.counters.longTiles) longest = std::max(longest, end - begin);
      for (uint32_t pair = begin; pair < end; ++pair) lists.tileSlots[tile].push_back(pairs.at(pair));
    }
    EXPECT_LE(longest, std::max(2 * lists.counters.pairs / gpu::kTilesAtOnce, 1u)) << "drawn as a short list";
    return lists;
  }
};

// What a ray's tile must hold: every ball that one of its pixels' rays meets, nearest power first.
void expectListsOfPixels(const Foam& foam, const View& camera, const std::vector<std::vector<uint32_t>>& tileCells) {
  const auto& world = camera.worldFromCamera;
  const glm::dvec3 right(world[0], world[4], world[8]), down(world[1], world[5], world[9]),
      forward(world[2], world[6], world[10]), eye(world[3], world[7], world[11]);
  const auto ray = [&](double x, double y) {
    return forward + right * ((x - camera.cx) / camera.fx) + down * ((y - camera.cy) / camera.fy);
  };
  const uint32_t tilesX = tilesAlong(camera.width);
  for (uint32_t tile = 0; tile < tileCells.size(); ++tile) {
    std::vector<bool> isListed(foam.cellCount);
    double lastPower = -INFINITY;
    for (const uint32_t cell : tileCells[tile]) {
      EXPECT_FALSE(isListed[cell]) << "cell " << cell << " twice in tile " << tile;
      isListed[cell] = true;
      const glm::dvec3 centre = glm::dvec3(foam.sites[cell]) - eye;
      const double power = glm::dot(centre, centre) - double{foam.radii[cell]} * foam.radii[cell];
      EXPECT_GE(power, lastPower - 1e-5) << "tile " << tile;
      lastPower = power;
    }
    const uint32_t x0 = tile % tilesX * gpu::kTileSize, y0 = tile / tilesX * gpu::kTileSize;
    const uint32_t x1 = std::min(x0 + gpu::kTileSize, camera.width), y1 = std::min(y0 + gpu::kTileSize, camera.height);
    for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
      const glm::dvec3 centre = glm::dvec3(foam.sites[cell]) - eye;
      bool isMet = false, isNearby = false;
      for (uint32_t y = y0; y < y1; ++y) {
        for (uint32_t x = x0; x < x1; ++x) {
          const glm::dvec3 direction = glm::normalize(ray(x + 0.5, y + 0.5));
          const double along = std::max(glm::dot(direction, centre), 0.0);
          const double miss = glm::length(centre - along * direction) - foam.radii[cell];
          isMet |= miss < -1e-6;
          isNearby |= miss < 0.01;  // a pixel is up to 0.02 wide at distance 1
        }
      }
      EXPECT_FALSE(isMet && !isListed[cell]) << "cell " << cell << " is missing in tile " << tile;
      EXPECT_FALSE(isListed[cell] && !isNearby) << "cell " << cell << " far from tile " << tile;
    }
  }
}

TEST_F(Bin, TilesHoldTheBallsThatTheirPixelsMeetInOrderOfPower) {
  const Foam foam = makeRandomFoam(700, 1, 1, 11);
  const View camera = lookAt({0.3, 0.2, 1.2}, {0, 0, 3}, 150, 100, 0.7);
  expectListsOfPixels(foam, camera, listByTile(foam, camera));
}

// Balls around the eye, before it, and smaller than a pixel, on more tiles than a workgroup has threads.
TEST_F(Bin, TilesHoldHugeAndTinyBallsAlike) {
  Foam foam = makeRandomFoam(40, 1, 1, 12);
  for (uint32_t i = 0; i < foam.cellCount; ++i) foam.radii[i] *= std::exp2(static_cast<float>(i % 10) - 5);
  const View camera = lookAt({0.3, 0.2, 1.2}, {0, 0, 3}, 700, 500, 0.7);
  expectListsOfPixels(foam, camera, listByTile(foam, camera));
}

// So many copies of a chunk that all sums of sums are in use. Equal balls stay in the order of the chunks.
TEST_F(Bin, CopiesOfAChunkFollowEachOtherInEveryTile) {
  constexpr uint32_t kCopies = 600;
  const View camera = lookAt({0.3, 0.2, 1.2}, {0, 0, 3}, 150, 100, 0.7);
  GpuAsset asset = uploadBalls(makeRandomFoam(60, 1, 1, 13));
  const Lists single = listCells(asset, camera);
  asset.chunks.resize(kCopies, asset.chunks[0]);
  asset.liveCount *= kCopies;
  const Lists copies = listCells(asset, camera);

  const uint32_t cells = single.counters.visibleCells;
  ASSERT_EQ(copies.counters.visibleCells, kCopies * cells);
  ASSERT_EQ(copies.counters.pairs, kCopies * single.counters.pairs);
  for (uint32_t slot = 0; slot < copies.visible.size(); ++slot) {
    const gpu::uvec4 expected{slot / cells, single.visible[slot % cells][1], 0, 0};
    ASSERT_EQ(copies.visible[slot], expected) << "slot " << slot;
  }
  for (size_t tile = 0; tile < single.tileSlots.size(); ++tile) {
    std::vector<uint32_t> expected;
    for (const uint32_t slot : single.tileSlots[tile]) {
      for (uint32_t copy = 0; copy < kCopies; ++copy) expected.push_back(copy * cells + slot);
    }
    ASSERT_EQ(copies.tileSlots[tile], expected) << "tile " << tile;
  }
}

}  // namespace
}  // namespace froth::test
