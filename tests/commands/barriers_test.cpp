// Between each use of memory and the next that disturbs it stands a barrier. lavapipe runs one dispatch after the
// other, so no image that it draws shows a barrier that is missing; and the validation layers know nothing of memory
// that is reached by address.
//
// What it does not see: dispatches that touch different parts of an array are taken to touch the same; the second and
// later elements of arrays that hold addresses (chunks). Barriers inside of a shader: workgroup_races_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/commands/recording_engine.h"

namespace froth::test {
namespace {

constexpr int kFrames = 4;        // the asset comes in the first ones; in the last ones all memory is used again
constexpr int kLevelFrames = 15;  // first the floor is drawn, then both in a fade, then level 0

// Returns which shaders were dispatched.
std::set<std::string> expectOrdered(RecordingEngine& engine, const FrameForm& form, int frames = kFrames) {
  for (int frame = 0; frame < frames; ++frame) engine.recordFrame(form);
  engine.finish();
  const std::set<std::string> found(engine.stream.hazards.found.begin(), engine.stream.hazards.found.end());
  EXPECT_THAT(found, testing::IsEmpty());
  return engine.stream.dispatched;
}

TEST(Barriers, StandBetweenAllUsesOfMemoryByEveryShader) {
  std::set<std::string> missing = CommandStream::namesOfShaders();
  const auto see = [&](uint32_t instances, VkFormat composite, const FrameForm& form, uint32_t reserveCells = 0) {
    SCOPED_TRACE(testing::Message() << "camera " << static_cast<int>(form.camera) << ", " << instances << " instances"
                                    << (form.isFull ? ", all images" : "") << (form.isEmpty ? ", out of sight" : ""));
    RecordingEngine engine(instances, composite, reserveCells);
    for (const std::string& shader : expectOrdered(engine, form)) missing.erase(shader);
  };
  constexpr VkFormat kHalf = VK_FORMAT_R16G16B16A16_SFLOAT, kFloat = VK_FORMAT_R32G32B32A32_SFLOAT;
  for (const CameraKind camera :
       {CameraKind::kProjection, CameraKind::kParallel, CameraKind::kFisheye, CameraKind::kRayMap}) {
    see(1, kHalf, {.camera = camera});
    see(2, kHalf, {.camera = camera, .isFull = true});
  }
  see(2, kHalf, {.isFull = true}, 1);
  see(2, kFloat, {.colour = kFloat, .isFull = true});
  see(1, VK_FORMAT_B10G11R11_UFLOAT_PACK32, {.colour = kFloat});
  see(1, kHalf, {.colour = kHalf, .isEmpty = true});
  see(1, kHalf, {.colour = kFloat, .isFull = true, .isEmpty = true});
  for (const VkFormat colour : {kHalf, kFloat}) {
    SCOPED_TRACE(colour);
    RecordingEngine streaming(1, kHalf, 0, true);
    const FrameForm form{.colour = colour, .isFull = true};
    for (const std::string& shader : expectOrdered(streaming, form, kLevelFrames)) missing.erase(shader);
  }
  // A list must be long for it; but it is the text of sort_scatter.
  EXPECT_THAT(missing, testing::ElementsAre("sort_scatter_many"));
}

// What keeps the test above from seeing nothing. Rays, and what the first eye sees: the second one's are the same
// again.
TEST(Barriers, OfOneFrameAreMissedWhereAnyOfThemIsLeftOut) {
  const FrameForm form{.isFull = true};
  const auto countBarriers = [&](int frames) {
    RecordingEngine engine(2, VK_FORMAT_R16G16B16A16_SFLOAT);
    for (int frame = 0; frame < frames; ++frame) engine.recordFrame(form);
    return engine.stream.barrierCount();
  };
  const uint64_t first = countBarriers(2), last = (first + countBarriers(3)) / 2;
  EXPECT_GT(last - first, 20u);
  for (uint64_t barrier = first; barrier < last; ++barrier) {
    RecordingEngine engine(2, VK_FORMAT_R16G16B16A16_SFLOAT);
    engine.stream.leaveOut(barrier);
    for (int frame = 0; frame < kFrames; ++frame) engine.recordFrame(form);
    engine.finish();
    EXPECT_THAT(engine.stream.hazards.found, testing::Not(testing::IsEmpty())) << barrier - first << " of the frame";
  }
}

}  // namespace
}  // namespace froth::test
