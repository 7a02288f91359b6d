// Rays through an asset with levels of detail: entries, borders and names of cells go with the cut.
#include <cmath>
#include <cstring>

#include "runtime/context/context.h"
#include "tests/levels/level_cuts.h"
#include "tests/render/render_harness.h"
#include "tests/walk/engine_shader.h"
#include "walk_spirv/calls_comp.h"

namespace froth::test {
namespace {

constexpr int kMostFrames = 100;  // until a cut is drawn

class LevelRays : public EngineShader, public testing::WithParamInterface<FrothRayPreparation> {
 protected:
  LevelRays() : levels_(stage_.open(levelSample(), GetParam())) { stage_.move(instance_, levels_, {}); }

  void show(const std::vector<uint32_t>& cut) {
    Context& context = *stage_.context();
    const auto isDrawn = [&] { return std::ranges::equal(cut, context.findAsset(levels_)->drawnChunks()); };
    const uint64_t seededBefore = context.findAsset(levels_)->entriesSerial;
    const bool isOther = !isDrawn();
    context.setCut(levels_, cut);
    for (int frame = 0; frame < kMostFrames && !isDrawn(); ++frame) {
      stage_.frame(walkInfo(), [](VkCommandBuffer, VkDescriptorSet) {});
    }
    ASSERT_TRUE(isDrawn());
    EXPECT_EQ(context.findAsset(levels_)->entriesSerial > seededBefore, isOther) << "entries are those of the cut";
  }

  static std::vector<std::vector<uint32_t>> cuts() {
    std::mt19937 random(11);
    return {finestCut(), floorCut(), randomCut(random), randomCut(random), finestCut(), randomCut(random)};
  }

  // In the sample's cube.
  static std::vector<Asked> pointsInside(size_t count) {
    std::mt19937 random(12);
    const auto next = [&] { return 1.8f * (static_cast<float>(random() >> 8) * 0x1p-24f - 0.5f); };
    std::vector<Asked> asked;
    for (size_t i = 0; i < count; ++i) {
      const float x = next(), y = next(), z = next(), u = next(), v = next();
      asked.push_back(ask({x, y, z}, glm::normalize(glm::vec3(u, v, 1))));
    }
    return asked;
  }

  FrothAsset levels_;
};

// Of the cells of a cut.
std::pair<uint32_t, uint32_t> cellAt(const std::vector<uint32_t>& cut, const glm::dvec3& point) {
  std::pair<uint32_t, uint32_t> best;
  double least = INFINITY;
  for (const uint32_t number : cut) {
    const ChunkContents& chunk = levelSample().chunks[number];
    const glm::dvec3 origin(chunk.origin[0], chunk.origin[1], chunk.origin[2]);
    for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
      const glm::dvec3 away = point - origin - glm::dvec3(chunk.sites[cell]);
      const double power = glm::dot(away, away) - double{chunk.radii[cell]} * chunk.radii[cell];
      if (power >= least) continue;
      least = power;
      best = {number, cell};
    }
  }
  return best;
}

TEST_P(LevelRays, OfAnyCutAreThePictureOfTheRaster) {
  const View outside = lookAt({0.2, 0.3, -5}, {0, 0, 0}, 96, 64, 0.4);
  const View inside = lookAt({0.3, 0.2, -0.4}, {0, -0.1, 0.4}, 96, 64, 0.9);
  std::vector<Image> casts, rasters;
  for (const std::vector<uint32_t>& cut : cuts()) {
    show(cut);
    for (const View& view : {outside, inside}) {
      const std::vector<FrothGpuHit> hits = stage_.cast(cameraRays(view), FROTH_RAY_RADIANCE, walkInfo(eyeOf(view)));
      casts.push_back(imageOf(hits, view));
      rasters.push_back(stage_.rasterize(view));
      EXPECT_GE(psnr(casts.back(), rasters.back()), 60);
      size_t met = 0;
      for (const FrothGpuHit& hit : hits) {
        if (hit.chunk == UINT32_MAX) continue;
        ASSERT_TRUE(std::ranges::binary_search(cut, hit.chunk)) << hit.chunk;
        ASSERT_LT(hit.cell, levelSample().chunks[hit.chunk].liveCount);
        ++met;
      }
      EXPECT_GT(met, hits.size() / 8);
    }
    EXPECT_EQ(stage_.status().indexViolations, 0u);
  }
  for (const size_t view : {0, 1}) {  // of the finest cut, first and after others
    EXPECT_EQ(casts[view].values, casts[8 + view].values);
    EXPECT_EQ(rasters[view].values, rasters[8 + view].values);
  }
}

TEST_P(LevelRays, LocateTheCellOfTheCutByItsNameInTheFile) {
  const EnginePipeline pipeline = pipelineOf(calls_comp_spirv);
  std::vector<Asked> asked = pointsInside(500);
  for (Asked& point : asked) point.hint[0] = 0;
  for (const std::vector<uint32_t>& cut : cuts()) {
    show(cut);
    const std::vector<Answer> answers = call(pipeline, kLocate, asked);
    size_t others = 0;
    for (size_t i = 0; i < asked.size(); ++i) {
      const auto [chunk, cell] = cellAt(cut, {asked[i].origin[0], asked[i].origin[1], asked[i].origin[2]});
      others += answers[i].fourth[0] != 1 || answers[i].fourth[1] != chunk || answers[i].fourth[2] != cell;
      asked[i].hint[1] = answers[i].fourth[1];  // the next cut may not draw it
      asked[i].hint[2] = answers[i].fourth[2];
    }
    EXPECT_LE(others, 2u);
  }
  EXPECT_EQ(stage_.status().indexViolations, 0u);
}

TEST_P(LevelRays, TakeNamesAsHints) {
  const EnginePipeline pipeline = pipelineOf(calls_comp_spirv);
  std::mt19937 random(11);
  show(randomCut(random));
  std::vector<Asked> asked = pointsInside(500);
  const std::vector<Answer> expected = call(pipeline, kFindClosest, asked);
  const uint64_t descents = stage_.status().descents;
  std::vector<Asked> located = asked, hostile = asked;
  for (Asked& ray : located) ray.hint[0] = 0;
  const std::vector<Answer> cells = call(pipeline, kLocate, located);
  for (size_t i = 0; i < asked.size(); ++i) {
    std::copy_n(cells[i].fourth + 1, 2, located[i].hint + 1);
    hostile[i].hint[0] = 0;
    for (int part : {1, 2}) hostile[i].hint[part] = i % 2 ? random() % 30 : random();
  }
  const std::vector<Answer> found = call(pipeline, kFindClosest, located);
  EXPECT_LT(stage_.status().descents, descents / 4);
  EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(Answer)), 0);
  const std::vector<Answer> others = call(pipeline, kFindClosest, hostile);
  EXPECT_EQ(std::memcmp(others.data(), expected.data(), others.size() * sizeof(Answer)), 0);
  EXPECT_EQ(stage_.status().indexViolations, 0u);
}

INSTANTIATE_TEST_SUITE_P(Prepared, LevelRays, testing::Values(FROTH_PREPARE_NOTHING, FROTH_PREPARE_RADIANCE),
                         nameOfPreparation);

}  // namespace
}  // namespace froth::test
