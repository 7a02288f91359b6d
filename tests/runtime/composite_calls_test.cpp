// What frothRecordComposite and frothRecordDepthExport refuse. The checks need no device.
#include "froth/froth_composite.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class CompositeCalls : public RuntimeTest {
 protected:
  void open(VkFormat format) {
    FrothContextInfo info = nullContextInfo();
    info.compositeFormat = format;
    createContext(info);
    view_ = createView({16, 16});
    info_ = makeStruct<FrothCompositeInfo>();
    info_.foam = info_.target = fakeImage(VK_FORMAT_R16G16B16A16_SFLOAT);
  }

  void expectResult(FrothResult expected, const char* text) {
    messages_.clear();
    EXPECT_EQ(frothRecordComposite(context_, view_, nullptr, &info_), expected) << lastText();
    if (expected < 0) {
      EXPECT_THAT(lastText(), HasSubstr(text));
    }
  }

  void drawView() {
    auto render = makeStruct<FrothRenderInfo>();
    render.camera = makeCamera(16, 16);
    render.colour = fakeImage(VK_FORMAT_R16G16B16A16_SFLOAT);
    ASSERT_EQ(frothRecordRaster(context_, view_, nullptr, &render), FROTH_OK) << lastText();
  }

  FrothView view_{};
  FrothCompositeInfo info_{};
};

TEST_F(CompositeCalls, NeedAFrameAndADeclaredFormat) {
  open(VK_FORMAT_UNDEFINED);
  expectResult(FROTH_ERROR_STATE, "call frothUpdate first");
  ASSERT_EQ(update(1), FROTH_OK);
  expectResult(FROTH_ERROR_UNSUPPORTED, "set FrothContextInfo::compositeFormat");
}

TEST_F(CompositeCalls, RefuseImagesThatAreMissingOrOfOtherFormats) {
  open(VK_FORMAT_R16G16B16A16_SFLOAT);
  ASSERT_EQ(update(1), FROTH_OK);
  drawView();
  expectResult(FROTH_OK, "");
  const FrothCompositeInfo good = info_;
  info_.target = {};
  expectResult(FROTH_ERROR_ARGUMENT, "target: null");
  info_ = good;
  info_.target.format = VK_FORMAT_R8G8B8A8_UNORM;
  expectResult(FROTH_ERROR_ARGUMENT, "target.format: VkFormat 37; must be FrothContextInfo::compositeFormat");
  info_ = good;
  info_.shadowFactor = fakeImage(VK_FORMAT_R8_UNORM);
  expectResult(FROTH_OK, "");
  info_.shadowFactor.extent = {8, 8};
  expectResult(FROTH_ERROR_ARGUMENT, "shadowFactor.extent: 8 x 8");
  info_ = good;
  info_.target.layoutIn = VK_IMAGE_LAYOUT_UNDEFINED;
  expectResult(FROTH_ERROR_ARGUMENT, "target.layoutIn: VK_IMAGE_LAYOUT_UNDEFINED, which drops its contents");
  info_.structSize = 0;
  expectResult(FROTH_ERROR_ARGUMENT, "structSize: 0");
}

TEST_F(CompositeCalls, OfAContextWithAnUnknownFormatAreRefusedAtItsCreation) {
  FrothContextInfo info = nullContextInfo();
  info.compositeFormat = VK_FORMAT_R8G8B8A8_SRGB;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_UNSUPPORTED);
  EXPECT_THAT(lastText(), HasSubstr("compositeFormat: VkFormat 43"));
}

TEST_F(CompositeCalls, ExportDepthOfAProjectionToTheDeclaredFormatOnly) {
  FrothContextInfo contextInfo = nullContextInfo();
  contextInfo.depthExportFormat = VK_FORMAT_D32_SFLOAT;
  contextInfo.lensClasses = FROTH_LENS_CLASS_MAPPED;
  createContext(contextInfo);
  auto viewInfo = makeStruct<FrothViewInfo>();
  viewInfo.maxExtent = {16, 16};
  viewInfo.lensClasses = FROTH_LENS_CLASS_MAPPED;
  ASSERT_EQ(frothCreateView(context_, &viewInfo, &view_), FROTH_OK);
  ASSERT_EQ(update(1), FROTH_OK);
  drawView();
  auto info = makeStruct<FrothDepthExportInfo>();
  info.depth = fakeImage(VK_FORMAT_R32_SFLOAT);
  info.attachment = fakeImage(VK_FORMAT_D32_SFLOAT);
  EXPECT_EQ(frothRecordDepthExport(context_, view_, nullptr, &info), FROTH_OK) << lastText();
  info.attachment.format = VK_FORMAT_D16_UNORM;
  EXPECT_EQ(frothRecordDepthExport(context_, view_, nullptr, &info), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("attachment.format: VkFormat 124; must be FrothContextInfo::depthExportFormat"));
  ASSERT_EQ(update(2), FROTH_OK);
  auto render = makeStruct<FrothRenderInfo>();
  render.camera = makeCamera(16, 16);
  render.camera.lens.kind = FROTH_LENS_FISHEYE;
  render.camera.lens.focal[0] = render.camera.lens.focal[1] = 10;
  render.colour = fakeImage(VK_FORMAT_R16G16B16A16_SFLOAT);
  ASSERT_EQ(frothRecordRaster(context_, view_, nullptr, &render), FROTH_OK) << lastText();
  EXPECT_EQ(frothRecordDepthExport(context_, view_, nullptr, &info), FROTH_ERROR_UNSUPPORTED);
  EXPECT_THAT(lastText(), HasSubstr("its depth is a distance"));
}

class CompositeCallsOnDevice : public RuntimeGpuTest {};

TEST_F(CompositeCallsOnDevice, NeedAViewThatWasDrawnInTheFrame) {
  FrothContextInfo contextInfo = host_->contextInfo();
  contextInfo.compositeFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  createContext(contextInfo);
  const FrothView view = createView({16, 16});
  auto info = makeStruct<FrothCompositeInfo>();
  info.foam = info.target = fakeImage(VK_FORMAT_R16G16B16A16_SFLOAT);
  runFrame(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(frothRecordComposite(context_, view, commands, &info), FROTH_ERROR_STATE);
    EXPECT_THAT(lastText(), HasSubstr("call it after frothRecordRaster"));
  });
}

TEST_F(CompositeCallsOnDevice, OnAPackedFormatNeedTheFeature) {
  FrothContextInfo info = host_->contextInfo();
  VkPhysicalDeviceFeatures2 features = *info.enabledFeatures;
  features.features.shaderStorageImageExtendedFormats = VK_FALSE;
  info.enabledFeatures = &features;
  info.compositeFormat = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_FEATURE);
  EXPECT_THAT(lastText(), HasSubstr("shaderStorageImageExtendedFormats"));
}

TEST_F(CompositeCallsOnDevice, ThatExportDepthNeedDynamicRenderingAndADepthFormat) {
  FrothContextInfo info = host_->contextInfo();
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  info.depthExportFormat = VK_FORMAT_R32_SFLOAT;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_UNSUPPORTED);
  EXPECT_THAT(lastText(), HasSubstr("depthExportFormat: VkFormat 100 cannot be a depth attachment"));
  info.depthExportFormat = VK_FORMAT_D16_UNORM;
  VkPhysicalDeviceVulkan13Features features13{};
  features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  features13.synchronization2 = VK_TRUE;
  VkPhysicalDeviceVulkan12Features features12{};
  features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features12.bufferDeviceAddress = VK_TRUE;
  features12.pNext = &features13;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &features12;
  info.enabledFeatures = &features;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_FEATURE);
  EXPECT_THAT(lastText(), HasSubstr("dynamicRendering"));
}

}  // namespace
}  // namespace froth
