// Walks begin at the nearest ball of their tile, in a cell that is found from that of the frame before
// (shaders/locate.comp). How many steps they take then: work_test.cpp.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent{160, 96};
constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;

View viewFrom(LensKind kind, const glm::dvec3& eye) {
  View view = lookAt(eye, {0.1, 0.05, 3}, kExtent.width, kExtent.height, 0.4);
  view.lens.kind = kind;
  if (kind == LensKind::kOrthographic) view.fx = view.fy = 40;
  return view;
}

TEST(WalkBegin, ChangesNoBitWithTheViewsBefore) {
  static FrothContext* const context = createCheckedContext(kLenses);
  const AssetContents contents = bakeForTest(makeRandomFoam(3000, 2, 1, 31));
  for (const LensKind kind : {LensKind::kPinhole, LensKind::kOrthographic, LensKind::kFisheye}) {
    const View far = viewFrom(kind, {0.3, -0.2, -9}), within = viewFrom(kind, {0.2, 0.1, 2.8}),
               behind = viewFrom(kind, {-2, 1, 8});
    for (const View& view : {far, within, behind}) {
      Stage stage(contents, kExtent, context, 0, kLenses);
      const Frame first = stage.draw(Method::kWalk, view);
      for (const View& before : {within, behind, far}) {
        stage.draw(Method::kWalk, before);
        const Frame again = stage.draw(Method::kWalk, view);
        EXPECT_EQ(again.colour.values, first.colour.values);
        EXPECT_EQ(again.distance.values, first.distance.values);
        EXPECT_EQ(again.normal.values, first.normal.values);
      }
      EXPECT_GT(std::ranges::max(first.alpha.values), 0.5f);
    }
  }
}

}  // namespace
}  // namespace froth::test
