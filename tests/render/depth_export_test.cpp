// The foam's depth in the engine's depth attachment, in both directions of depth.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "froth/froth_composite.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent{90, 70};
constexpr uint32_t kPixels = kExtent.width * kExtent.height;
constexpr double kNear = 0.1, kFar = 12;

struct Form {
  VkFormat format;
  bool isReversed, isOrthographic;
};

class DepthExport : public testing::TestWithParam<Form> {
 protected:
  DepthExport() {
    constexpr uint32_t kLenses = FROTH_LENS_CLASS_ORTHOGRAPHIC;
    FrothContextInfo info = checkedContextInfo(kLenses);
    info.depthExportFormat = GetParam().format;
    EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_OK);
    stage_ = std::make_unique<Stage>(bakeForTest(makeRandomFoam(300, 2, 1, 3)), kExtent, context_, 0, kLenses);
    colour_ = *sharedHost().createImage(VK_FORMAT_R16G16B16A16_SFLOAT, kExtent);
    depth_ = *sharedHost().createImage(VK_FORMAT_R32_SFLOAT, kExtent);
    attachment_ = *sharedHost().createImage(GetParam().format, kExtent);
  }
  ~DepthExport() override {
    for (HostImage* image : {&colour_, &depth_, &attachment_}) sharedHost().destroyImage(*image);
    stage_.reset();
    EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
  }

  static FrothRenderInfo renderInfo() {
    View view = lookAt({0.5, -0.4, 0.2}, {0, 0, 3}, kExtent.width, kExtent.height, 0.6);
    if (GetParam().isOrthographic) {
      view.lens.kind = LensKind::kOrthographic;
      view.fx = view.fy = 25;
    }
    FrothRenderInfo info = infoOf(view);
    float(&clip)[16] = info.camera.clipFromView;
    const double a = GetParam().isOrthographic ? 1 / (kFar - kNear) : kFar / (kFar - kNear), b = -a * kNear;
    clip[10] = static_cast<float>(GetParam().isReversed ? (GetParam().isOrthographic ? 0 : 1) - a : a);
    clip[14] = static_cast<float>(GetParam().isReversed ? (GetParam().isOrthographic ? 1 : 0) - b : b);
    return info;
  }

  // A frame that draws the foam and exports its depth over `engine`; what the attachment holds then.
  std::vector<float> draw(const std::vector<float>& engine, const VkRect2D& scissor = {}) {
    EXPECT_TRUE(sharedHost().writeImage(attachment_, engine));
    FrothRenderInfo render = renderInfo();
    render.camera.scissor = scissor;
    render.colour = sharedHost().describe(colour_);
    render.depth = sharedHost().describe(depth_);
    render.depth.stageOut = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    render.depth.accessOut = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    FrothDepthExportInfo info{};
    info.structSize = sizeof(info);
    info.depth = sharedHost().describeInput(depth_);
    info.attachment = sharedHost().describeInput(attachment_);
    stage_->submit({{Method::kRaster, render}}, {}, [&](VkCommandBuffer commandBuffer) {
      EXPECT_EQ(frothRecordDepthExport(context_, stage_->view(), commandBuffer, &info), FROTH_OK);
    });
    foam_ = *sharedHost().readImage(depth_);
    return *sharedHost().readImage(attachment_);
  }

  // What the format makes of a depth.
  static float rounded(float depth) {
    return GetParam().format == VK_FORMAT_D16_UNORM ? std::round(depth * 65535) / 65535 : depth;
  }
  // Devices round as they like.
  static float tolerance() { return GetParam().format == VK_FORMAT_D16_UNORM ? 1.01f / 65535 : 1e-7f; }
  static float nearer(float a, float b) { return GetParam().isReversed ? std::max(a, b) : std::min(a, b); }
  static float farEnd() { return GetParam().isReversed ? 0.0f : 1.0f; }

  FrothContext* context_ = nullptr;
  std::unique_ptr<Stage> stage_;
  HostImage colour_, depth_, attachment_;
  std::vector<float> foam_;
};

TEST_P(DepthExport, LeavesWhatIsNearer) {
  // Slats of the engine, before and behind the foam, and nothing between them.
  std::vector<float> engine(kPixels);
  const std::vector<float> depths = draw(std::vector<float>(kPixels, farEnd()));
  float least = 1, most = 0;
  for (uint32_t i = 0; i < kPixels; ++i) {
    if (foam_[i] == farEnd()) continue;
    least = std::min(least, foam_[i]);
    most = std::max(most, foam_[i]);
  }
  ASSERT_LT(least, most) << "the foam has no depth";
  for (uint32_t i = 0; i < kPixels; ++i) {
    ASSERT_NEAR(depths[i], rounded(foam_[i]), tolerance()) << "of an empty attachment";
    const float across = static_cast<float>(i % 10) / 9;
    engine[i] = i % 3 == 0 ? farEnd() : rounded(least + across * (most - least));
  }
  const std::vector<float> found = draw(engine);
  uint32_t ofFoam = 0, ofEngine = 0;
  for (uint32_t i = 0; i < kPixels; ++i) {
    const float expected = nearer(engine[i], foam_[i]);
    ASSERT_NEAR(found[i], rounded(expected), tolerance()) << i;
    ofFoam += expected != engine[i];
    ofEngine += expected == engine[i] && engine[i] != farEnd() && foam_[i] != farEnd();
  }
  EXPECT_GT(ofFoam, kPixels / 20);
  EXPECT_GT(ofEngine, kPixels / 50);
}

TEST_P(DepthExport, LeavesPixelsThatWereNotDrawnAlone) {
  const VkRect2D region = {{20, 15}, {40, 30}};
  const std::vector<float> found = draw(std::vector<float>(kPixels, farEnd()), region);
  uint32_t ofFoam = 0;
  for (uint32_t i = 0; i < kPixels; ++i) {
    const uint32_t x = i % kExtent.width, y = i / kExtent.width;
    const bool isInside = x >= 20 && y >= 15 && x < 60 && y < 45;
    ASSERT_NEAR(found[i], isInside ? rounded(foam_[i]) : farEnd(), isInside ? tolerance() : 0) << x << ", " << y;
    ofFoam += isInside && foam_[i] != farEnd();
  }
  EXPECT_GT(ofFoam, 100u);
}

std::string nameOf(const testing::TestParamInfo<Form>& test) {
  const char* format = test.param.format == VK_FORMAT_D32_SFLOAT  ? "floats"
                       : test.param.format == VK_FORMAT_D16_UNORM ? "sixteen_bits"
                                                                  : "floats_and_stencil";
  return std::string(format) + (test.param.isReversed ? "_reversed" : "_forward") +
         (test.param.isOrthographic ? "_parallel" : "");
}

INSTANTIATE_TEST_SUITE_P(
    Forms, DepthExport,
    testing::Values(Form{VK_FORMAT_D32_SFLOAT, false, false}, Form{VK_FORMAT_D32_SFLOAT, true, false},
                    Form{VK_FORMAT_D16_UNORM, false, false}, Form{VK_FORMAT_D16_UNORM, true, false},
                    Form{VK_FORMAT_D32_SFLOAT_S8_UINT, true, false}, Form{VK_FORMAT_D32_SFLOAT, true, true}),
    nameOf);

}  // namespace
}  // namespace froth::test
