// froth_walk.glsl in shaders of an engine: a compute and a fragment shader with names of their own.
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/surroundings.h"
#include "tests/walk/engine_pipeline.h"
#include "tests/walk/walk_stage.h"
#include "walk_spirv/calls_comp.h"
#include "walk_spirv/mirror_frag.h"
#include "walk_spirv/mirror_vert.h"

namespace froth::test {
namespace {

// calls.comp
enum Mode : uint32_t { kSplitRay, kFindClosest, kLocate };
struct Asked {
  float origin[3], tMin, direction[3], tMax;
  uint32_t hint[4];
};
struct Answer {
  float first[4], second[4], third[4];
  uint32_t fourth[4];
};
struct CallConstants {
  VkDeviceAddress asked, answers;
  uint32_t count, mode;
};

constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr uint32_t kNone = UINT32_MAX;

Asked ask(const glm::vec3& origin, const glm::vec3& direction, float tMax = kNever) {
  return {{origin.x, origin.y, origin.z}, 0, {direction.x, direction.y, direction.z}, tMax, {kNone, kNone, kNone, 0}};
}

class EngineShader : public testing::Test {
 protected:
  EngineShader() : contents_(bakeScene(makeRandomFoam(150, 4, 2, 5), "exact", 64)), asset_(stage_.open(contents_)) {
    instance_ = stage_.place(asset_);
  }

  std::vector<Answer> call(Mode mode, const std::vector<Asked>& asked, FrothWalkInfo info = walkInfo()) {
    Device& device = stage_.device();
    const VkDeviceSize askedSize = asked.size() * sizeof(Asked);
    Result<GpuBuffer> buffer = device.createBuffer(MemoryUse::kViewsHost, BufferKind::kReadback,
                                                   askedSize + asked.size() * sizeof(Answer), "calls");
    EXPECT_TRUE(buffer) << buffer.error().message;
    std::memcpy(buffer->mapped, asked.data(), askedSize);
    const CallConstants constants{buffer->address, buffer->address + askedSize, static_cast<uint32_t>(asked.size()),
                                  mode};
    const EnginePipeline pipeline(stage_.context(), calls_comp_spirv, sizeof(constants));
    stage_.frame(info, [&](VkCommandBuffer commands, VkDescriptorSet set) {
      pipeline.bind(commands, set, &constants);
      vkCmdDispatch(commands, (constants.count + 63) / 64, 1, 1);
      device.table.recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                       VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                                       VK_ACCESS_2_HOST_READ_BIT);
    });
    std::vector<Answer> answers(asked.size());
    std::memcpy(answers.data(), static_cast<const char*>(buffer->mapped) + askedSize, answers.size() * sizeof(Answer));
    device.destroyBuffer(*buffer);
    return answers;
  }

  std::vector<Asked> randomAsked(size_t count) const {
    Random random(9);
    std::vector<Asked> asked;
    for (size_t i = 0; i < count; ++i) {
      const glm::dvec3 origin = random.inBox({-1.5, -1.5, 1.5}, {1.5, 1.5, 4.5});
      asked.push_back(ask(glm::vec3(origin), glm::vec3(random.direction())));
    }
    return asked;
  }

  WalkStage stage_;
  AssetContents contents_;
  FrothAsset asset_;
  FrothInstance instance_{};
};

TEST(FrothWalkShader, HasTheAbiOfTheHeader) {
  std::ifstream file(pathFrom("FROTH_SHADERS", FROTH_SHADER_DIR) / "froth_walk.glsl");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(text.find("#define FROTH_WALK_ABI " + std::to_string(FROTH_WALK_ABI) + "u\n"), std::string::npos);
}

// The decode to linear light is not that of a sum: only opacities are exact, and colours where one part is empty.
TEST_F(EngineShader, SegmentsBlendToTheWholeRay) {
  std::vector<Asked> asked = randomAsked(500);
  Random random(10);
  for (Asked& ray : asked) ray.tMax = static_cast<float>(random.uniform(0.05, 2));
  FrothWalkInfo info = walkInfo();
  info.cutoff = -1;
  const std::vector<Answer> answers = call(kSplitRay, asked, info);
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
  for (const Answer& answer : call(kSplitRay, asked, info)) {
    for (const float* part : {answer.first, answer.second, answer.third}) {
      for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(part[c]));
      EXPECT_TRUE(part[3] == 0 || part[3] == 1) << part[3];
    }
    bothOpaque += answer.second[3] == 1 && answer.third[3] == 1;
  }
  EXPECT_GT(bothOpaque, 20u);
}

TEST_F(EngineShader, LocatesThePowerCellThatTheHostFinds) {
  std::vector<Asked> asked = randomAsked(1000);
  for (Asked& point : asked) point.hint[0] = 0;
  const std::vector<Answer> answers = call(kLocate, asked);
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
  EXPECT_EQ(call(kLocate, {asked[0]})[0].fourth[0], 0u) << "there is one instance";
}

// A hint only shortens the way to the first cell, whatever it holds.
TEST_F(EngineShader, HintsChangeNoAnswer) {
  std::vector<Asked> asked = randomAsked(1000);
  const std::vector<Answer> expected = call(kFindClosest, asked);
  const uint64_t descents = stage_.status().descents;
  std::vector<Asked> hinted = asked, hostile = asked, located = asked;
  for (Asked& ray : located) ray.hint[0] = 0;
  const std::vector<Answer> cells = call(kLocate, located);
  Random random(11);
  for (size_t i = 0; i < asked.size(); ++i) {
    hinted[i].hint[0] = 0;
    hinted[i].hint[1] = cells[i].fourth[1];
    hinted[i].hint[2] = cells[i].fourth[2];
    hostile[i].hint[0] = i % 3;
    for (int part : {1, 2}) hostile[i].hint[part] = static_cast<uint32_t>(random.uniform(0, i % 2 ? 100 : 4e9));
  }
  const std::vector<Answer> found = call(kFindClosest, hinted);
  EXPECT_LT(stage_.status().descents, descents / 4);
  EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(Answer)), 0);
  const std::vector<Answer> others = call(kFindClosest, hostile);
  EXPECT_EQ(std::memcmp(others.data(), expected.data(), others.size() * sizeof(Answer)), 0);
  EXPECT_EQ(stage_.status().indexViolations, 0u);
}

TEST_F(EngineShader, InTheFragmentStageDrawsThePictureOfTheRays) {
  const View view = lookAt({0.2, 0.3, -1}, {0, 0, 3}, 64, 48, 0.4);
  const Image expected = imageOf(stage_.cast(cameraRays(view), FROTH_RAY_RADIANCE, walkInfo(eyeOf(view))), view);
  float constants[12] = {};
  for (int row = 0; row < 3; ++row) {
    const double* axes = &view.worldFromCamera[4 * row];
    constants[row] = static_cast<float>(axes[2] - axes[0] * view.cx / view.fx - axes[1] * view.cy / view.fy);
    constants[4 + row] = static_cast<float>(axes[0] / view.fx);
    constants[8 + row] = static_cast<float>(axes[1] / view.fy);
  }
  const VkExtent2D extent{view.width, view.height};
  const EnginePipeline pipeline(stage_.context(), mirror_vert_spirv, mirror_frag_spirv, sizeof(constants), extent);
  stage_.frame(walkInfo(eyeOf(view)),
               [&](VkCommandBuffer commands, VkDescriptorSet set) { pipeline.draw(commands, set, constants); });
  const Result<std::vector<float>> texels = sharedHost().readImage(pipeline.picture());
  ASSERT_TRUE(texels) << texels.error().message;
  EXPECT_GE(psnr({view.width, view.height, 4, *texels}, expected), 90);
}

}  // namespace
}  // namespace froth::test
