// Motion leads from a pixel to where its point was seen in the frame before: against closed forms in double, for moving
// cameras and instances.
#include <cmath>

#include <gtest/gtest.h>

#include "reference/camera/view_rays.h"
#include "tests/render/motion_forms.h"
#include "tests/render/random_foam.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = kMotionWidth, kHeight = kMotionHeight;
constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;

FrothContext* context() {
  static FrothContext* const made = createCheckedContext(kLenses);
  return made;
}

Stage& stage() {
  static Stage* const made =
      new Stage(bakeForTest(makeRandomFoam(400, 4, 2, 57)), {kWidth, kHeight}, context(), 0, kLenses, true);
  return *made;
}

// Pixels whose point the foam gives, and all others.
void expectMotion(const Moved& moved, const Frame& frame, const glm::dvec2& scale = {1, 1}) {
  const ViewRays rays(moved.now);
  const bool isParallel = moved.now.lens.kind == LensKind::kOrthographic;
  size_t stopped = 0;
  double most = 0;
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) {
      const std::optional<ViewRay> ray = rays.ofPixel(x, y);
      ASSERT_TRUE(ray);
      const double t = *frame.distance.pixel(x, y);
      glm::dvec2 before;
      if (std::isfinite(t)) {
        const glm::dvec3 point = eyeOf(moved.now) + ray->offset + t * ray->direction;
        before = pixelOf(moved.before, toWorld(moved.poseBefore, toAsset(moved.poseNow, point)), false);
        ++stopped;
      } else {
        before = pixelOf(moved.before, isParallel ? eyeOf(moved.now) + ray->offset : ray->direction, !isParallel);
      }
      glm::dvec2 expected = before - glm::dvec2(x + 0.5, y + 0.5);
      if (moved.now.lens.kind == LensKind::kEquirectangular) expected.x -= kWidth * std::round(expected.x / kWidth);
      const float* found = frame.motion.pixel(x, y);
      for (int axis = 0; axis < 2; ++axis) {
        const double wanted = expected[axis] * scale[axis];
        most = std::max(most, std::abs(wanted));
        ASSERT_NEAR(found[axis], wanted, 1e-3 * std::abs(scale[axis]) + std::abs(wanted) / 1024)
            << "lens " << static_cast<int>(moved.now.lens.kind) << ", pixel " << x << ", " << y << ", axis " << axis;
      }
    }
  }
  EXPECT_GT(stopped, kWidth * kHeight / 25);
  EXPECT_LT(stopped, kWidth * kHeight);
  EXPECT_GT(most, 1.0) << "nothing moves";
}

// The instance stands where it was drawn last.
void putAtRest() {
  stage().place({});
  stage().draw(Method::kRaster, lensView(LensKind::kPinhole));
}

TEST(Motion, OfACameraIsThatOfTheClosedForms) {
  putAtRest();
  for (const LensKind kind : kMotionLenses) {
    const Moved moved{lensView(kind), lensView(kind, {0.5, -0.45, 0.38}, {0.15, 0.05, 3})};
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      expectMotion(moved, stage().draw(method, infoOf(moved), {kWidth, kHeight}));
    }
  }
}

TEST(Motion, IsThatOfTheUnjitteredImages) {
  putAtRest();
  for (const LensKind kind : {LensKind::kPinhole, LensKind::kOrthographic, LensKind::kFisheye}) {
    Moved moved{lensView(kind), lensView(kind, {0.5, -0.45, 0.38})};
    FrothRenderInfo info = infoOf(moved);
    info.camera.jitter[0] = 0.375f;
    info.camera.jitter[1] = -0.25f;
    info.previousCamera.jitter[0] = -0.5f;
    const Frame frame = stage().draw(Method::kRaster, info, {kWidth, kHeight});
    for (View* view : {&moved.now, &moved.before}) {  // the rays of the jittered image, and both images moved alike
      view->cx += 0.375;
      view->cy -= 0.25;
    }
    expectMotion(moved, frame);
  }
}

TEST(Motion, OfAStillSceneIsZero) {
  putAtRest();
  for (const LensKind kind : kMotionLenses) {
    const View view = lensView(kind);
    FrothRenderInfo info = infoOf({view, view});
    info.camera.jitter[0] = 0.25f;
    for (const float value : stage().draw(Method::kRaster, info, {kWidth, kHeight}).motion.values) {
      ASSERT_NEAR(value, 0, 3e-4);
    }
  }
}

TEST(Motion, IsZeroWithoutAFrameBefore) {
  for (const float value : stage().draw(Method::kRaster, lensView(LensKind::kPinhole)).motion.values) {
    ASSERT_EQ(value, 0);
  }
}

TEST(Motion, IsScaledAndFollowsTheViewport) {
  putAtRest();
  const Moved moved{lensView(LensKind::kPinhole), lensView(LensKind::kPinhole, {0.5, -0.45, 0.38})};
  FrothRenderInfo info = infoOf(moved);
  info.motionScale[0] = -1.0f / kWidth;
  info.motionScale[1] = 2;
  for (FrothCamera* camera : {&info.camera, &info.previousCamera}) {  // the same image from the axes of OpenGL
    for (const int y : {1, 5, 9, 13}) camera->clipFromView[y] *= -1;
    camera->viewport.y = camera->viewport.height;
    camera->viewport.height *= -1;
  }
  expectMotion(moved, stage().draw(Method::kRaster, info, {kWidth, kHeight}), {-1.0 / kWidth, 2});
}

// Draws with the instance at poseBefore, and then at poseNow.
Frame drawMoved(const Moved& moved, Method method, FrothInstanceInfo now) {
  stage().place(infoOf(moved.poseBefore));
  stage().draw(method, moved.before);
  stage().place(now);
  return stage().draw(method, infoOf(moved), {kWidth, kHeight});
}

TEST(Motion, OfAnInstanceIsAddedToThatOfTheCamera) {
  for (const LensKind kind : {LensKind::kPinhole, LensKind::kOrthographic, LensKind::kFisheye}) {
    const Moved moved{lensView(kind), lensView(kind, {0.5, -0.45, 0.38}), kTurned, {}};
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      expectMotion(moved, drawMoved(moved, method, infoOf(kTurned)));
    }
  }
  stage().place({});
}

// Two that move apart: each pixel has the motion of the instance that its id names.
TEST(Motion, OfSeveralInstancesIsThatOfEach) {
  Stage other(bakeForTest(makeRandomFoam(250, 2, 0, 7)), {kWidth, kHeight}, context(), 0, kLenses, true);
  const Pose otherNow{{0.7, 0.2, 0.3}, {1, 0, 0, 0}, 0.8}, otherBefore{{0.8, 0.15, 0.3}, {1, 0, 0, 0}, 0.8};
  const View view = lensView(LensKind::kPinhole), before = lensView(LensKind::kPinhole, {0.5, -0.45, 0.38});
  const ViewRays rays(view);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    stage().place({});
    other.place(infoOf(otherBefore));
    stage().draw(method, before);
    stage().place(infoOf(kTurned));
    FrothInstanceInfo moved = infoOf(otherNow);
    moved.userId = 1;
    other.place(moved);
    const Frame frame = stage().draw(method, infoOf({view, before}), {kWidth, kHeight});
    size_t found[2] = {0, 0};
    for (uint32_t y = 0; y < kHeight; ++y) {
      for (uint32_t x = 0; x < kWidth; ++x) {
        const double t = *frame.distance.pixel(x, y);
        if (std::isinf(t)) continue;
        const uint32_t user = frame.id[y * kWidth + x][0];
        ASSERT_LE(user, 1u);
        ++found[user];
        const glm::dvec3 point = eyeOf(view) + t * rays.ofPixel(x, y)->direction;
        const glm::dvec3 was =
            user == 0 ? toWorld({}, toAsset(kTurned, point)) : toWorld(otherBefore, toAsset(otherNow, point));
        const glm::dvec2 expected = pixelOf(before, was, false) - glm::dvec2(x + 0.5, y + 0.5);
        for (int axis = 0; axis < 2; ++axis) {
          ASSERT_NEAR(frame.motion.pixel(x, y)[axis], expected[axis], 1e-3 + std::abs(expected[axis]) / 1024)
              << x << ", " << y;
        }
      }
    }
    EXPECT_GT(found[0], kWidth * kHeight / 25);
    EXPECT_GT(found[1], kWidth * kHeight / 25);
  }
  stage().place({});
}

// Eye and instance 10^6 units away move as they do at home.
TEST(Motion, IsAsExactFarFromTheOrigin) {
  const glm::dvec3 away(1e6, -2e6, 5e5);
  const auto shifted = [&](const glm::dvec3& place) { return place + away; };
  Moved moved{lensView(LensKind::kPinhole, shifted({0.6, -0.5, 0.3}), shifted({0.05, 0.1, 3})),
              lensView(LensKind::kPinhole, shifted({0.5, -0.45, 0.38}), shifted({0.05, 0.1, 3})),
              kTurned,
              {}};
  moved.poseNow.position += away;
  moved.poseBefore.position += away;
  expectMotion(moved, drawMoved(moved, Method::kRaster, infoOf(moved.poseNow)));
  stage().place({});
}

TEST(Motion, OfAnInstanceThatJumpedIsThatOfTheCameraAlone) {
  Moved moved{lensView(LensKind::kPinhole), lensView(LensKind::kPinhole, {0.5, -0.45, 0.38}), kTurned, {}};
  FrothInstanceInfo jumped = infoOf(kTurned);
  jumped.hasJumped = 1;
  const Frame frame = drawMoved(moved, Method::kRaster, jumped);
  moved.poseBefore = moved.poseNow;
  expectMotion(moved, frame);
  stage().place({});
}

TEST(Motion, OfAnInstanceEndsWhereItStays) {
  Moved moved{lensView(LensKind::kPinhole), lensView(LensKind::kPinhole, {0.5, -0.45, 0.38}), kTurned, {}};
  drawMoved(moved, Method::kRaster, infoOf(kTurned));
  moved.poseBefore = moved.poseNow;
  expectMotion(moved, stage().draw(Method::kRaster, infoOf(moved), {kWidth, kHeight}));
  stage().place({});
}

// frothSetInstance may come before or after frothUpdate, and several times.
TEST(Motion, LeadsToWhereTheInstanceWasDrawnLastInAnyOrderOfCalls) {
  const Moved moved{lensView(LensKind::kPinhole), lensView(LensKind::kPinhole, {0.5, -0.45, 0.38}), kTurned, {}};
  stage().place({});
  stage().draw(Method::kRaster, moved.before);
  const Frame inOrder = drawMoved(moved, Method::kRaster, infoOf(kTurned));
  stage().place(infoOf(moved.poseBefore));
  stage().draw(Method::kRaster, moved.before);
  const Frame after =
      stage().draw(Method::kRaster, infoOf(moved), {kWidth, kHeight}, VK_FORMAT_R32G32B32A32_SFLOAT, [&] {
        stage().place(infoOf(Pose{{5, 5, 5}}));
        stage().place(infoOf(kTurned));
      });
  EXPECT_EQ(inOrder.motion.values, after.motion.values);
  expectMotion(moved, after);
  stage().place({});
}

TEST(Motion, OfWhatLayBehindTheCameraLeadsOffTheImage) {
  putAtRest();
  View turned = lensView(LensKind::kPinhole, {0.6, -0.5, 0.3}, {1.15, -1.1, -2.4});
  for (const float value :
       stage().draw(Method::kRaster, infoOf({lensView(LensKind::kPinhole), turned}), {kWidth, kHeight}).motion.values) {
    ASSERT_EQ(value, 32768);
  }
}

}  // namespace
}  // namespace froth::test
