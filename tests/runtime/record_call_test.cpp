#include <cmath>
#include <limits>

#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

// What record calls refuse, in every build. The checks need no device.
class RecordCall : public RuntimeTest {
 protected:
  void SetUp() override {
    createContext();
    view_ = createView({64, 64});
    ASSERT_EQ(update(1), FROTH_OK);
    info_ = makeStruct<FrothRenderInfo>();
    info_.camera = makeCamera(64, 64);
    info_.nearRatio = info_.nearDepth = FROTH_NEAR_DEFAULT;
    info_.colour.image = reinterpret_cast<VkImage>(1);
    info_.colour.view = reinterpret_cast<VkImageView>(1);
    info_.colour.stageIn = VK_PIPELINE_STAGE_2_COPY_BIT;
    info_.colour.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    info_.colour.extent = {64, 64};
    info_.colour.layoutOut = VK_IMAGE_LAYOUT_GENERAL;
  }

  // Both calls, in a frame of their own.
  void expectResult(FrothResult expected, const char* text) {
    ASSERT_EQ(update(++serial_), FROTH_OK);
    messages_.clear();
    EXPECT_EQ(frothRecordRaster(context_, view_, nullptr, &info_), expected) << lastText();
    EXPECT_EQ(frothRecordWalk(context_, view_, nullptr, &info_), expected) << lastText();
    if (expected < 0) {
      EXPECT_THAT(lastText(), HasSubstr(text));
    }
  }

  FrothView view_{};
  FrothRenderInfo info_{};
  uint64_t serial_ = 1;
};

TEST_F(RecordCall, AcceptsAGoodCamera) { expectResult(FROTH_OK, ""); }

TEST_F(RecordCall, AcceptsReversedOffCentreObliqueAndFlippedProjections) {
  info_.camera.clipFromView[8] = 0.3f;  // off-centre
  info_.camera.clipFromView[2] = 0.2f;  // oblique near plane: only the depth row
  info_.camera.clipFromView[10] = -1.0f;
  expectResult(FROTH_OK, "");
  info_.camera.viewport.y = 64;
  info_.camera.viewport.height = -64;
  expectResult(FROTH_OK, "");
  info_.camera.clipFromView[11] = -1;  // the view looks along -z
  expectResult(FROTH_OK, "");
}

TEST_F(RecordCall, RefusesValuesThatAreNotFinite) {
  info_.camera.eye[2] = std::numeric_limits<double>::quiet_NaN();
  expectResult(FROTH_ERROR_ARGUMENT, "camera.eye: element 2 is nan");
  info_.camera.eye[2] = 0;
  info_.camera.jitter[0] = std::numeric_limits<float>::infinity();
  expectResult(FROTH_ERROR_ARGUMENT, "camera.jitter: element 0 is inf");
}

TEST_F(RecordCall, RefusesARotationWithScale) {
  info_.camera.viewFromWorld[0] = 1.01f;
  expectResult(FROTH_ERROR_ARGUMENT, "viewFromWorld: not a rotation");
}

TEST_F(RecordCall, RefusesAReflection) {
  info_.camera.viewFromWorld[4] = -1;
  expectResult(FROTH_ERROR_ARGUMENT, "viewFromWorld: a reflection");
  info_.camera.viewFromWorld[0] = -1;  // both: half a turn
  expectResult(FROTH_OK, "");
}

TEST_F(RecordCall, RefusesToDrawBeforeTheFirstFrame) {
  frothDestroyContext(context_, UINT64_MAX);
  createContext();
  view_ = createView({64, 64});
  EXPECT_EQ(frothRecordRaster(context_, view_, nullptr, &info_), FROTH_ERROR_STATE);
  EXPECT_EQ(lastText(), "no frame; call frothUpdate first");
}

TEST_F(RecordCall, RefusesLensesThatTheViewWasNotMadeFor) {
  info_.camera.lens.kind = FROTH_LENS_FISHEYE;
  info_.camera.lens.focal[0] = info_.camera.lens.focal[1] = 20;
  expectResult(FROTH_ERROR_UNSUPPORTED, "FROTH_LENS_CLASS_MAPPED");
  info_.camera.lens = {};
  info_.camera.clipFromView[11] = 0;
  info_.camera.clipFromView[15] = 1;
  expectResult(FROTH_ERROR_UNSUPPORTED, "FROTH_LENS_CLASS_ORTHOGRAPHIC");
  auto view = makeStruct<FrothViewInfo>();
  view.maxExtent = {64, 64};
  view.lensClasses = FROTH_LENS_CLASS_MAPPED;
  FrothView refused{};
  EXPECT_EQ(frothCreateView(context_, &view, &refused), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("lensClasses: 0x1, but the context was made for 0"));
}

// In a context and a view for all of them.
class RecordLens : public RecordCall {
 protected:
  void SetUp() override {
    RecordCall::SetUp();
    frothDestroyContext(context_, UINT64_MAX);
    FrothContextInfo context = nullContextInfo();
    context.lensClasses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
    createContext(context);
    auto view = makeStruct<FrothViewInfo>();
    view.maxExtent = {64, 64};
    view.lensClasses = context.lensClasses;
    ASSERT_EQ(frothCreateView(context_, &view, &view_), FROTH_OK) << lastText();
  }
};

TEST_F(RecordLens, RefusesWhatIsNoLens) {
  FrothLens& lens = info_.camera.lens;
  for (const auto kind :
       {FROTH_LENS_FISHEYE, FROTH_LENS_KANNALA_BRANDT, FROTH_LENS_RADIAL_TANGENTIAL, FROTH_LENS_EQUIRECTANGULAR}) {
    lens = {};
    lens.kind = kind;
    lens.focal[0] = 20;
    expectResult(FROTH_ERROR_ARGUMENT, "camera.lens.focal: 0");
    lens.focal[1] = 20;
    expectResult(FROTH_OK, "");
    lens.coefficients[6] = NAN;
    expectResult(FROTH_ERROR_ARGUMENT, "camera.lens.coefficients: element 6 is nan");
    lens.coefficients[6] = 0;
    lens.centre[1] = INFINITY;
    expectResult(FROTH_ERROR_ARGUMENT, "camera.lens.centre: element 1 is inf");
  }
  lens = {};
  lens.kind = FROTH_LENS_EQUIRECTANGULAR;
  expectResult(FROTH_OK, "");
  lens.kind = static_cast<FrothLensKind>(6);
  expectResult(FROTH_ERROR_ARGUMENT, "camera.lens.kind: 6");
}

TEST_F(RecordLens, RefusesARayMapThatCannotBeRead) {
  FrothLens& lens = info_.camera.lens;
  lens.kind = FROTH_LENS_RAY_MAP;
  expectResult(FROTH_ERROR_ARGUMENT, "camera.lens.rayMap: null");
  lens.rayMap = info_.colour;
  expectResult(FROTH_ERROR_ARGUMENT, "camera.lens.rayMap.format");
  lens.rayMap.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  expectResult(FROTH_OK, "");
  lens.rayMap.extent = {64, 32};
  expectResult(FROTH_ERROR_ARGUMENT, "camera.lens.rayMap.extent: 64 x 32");
  lens.rayMap.extent = {64, 64};
  info_.camera.jitter[1] = 0.5f;
  expectResult(FROTH_ERROR_ARGUMENT, "camera.jitter: (0, 0.5) with a ray map");
}

TEST_F(RecordLens, RefusesParallelRaysWithoutAnImage) {
  float(&clip)[16] = info_.camera.clipFromView;
  clip[11] = 0;
  clip[15] = 1;
  expectResult(FROTH_OK, "");
  clip[15] = -1;
  expectResult(FROTH_ERROR_ARGUMENT, "row w is (0, 0, 0, -1)");
  clip[15] = 1;
  clip[5] = 0;
  clip[1] = 2;  // row y is twice row x
  expectResult(FROTH_ERROR_ARGUMENT, "cross product 0");
}

TEST_F(RecordCall, RefusesAProjectionWithoutRays) {
  info_.camera.clipFromView[5] = 0;
  expectResult(FROTH_ERROR_ARGUMENT, "determinant 0");
  std::fill_n(info_.camera.clipFromView, 16, 0.0f);
  expectResult(FROTH_ERROR_ARGUMENT, "determinant 0");
}

TEST_F(RecordCall, RefusesAnEyeHiddenInTheProjection) {
  info_.camera.clipFromView[12] = 0.5f;
  expectResult(FROTH_ERROR_ARGUMENT, "move the eye into camera.eye");
}

TEST_F(RecordCall, RefusesWhatDoesNotFitTheImageOrTheView) {
  info_.colour.extent = {64, 63};
  expectResult(FROTH_ERROR_ARGUMENT, "colour.extent: 64 x 63");
  info_.camera.scissor = {{0, 0}, {64, 32}};
  expectResult(FROTH_OK, "");
  info_.camera.scissor = {{100, 0}, {8, 8}};
  expectResult(FROTH_ERROR_ARGUMENT, "leave 0 x 8 pixels");
  info_.camera.scissor = {};
  info_.colour.extent = {4096, 4096};
  info_.camera.viewport.width = 65;
  expectResult(FROTH_ERROR_ARGUMENT, "the view was made for 64 x 64");
  info_.camera.viewport.width = 1e30f;
  expectResult(FROTH_ERROR_ARGUMENT, "the view was made for 64 x 64");
  info_.camera.viewport.width = 0;
  expectResult(FROTH_ERROR_ARGUMENT, "camera.viewport: 0 x 64");
}

TEST_F(RecordCall, RefusesImagesOfOtherFormats) {
  info_.colour.format = VK_FORMAT_R8G8B8A8_UNORM;
  expectResult(FROTH_ERROR_ARGUMENT, "colour.format: VkFormat 37; must be R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT");
  info_.colour.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  info_.distance = info_.colour;
  expectResult(FROTH_ERROR_ARGUMENT, "distance.format");
  info_.distance = {};
  info_.colour.view = VK_NULL_HANDLE;
  expectResult(FROTH_ERROR_ARGUMENT, "colour.view: null");
  info_.colour = {};
  expectResult(FROTH_ERROR_ARGUMENT, "all null");
}

TEST_F(RecordCall, RefusesALayoutToLeaveTheImageInThatIsNone) {
  info_.colour.layoutOut = VK_IMAGE_LAYOUT_UNDEFINED;
  expectResult(FROTH_ERROR_ARGUMENT, "colour.layoutOut");
}

TEST_F(RecordCall, RefusesStagesThatOrderNothing) {
  info_.colour.stageIn = 0;
  expectResult(FROTH_ERROR_ARGUMENT, "colour.stageIn: 0; name the stages of its last use");
  info_.colour.stageIn = VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT;
  expectResult(FROTH_OK, "");
  info_.colour.stageOut = 0;
  info_.colour.accessOut = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  expectResult(FROTH_ERROR_ARGUMENT, "colour.stageOut: 0; name the stages of its next use");
}

TEST_F(RecordCall, RefusesExtensionsOfLaterVersions) {
  const FrothExtension later{7, nullptr};
  const FrothRenderInfo good = info_;
  info_.camera.extension = &later;
  expectResult(FROTH_ERROR_VERSION, "camera.extension: of kind 7, which this library does not know");
  info_ = good;
  info_.camera.lens.extension = &later;
  expectResult(FROTH_ERROR_VERSION, "camera.lens.extension: of kind 7");
  info_ = good;
  info_.colour.extension = &later;
  expectResult(FROTH_ERROR_VERSION, "colour.extension: of kind 7");
}

TEST_F(RecordCall, RefusesLimitsOutOfTheirRange) {
  const FrothRenderInfo good = info_;
  info_.cutoff = 1;
  expectResult(FROTH_ERROR_ARGUMENT, "cutoff: 1");
  info_ = good;
  info_.cutoff = std::nanf("");
  expectResult(FROTH_ERROR_ARGUMENT, "cutoff");
  info_ = good;
  info_.quantile = -0.5f;
  expectResult(FROTH_ERROR_ARGUMENT, "quantile: -0.5");
  info_ = good;
  info_.nearRatio = -3;
  expectResult(FROTH_ERROR_ARGUMENT, "nearDepth: -3");
}

TEST_F(RecordCall, RefusesASceneDepthThatItCannotRead) {
  info_.sceneDepth = info_.colour;
  info_.sceneDepth.format = VK_FORMAT_D32_SFLOAT;
  info_.camera.viewport.maxDepth = 1;
  info_.camera.clipFromView[10] = 0;
  info_.camera.clipFromView[14] = 0.1f;
  expectResult(FROTH_OK, "");
  info_.sceneDepth.samples = VK_SAMPLE_COUNT_4_BIT;
  expectResult(FROTH_ERROR_UNSUPPORTED,
               "sceneDepth.samples: 4; one sample per pixel is needed; resolve the image first");
  info_.sceneDepth.samples = VK_SAMPLE_COUNT_1_BIT;
  info_.sceneDepth.format = VK_FORMAT_S8_UINT;
  expectResult(FROTH_ERROR_ARGUMENT, "sceneDepth.format");
  info_.sceneDepth.format = VK_FORMAT_D16_UNORM;
  info_.camera.clipFromView[14] = 0;
  expectResult(FROTH_ERROR_ARGUMENT, "clipFromView has no depth that changes with distance");
  info_.camera.clipFromView[14] = 0.1f;
  info_.camera.viewport.maxDepth = 0;
  expectResult(FROTH_ERROR_ARGUMENT, "viewport.minDepth equals maxDepth");
  info_.sceneDepth = {};
  info_.depth = info_.colour;
  expectResult(FROTH_ERROR_ARGUMENT, "depth.format");
}

}  // namespace
}  // namespace froth
