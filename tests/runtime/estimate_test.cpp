// froth_estimate.h: what is told ahead of time is what assets and views then take.
#include "froth/froth_estimate.h"
#include "froth/froth_reader.h"
#include "froth/froth_walk.h"

#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

struct EstimateCase {
  const char* name;
  SampleOptions sample;
  uint32_t layers = 0, keepForQueries = 0, walkShaders = 0, framesInFlight = 0, instances = 1;
  uint32_t lensClasses = 0, keepsHits = 0, keepsReactive = 0, reserveCells = 0, prepareRays = 0, fadeFrames = 0;
  VkExtent2D extent = {64, 48};
};

class Estimate : public RuntimeGpuTest, public testing::WithParamInterface<EstimateCase> {
 protected:
  static FrothMemoryReport reportOf(FrothContext* context) {
    auto report = makeStruct<FrothMemoryReport>();
    EXPECT_EQ(frothGetMemoryReport(context, &report), FROTH_OK);
    return report;
  }

  void open(const EstimateCase& given) {
    FrothContextInfo info = host_->contextInfo();
    info.walkShaders = given.walkShaders;
    info.framesInFlight = given.framesInFlight;
    info.lensClasses = given.lensClasses;
    info.reactiveImages = given.keepsReactive;
    createContext(info);
    ASSERT_EQ(frothOpenAsset(context_, &assetInfo_, &asset_), FROTH_OK);
    for (int frame = 0; frame < 20 && statusOf(asset_).state == FROTH_ASSET_OPENING; ++frame) runFrame();
    ASSERT_EQ(statusOf(asset_).state, FROTH_ASSET_READY) << lastText();
    for (uint32_t i = 0; i < given.instances; ++i) createInstance(asset_);
  }

  FrothAssetInfo assetInfo_ = makeStruct<FrothAssetInfo>();
  FrothAsset asset_{};
};

TEST_P(Estimate, IsWhatTheAssetAndTheViewTake) {
  const EstimateCase& given = GetParam();
  const std::vector<uint8_t> bytes = encodeSample(given.sample);
  assetInfo_.data = bytes.data();
  assetInfo_.dataSize = bytes.size();
  assetInfo_.layers = given.layers;
  assetInfo_.prepareRays = given.prepareRays;
  assetInfo_.keepForQueries = given.keepForQueries;
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = given.extent;
  viewInfo.lensClasses = given.lensClasses;
  viewInfo.keepsHits = given.keepsHits;
  viewInfo.keepsReactive = given.keepsReactive;
  viewInfo.reserveCells = given.reserveCells;
  viewInfo.fadeFrames = given.fadeFrames;
  auto info = makeStruct<FrothEstimateInfo>();
  info.asset = &assetInfo_;
  info.view = &viewInfo;
  info.walkShaders = given.walkShaders;
  info.framesInFlight = given.framesInFlight;
  auto estimate = makeStruct<FrothMemoryEstimate>();
  ASSERT_EQ(frothEstimateMemory(&info, &estimate), FROTH_OK);

  ASSERT_NO_FATAL_FAILURE(open(given));
  const FrothAssetStatus asset = statusOf(asset_);
  uint64_t arrays = 0;
  for (uint32_t i = 0; i + 1 < asset.memoryCount; ++i) arrays += asset.memory[i].bytes;
  EXPECT_STREQ(asset.memory[asset.memoryCount - 1].name, "alignment, spare");
  EXPECT_GT(estimate.assetBytes, 0u);
  EXPECT_EQ(estimate.assetBytes, arrays);
  EXPECT_EQ(estimate.assetHostBytes, asset.hostBytes);
  EXPECT_EQ(estimate.assetHostBytes != 0, given.keepForQueries != 0);

  const uint64_t hostBefore = reportOf(context_).categories[2].used;
  FrothView view{};
  ASSERT_EQ(frothCreateView(context_, &viewInfo, &view), FROTH_OK) << lastText();
  runFrame();
  auto status = makeStruct<FrothViewStatus>();
  ASSERT_EQ(frothGetViewStatus(context_, view, &status), FROTH_OK);
  EXPECT_EQ(estimate.viewBytes + given.instances * estimate.viewInstanceBytes, status.deviceBytes);
  EXPECT_EQ(given.instances * estimate.viewInstanceHostBytes, reportOf(context_).categories[2].used - hostBefore);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Estimate,
    testing::Values(EstimateCase{.name = "OneChunk", .sample = {}},
                    EstimateCase{.name = "OneLayer", .sample = {.detailCount = 4, .hasLayers = true}, .layers = 1},
                    EstimateCase{.name = "TwoLayers", .sample = {.detailCount = 4, .hasLayers = true}, .layers = 2},
                    EstimateCase{.name = "ManySitesAndLobes",
                                 .sample = {.cellsPerChunk = 90, .detailCount = 8, .lobeCount = 5, .isQuantized = true},
                                 .layers = 3,
                                 .framesInFlight = 3},
                    EstimateCase{.name = "TwoInstancesOfChunks",
                                 .sample = {.chunkCount = 3, .cellsPerChunk = 20, .localBits = 16},
                                 .instances = 2},
                    EstimateCase{.name = "FewReservedCells",
                                 .sample = {.cellsPerChunk = 90, .detailCount = 3},
                                 .reserveCells = 10,
                                 .extent = {1, 300}},
                    EstimateCase{.name = "Queries",
                                 .sample = {.chunkCount = 2, .cellsPerChunk = 30, .localBits = 16},
                                 .keepForQueries = 1,
                                 .walkShaders = 1},
                    EstimateCase{.name = "PreparedForVisibility",
                                 .sample = {.chunkCount = 2, .cellsPerChunk = 30, .localBits = 16},
                                 .walkShaders = 1,
                                 .prepareRays = FROTH_PREPARE_VISIBILITY},
                    EstimateCase{.name = "PreparedForRadiance",
                                 .sample = {.cellsPerChunk = 90, .detailCount = 8, .lobeCount = 5},
                                 .walkShaders = 1,
                                 .prepareRays = FROTH_PREPARE_RADIANCE},
                    EstimateCase{.name = "LensesAndHits",
                                 .sample = {.hasWalkGraph = false},
                                 .walkShaders = 1,
                                 .instances = 2,
                                 .lensClasses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC,
                                 .keepsHits = 1},
                    EstimateCase{.name = "Reactive", .sample = {}, .instances = 2, .keepsReactive = 1},
                    EstimateCase{.name = "Fading", .sample = {}, .instances = 2, .fadeFrames = 8}),
    [](const auto& test) { return std::string(test.param.name); });

class EstimateCall : public RuntimeTest {
 protected:
  EstimateCall() {
    asset_.data = bytes_.data();
    asset_.dataSize = bytes_.size();
    view_.maxExtent = {8, 8};
    info_.asset = &asset_;
    info_.view = &view_;
    info_.onMessage = logMessage;
    info_.messageUser = &messages_;
  }
  void expectRefused(FrothResult expected, const char* text) {
    messages_.clear();
    EXPECT_EQ(frothEstimateMemory(&info_, &estimate_), expected);
    ASSERT_EQ(messages_.size(), 1u);
    EXPECT_THAT(lastText(), HasSubstr(text));
  }

  std::vector<uint8_t> bytes_ = encodeSample();
  FrothAssetInfo asset_ = makeStruct<FrothAssetInfo>();
  FrothViewInfo view_ = makeStruct<FrothViewInfo>();
  FrothEstimateInfo info_ = makeStruct<FrothEstimateInfo>();
  FrothMemoryEstimate estimate_ = makeStruct<FrothMemoryEstimate>();
};

TEST_F(EstimateCall, NeedsNoView) {
  info_.view = nullptr;
  ASSERT_EQ(frothEstimateMemory(&info_, &estimate_), FROTH_OK) << lastText();
  EXPECT_GT(estimate_.assetBytes, 0u);
  EXPECT_EQ(estimate_.viewInstanceBytes, 0u);
}

TEST_F(EstimateCall, RefusesWhatOtherCallsRefuse) {
  EXPECT_EQ(frothEstimateMemory(nullptr, &estimate_), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothEstimateMemory(&info_, nullptr), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("estimate: null"));
  info_.framesInFlight = 9;
  expectRefused(FROTH_ERROR_ARGUMENT, "framesInFlight: 9; at most 8");
  info_.framesInFlight = 0;
  view_.maxExtent.width = 0;
  expectRefused(FROTH_ERROR_ARGUMENT, "maxExtent: 0 x 8");
  view_.maxExtent.width = 8;
  view_.structSize = 0;
  expectRefused(FROTH_ERROR_ARGUMENT, "structSize: 0");
  view_.structSize = sizeof(view_);
  asset_.layers = 4;
  expectRefused(FROTH_ERROR_ARGUMENT, "layers: 4");
  asset_.layers = 0;
  asset_.prepareRays = 3;
  expectRefused(FROTH_ERROR_ARGUMENT, "prepareRays: 3");
  asset_.prepareRays = 0;
  asset_.dataSize /= 2;
  expectRefused(FROTH_ERROR_FILE, "asset in memory");
  const auto reader = makeStruct<FrothReader>();
  asset_.reader = &reader;
  expectRefused(FROTH_ERROR_UNSUPPORTED, "reader: its answers may come later");
  info_.asset = nullptr;
  expectRefused(FROTH_ERROR_ARGUMENT, "asset: null");
}

}  // namespace
}  // namespace froth
