// What cameras see, as the decisions on chunks are told it, against projections of points.
#include "runtime/context/stream_eyes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace froth::test {
namespace {

class Dice {
 public:
  explicit Dice(uint64_t seed) : random_(seed) {}
  double roll(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  glm::dvec3 point(double extent) { return {roll(-extent, extent), roll(-extent, extent), roll(-extent, extent)}; }
  glm::quat turn() {
    return glm::normalize(glm::quat(static_cast<float>(roll(-1, 1)), static_cast<float>(roll(-1, 1)),
                                    static_cast<float>(roll(-1, 1)), static_cast<float>(roll(-1, 1))));
  }

 private:
  std::mt19937_64 random_;
};

FrothRenderInfo makeInfo(Dice& dice, const glm::mat4& clipFromView) {
  FrothRenderInfo info{};
  const glm::dvec3 eye = dice.point(3);
  std::copy_n(glm::value_ptr(eye), 3, info.camera.eye);
  const glm::mat3 viewFromWorld = glm::mat3_cast(dice.turn());
  std::copy_n(glm::value_ptr(viewFromWorld), 9, info.camera.viewFromWorld);
  std::copy_n(glm::value_ptr(clipFromView), 16, info.camera.clipFromView);
  info.camera.viewport = {0, 0, 1600, 900, 0, 1};
  return info;
}

// By how much of half a viewport a point lies beyond a side of it; negative: inside; infinite: behind the eye.
double beyondOf(const FrothCamera& camera, const glm::dvec3& inWorld) {
  const glm::dmat3 viewFromWorld(glm::make_mat3(camera.viewFromWorld));
  const glm::dvec3 inView = viewFromWorld * (inWorld - glm::make_vec3(camera.eye));
  const glm::dvec4 clip = glm::dmat4(glm::make_mat4(camera.clipFromView)) * glm::dvec4(inView, 1);
  return clip.w <= 0 ? INFINITY : std::max(std::abs(clip.x), std::abs(clip.y)) / clip.w - 1;
}

// Seen are points of the viewport and its margin, of the world and of an instance's asset, and no others.
TEST(StreamEyes, SeeTheViewportAndItsMargin) {
  Dice dice(7);
  const glm::mat4 offCentre = glm::frustum(-0.4f, 0.6f, -0.5f, 0.3f, 1.0f, 100.0f);
  const glm::mat4 parallel = glm::ortho(-2.0f, 3.0f, -1.0f, 2.0f, -1.0f, 10.0f);
  size_t seen = 0, unseen = 0;
  for (int i = 0; i < 4000; ++i) {
    const FrothRenderInfo info = makeInfo(dice, i % 2 == 0 ? offCentre : parallel);
    GpuAsset asset;
    asset.boundsLow = {-1, -1, -1};
    asset.boundsHigh = {1, 1, 1};
    const glm::quat turn = dice.turn();
    RenderInstance instance;
    instance.rotation = {turn.x, turn.y, turn.z, turn.w};
    instance.position = {1, -2, 0.5};
    instance.scale = static_cast<float>(dice.roll(0.2, 3));
    const StreamEye eye = eyeOf(seenFrom(info), instance, asset);
    const glm::dvec3 inAsset = dice.point(4);
    const glm::dvec3 inWorld = glm::dquat(turn) * inAsset * double{instance.scale} + glm::dvec3(1, -2, 0.5);
    const double beyond = beyondOf(info.camera, inWorld);
    if (std::abs(beyond - 2 * kSightMargin) < 1e-3) continue;
    const bool isSeen = beyond < 2 * kSightMargin;
    (isSeen ? seen : unseen) += 1;
    EXPECT_EQ(sees(eye, {inAsset, inAsset}), isSeen) << i << ", beyond " << beyond;
    const glm::dvec3 around = glm::abs(dice.point(0.5));
    if (isSeen) {
      EXPECT_TRUE(sees(eye, {inAsset - around, inAsset + around})) << i;
    }
  }
  EXPECT_GT(seen, 200u);
  EXPECT_GT(unseen, 200u);
}

TEST(StreamEyes, OfOtherLensesSeeAllAround) {
  Dice dice(8);
  FrothRenderInfo info = makeInfo(dice, glm::mat4(1));
  info.camera.lens.kind = FROTH_LENS_FISHEYE;
  info.camera.lens.focal[0] = info.camera.lens.focal[1] = 500;
  const StreamEye eye = eyeOf(seenFrom(info), RenderInstance{}, GpuAsset{});
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 point = dice.point(10);
    EXPECT_TRUE(sees(eye, {point, point}));
  }
}

}  // namespace
}  // namespace froth::test
