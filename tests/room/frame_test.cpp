// The whole frame against the double reference.
#include <algorithm>
#include <array>
#include <cmath>

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

// One pixel in four casts rays, and the others show what is around them.
TEST(RoomFrame, OfRaysForOnePixelInFourIsTheSameAtTheseAndLikeItElsewhere) {
  if (!hasSuitableDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  const auto draw = [](const RoomLook& look) {
    RoomUnderTest room(look, true, 0.6);
    room.draw();
    const RoomImages& images = room.stage().renderer().images();
    return std::array{room.read(images.reflection), room.read(images.sunlight), room.read(images.result)};
  };
  RoomLook sparse;
  sparse.rayStep = 2;
  const auto all = draw({}), some = draw(sparse);
  for (size_t image = 0; image < 2; ++image) {
    size_t taken = 0;
    for (size_t i = 0; i < all[image].size(); i += 4) {
      const bool isSame = std::equal(&all[image][i], &all[image][i] + 4, &some[image][i]);
      const size_t x = i / 4 % kRoomExtent.width, y = i / 4 / kRoomExtent.width;
      if (x % 2 == 0 && y % 2 == 0) {
        EXPECT_TRUE(isSame) << "image " << image << ", pixel " << x << ", " << y;
      }
      taken += isSame ? 0 : 1;
    }
    std::printf("image %zu: %zu pixels differ\n", image, taken);
    EXPECT_GT(taken, 0u) << "image " << image << ": no pixel takes what is around it";
  }
  const Result<double> psnr = comparePictures(encodePicture(some[2], kRoomExtent), encodePicture(all[2], kRoomExtent));
  ASSERT_TRUE(psnr) << psnr.error().message;
  std::printf("rays for one pixel in four against rays for all: %.2f dB\n", *psnr);
  EXPECT_GE(*psnr, 26);  // of so few pixels: most of them lie at an edge
}

TEST(RoomFrame, ReflectsBaseColoursWhereTheyAreAskedFor) {
  if (!hasSuitableDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  const auto draw = [](const RoomLook& look) {
    RoomUnderTest room(look, false);
    room.draw();
    return room.read(room.stage().renderer().images().reflection);
  };
  RoomLook plain;
  plain.hasBaseColours = true;
  const std::vector<float> seen = draw({}), base = draw(plain);
  double largest = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    largest = std::max(largest, std::abs(double{seen[i]} - double{base[i]}));
    if (i % 4 == 3) {
      ASSERT_EQ(seen[i], base[i]) << "opacity of pixel " << i / 4;
    }
  }
  EXPECT_GT(largest, 0.02);
}

}  // namespace
}  // namespace froth::test
