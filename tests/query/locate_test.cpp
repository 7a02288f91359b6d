// Power cells of points against brute force over all cells.
#include "tests/query/query_fixture.h"

namespace froth::test {
namespace {

class Locate : public QueryTest {
 protected:
  void SetUp() override {
    contents_ = bakeScene(synthesize("gallery", 5000), "default", 500);
    ASSERT_GT(contents_.chunks.size(), 4u);
    foam_ = *foamFromAsset(contents_);
    asset_ = openReady(contents_);
  }

  // The foam has the cells of chunk after chunk.
  size_t numberOf(uint32_t chunk, uint32_t cell) const {
    size_t number = cell;
    for (uint32_t before = 0; before < chunk; ++before) number += contents_.chunks[before].cellCount;
    return number;
  }

  void expectLeast(FrothInstance instance, const glm::dvec3& point, double tolerance) {
    const FrothLocation location = locate(instance, point);
    const double least = leastPower(foam_, point);
    EXPECT_NEAR(location.power, least, tolerance);
    EXPECT_NEAR(powerOfCell(foam_, numberOf(location.chunk, location.cell), point), least, tolerance);
    EXPECT_EQ(location.isLive != 0, location.cell < contents_.chunks[location.chunk].liveCount);
  }

  AssetContents contents_;
  Foam foam_;
  FrothAsset asset_{};
};

TEST_F(Locate, FindsTheCellOfLeastPowerAtRandomPoints) {
  const FrothInstance instance = createInstance(asset_);
  const FrothAssetStatus status = statusOf(asset_);
  const glm::dvec3 low(status.boundsMin[0], status.boundsMin[1], status.boundsMin[2]);
  const glm::dvec3 high(status.boundsMax[0], status.boundsMax[1], status.boundsMax[2]);
  Random random(3);
  for (int i = 0; i < 3000; ++i) {
    expectLeast(instance, random.inBox(1.5 * low - 0.5 * high, 1.5 * high - 0.5 * low), 1e-12);
  }
}

TEST_F(Locate, FindsTheCellOfLeastPowerAtTheSites) {
  const FrothInstance instance = createInstance(asset_);
  for (size_t cell = 0; cell < foam_.cellCount; cell += 7) {
    expectLeast(instance, glm::dvec3(foam_.sites[cell]), 1e-12);
  }
}

TEST_F(Locate, AnswersForPointsFarAway) {
  const FrothInstance instance = createInstance(asset_);
  Random random(4);
  for (int i = 0; i < 200; ++i) expectLeast(instance, 1e6 * random.direction(), 1e-3);  // of 1e12
}

TEST_F(Locate, WorksInThePlaceOfTheInstance) {
  const double turn = 0.3;
  const glm::vec4 rotation(0, 0, std::sin(turn / 2), std::cos(turn / 2));
  const glm::dvec3 position(1e6, -2e6, 3);
  const FrothInstance instance = placeAt(asset_, position, rotation, 2);
  const FrothInstance plain = createInstance(asset_);
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 local = random.inBox(glm::dvec3(-3), glm::dvec3(3));
    const glm::dvec3 turned(std::cos(turn) * local.x - std::sin(turn) * local.y,
                            std::sin(turn) * local.x + std::cos(turn) * local.y, local.z);
    // The rotation's floats are good to 1e-7, coordinates of 1e6 to 1e-10.
    EXPECT_NEAR(locate(instance, position + 2.0 * turned).power, 4 * locate(plain, local).power, 1e-5);
  }
}

}  // namespace
}  // namespace froth::test
