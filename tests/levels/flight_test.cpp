// A flight on a simulated disk: its figures are those of the disk and the budget, and the same each time.
#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "host/make_struct.h"
#include "measure/flight/flight.h"
#include "measure/flight/flight_figures.h"
#include "tests/render/render_harness.h"
#include "tests/surroundings.h"

namespace froth::test {
namespace {

const std::filesystem::path kAsset = sourceFolder() / "tests/format/golden/version_3_0.froth";

// Reads through a context without a device.
class Disk : public testing::Test {
 protected:
  void open(const DiskOptions& options) {
    Result<SimulatedDisk> opened = SimulatedDisk::open(kAsset, options);
    ASSERT_TRUE(opened) << opened.error().message;
    disk_ = std::make_unique<SimulatedDisk>(std::move(*opened));
    auto info = makeStruct<FrothContextInfo>();
    info.abiVersion = FROTH_ABI_VERSION;
    check(frothCreateContext(&info, &context_), "frothCreateContext");
    disk_->answerTo(context_);
    const FrothReader reader = disk_->reader();
    auto asset = makeStruct<FrothAssetInfo>();
    asset.reader = &reader;
    check(frothOpenAsset(context_, &asset, &asset_), "frothOpenAsset");
  }
  void TearDown() override {
    disk_->answerAll();
    check(frothDestroyContext(context_, UINT64_MAX), "frothDestroyContext");
  }
  // Bytes that are there at a time; what they ask for is asked then.
  uint64_t bytesAt(double seconds) {
    const Status advanced = disk_->advance(seconds);
    EXPECT_TRUE(advanced) << advanced.error().message;
    auto frame = makeStruct<FrothFrame>();
    frame.serial = ++serial_;
    frame.completedSerial = serial_ - 1;
    check(frothUpdate(context_, &frame, nullptr), "frothUpdate");
    return disk_->bytesRead();
  }

  std::unique_ptr<SimulatedDisk> disk_;
  FrothContext* context_ = nullptr;
  FrothAsset asset_{};
  uint64_t serial_ = 0;
};

TEST_F(Disk, AnswersAfterItsLatency) {
  DiskOptions options;
  options.latency = 0.05;
  open(options);
  EXPECT_EQ(bytesAt(0), 0u);
  EXPECT_EQ(bytesAt(0.049), 0u);
  const uint64_t head = bytesAt(0.05);
  EXPECT_GT(head, 0u);
  EXPECT_EQ(bytesAt(0.09), head);
}

TEST_F(Disk, AnswersAtItsRate) {
  DiskOptions options;
  options.bytesPerSecond = 1e6;
  open(options);
  EXPECT_EQ(bytesAt(0), 0u);
  const uint64_t head = std::filesystem::file_size(kAsset);  // it lies within the first 64 KiB
  EXPECT_EQ(bytesAt(1e-6 * head - 1e-9), 0u);
  EXPECT_EQ(bytesAt(1e-6 * head), head);
}

// Along the axis of the sample, from where its floor suffices to where all of level 0 is wanted.
CameraPath approach() {
  std::vector<Pose> keys(2);
  for (Pose& key : keys) key.worldFromCamera = glm::dquat(1, 0, 0, 0);
  keys[0].eye = {0.1, 0.2, -300};
  keys[1].eye = {0.1, 0.2, -1.5};
  return CameraPath(keys);
}

FlightOptions options() {
  FlightOptions options;
  options.frames = 60;
  options.imageEvery = 20;
  options.scene.asset = kAsset;
  options.scene.extent = {48, 32};
  return options;
}

Flight flyWell(const FlightOptions& options) {
  Result<Flight> flight = fly(approach(), options, {});
  EXPECT_TRUE(flight) << flight.error().message;
  return flight ? std::move(*flight) : Flight();
}

uint32_t firstReady(const Flight& flight) {
  uint32_t frame = 0;
  while (frame < flight.frames.size() && !flight.frames[frame].isReady) ++frame;
  return frame;
}

TEST(Flight, IsTheSameEachTime) {
  FlightOptions slow = options();
  slow.scene.disk.latency = 0.02;
  slow.scene.disk.bytesPerSecond = 2e5;
  slow.scene.disk.failOnce = 0.3;
  const Flight first = flyWell(slow), second = flyWell(slow);
  ASSERT_EQ(first.images.size(), second.images.size());
  for (size_t i = 0; i < first.images.size(); ++i) {
    EXPECT_EQ(first.images[i].flown, second.images[i].flown);
    EXPECT_EQ(first.images[i].settled, second.images[i].settled);
  }
  ASSERT_EQ(first.frames.size(), second.frames.size());
  for (size_t i = 0; i < first.frames.size(); ++i) {
    EXPECT_EQ(first.frames[i].stream.drawnChunks, second.frames[i].stream.drawnChunks) << i;
    EXPECT_EQ(first.frames[i].stream.usedBytes, second.frames[i].stream.usedBytes) << i;
    EXPECT_EQ(first.frames[i].isReady, second.frames[i].isReady) << i;
  }
}

TEST(Flight, TellsTimesByPass) {
  const FlightOptions drawn = options();
  const nlohmann::ordered_json json = flightAsJson(flyWell(drawn), drawn);
  const nlohmann::ordered_json& passes = json["passesMs"];
  EXPECT_FALSE(passes.contains("walk"));
  for (const char* name : {"cull", "sort", "bin", "raster"}) {
    ASSERT_TRUE(passes.contains(name)) << name;
    EXPECT_GT(passes[name]["median"], 0) << name;
    EXPECT_LT(passes[name]["median"], json["gpuMs"]["median"]) << name;
  }
}

TEST(Flight, OfASlowDiskShowsLater) {
  const Flight fast = flyWell(options());
  FlightOptions slow = options();
  slow.scene.disk.latency = 0.1;
  const Flight late = flyWell(slow);
  EXPECT_GE(firstReady(late), firstReady(fast) + 6);
}

TEST(Flight, FromRestBeginsWithAllThatTheFirstViewWants) {
  FlightOptions rested = options();
  rested.imageEvery = rested.frames + 1;
  rested.isFromRest = true;
  rested.scene.disk.latency = 0.1;
  const Flight flight = flyWell(rested);
  ASSERT_EQ(flight.frames.size(), rested.frames);
  EXPECT_TRUE(flight.frames.front().isReady);
  EXPECT_TRUE(flight.frames.front().stream.isSettled);
  EXPECT_LT(flight.framesToSettle, 1000u);
}

// Views make room for a cut before it is drawn, whatever the disk does and wherever the camera goes on.
TEST(Flight, LacksNoCellsOnceItsFloorIsDrawn) {
  for (const auto& [latency, jumpEvery] : {std::pair(0.0, 13u), std::pair(0.005, 0u), std::pair(0.05, 13u)}) {
    FlightOptions late = options();
    late.imageEvery = late.frames + 1;
    late.jumpEvery = jumpEvery;
    late.scene.disk.latency = latency;
    const Flight flight = flyWell(late);
    for (uint32_t frame = firstReady(flight) + 1; frame < flight.frames.size(); ++frame) {
      EXPECT_TRUE(flight.frames[frame].isWhole) << "frame " << frame << ", latency " << latency;
    }
  }
}

// Chunks and what views need of them come out of one budget; where all of it is too much, less is wanted.
TEST(Flight, LacksNoCellsAndSettlesInTightBudgets) {
  uint64_t whole = 0;
  for (const FlownFrame& frame : flyWell(options()).frames) whole = std::max(whole, frame.deviceBytes);
  for (const uint64_t sixteenths : {8, 11, 14}) {
    FlightOptions tight = options();
    tight.imageEvery = tight.frames + 1;
    tight.scene.budget = whole * sixteenths / 16;
    const Flight flight = flyWell(tight);
    EXPECT_TRUE(flight.atEnd.isSettled);
    for (uint32_t frame = firstReady(flight) + 1; frame < flight.frames.size(); ++frame) {
      EXPECT_TRUE(flight.frames[frame].isWhole) << "frame " << frame << ", budget " << sixteenths << " / 16";
      EXPECT_LE(flight.frames[frame].deviceBytes, tight.scene.budget);
    }
  }
}

// What the caller's own limits leave out is not lacking.
TEST(Flight, TellsFramesThatMeetALimitApart) {
  FlightOptions limited = options();
  limited.imageEvery = limited.frames + 1;
  limited.scene.render.method = Method::kWalk;
  for (const uint32_t maxSteps : {0u, 1u}) {
    limited.scene.render.maxSteps = maxSteps;
    const Flight flight = flyWell(limited);
    const FlownFrame& frame = flight.frames[limited.frames - 2];
    EXPECT_TRUE(frame.isWhole);
    EXPECT_EQ(frame.isLimited, maxSteps == 1);
  }
}

TEST(Flight, AtRestHasAllThatIsWanted) {
  FlightOptions fine = options();
  fine.scene.detail = 1e9f;
  for (const ComparedImage& image : flyWell(fine).images) {
    EXPECT_EQ(image.settled, std::numeric_limits<double>::infinity()) << image.frame;
  }
  FlightOptions coarse = options();
  coarse.scene.mostCells = 1;
  const Flight flight = flyWell(coarse);
  EXPECT_LT(flight.images.back().settled, 60) << "the floor is another foam";
  EXPECT_LT(flight.bytesRead, flyWell(fine).bytesRead);
}

// At rest, from a camera that sees all copies: share of the pixels that they cover, and number of chunks.
std::pair<double, size_t> sizesOfCopies(Host& host, uint32_t copies) {
  const CameraPath path = approach();
  FlightOptions far = options();
  far.scene.copies = copies;
  Result<std::unique_ptr<StreamedScene>> scene = StreamedScene::create(host, far.scene);
  EXPECT_TRUE(scene) << scene.error().message;
  const Status settled = (*scene)->settle(viewOf(path, far, 56));
  EXPECT_TRUE(settled) << settled.error().message;
  const Result<FlownImage> image = (*scene)->readImage();
  const Result<std::vector<uint32_t>> chunks = (*scene)->drawnChunks();
  const double sum = std::accumulate(image->alpha.values.begin(), image->alpha.values.end(), 0.0);
  return {sum / static_cast<double>(image->alpha.values.size()), chunks->size()};
}

TEST(Flight, SetsCopiesBesideEachOther) {
  Result<std::unique_ptr<Host>> host = Host::create({});
  ASSERT_TRUE(host) << host.error().message;
  const auto [oneCovers, oneDraws] = sizesOfCopies(**host, 1);
  const auto [threeCover, threeDraw] = sizesOfCopies(**host, 3);
  EXPECT_NEAR(threeCover, 3 * oneCovers, 0.3 * oneCovers);
  EXPECT_EQ(threeDraw, 3 * oneDraws);
}

TEST(Flight, GoesOnWithoutWhatCannotBeRead) {
  FlightOptions bad = options();
  bad.frames = 300;
  bad.scene.disk.hasBadRange = true;
  bad.scene.detail = 0.65f;  // at the end it still wants what it asks for first, and nothing finer
  bad.scene.frameSeconds = 1;
  const Flight flight = flyWell(bad);
  EXPECT_GE(flight.atEnd.failures, 1u);
  FlightOptions weak = options();
  weak.scene.disk.failOnce = 1;
  const Flight again = flyWell(weak);
  EXPECT_GT(again.atEnd.retries, 0u);
  EXPECT_EQ(again.atEnd.failedChunks, 0u);
  EXPECT_TRUE(again.atEnd.isSettled);
}

}  // namespace
}  // namespace froth::test
