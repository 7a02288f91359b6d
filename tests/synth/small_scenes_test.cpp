#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/synth/synth.h"
#include "tests/synth/foam_checks.h"

namespace froth {
namespace {

using testing::HasSubstr;

TEST(SmallScenes, AreSoundAtTheirDefaultSize) {
  for (const std::string name : {"one", "two", "grid", "shell", "random"}) {
    SCOPED_TRACE(name);
    const Result<Foam> foam = synthesizeFoam({name});
    ASSERT_TRUE(foam) << foam.error().message;
    expectSound(*foam);
  }
}

TEST(SmallScenes, HonourACellCountThatTheyCanHave) {
  EXPECT_EQ(synthesizeFoam({"grid", 27})->cellCount, 27u);
  EXPECT_EQ(synthesizeFoam({"shell", 321})->cellCount, 321u);
  EXPECT_EQ(synthesizeFoam({"random", 77})->cellCount, 77u);
}

TEST(SmallScenes, RefuseACellCountThatTheyCannotHave) {
  for (const SynthOptions& options : {SynthOptions{"one", 2}, {"two", 3}, {"grid", 28}, {"shell", 3}}) {
    const Result<Foam> foam = synthesizeFoam(options);
    ASSERT_FALSE(foam) << options.name;
    EXPECT_EQ(foam.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(foam.error().message, HasSubstr(options.name));
  }
}

TEST(SmallScenes, AnUnknownNameIsRefusedWithTheKnownOnes) {
  const Result<Foam> foam = synthesizeFoam({"galery"});
  ASSERT_FALSE(foam);
  EXPECT_EQ(foam.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(foam.error().message, HasSubstr("'galery'"));
  for (const std::string& name : synthNames()) EXPECT_THAT(foam.error().message, HasSubstr(name));
}

TEST(SmallScenes, RepeatBitForBitAndDifferBetweenSeeds) {
  for (const std::string name : {"grid", "random"}) {
    const Foam foam = *synthesizeFoam({name, 0, 7});
    EXPECT_TRUE(haveSameBits(foam, *synthesizeFoam({name, 0, 7}))) << name;
    EXPECT_FALSE(haveSameBits(foam, *synthesizeFoam({name, 0, 8}))) << name;
  }
}

TEST(SmallScenes, StopOnRequest) {
  for (const std::string name : {"grid", "shell", "random"}) {
    const Result<Foam> foam = synthesizeFoam({name}, [](std::string_view, uint64_t, uint64_t) { return false; });
    ASSERT_FALSE(foam) << name;
    EXPECT_EQ(foam.error().kind, ErrorKind::kCancelled);
  }
}

TEST(SmallScenes, CellsOfTheShellFaceItsCentre) {
  const Foam foam = *synthesizeFoam({"shell", 100});
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    const glm::dvec3 inwards = -glm::normalize(glm::dvec3(foam.sites[i]));
    EXPECT_GT(glm::dot(faceFrame<double>(foam.orientations[i]).normal, inwards), 1 - 1e-6);
  }
}

TEST(SmallScenes, RandomCellsIncludeEmptyOnes) {
  const Foam foam = *synthesizeFoam({"random"});
  const auto empty = std::count(foam.densities.begin(), foam.densities.end(), 0.0f);
  EXPECT_GT(empty, 0);
  EXPECT_LT(empty, foam.cellCount / 4);
}

}  // namespace
}  // namespace froth
