// froth_walk.slang in shaders of an engine, against froth_walk.glsl in the same shaders.
#include <algorithm>
#include <cmath>

#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/walk/engine_shader.h"
#include "walk_spirv/calls_alone_comp.h"
#include "walk_spirv/calls_alone_slang.h"
#include "walk_spirv/calls_comp.h"
#include "walk_spirv/calls_slang.h"
#include "walk_spirv/mirror_frag.h"
#include "walk_spirv/mirror_slang.h"
#include "walk_spirv/mirror_vert.h"

namespace froth::test {
namespace {

// Of SPIR-V.
constexpr size_t kHeaderWords = 5;
constexpr uint32_t kOpSource = 3, kOpName = 5, kOpMemberName = 6, kOpDecorate = 71, kNoContraction = 42;

// Without OpSource, OpName and OpMemberName: Debian 12's validation layers do not know Slang's number, and its
// Mesa 22.3 takes structures of two names for two types where a value is copied from one to the other.
std::vector<uint32_t> withoutNames(std::span<const uint32_t> spirv) {
  std::vector<uint32_t> words(spirv.begin(), spirv.begin() + kHeaderWords);
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const uint32_t operation = spirv[at] & 0xffff;
    if (operation == kOpSource || operation == kOpName || operation == kOpMemberName) continue;
    words.insert(words.end(), spirv.begin() + at, spirv.begin() + at + (spirv[at] >> 16));
  }
  return words;
}

size_t countPrecise(std::span<const uint32_t> spirv) {
  size_t count = 0;
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    count += (spirv[at] & 0xffff) == kOpDecorate && spirv[at + 2] == kNoContraction;
  }
  return count;
}

class SlangShader : public EngineShader {
 protected:
  SlangShader() {
    FrothInstanceInfo overlapping{};
    overlapping.position[0] = 0.4;
    overlapping.position[2] = 0.7;
    overlapping.rotation[1] = std::sin(0.3f);
    overlapping.rotation[3] = std::cos(0.3f);
    overlapping.scale = 0.8f;
    stage_.place(asset_, overlapping);
  }

  // Where no bits depend on it, a device may fuse products and sums of the one in GLSL alone.
  static bool isNear(const float (&values)[4], const float (&expected)[4]) {
    return std::equal(values, values + 4, expected,
                      [](float value, float other) { return value == other || std::abs(value - other) < 1e-4f; });
  }

  static bool isSame(const Answer& answer, const Answer& expected) {
    return isNear(answer.first, expected.first) && isNear(answer.second, expected.second) &&
           isNear(answer.third, expected.third) && std::equal(answer.fourth, answer.fourth + 4, expected.fourth);
  }

  // On lavapipe bit for bit. Elsewhere rounding may decide a tie, as between two devices.
  void expectSameAnswers(std::span<const uint32_t> glslSpirv, std::span<const uint32_t> slangSpirv) {
    const EnginePipeline glsl = pipelineOf(glslSpirv), slang = pipelineOf(withoutNames(slangSpirv));
    std::vector<Asked> asked = randomAsked(1000);
    Random random(12);
    for (Asked& ray : asked) {
      ray.hint[0] = 0;
      ray.tMax = static_cast<float>(random.uniform(0.05, 3));
    }
    for (const Mode mode : {kSplitRay, kFindClosest, kLocate}) {
      const std::vector<Answer> expected = call(glsl, mode, asked);
      const auto expectedCells = static_cast<double>(stage_.status().cells);
      const std::vector<Answer> answers = call(slang, mode, asked);
      EXPECT_NEAR(static_cast<double>(stage_.status().cells), expectedCells, 1e-3 * expectedCells) << mode;
      size_t others = 0;
      for (size_t i = 0; i < asked.size(); ++i) others += !isSame(answers[i], expected[i]);
      EXPECT_LE(others, asked.size() / 500) << mode;
    }
  }
};

// What is precise in GLSL must be so in Slang, where no image shows whether a driver may simplify it.
TEST(SlangCompiler, MarksAllThatIsPrecise) {
  EXPECT_GE(countPrecise(calls_slang_spirv), countPrecise(calls_comp_spirv));
}

TEST_F(SlangShader, AnswersAsTheOneInGlslDoes) { expectSameAnswers(calls_comp_spirv, calls_slang_spirv); }

TEST_F(SlangShader, AloneAnswersAsTheOneInGlslDoes) {
  expectSameAnswers(calls_alone_comp_spirv, calls_alone_slang_spirv);
}

TEST_F(SlangShader, InTheFragmentStageDrawsThePictureOfTheOneInGlsl) {
  const View view = lookAt({0.2, 0.3, -1}, {0, 0, 3}, 64, 48, 0.4);
  const Image expected = drawMirror(mirror_vert_spirv, mirror_frag_spirv, view);
  EXPECT_GE(psnr(drawMirror(mirror_vert_spirv, withoutNames(mirror_slang_spirv), view), expected), 90);
}

}  // namespace
}  // namespace froth::test
