// The passes that count and write (tile, cell) pairs are two programs, whose tests of a ball against a tile compilers
// may round apart. Here they disagree on purpose.
#include <cmath>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "render_spirv/count_planted.h"
#include "spirv/count_tiles.h"
#include "tests/render/ball_asset.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 160, kHeight = 96, kTiles = 15;

PFN_vkCreateShaderModule createRealModule = nullptr;

VKAPI_ATTR VkResult VKAPI_CALL createPlantedModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                   const VkAllocationCallbacks* allocator, VkShaderModule* module) {
  VkShaderModuleCreateInfo planted = *info;
  const size_t bytes = sizeof(count_tiles_spirv);
  if (info->codeSize == bytes && std::memcmp(info->pCode, count_tiles_spirv, bytes) == 0) {
    planted.codeSize = sizeof(count_planted_spirv);
    planted.pCode = count_planted_spirv;
  }
  return createRealModule(device, &planted, allocator, module);
}

PFN_vkVoidFunction VKAPI_CALL getPlantedDeviceProcAddr(VkDevice device, const char* name) {
  const PFN_vkVoidFunction real = vkGetDeviceProcAddr(device, name);
  if (std::strcmp(name, "vkCreateShaderModule") != 0) return real;
  createRealModule = reinterpret_cast<PFN_vkCreateShaderModule>(real);
  return reinterpret_cast<PFN_vkVoidFunction>(createPlantedModule);
}

PFN_vkVoidFunction VKAPI_CALL getPlantedProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(getPlantedDeviceProcAddr);
  }
  return vkGetInstanceProcAddr(instance, name);
}

View viewFrom(double x) { return lookAt({x, 0.1, -1}, {0, 0, 3}, kWidth, kHeight, 0.5); }

AssetContents makeBalls() {
  std::vector<BallCell> cells;
  for (int i = 0; i < 60; ++i) {
    const auto place = static_cast<float>(i);
    const glm::vec3 site(std::sin(2.4f * place), std::cos(1.7f * place), 3 + 0.01f * place);
    cells.push_back({site, 0.1f + 0.005f * place, 3, 0.4f * glm::vec3(std::sin(place), std::cos(place), 0.3f)});
  }
  return makeBallAsset(cells);
}

class DisagreeingPairs : public testing::Test {
 protected:
  DisagreeingPairs() {
    FrothContextInfo info = checkedContextInfo(0);
    info.getInstanceProcAddr = getPlantedProcAddr;
    check(frothCreateContext(&info, &context_), "frothCreateContext");
    stage_ = std::make_unique<Stage>(makeBalls(), VkExtent2D{kWidth, kHeight}, context_);
  }
  ~DisagreeingPairs() override {
    stage_.reset();
    check(frothDestroyContext(context_, UINT64_MAX), "frothDestroyContext");
  }

  // As if every cell had been counted in so many tiles.
  Frame drawCounted(uint32_t tiles, double x) {
    FrothRenderInfo info = infoOf(viewFrom(x));
    info.maxNeighbours = tiles;
    return stage_->draw(Method::kRaster, info, {kWidth, kHeight});
  }

  FrothContext* context_ = nullptr;
  std::unique_ptr<Stage> stage_;
};

TEST_F(DisagreeingPairs, ThatLackSomeOfTheCountGiveTheSameBits) {
  Stage honest(makeBalls(), {kWidth, kHeight});
  for (const double x : {0.0, 0.7}) {  // what the first frame left behind must not be seen in the second
    const Frame expected = honest.draw(Method::kRaster, viewFrom(x));
    const Frame found = drawCounted(kTiles + 5, x);
    EXPECT_GT(found.status.pairs, expected.status.pairs);
    EXPECT_EQ(found.colour.values, expected.colour.values);
    EXPECT_EQ(found.alpha.values, expected.alpha.values);
  }
}

TEST_F(DisagreeingPairs, ThatExceedTheCountAreLeftOut) {
  Stage honest(makeBalls(), {kWidth, kHeight});
  const Frame expected = honest.draw(Method::kRaster, viewFrom(0));
  const Frame found = drawCounted(1, 0);
  EXPECT_EQ(found.status.pairs, found.status.visibleCells);
  EXPECT_LT(found.status.pairs, expected.status.pairs);
  for (size_t i = 0; i < found.alpha.values.size(); ++i) {
    ASSERT_LE(found.alpha.values[i], expected.alpha.values[i] + 1e-5f) << "a cell was drawn twice";
  }
}

}  // namespace
}  // namespace froth::test
