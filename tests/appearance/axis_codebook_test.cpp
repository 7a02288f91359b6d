#include "baker/appearance/axis_codebook.h"

#include <gtest/gtest.h>

#include <random>

namespace froth {
namespace {

std::vector<glm::vec3> randomAxes(size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> part(-8, 8);
  std::vector<glm::vec3> axes(count);
  for (glm::vec3& axis : axes) axis = {part(random), part(random), part(random)};
  return axes;
}

TEST(AxisCodebook, NearestEntryIsThatOfAFullSearch) {
  const AxisCodebook codebook(randomAxes(500, 1));
  for (const glm::vec3& axis : randomAxes(300, 2)) {
    uint32_t nearest = 0;
    for (uint32_t i = 1; i < codebook.entries().size(); ++i) {
      const auto distance = [&](uint32_t entry) {
        return glm::distance(warpAxis(codebook.entries()[entry]), warpAxis(axis));
      };
      if (distance(i) < distance(nearest)) nearest = i;
    }
    EXPECT_EQ(codebook.findNearest(axis), nearest);
  }
}

TEST(AxisCodebook, WarpingIsUndone) {
  for (const glm::vec3& axis : {glm::vec3(0), glm::vec3(1e-3f, 0, 0), glm::vec3(3, -4, 5), glm::vec3(0, 1e4f, 0)}) {
    EXPECT_LE(glm::distance(unwarpAxis(warpAxis(axis)), axis), 1e-4f * (glm::length(axis) + 1e-3f));
  }
}

TEST(AxisCodebook, TrainingFindsTheClustersOfItsSamples) {
  const std::vector<glm::vec3> centres = {{6, 0, 0}, {0, 6, 0}, {0, 0, -6}, {-3, -3, 0}};
  std::vector<glm::vec3> samples = randomAxes(4000, 3);
  for (size_t i = 0; i < samples.size(); ++i) samples[i] = centres[i % centres.size()] + 0.01f * samples[i];
  const AxisCodebook codebook(trainCodebook(samples, 64, 1));
  for (const glm::vec3& centre : centres) {
    EXPECT_LT(glm::distance(codebook.entries()[codebook.findNearest(centre)], centre), 0.1f);
  }
}

TEST(AxisCodebook, NoSamplesGiveNoEntries) {
  EXPECT_TRUE(trainCodebook({}, 16, 1).empty());
  EXPECT_TRUE(trainCodebook(randomAxes(8, 1), 0, 1).empty());
}

}  // namespace
}  // namespace froth
