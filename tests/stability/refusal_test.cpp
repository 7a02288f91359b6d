// Numbers that are none: refused where they come in, by array and cell, so that no shader meets them.
#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "base/float_span.h"
#include "reference/render/reference.h"
#include "tests/checkpoint/import_checks.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
constexpr float kDenormal = 1e-40f;
constexpr const char* kTensors[] = {"points",      "radii",        "density",       "quaternions",
                                    "texel_sites", "texel_height", "texel_sv_axis", "texel_sv_rgb"};

constexpr uint32_t kCells = 3;

// A checkpoint with one number of one tensor changed: the last of cell 1.
CheckpointSpec checkpointWith(const char* tensor, float number) {
  CheckpointSpec checkpoint = sampleCheckpoint(kCells);
  std::string& bytes = checkpoint.storages[tensor];
  const size_t perCell = bytes.size() / sizeof(float) / kCells;
  std::memcpy(bytes.data() + (2 * perCell - 1) * sizeof(float), &number, sizeof number);
  return checkpoint;
}

// The same, all numbers of the tensor.
CheckpointSpec checkpointOf(const char* tensor, float number) {
  CheckpointSpec checkpoint = sampleCheckpoint(kCells);
  std::string& bytes = checkpoint.storages[tensor];
  const std::vector<float> numbers(bytes.size() / sizeof(float), number);
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return checkpoint;
}

TEST(Refusals, ACheckpointThatIsNotFiniteIsRefusedByTensorAndCell) {
  for (const char* tensor : kTensors) {
    for (const float number : {kNan, -kNan, kInfinity, -kInfinity}) {
      const Result<Foam> foam = importSpec(checkpointWith(tensor, number));
      expectRefusal(foam, join("tensor '", tensor, "'"));
      expectRefusal(foam, "cell 1");
    }
  }
}

TEST(Refusals, AQuaternionWithoutALengthIsRefusedAndATinyOneNormalised) {
  expectRefusal(importSpec(checkpointOf("quaternions", 0)), "quaternion of cell 0 has length 0");
  const Result<Foam> foam = importSpec(checkpointOf("quaternions", 1e-20f));
  ASSERT_TRUE(foam) << foam.error().message;
  for (const glm::vec4& orientation : foam->orientations) EXPECT_EQ(orientation, glm::vec4(0.5f));
}

// Some devices take them for 0, and divide by 0 where others do not.
TEST(Refusals, ADenormalNumberOfACheckpointIsRefusedByTensorAndCell) {
  for (const char* tensor : kTensors) {
    const Result<Foam> foam = importSpec(checkpointWith(tensor, kDenormal));
    expectRefusal(foam, join("tensor '", tensor, "'"));
    expectRefusal(foam, "cell 1");
  }
}

// Raw values of -0.9 are ordinary numbers.
TEST(Refusals, ARadiusThatActivatesToADenormalNumberIsRefusedAndSuchADensityIsZero) {
  expectRefusal(importSpec(checkpointOf("radii", -0.9f)), "tensor 'radii': cell 0");
  const Result<Foam> foam = importSpec(checkpointOf("density", -0.9f));
  ASSERT_TRUE(foam) << foam.error().message;
  for (const float density : foam->densities) EXPECT_EQ(density, 0);
}

struct FoamArray {
  const char* name;  // as messages name it
  std::function<std::span<float>(Foam&)> numbersOf;
};

TEST(Refusals, AFoamThatIsNotFiniteIsNotBaked) {
  const FoamArray arrays[] = {
      {"site", [](Foam& foam) { return floatsOf(foam.sites); }},
      {"radius", [](Foam& foam) { return floatsOf(foam.radii); }},
      {"density", [](Foam& foam) { return floatsOf(foam.densities); }},
      {"orientation", [](Foam& foam) { return floatsOf(foam.orientations); }},
      {"detail site", [](Foam& foam) { return floatsOf(foam.detailSites); }},
      {"height", [](Foam& foam) { return floatsOf(foam.detailHeights); }},
      {"baseColours", [](Foam& foam) { return floatsOf(foam.baseColours); }},
      {"lobeAxes", [](Foam& foam) { return floatsOf(foam.lobeAxes); }},
      {"lobeColours", [](Foam& foam) { return floatsOf(foam.lobeColours); }},
  };
  for (const FoamArray& array : arrays) {
    for (const float number : {kNan, kInfinity, -kInfinity}) {
      Foam foam = randomFoam(5, 2, 3, 1);
      foam.baseColours.assign(10, glm::vec3(0));
      const std::span<float> numbers = array.numbersOf(foam);
      numbers[4 * (numbers.size() / 5) - 1] = number;  // of cell 3
      const Result<BakeResult> baked = bakeFoam(foam, {});
      ASSERT_FALSE(baked) << array.name;
      EXPECT_THAT(baked.error().message, testing::AllOf(testing::HasSubstr("cell 3"), testing::HasSubstr(array.name)));
    }
  }
}

TEST(Refusals, AFoamWithFramesOfAnotherLengthIsNotBaked) {
  for (const float length : {0.0f, 1e-20f, 1.01f, 1e30f}) {
    Foam foam = randomFoam(5, 2, 3, 1);
    foam.orientations[2] *= length;
    const Result<BakeResult> baked = bakeFoam(foam, {});
    ASSERT_FALSE(baked) << length;
    EXPECT_THAT(baked.error().message, testing::HasSubstr("cell 2: orientation"));
  }
}

}  // namespace
}  // namespace froth
