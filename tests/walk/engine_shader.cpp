#include "tests/walk/engine_shader.h"

#include <cstring>

#include <vulkan/vulkan.h>

#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

struct CallConstants {
  VkDeviceAddress asked, answers;
  uint32_t count, mode;
};

constexpr uint32_t kNone = UINT32_MAX;

}  // namespace

Asked ask(const glm::vec3& origin, const glm::vec3& direction, float tMax) {
  return {{origin.x, origin.y, origin.z}, 0, {direction.x, direction.y, direction.z}, tMax, {kNone, kNone, kNone, 0}};
}

EngineShader::EngineShader()
    : contents_(bakeScene(makeRandomFoam(150, 4, 2, 5), "exact", 64)), asset_(stage_.open(contents_)) {
  instance_ = stage_.place(asset_);
}

EnginePipeline EngineShader::pipelineOf(std::span<const uint32_t> spirv, FrothRayPreparation prepared) const {
  return EnginePipeline(stage_.context(), spirv, sizeof(CallConstants), prepared);
}

std::vector<Answer> EngineShader::call(const EnginePipeline& pipeline, Mode mode, const std::vector<Asked>& asked,
                                       const FrothWalkInfo& info) {
  Device& device = stage_.device();
  const VkDeviceSize askedSize = asked.size() * sizeof(Asked);
  Result<GpuBuffer> buffer = device.createBuffer(MemoryUse::kViewsHost, BufferKind::kReadback,
                                                 askedSize + asked.size() * sizeof(Answer), "calls");
  EXPECT_TRUE(buffer) << buffer.error().message;
  std::memcpy(buffer->mapped, asked.data(), askedSize);
  const CallConstants constants{buffer->address, buffer->address + askedSize, static_cast<uint32_t>(asked.size()),
                                mode};
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

std::vector<Asked> EngineShader::randomAsked(size_t count) const {
  Random random(9);
  std::vector<Asked> asked;
  for (size_t i = 0; i < count; ++i) {
    const glm::dvec3 origin = random.inBox({-1.5, -1.5, 1.5}, {1.5, 1.5, 4.5});
    asked.push_back(ask(glm::vec3(origin), glm::vec3(random.direction())));
  }
  return asked;
}

Image EngineShader::drawMirror(std::span<const uint32_t> vertexSpirv, std::span<const uint32_t> fragmentSpirv,
                               const View& view) {
  float constants[12] = {};
  for (int row = 0; row < 3; ++row) {
    const double* axes = &view.worldFromCamera[4 * row];
    constants[row] = static_cast<float>(axes[2] - axes[0] * view.cx / view.fx - axes[1] * view.cy / view.fy);
    constants[4 + row] = static_cast<float>(axes[0] / view.fx);
    constants[8 + row] = static_cast<float>(axes[1] / view.fy);
  }
  const VkExtent2D extent{view.width, view.height};
  const EnginePipeline pipeline(stage_.context(), vertexSpirv, fragmentSpirv, sizeof(constants), extent);
  stage_.frame(walkInfo(eyeOf(view)),
               [&](VkCommandBuffer commands, VkDescriptorSet set) { pipeline.draw(commands, set, constants); });
  Result<std::vector<float>> texels = sharedHost().readImage(pipeline.picture());
  EXPECT_TRUE(texels) << texels.error().message;
  return {view.width, view.height, 4, std::move(*texels)};
}

}  // namespace froth::test
