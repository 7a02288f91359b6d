// Views with too little space draw valid frames and grow to what they want; the smallest and the longest images.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "runtime/asset/asset.h"
#include "runtime/render/view_state.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent{96, 64};

View viewFrom(double distance) {
  return lookAt({0.1, 0.2, 3 - distance}, {0, 0, 3}, kExtent.width, kExtent.height, 0.6);
}

// A view whose capacity the test sets.
class Growth : public testing::Test {
 protected:
  struct Drawn {
    std::vector<float> colour;
    gpu::Counters counters;

    bool lostCells() const { return counters.cellsWanted > counters.visibleCells; }
    bool lostPairs() const { return counters.pairs > counters.pairsKept; }
  };

  explicit Growth(uint32_t cells = 400)
      : device_(*Device::create(vkGetInstanceProcAddr, sharedHost().instance, sharedHost().physicalDevice,
                                sharedHost().device)),
        pipelines_(std::move(*RenderPipelines::create(device_, VK_NULL_HANDLE, {.checkIndices = true}))),
        bytes_(*encodeAsset(bakeForTest(makeRandomFoam(cells, 3, 2, 5)))),
        asset_({.kind = SourceKind::kMemory, .name = "asset in memory", .bytes = bytes_}, &device_) {
    std::unique_ptr<UploadRing> ring = std::move(*UploadRing::create(device_, 16 << 20));
    while (!asset_.isDecoded()) {
      LoadLimit limit = LoadLimit::ofWork();
      asset_.load(jobs_, reads_, limit,
                  [&](const AssetShape& shape) { return std::optional(pipelines_->prepareFor(shape)); }, {});
      EXPECT_FALSE(asset_.hasFailed());
      asset_.stage(*ring, UINT64_MAX);
    }
    submit([&](VkCommandBuffer commandBuffer, uint64_t serial) { ring->record(commandBuffer, serial, UINT64_MAX); });
    image_ = *sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
  }

  ~Growth() override { sharedHost().destroyImage(image_); }

  void submit(const std::function<void(VkCommandBuffer, uint64_t)>& record) {
    const Status status = sharedHost().submit([&](VkCommandBuffer commandBuffer, uint64_t serial) -> Status {
      record(commandBuffer, serial);
      return {};
    });
    EXPECT_TRUE(status) << status.error().message;
  }

  // All that the asset can need.
  ViewCapacity wholeCapacity() const {
    ViewCapacity capacity;
    capacity.tiles = tilesAlong(kExtent.width) * tilesAlong(kExtent.height);
    coverAsset(asset_.gpu(), UINT32_MAX, capacity);
    return capacity;
  }

  Drawn draw(Method method, const View& camera) {
    FrothRenderInfo info = infoOf(camera);
    info.colour = sharedHost().describe(image_);
    info.camera.scissor = {{0, 0}, kExtent};
    info.cutoff = 1e-3f;
    info.quantile = 0.5f;
    info.maxSteps = info.maxEntries = info.maxNeighbours = 65536;
    const RenderInstance instance{.asset = &asset_.gpu(), .position = {}, .rotation = {0, 0, 0, 1}, .scale = 1};
    const bool isRaster = method == Method::kRaster;
    submit([&](VkCommandBuffer commandBuffer, uint64_t serial) {
      view_->slots[0] = {};
      const Recording recording = beginRecording(*view_, pipelines_->state(), commandBuffer,
                                                 isRaster ? RenderMethod::kRaster : RenderMethod::kWalk, info, serial);
      addPart(recording, space(), &instance, *pipelines_->state().find(asset_.gpu().shape(), gpu::kLensClassPinhole));
      startPasses(recording);
      const auto record = isRaster ? recordRasterPasses : recordWalkPasses;
      record(recording);
      endRecording(recording);
      lastSerial_ = serial;
    });
    Result<std::vector<float>> texels = sharedHost().readImage(image_);
    EXPECT_TRUE(texels) << texels.error().message;
    const Drawn drawn{*texels, readCounters(space(), 0)};
    EXPECT_EQ(drawn.counters.violations, 0u);
    return drawn;
  }

  // A new view.
  void startWith(const ViewCapacity& capacity) {
    view_.reset(new ViewState{.device = device_,
                              .spaces = {},
                              .images = std::move(*OutputImages::create(device_, kRecordingsPerFrame)),
                              .timer = nullptr,
                              .slots = std::vector<FrameSlot>(1)});
    view_->parts.reserve(1);
    view_->spaces.push_back(std::make_unique<InstanceSpace>(device_, kRecordingsPerFrame));
    growTo(capacity);
  }

  InstanceSpace& space() { return *view_->spaces.front(); }

  void growTo(const ViewCapacity& capacity) {
    const Status grown = space().buffers.grow(capacity, lastSerial_);
    EXPECT_TRUE(grown) << grown.error().message;
    space().buffers.freeRetired(lastSerial_);
  }

  // What transients hold before their first use is anything.
  void fillTransients(uint32_t word) {
    submit([&](VkCommandBuffer commandBuffer, uint64_t) {
      for (uint32_t i = 0; i < kViewBufferCount; ++i) {
        const GpuBuffer& buffer = space().buffers[static_cast<ViewBuffer>(i)];
        if (buffer.kind != BufferKind::kDevice || buffer.size == 0) continue;
        device_.table.vkCmdFillBuffer(commandBuffer, buffer.buffer, 0, VK_WHOLE_SIZE, word);
      }
    });
  }

  void expectNoTraceOfTransients() {
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      std::vector<float> colours[2];
      for (const uint32_t word : {0u, 0xffffffffu}) {
        startWith(wholeCapacity());
        fillTransients(word);
        colours[word & 1] = draw(method, viewFrom(4.5)).colour;
      }
      EXPECT_EQ(colours[0], colours[1]);
    }
  }

  // What the view does between frames.
  void growFor(const Drawn& drawn) {
    ViewCapacity capacity = space().buffers.capacity();
    coverDemand(asset_.gpu(), demandOf(drawn.counters), capacity);
    growTo(capacity);
  }

  Device device_;
  std::unique_ptr<RenderPipelines> pipelines_;
  std::vector<uint8_t> bytes_;
  ReadTable reads_;  // before asset_, which drops its reads
  JobRunner jobs_;
  Asset asset_;
  std::unique_ptr<ViewState> view_;
  HostImage image_;
  uint64_t lastSerial_ = 0;
};

TEST_F(Growth, WhatTransientsHeldBeforeIsNotSeen) { expectNoTraceOfTransients(); }

// Without neighbours, so without planes.
class LoneCell : public Growth {
 protected:
  LoneCell() : Growth(1) {}
};

TEST_F(LoneCell, WhatTransientsHeldBeforeIsNotSeen) { expectNoTraceOfTransients(); }

enum class Shortage { kCells, kPlanes, kSites, kPairs };

class GrowthAfter : public Growth, public testing::WithParamInterface<Shortage> {
 protected:
  ViewCapacity shortCapacity() const {
    ViewCapacity capacity = wholeCapacity();
    switch (GetParam()) {
      case Shortage::kCells:
        capacity.cells = 70;
        break;
      case Shortage::kPlanes:
        capacity.planes = 500;
        break;
      case Shortage::kSites:
        capacity.details = 200;
        break;
      case Shortage::kPairs:
        capacity.pairs = 50;
        break;
    }
    return capacity;
  }
};

TEST_P(GrowthAfter, AShortageFramesAreWholeAgain) {
  const View camera = viewFrom(4.5);
  const bool isPairs = GetParam() == Shortage::kPairs;
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    if (isPairs && method == Method::kWalk) continue;  // has none
    startWith(shortCapacity());
    const Drawn first = draw(method, camera);
    EXPECT_EQ(first.lostPairs(), isPairs);
    EXPECT_EQ(first.lostCells(), !isPairs);
    for (const float value : first.colour) ASSERT_TRUE(value >= 0 && value < 100) << value;
    EXPECT_EQ(draw(method, camera).colour, first.colour) << "what is missing is defined";
    growFor(first);
    const Drawn second = draw(method, camera);
    EXPECT_FALSE(second.lostCells() || second.lostPairs());
    startWith(wholeCapacity());
    const Drawn whole = draw(method, camera);
    EXPECT_NE(first.colour, whole.colour);
    EXPECT_EQ(second.colour, whole.colour);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, GrowthAfter,
                         testing::Values(Shortage::kCells, Shortage::kPlanes, Shortage::kSites, Shortage::kPairs));

TEST_F(Growth, KeepsAheadOfACameraThatMovesOnAndFollowsOneThatJumps) {
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    ViewCapacity least;
    least.tiles = wholeCapacity().tiles;
    least.groups = wholeCapacity().groups;
    startWith(least);
    bool lostBefore = false;
    std::vector<int> lostFrames;
    for (int frame = 0; frame < 40; ++frame) {
      const double distance = frame < 30 ? 0.2 + 0.08 * frame : 0.5 + 8.0 * (frame % 2);  // away, then to and fro
      const Drawn drawn = draw(method, viewFrom(distance));
      const bool isLost = drawn.lostCells() || drawn.lostPairs();
      EXPECT_FALSE(isLost && lostBefore) << "frame " << frame;
      if (isLost) lostFrames.push_back(frame);
      lostBefore = isLost;
      growFor(drawn);
    }
    ASSERT_FALSE(lostFrames.empty()) << "the first frame had no space";
    EXPECT_EQ(lostFrames.front(), 0);
    EXPECT_LE(lostFrames.size(), 2u) << "only the first frame and the jump may lose something";
  }
}

TEST_F(Growth, OfOneKindOfRoomLeavesTheBuffersOfOthersAlone) {
  startWith(wholeCapacity());
  const auto handles = [&] {
    std::array<VkBuffer, kViewBufferCount> all;
    for (uint32_t i = 0; i < kViewBufferCount; ++i) all[i] = space().buffers[static_cast<ViewBuffer>(i)].buffer;
    return all;
  };
  using enum ViewBuffer;
  const ViewCapacity whole = wholeCapacity();
  const struct {
    ViewCapacity wanted;
    ViewBuffer first, last;  // of what grows, besides kTallies
  } cases[] = {{{.planes = 2 * whole.planes}, kPlanes, kPlanes},
               {{.pairs = 2 * whole.pairs}, kPairTiles, kPairCellsSwap},
               {{.cells = 2 * whole.cells, .details = 2 * whole.details}, kVisibleCells, kDetails},
               {{.groups = 2 * whole.groups}, kFrames, kWalkStart}};
  for (const auto& [wanted, first, last] : cases) {
    const auto before = handles();
    growTo(wanted);
    const auto after = handles();
    for (uint32_t i = 0; i < kViewBufferCount; ++i) {
      const auto id = static_cast<ViewBuffer>(i);
      if (id == kTallies || before[i] == VK_NULL_HANDLE) continue;
      EXPECT_EQ(after[i] != before[i], first <= id && id <= last) << "buffer " << i;
    }
  }
}

TEST(Capacity, StartsWithAllCellsOrAsManyAsAreReserved) {
  GpuAsset asset;
  asset.detailCount = 8;
  asset.liveCount = asset.cellCount = 5'000'000;
  asset.alphaTotal = 7 * uint64_t{asset.liveCount};
  GpuChunk chunk;
  chunk.liveCount = chunk.cellCount = asset.liveCount;
  asset.chunks = {chunk};
  ViewCapacity all, some;
  coverAsset(asset, UINT32_MAX, all);
  coverAsset(asset, 1'000'000, some);
  EXPECT_EQ(all.cells, asset.cellCount);
  EXPECT_EQ(all.planes, asset.alphaTotal);
  EXPECT_EQ(some.cells, 1'000'000u);
  EXPECT_EQ(some.details, uint64_t{8} * some.cells);
  EXPECT_TRUE(coversAsset(asset, some));
  EXPECT_FALSE(mayLack(asset, {}, all));
  EXPECT_TRUE(mayLack(asset, {}, some)) << "no frame has told yet";
  EXPECT_FALSE(mayLack(asset, {.cells = 900'000, .planes = 6'300'000, .pairs = 1}, some));
  EXPECT_TRUE(mayLack(asset, {.cells = 1'000'001, .planes = 6'300'000, .pairs = 1}, some));
  EXPECT_TRUE(mayLack(asset, {.cells = 1, .planes = some.planes + 1, .pairs = 1}, some));
  EXPECT_TRUE(mayLack(asset, {.cells = 1, .planes = 1, .pairs = uint64_t{all.pairs} + 1}, all));
}

TEST(Capacity, NeverExceedsWhatTheAssetCanWant) {
  GpuAsset asset;
  asset.detailCount = 4;
  asset.cellCount = 1000;
  asset.neighbourTotal = 7000;
  ViewCapacity capacity;
  coverDemand(asset, {.cells = 900, .planes = 6800, .pairs = 100}, capacity);
  EXPECT_EQ(capacity.cells, 1000u);
  EXPECT_EQ(capacity.planes, 7000u);
  EXPECT_EQ(capacity.details, 4000u);
  EXPECT_EQ(capacity.pairs, 150u);
  const ViewCapacity before = capacity;
  coverDemand(asset, {.cells = 1000, .planes = 7000, .pairs = 120}, capacity);
  EXPECT_EQ(capacity.cells, before.cells);
  EXPECT_EQ(capacity.pairs, before.pairs) << "within the head room nothing grows";
}

// visible: what a walk counts; a raster counts nothing.
void expectEmpty(Stage& stage, const View& view, uint32_t visible) {
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame frame = stage.draw(method, view);
    EXPECT_EQ(frame.status.visibleCells, method == Method::kRaster ? 0u : visible);
    EXPECT_EQ(frame.status.bits, 0u);
    for (const float value : frame.colour.values) ASSERT_EQ(value, 0.0f);
    for (const float value : frame.distance.values) ASSERT_TRUE(std::isinf(value));
  }
}

TEST(Extremes, AViewThatSeesNoCellIsEmpty) {
  const AssetContents contents = bakeForTest(makeRandomFoam(50, 2, 1, 3));
  const uint32_t guides = contents.chunks[0].cellCount - contents.chunks[0].liveCount;
  Stage stage(contents, kExtent);
  expectEmpty(stage, lookAt({0, 0, 0}, {0, 0, -3}, kExtent.width, kExtent.height, 0.5), 0);
  // Along an edge of the box, where no cell lies.
  const FrothAssetStatus status = stage.assetStatus();
  const glm::dvec3 corner = glm::dvec3(status.boundsMin[0], status.boundsMin[1], status.boundsMin[2]) + 0.01;
  expectEmpty(stage, lookAt(corner - glm::dvec3(0, 5, 0), corner, kExtent.width, kExtent.height, 1e-4), guides);
}

class ExtremeExtents : public testing::TestWithParam<VkExtent2D> {};

TEST_P(ExtremeExtents, AreDrawnAsTheReferenceDrawsThem) {
  const Foam foam = makeRandomFoam(60, 2, 2, 4);
  const double tanHalfFovY = GetParam().height == 1 ? 1e-3 : 0.6;
  const View view = lookAt({0.1, 0.2, -1}, {0, 0, 3}, GetParam().width, GetParam().height, tanHalfFovY);
  const RenderedImages expected = renderReference(foam, view);
  Stage stage(bakeForTest(foam), GetParam());
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame frame = stage.draw(method, view);
    EXPECT_EQ(frame.status.bits, 0u);
    EXPECT_GE(psnr(frame.colour, expected.colour), 60);
    EXPECT_GE(psnr(frame.alpha, expected.alpha), 60);
  }
}

INSTANTIATE_TEST_SUITE_P(Pixels, ExtremeExtents,
                         testing::Values(VkExtent2D{1, 1}, VkExtent2D{1, 16384}, VkExtent2D{16384, 1}));

}  // namespace
}  // namespace froth::test
