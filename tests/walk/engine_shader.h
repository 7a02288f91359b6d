// An engine's compute shader: a thread per ray calls what `mode` says (shaders/calls.comp, shaders/calls.slang).
#pragma once

#include <limits>
#include <span>

#include <gtest/gtest.h>

#include "tests/walk/engine_pipeline.h"
#include "tests/walk/walk_stage.h"

namespace froth::test {

enum Mode : uint32_t { kSplitRay, kFindClosest, kLocate };
struct Asked {
  float origin[3], tMin, direction[3], tMax;
  uint32_t hint[4];
};
struct Answer {
  float first[4], second[4], third[4];
  uint32_t fourth[4];
};

Asked ask(const glm::vec3& origin, const glm::vec3& direction, float tMax = std::numeric_limits<float>::infinity());

// With a random foam.
class EngineShader : public testing::Test {
 protected:
  EngineShader();

  EnginePipeline pipelineOf(std::span<const uint32_t> spirv,
                            FrothRayPreparation prepared = FROTH_PREPARE_NOTHING) const;
  std::vector<Answer> call(const EnginePipeline& pipeline, Mode mode, const std::vector<Asked>& asked,
                           const FrothWalkInfo& info = walkInfo());
  std::vector<Asked> randomAsked(size_t count) const;
  // The rays of a view's pixels, in the fragment stage of mirror.frag or mirror.slang.
  Image drawMirror(std::span<const uint32_t> vertexSpirv, std::span<const uint32_t> fragmentSpirv, const View& view);

  WalkStage stage_;
  AssetContents contents_;
  FrothAsset asset_;
  FrothInstance instance_{};
};

}  // namespace froth::test
