// froth_walk.glsl in shaders of an engine: a compute and a fragment shader with names of their own.
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/surroundings.h"
#include "tests/walk/engine_shader.h"
#include "walk_spirv/calls_alone_comp.h"
#include "walk_spirv/calls_comp.h"
#include "walk_spirv/mirror_frag.h"
#include "walk_spirv/mirror_vert.h"

namespace froth::test {
namespace {

TEST(FrothWalkShader, HasTheAbiOfTheHeader) {
  for (const char* name : {"froth_walk.glsl", "froth_walk.slang"}) {
    std::ifstream file(pathFrom("FROTH_SHADERS", FROTH_SHADER_DIR) / name);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    EXPECT_NE(text.find("#define FROTH_WALK_ABI " + std::to_string(FROTH_WALK_ABI) + "u\n"), std::string::npos) << name;
  }
}

// The decode to linear light is not that of a sum: only opacities are exact, and colours where one part is empty.
TEST_F(EngineShader, SegmentsBlendToTheWholeRay) {
  std::vector<Asked> asked = randomAsked(500);
  Random random(10);
  for (Asked& ray : asked) ray.tMax = static_cast<float>(random.uniform(0.05, 2));
  FrothWalkInfo info = walkInfo();
  info.cutoff = -1;
  const std::vector<Answer> answers = call(pipelineOf(calls_comp_spirv), kSplitRay, asked, info);
  size_t inTwo = 0;
  for (const Answer& answer : answers) {
    const float front = answer.second[3], back = answer.third[3];
    EXPECT_NEAR(1 - answer.first[3], (1 - front) * (1 - back), 1e-6);
    EXPECT_EQ(answer.fourth[0], 0u);
    EXPECT_EQ(answer.fourth[2], 1u) << "another cell stops it";
    inTwo += front > 0.01f && back > 0.01f;
    const bool isOne = front == 0 || back == 0;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(answer.first[c], answer.second[c] + (1 - front) * answer.third[c], isOne ? 1e-6 : 0.1);
    }
  }
  EXPECT_GT(inTwo, 50u);
}

// Behind what is opaque beyond the floats; its cells are 2^100 dense and some 2^30 long.
TEST_F(EngineShader, APartBehindOneThatLetsNothingThroughIsWhatItIsAlone) {
  constexpr float kSize = 0x1p32f;
  Foam foam = makeRandomFoam(150, 4, 2, 5);
  for (glm::vec3& site : foam.sites) site *= kSize;
  for (float& radius : foam.radii) radius *= kSize;
  for (float& density : foam.densities) density = 0x1p100f;
  stage_.move(instance_, stage_.open(bakeScene(foam, "exact", 64)), {});
  std::vector<Asked> asked;
  for (const Asked& ray : randomAsked(200)) {
    const glm::vec3 origin = kSize * glm::vec3(ray.origin[0], ray.origin[1], ray.origin[2]);
    asked.push_back(ask(origin, {ray.direction[0], ray.direction[1], ray.direction[2]}, kSize));
  }
  FrothWalkInfo info = walkInfo();
  info.cutoff = -1;
  size_t bothOpaque = 0;
  for (const Answer& answer : call(pipelineOf(calls_comp_spirv), kSplitRay, asked, info)) {
    for (const float* part : {answer.first, answer.second, answer.third}) {
      for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(part[c]));
      EXPECT_TRUE(part[3] == 0 || part[3] == 1) << part[3];
    }
    bothOpaque += answer.second[3] == 1 && answer.third[3] == 1;
  }
  EXPECT_GT(bothOpaque, 20u);
}

TEST_F(EngineShader, LocatesThePowerCellThatTheHostFinds) {
  const EnginePipeline pipeline = pipelineOf(calls_comp_spirv);
  std::vector<Asked> asked = randomAsked(1000);
  for (Asked& point : asked) point.hint[0] = 0;
  const std::vector<Answer> answers = call(pipeline, kLocate, asked);
  size_t others = 0;
  for (size_t i = 0; i < asked.size(); ++i) {
    const double point[3] = {asked[i].origin[0], asked[i].origin[1], asked[i].origin[2]};
    FrothLocation location{};
    location.structSize = sizeof(location);
    ASSERT_EQ(frothLocate(stage_.context(), instance_, point, &location), FROTH_OK);
    EXPECT_EQ(answers[i].fourth[0], 1u);
    others += answers[i].fourth[1] != location.chunk || answers[i].fourth[2] != location.cell;
  }
  EXPECT_LE(others, 2u);
  asked[0].hint[0] = 1;
  EXPECT_EQ(call(pipeline, kLocate, {asked[0]})[0].fourth[0], 0u) << "there is one instance";
}

// So that no ray skips what lies before it.
bool isInALiveBall(const AssetContents& contents, const Asked& ray) {
  const glm::dvec3 origin(ray.origin[0], ray.origin[1], ray.origin[2]);
  for (const ChunkContents& chunk : contents.chunks) {
    const glm::dvec3 base(chunk.origin[0], chunk.origin[1], chunk.origin[2]);
    for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
      if (glm::distance(origin, base + glm::dvec3(chunk.sites[cell])) < double{chunk.radii[cell]}) return true;
    }
  }
  return false;
}

// A hint only shortens the way to the first cell, whatever it holds. The right one leaves none of it.
TEST_F(EngineShader, HintsChangeNoAnswer) {
  const EnginePipeline pipeline = pipelineOf(calls_comp_spirv);
  std::vector<Asked> asked = randomAsked(1000);
  const std::vector<Answer> expected = call(pipeline, kFindClosest, asked);
  std::vector<Asked> hinted = asked, hostile = asked, located = asked;
  for (Asked& ray : located) ray.hint[0] = 0;
  const std::vector<Answer> cells = call(pipeline, kLocate, located);
  Random random(11);
  for (size_t i = 0; i < asked.size(); ++i) {
    hinted[i].hint[0] = 0;
    hinted[i].hint[1] = cells[i].fourth[1];
    hinted[i].hint[2] = cells[i].fourth[2];
    hostile[i].hint[0] = i % 3;
    for (int part : {1, 2}) hostile[i].hint[part] = static_cast<uint32_t>(random.uniform(0, i % 2 ? 100 : 4e9));
  }
  const std::vector<Answer> found = call(pipeline, kFindClosest, hinted);
  EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(Answer)), 0);
  const std::vector<Answer> others = call(pipeline, kFindClosest, hostile);
  EXPECT_EQ(std::memcmp(others.data(), expected.data(), others.size() * sizeof(Answer)), 0);
  const auto countDescents = [&](std::vector<Asked> rays) {
    std::erase_if(rays, [&](const Asked& ray) { return !isInALiveBall(contents_, ray); });
    EXPECT_GT(rays.size(), 100u);
    call(pipeline, kFindClosest, rays);
    return stage_.status().descents;
  };
  EXPECT_GT(countDescents(asked), 0u);
  EXPECT_EQ(countDescents(hinted), 0u);
  EXPECT_EQ(stage_.status().indexViolations, 0u);
}

TEST_F(EngineShader, WithPreparedCellsFindsTheSameAndWithoutThemNothing) {
  const std::vector<Asked> asked = randomAsked(500);
  const std::vector<Answer> expected = call(pipelineOf(calls_comp_spirv), kFindClosest, asked);
  const EnginePipeline pipeline = pipelineOf(calls_comp_spirv, FROTH_PREPARE_RADIANCE);
  for (const Answer& answer : call(pipeline, kFindClosest, asked)) {
    EXPECT_EQ(answer.fourth[3], uint32_t{FROTH_WALK_UNPREPARED});
    EXPECT_TRUE(std::isinf(answer.first[3])) << answer.first[3];
  }
  stage_.move(instance_, stage_.open(contents_, FROTH_PREPARE_RADIANCE), {});
  const std::vector<Answer> answers = call(pipeline, kFindClosest, asked);
  for (size_t i = 0; i < asked.size(); ++i) {
    EXPECT_EQ(answers[i].fourth[3], uint32_t{FROTH_WALK_DONE});
    EXPECT_EQ(answers[i].fourth[2], expected[i].fourth[2]) << "another cell stops it";
    EXPECT_NEAR(answers[i].second[0], expected[i].second[0], 1e-5);
  }
}

TEST_F(EngineShader, AloneFindsInTheFirstInstanceWhatOthersFindWhereItIsTheOnlyOne) {
  const std::vector<Asked> asked = randomAsked(500);
  const EnginePipeline pipeline = pipelineOf(calls_comp_spirv), alone = pipelineOf(calls_alone_comp_spirv);
  const std::vector<Answer> closest = call(pipeline, kFindClosest, asked), whole = call(pipeline, kSplitRay, asked);
  for (const uint32_t status : {FROTH_WALK_DONE, FROTH_WALK_STREAM_LIMIT}) {
    const std::vector<Answer> found = call(alone, kFindClosest, asked), seen = call(alone, kSplitRay, asked);
    for (size_t i = 0; i < asked.size(); ++i) {
      EXPECT_EQ(found[i].fourth[3], status);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(found[i].fourth[k], closest[i].fourth[k]) << "another cell stops it";
      for (int k = 0; k < 4; ++k) {
        EXPECT_TRUE(found[i].first[k] == closest[i].first[k] ||
                    std::abs(found[i].first[k] - closest[i].first[k]) < 1e-5);
        EXPECT_NEAR(seen[i].first[k], whole[i].first[k], 1e-5);
      }
      EXPECT_NEAR(found[i].second[0], closest[i].second[0], 1e-5);
    }
    FrothInstanceInfo across{};
    across.position[0] = 0.3;
    stage_.place(stage_.open(contents_), across);
  }
  EXPECT_EQ(stage_.status().indexViolations, 0u);
}

TEST_F(EngineShader, InTheFragmentStageDrawsThePictureOfTheRays) {
  const View view = lookAt({0.2, 0.3, -1}, {0, 0, 3}, 64, 48, 0.4);
  const Image expected = imageOf(stage_.cast(cameraRays(view), FROTH_RAY_RADIANCE, walkInfo(eyeOf(view))), view);
  EXPECT_GE(psnr(drawMirror(mirror_vert_spirv, mirror_frag_spirv, view), expected), 90);
}

}  // namespace
}  // namespace froth::test
