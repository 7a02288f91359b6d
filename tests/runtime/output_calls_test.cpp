// What record calls refuse of the images id, motion and reactive, and of colours.
#include <cmath>

#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

FrothRenderInfo makeInfo() {
  auto info = makeStruct<FrothRenderInfo>();
  info.camera = makeCamera(16, 16);
  info.colour = fakeImage(VK_FORMAT_R16G16B16A16_SFLOAT);
  return info;
}

class OutputCalls : public RuntimeTest {
 protected:
  void SetUp() override {
    FrothContextInfo info = nullContextInfo();
    info.reactiveImages = 1;
    createContext(info);
  }

  FrothView createHitView(uint32_t keepsHits, uint32_t keepsReactive = 0) {
    auto info = makeStruct<FrothViewInfo>();
    info.maxExtent = {16, 16};
    info.keepsHits = keepsHits;
    info.keepsReactive = keepsReactive;
    FrothView view{};
    EXPECT_EQ(frothCreateView(context_, &info, &view), FROTH_OK) << lastText();
    return view;
  }

  void expectResult(FrothView view, FrothResult expected, const char* text) {
    ASSERT_EQ(update(++serial_), FROTH_OK);
    messages_.clear();
    EXPECT_EQ(frothRecordRaster(context_, view, nullptr, &info_), expected) << lastText();
    EXPECT_EQ(frothRecordWalk(context_, view, nullptr, &info_), expected) << lastText();
    if (expected < 0) {
      EXPECT_THAT(lastText(), HasSubstr(text));
    }
  }

  FrothRenderInfo info_ = makeInfo();
  uint64_t serial_ = 0;
};

TEST_F(OutputCalls, RefuseIdAndMotionOfAViewThatKeepsNoHits) {
  info_.id = fakeImage(VK_FORMAT_R32G32_UINT);
  expectResult(createHitView(0), FROTH_ERROR_UNSUPPORTED, "set FrothViewInfo::keepsHits");
  expectResult(createHitView(1), FROTH_OK, "");
}

TEST_F(OutputCalls, RefuseIdAndMotionOfOtherFormats) {
  const FrothView view = createHitView(1);
  info_.id = info_.motion = info_.colour;
  expectResult(view, FROTH_ERROR_ARGUMENT, "id.format: VkFormat 97; must be R32G32_UINT");
  info_.id = {};
  expectResult(view, FROTH_ERROR_ARGUMENT, "motion.format: VkFormat 97; must be R16G16_SFLOAT");
}

TEST_F(OutputCalls, RefuseReactiveOfAViewThatKeepsHitsAlone) {
  info_.reactive = fakeImage(VK_FORMAT_R8_UNORM);
  expectResult(createHitView(1), FROTH_ERROR_UNSUPPORTED, "set FrothViewInfo::keepsReactive");
  expectResult(createHitView(0, 1), FROTH_OK, "");
}

TEST_F(OutputCalls, TakeIdAndMotionOfAViewThatKeepsReactive) {
  info_.id = fakeImage(VK_FORMAT_R32G32_UINT);
  info_.motion = fakeImage(VK_FORMAT_R16G16_SFLOAT);
  expectResult(createHitView(0, 1), FROTH_OK, "");
}

TEST_F(OutputCalls, RefuseReactiveOfAnotherFormatOrWithoutAMeaning) {
  const FrothView view = createHitView(0, 1);
  info_.reactive = info_.colour;
  expectResult(view, FROTH_ERROR_ARGUMENT, "reactive.format: VkFormat 97; must be R8_UNORM");
  info_.reactive = fakeImage(VK_FORMAT_R8_UNORM);
  info_.previousCamera = info_.camera;
  info_.previousCamera.viewFromWorld[0] = 2;
  expectResult(view, FROTH_ERROR_ARGUMENT, "viewFromWorld: not a rotation");
  info_.previousCamera.lens.kind = FROTH_LENS_RAY_MAP;
  expectResult(view, FROTH_ERROR_UNSUPPORTED, "with a ray map");
}

class ReactiveView : public RuntimeTest {};

TEST_F(ReactiveView, IsRefusedInAContextWithoutReactiveImages) {
  createContext();
  auto info = makeStruct<FrothViewInfo>();
  info.maxExtent = {16, 16};
  info.keepsReactive = 1;
  FrothView view{};
  EXPECT_EQ(frothCreateView(context_, &info, &view), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("set FrothContextInfo::reactiveImages"));
}

TEST_F(OutputCalls, RefuseMotionThatHasNoMeaning) {
  const FrothView view = createHitView(1);
  info_.motion = fakeImage(VK_FORMAT_R16G16_SFLOAT);
  info_.motionScale[1] = INFINITY;
  expectResult(view, FROTH_ERROR_ARGUMENT, "motionScale: inf");
  info_.motionScale[1] = 0;
  expectResult(view, FROTH_OK, "");
  info_.previousCamera = info_.camera;
  expectResult(view, FROTH_OK, "");
  info_.previousCamera.viewFromWorld[0] = 2;
  expectResult(view, FROTH_ERROR_ARGUMENT, "viewFromWorld: not a rotation");
  EXPECT_THAT(messages_.back().object, HasSubstr("previousCamera"));
  info_.previousCamera.lens.kind = FROTH_LENS_RAY_MAP;
  expectResult(view, FROTH_ERROR_UNSUPPORTED, "with a ray map");
}

TEST_F(OutputCalls, RefuseAToneCurveThatIsNoneOrMeetsADisplayCodedImage) {
  const FrothView view = createHitView(0);
  info_.toneCurve = static_cast<FrothToneCurve>(9);
  expectResult(view, FROTH_ERROR_ARGUMENT, "toneCurve: 9");
  info_.toneCurve = FROTH_TONE_REINHARD;
  expectResult(view, FROTH_OK, "");
  info_.displayCoded = 1;
  expectResult(view, FROTH_ERROR_ARGUMENT, "toneCurve: 1 with displayCoded");
}

TEST_F(OutputCalls, RefuseATileFormThatIsNone) {
  const FrothView view = createHitView(0);
  info_.tileForm = static_cast<FrothTileForm>(3);
  expectResult(view, FROTH_ERROR_ARGUMENT, "tileForm: 3");
  info_.tileForm = FROTH_TILE_FORM_ALL_LONG;
  expectResult(view, FROTH_OK, "");
}

class OutputCallsOnDevice : public RuntimeGpuTest {};

TEST_F(OutputCallsOnDevice, NameTheFeatureThatIdAndMotionNeed) {
  FrothContextInfo contextInfo = host_->contextInfo();
  VkPhysicalDeviceFeatures2 features = *contextInfo.enabledFeatures;
  features.features.shaderStorageImageExtendedFormats = VK_FALSE;
  contextInfo.enabledFeatures = &features;
  createContext(contextInfo);
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = {16, 16};
  viewInfo.keepsHits = 1;
  FrothView view{};
  ASSERT_EQ(frothCreateView(context_, &viewInfo, &view), FROTH_OK) << "the engine's code is the same on all devices";
  runFrame(0, [&](VkCommandBuffer commands) {
    FrothRenderInfo info = makeInfo();
    info.id = fakeImage(VK_FORMAT_R32G32_UINT);
    EXPECT_EQ(frothRecordRaster(context_, view, commands, &info), FROTH_ERROR_FEATURE);
    EXPECT_THAT(lastText(), HasSubstr("made without shaderStorageImageExtendedFormats"));
  });
}

}  // namespace
}  // namespace froth
