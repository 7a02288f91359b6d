// The whole frame against the double reference.
#include <gtest/gtest.h>

#include "host/picture_file.h"
#include "tests/room/reference_frame.h"
#include "tests/surroundings.h"

namespace froth::test {
namespace {

void expectLikeReference(const RoomLook& look, bool hasParticles, double seconds) {
  if (!hasSuitableDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  RoomUnderTest room(look, hasParticles, seconds);
  room.draw();
  const Image drawn = encodePicture(room.read(room.stage().renderer().result()), kRoomExtent);
  const Image expected = encodePicture(ReferenceFrame(room, room.stage().particles()).render(), kRoomExtent);
  const Result<double> psnr = comparePictures(drawn, expected);
  ASSERT_TRUE(psnr) << psnr.error().message;
  EXPECT_GE(*psnr, 40);
  std::printf("frame against the double reference: %.2f dB\n", *psnr);
  if (const char* folder = std::getenv("FROTH_KEEP_PICTURES")) {
    const std::string name = hasParticles ? "motes" : "plain";
    ASSERT_TRUE(writePicture(std::filesystem::path(folder) / (name + "_drawn.png"), drawn));
    ASSERT_TRUE(writePicture(std::filesystem::path(folder) / (name + "_expected.png"), expected));
  }
}

TEST(RoomFrame, IsThatOfTheDoubleReference) { expectLikeReference({}, false, 0); }

TEST(RoomFrame, IsThatOfTheDoubleReferenceWithMotesInTheFoamAndTheBallOnIt) { expectLikeReference({}, true, 0.6); }

TEST(RoomFrame, LeavesThePhotosLightAloneWithoutShadowCatching) {
  expectLikeReference({.shadowCatching = 0, .occlusionReach = 0.5}, false, 0);
}

}  // namespace
}  // namespace froth::test
