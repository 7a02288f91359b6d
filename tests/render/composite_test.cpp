// The foam's colour over the engine's own image, against the formula.
#include <bit>
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/packing.hpp>

#include "froth/froth_composite.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent{90, 70};
constexpr uint32_t kPixels = kExtent.width * kExtent.height;
constexpr VkFormat kPacked = VK_FORMAT_B10G11R11_UFLOAT_PACK32;

FrothContext* createContext(VkFormat compositeFormat) {
  FrothContextInfo info = checkedContextInfo(0);
  info.compositeFormat = compositeFormat;
  FrothContext* context = nullptr;
  EXPECT_EQ(frothCreateContext(&info, &context), FROTH_OK);
  return context;
}

// The engine's colours, which the packed format holds exactly.
std::vector<glm::vec4> engineColours() {
  std::vector<glm::vec4> colours;
  for (uint32_t i = 0; i < kPixels; ++i) {
    const float across = static_cast<float>(i % 7 + 1) / 4, down = static_cast<float>(i / kExtent.width % 5 + 1) / 2;
    colours.push_back({across, down, 4.75f - across - down, 0.5f});
  }
  return colours;
}

std::vector<float> packTexels(const std::vector<glm::vec4>& colours, VkFormat format) {
  std::vector<float> texels;
  for (const glm::vec4& c : colours) {
    if (format == kPacked) {
      texels.push_back(std::bit_cast<float>(glm::packF2x11_1x10(glm::vec3(c))));
    } else {
      texels.insert(texels.end(), {c.x, c.y, c.z, c.w});
    }
  }
  return texels;
}

std::vector<glm::vec4> unpackTexels(const std::vector<float>& texels, VkFormat format) {
  std::vector<glm::vec4> colours;
  for (uint32_t i = 0; i < kPixels; ++i) {
    if (format == kPacked) {
      colours.push_back(glm::vec4(glm::unpackF2x11_1x10(std::bit_cast<uint32_t>(texels[i])), 1));
    } else {
      colours.push_back({texels[4 * i], texels[4 * i + 1], texels[4 * i + 2], texels[4 * i + 3]});
    }
  }
  return colours;
}

class Composite : public testing::TestWithParam<VkFormat> {
 protected:
  Composite() : context_(createContext(GetParam())) {
    stage_ = std::make_unique<Stage>(bakeForTest(makeRandomFoam(300, 2, 1, 3)), kExtent, context_);
    foam_ = *sharedHost().createImage(VK_FORMAT_R16G16B16A16_SFLOAT, kExtent);
    target_ = *sharedHost().createImage(GetParam(), kExtent);
    shadow_ = *sharedHost().createImage(VK_FORMAT_R32_SFLOAT, kExtent);
    EXPECT_TRUE(sharedHost().writeImage(target_, packTexels(engine_, GetParam())));
    for (uint32_t i = 0; i < kPixels; ++i) lit_.push_back(i % 3 == 0 ? 0.25f : 1.0f);
    EXPECT_TRUE(sharedHost().writeImage(shadow_, lit_));
    info_.structSize = sizeof(info_);
    info_.foam = sharedHost().describeInput(foam_);
    info_.target = sharedHost().describeInput(target_);
  }
  ~Composite() override {
    for (HostImage* image : {&foam_, &target_, &shadow_}) sharedHost().destroyImage(*image);
    stage_.reset();
    EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  }

  // A frame that draws and composites; what is in the target then.
  std::vector<glm::vec4> draw(const VkRect2D& scissor = {}) {
    FrothRenderInfo render = infoOf(lookAt({0.5, -0.4, 0.2}, {0, 0, 3}, kExtent.width, kExtent.height, 0.6));
    render.displayCoded = 0;
    render.camera.scissor = scissor;
    render.colour = sharedHost().describe(foam_);
    render.colour.stageOut = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    render.colour.accessOut = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    stage_->submit({{Method::kRaster, render}}, {}, [&](VkCommandBuffer commandBuffer) {
      EXPECT_EQ(frothRecordComposite(context_, stage_->view(), commandBuffer, &info_), FROTH_OK);
    });
    foamTexels_ = unpackTexels(*sharedHost().readImage(foam_), VK_FORMAT_R16G16B16A16_SFLOAT);
    return unpackTexels(*sharedHost().readImage(target_), GetParam());
  }

  // Of 6 bits after the point at least; packed channels are cut off, not rounded.
  double tolerance() const {
    return GetParam() == VK_FORMAT_R32G32B32A32_SFLOAT ? 1e-6 : GetParam() == kPacked ? 1.0 / 32 : 1.0 / 1024;
  }

  void expectBlended(const std::vector<glm::vec4>& found, bool hasShadow, const VkRect2D& region) {
    uint32_t covered = 0;
    for (uint32_t i = 0; i < kPixels; ++i) {
      const auto x = static_cast<int32_t>(i % kExtent.width), y = static_cast<int32_t>(i / kExtent.width);
      const bool isInside = x >= region.offset.x && y >= region.offset.y &&
                            x < region.offset.x + static_cast<int32_t>(region.extent.width) &&
                            y < region.offset.y + static_cast<int32_t>(region.extent.height);
      glm::dvec4 foam(foamTexels_[i]), expected(engine_[i]);
      const double alpha = foam.w;
      if (hasShadow) foam *= glm::dvec4(glm::dvec3(lit_[i]), 1);
      if (isInside) expected = foam + (1 - alpha) * expected;
      covered += isInside && alpha > 0.5;
      for (int c = 0; c < (GetParam() == kPacked ? 3 : 4); ++c) {
        ASSERT_NEAR(found[i][c], expected[c], tolerance() * (isInside ? std::max(1.0, expected[c]) : 0))
            << x << ", " << y;
      }
    }
    EXPECT_GT(covered, kPixels / 20);
  }

  FrothContext* context_;
  std::unique_ptr<Stage> stage_;
  HostImage foam_, target_, shadow_;
  std::vector<glm::vec4> engine_ = engineColours(), foamTexels_;
  std::vector<float> lit_;
  FrothCompositeInfo info_{};
};

TEST_P(Composite, BlendsTheFoamOverTheEnginesColour) { expectBlended(draw(), false, {{0, 0}, kExtent}); }

TEST_P(Composite, MultipliesTheShadowIntoTheFoamAlone) {
  info_.shadowFactor = sharedHost().describeInput(shadow_);
  expectBlended(draw(), true, {{0, 0}, kExtent});
}

TEST_P(Composite, LeavesPixelsThatWereNotDrawnAlone) {
  const VkRect2D region = {{11, 7}, {60, 50}};
  expectBlended(draw(region), false, region);
}

INSTANTIATE_TEST_SUITE_P(Formats, Composite,
                         testing::Values(VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, kPacked),
                         [](const testing::TestParamInfo<VkFormat>& test) {
                           return test.param == kPacked                         ? "packed"
                                  : test.param == VK_FORMAT_R16G16B16A16_SFLOAT ? "halves"
                                                                                : "floats";
                         });

}  // namespace
}  // namespace froth::test
