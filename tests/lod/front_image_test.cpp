// The picture of a level, and whose each pixel is.
#include "baker/lod/front_image.h"

#include <gtest/gtest.h>

#include "tests/reference/scenes.h"

namespace froth {
namespace {

TEST(FrontImage, ShowsWhatTheReferenceShows) {
  const Foam foam = randomFoam(80, 3, 2, 9);
  const std::vector<uint32_t> owners(foam.cellCount, 4);
  const std::vector<View> views{lookAt({0.1, 0.2, -4}, {0, 0, 0}, 40, 30, 0.3)};
  const std::vector<FrontImage> found = *drawFront(foam, owners, views, {.nearRatio = 0});
  const RenderedImages expected = renderFoam(foam, views[0]);
  for (uint32_t y = 0; y < 30; ++y) {
    for (uint32_t x = 0; x < 40; ++x) {
      const size_t pixel = size_t{y} * 40 + x;
      // The cutoff is 1e-3, and colours are up to 2 or so.
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[0].colours[pixel][c], expected.colour.pixel(x, y)[c], 4e-3);
      EXPECT_EQ(found[0].owners[pixel] == kNoOwner, *expected.alpha.pixel(x, y) == 0);
    }
  }
}

// The eye looks along +z at a thin cell before an opaque one.
TEST(FrontImage, APixelBelongsToTheCellThatShowsMost) {
  const Foam foam = foamOf({{.site = {0, 0, 0}, .density = 0.3f, .orientation = kFaceTowardsMinusZ},
                            {.site = {0, 0, 3}, .density = 1000, .orientation = kFaceTowardsMinusZ}});
  const std::vector<uint32_t> owners{7, 9};
  const std::vector<View> views{lookAt({0.01, 0, -6}, {0, 0, 3}, 33, 33, 0.3)};
  const FrontImage image = drawFront(foam, owners, views, {.nearRatio = 0})->front();
  const size_t middle = 16 * 33 + 16;
  EXPECT_EQ(image.owners[middle], 9u);
  EXPECT_NEAR(image.distances[middle], 9, 0.01);  // to the site
  EXPECT_EQ(image.owners[0], kNoOwner);
}

}  // namespace
}  // namespace froth
