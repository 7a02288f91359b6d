#include "tests/room/room_fixture.h"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "format/write/asset_writer.h"
#include "tests/render/random_foam.h"

namespace froth::test {
namespace {

std::filesystem::path writeAsset(const Foam& foam, const std::filesystem::path& folder) {
  const Result<BakeResult> baked = bakeFoam(foam, {});
  EXPECT_TRUE(baked) << baked.error().message;
  const Result<std::vector<uint8_t>> bytes = encodeAsset(baked->contents);
  EXPECT_TRUE(bytes) << bytes.error().message;
  const std::filesystem::path path = folder / "random.froth";
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes->data()), std::ssize(*bytes));
  return path;
}

// The shipped room with the foam let down, so that the pedestal stands in it.
std::filesystem::path writeRoom(const std::filesystem::path& folder) {
  std::ifstream shipped(shippedRoom(), std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(shipped), {}};
  const std::string place = "\"name\":\"foam\",\"translation\":[0,0.3,0]";
  const size_t at = text.find(place);
  EXPECT_NE(at, std::string::npos);
  text.replace(at, place.size(), "\"name\":\"foam\",\"translation\":[0,0.02,0]");
  const std::filesystem::path path = folder / "room.gltf";
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

}  // namespace

RoomUnderTest::RoomUnderTest(const RoomLook& look, bool hasParticles, double seconds)
    : foam_(makeRandomFoam(300, 4, 2, 77)) {
  std::string pattern = (std::filesystem::temp_directory_path() / "froth_room_XXXXXX").string();
  folder_ = mkdtemp(pattern.data());
  MirrorRoomOptions options;
  options.asset = writeAsset(foam_, folder_);
  options.room = writeRoom(folder_);
  options.validate = true;
  options.look = look;
  options.hasParticles = hasParticles;
  Result<std::unique_ptr<Host>> host = Host::create(hostOptionsOf(options));
  EXPECT_TRUE(host) << host.error().message;
  host_ = std::move(*host);
  Result<std::unique_ptr<RoomStage>> stage = RoomStage::create(*host_, options);
  EXPECT_TRUE(stage) << stage.error().message;
  stage_ = std::move(*stage);
  Status status = waitUntilReady(*host_, stage_->scene());
  EXPECT_TRUE(status) << status.error().message;
  status = stage_->placeFoam();
  EXPECT_TRUE(status) << status.error().message;
  status = stage_->advance(seconds);
  EXPECT_TRUE(status) << status.error().message;
  status = stage_->renderer().setExtent(stage_->scene(), kRoomExtent);
  EXPECT_TRUE(status) << status.error().message;
}

RoomUnderTest::~RoomUnderTest() {
  stage_.reset();
  const Status silent = host_->checkSilence();
  EXPECT_TRUE(silent) << silent.error().message;
  std::filesystem::remove_all(folder_);
}

void RoomUnderTest::draw() {
  const Status drawn = submitWholeFrame(*host_, stage_->scene(), [&](VkCommandBuffer commands, uint64_t serial) {
    return stage_->record(commands, pose(), serial, VK_PIPELINE_STAGE_2_COPY_BIT);
  });
  ASSERT_TRUE(drawn) << drawn.error().message;
}

std::vector<float> RoomUnderTest::read(const HostImage& image) {
  Result<std::vector<float>> texels = host_->readImage(image);
  EXPECT_TRUE(texels) << texels.error().message;
  return std::move(*texels);
}

glm::dvec3 pixelDirection(const Pose& pose, uint32_t x, uint32_t y) {
  const double perPixel = 2 * pose.tanHalfFovY / kRoomExtent.height;
  const glm::dvec3 inView(perPixel * (x + 0.5 - 0.5 * kRoomExtent.width),
                          perPixel * (y + 0.5 - 0.5 * kRoomExtent.height), 1);
  return pose.worldFromCamera * glm::normalize(inView);
}

bool hasSuitableDevice() {
  const Result<std::vector<HostDeviceInfo>> devices = listHostDevices();
  return devices &&
         std::any_of(devices->begin(), devices->end(), [](const HostDeviceInfo& device) { return device.isSuitable; });
}

}  // namespace froth::test
