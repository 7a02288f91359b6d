#include "tests/render/render_harness.h"

#include <cmath>
#include <cstring>
#include <map>

#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "reference/camera/ray_map.h"
#include "reference/camera/view_pose.h"
#include "tests/kept_pipelines.h"

namespace froth::test {
namespace {

// Fails once for each message of the validation layers.
void expectSilence(const Host& host) {
  static size_t reported = 0;
  const std::vector<std::string> messages = host.validationMessages();
  for (; reported < messages.size(); ++reported) ADD_FAILURE() << messages[reported];
}

Image channelsOf(const std::vector<float>& texels, uint32_t stride, uint32_t first, uint32_t channels,
                 VkExtent2D extent) {
  Image image{extent.width, extent.height, channels, {}};
  for (size_t pixel = 0; pixel < size_t{extent.width} * extent.height; ++pixel) {
    for (uint32_t c = 0; c < channels; ++c) image.values.push_back(texels[pixel * stride + first + c]);
  }
  return image;
}

std::vector<std::array<uint32_t, 2>> idsOf(const std::vector<float>& texels) {
  std::vector<std::array<uint32_t, 2>> ids(texels.size() / 2);
  std::memcpy(ids.data(), texels.data(), texels.size() * sizeof(float));
  return ids;
}

FrothLens lensOf(const View& view) {
  FrothLens lens{};
  lens.kind = static_cast<FrothLensKind>(view.lens.kind);
  lens.focal[0] = static_cast<float>(view.fx);
  lens.focal[1] = static_cast<float>(view.fy);
  lens.centre[0] = static_cast<float>(view.cx);
  lens.centre[1] = static_cast<float>(view.cy);
  for (size_t i = 0; i < view.lens.distortion.size(); ++i) {
    lens.coefficients[i] = static_cast<float>(view.lens.distortion[i]);
  }
  return lens;
}

// How many stages stand in each of the contexts that tests share.
std::map<FrothContext*, int>& stagesOfSharedContexts() {
  static std::map<FrothContext*, int> counts;
  return counts;
}

FrothContext* createSharedContext(uint32_t lensClasses) {
  FrothContext* const context = createCheckedContext(lensClasses);
  stagesOfSharedContexts()[context] = 0;
  return context;
}

// A view draws every instance of its context, so a stage that another test left there would be in this one's images.
void enter(FrothContext* context) {
  const auto shared = stagesOfSharedContexts().find(context);
  if (shared == stagesOfSharedContexts().end()) return;
  EXPECT_EQ(shared->second++, 0)
      << "another stage stands in this shared context; one that stays needs a context of its own";
}

void leave(FrothContext* context) {
  const auto shared = stagesOfSharedContexts().find(context);
  if (shared != stagesOfSharedContexts().end()) --shared->second;
}

constexpr uint32_t kAllLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;

std::vector<float> readBack(Host& host, const HostImage& image) {
  Result<std::vector<float>> texels = host.readImage(image);
  EXPECT_TRUE(texels) << texels.error().message;
  return texels ? *texels : std::vector<float>();
}

}  // namespace

void check(FrothResult result, const char* call) {
  EXPECT_EQ(result, FROTH_OK) << call << ": " << frothResultName(result);
}

void failOnMessage(void*, FrothSeverity, FrothResult, const char* object, const char* text) {
  ADD_FAILURE() << object << ": " << text;
}

Host& sharedHost() {
  static const std::unique_ptr<Host> host = [] {
    Result<std::unique_ptr<Host>> created = Host::create({.device = {}, .useValidation = true});
    if (!created) {
      ADD_FAILURE() << created.error().message;
      std::abort();
    }
    return std::move(*created);
  }();
  return *host;
}

FrothContextInfo sharedContextInfo() {
  FrothContextInfo info = sharedHost().contextInfo();
  info.getInstanceProcAddr = getInstanceProcAddrKeepingPipelines;
  return info;
}

FrothContextInfo checkedContextInfo(uint32_t lensClasses) {
  FrothContextInfo info = sharedContextInfo();
  info.onMessage = failOnMessage;
  info.checkIndices = 1;
  info.countWork = 1;
  info.lensClasses = lensClasses;
  return info;
}

FrothContext* createCheckedContext(uint32_t lensClasses) {
  const FrothContextInfo info = checkedContextInfo(lensClasses);
  FrothContext* created = nullptr;
  check(frothCreateContext(&info, &created), "frothCreateContext");
  return created;
}

FrothContext* sharedContext() {
  static FrothContext* const context = createSharedContext(0);
  return context;
}

FrothContext* lensContext() {
  static FrothContext* const context = createSharedContext(kAllLenses);
  return context;
}

Stage::Stage(const AssetContents& contents, VkExtent2D maxExtent, FrothContext* context, uint32_t layers,
             uint32_t lensClasses, bool keepsHits, uint32_t eyeCount, bool keepForQueries, bool keepsReactive)
    : context_(context), keepsHits_(keepsHits), keepsReactive_(keepsReactive) {
  enter(context_);
  Result<std::vector<uint8_t>> bytes = encodeAsset(contents);
  EXPECT_TRUE(bytes) << bytes.error().message;
  bytes_ = std::move(*bytes);
  FrothAssetInfo assetInfo{};
  assetInfo.structSize = sizeof(assetInfo);
  assetInfo.data = bytes_.data();
  assetInfo.dataSize = bytes_.size();
  assetInfo.layers = layers;
  assetInfo.keepForQueries = keepForQueries;
  check(frothOpenAsset(context_, &assetInfo, &asset_), "frothOpenAsset");
  const FrothViewInfo viewInfo{sizeof(FrothViewInfo), maxExtent, 1, lensClasses, keepsHits, eyeCount, 0, {},
                               keepsReactive,         0};
  check(frothCreateView(context_, &viewInfo, &view_), "frothCreateView");
  place({});

  do {
    submit({});
  } while (assetStatus().state == FROTH_ASSET_OPENING && !testing::Test::HasFailure());
  EXPECT_EQ(assetStatus().state, FROTH_ASSET_READY);
}

FrothAssetStatus Stage::assetStatus() const {
  FrothAssetStatus status{};
  status.structSize = sizeof(status);
  check(frothGetAssetStatus(context_, asset_, &status), "frothGetAssetStatus");
  return status;
}

Stage::~Stage() {
  check(frothDestroyView(context_, view_), "frothDestroyView");
  check(frothDestroyInstance(context_, instance_), "frothDestroyInstance");
  check(frothCloseAsset(context_, asset_), "frothCloseAsset");
  leave(context_);
  expectSilence(sharedHost());
}

void Stage::place(const FrothInstanceInfo& placement) {
  FrothInstanceInfo info = placement;
  info.structSize = sizeof(info);
  info.asset = asset_;
  if (instance_.generation == 0) {
    check(frothCreateInstance(context_, &info, &instance_), "frothCreateInstance");
  } else {
    check(frothSetInstance(context_, instance_, &info), "frothSetInstance");
  }
}

FrothViewStatus Stage::submit(const std::vector<std::pair<Method, FrothRenderInfo>>& draws,
                              const std::function<void()>& afterUpdate,
                              const std::function<void(VkCommandBuffer)>& afterDraws) {
  bool isIncomplete = false;
  const auto record = [&](VkCommandBuffer commandBuffer, uint64_t serial, bool isDrawn) -> Status {
    const FrothFrame frame{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
    check(frothUpdate(context_, &frame, nullptr), "frothUpdate");
    check(frothRecordUpload(context_, commandBuffer), "frothRecordUpload");
    if (isDrawn && afterUpdate) afterUpdate();
    for (const auto& [method, info] : draws) {
      if (!isDrawn) break;
      const FrothResult result = infoOf(method).record(context_, view_, commandBuffer, &info);
      isIncomplete = isIncomplete || result == FROTH_INCOMPLETE;
      check(result == FROTH_INCOMPLETE ? FROTH_OK : result, infoOf(method).call);
    }
    if (isDrawn && afterDraws) afterDraws(commandBuffer);
    return {};
  };
  // The frame after it brings its status.
  for (const bool isDrawn : {true, false}) {
    const Status submitted = sharedHost().submit(
        [&](VkCommandBuffer commandBuffer, uint64_t serial) { return record(commandBuffer, serial, isDrawn); });
    EXPECT_TRUE(submitted) << submitted.error().message;
  }
  FrothViewStatus status{};
  status.structSize = sizeof(status);
  check(frothGetViewStatus(context_, view_, &status), "frothGetViewStatus");
  EXPECT_EQ(status.indexViolations, 0u);
  EXPECT_EQ(isIncomplete, (status.bits & (FROTH_VIEW_MAY_LACK_CELLS | FROTH_VIEW_FEWER_LAYERS)) != 0);
  return status;
}

Frame Stage::draw(Method method, const FrothRenderInfo& info, VkExtent2D extent, VkFormat colourFormat,
                  const std::function<void()>& afterUpdate) {
  Host& host = sharedHost();
  Result<HostImage> colour = host.createImage(colourFormat, extent);
  Result<HostImage> distance = host.createImage(VK_FORMAT_R32_SFLOAT, extent);
  Result<HostImage> normal = host.createImage(VK_FORMAT_R16G16B16A16_SFLOAT, extent);
  Result<HostImage> depth = host.createImage(VK_FORMAT_R32_SFLOAT, extent);
  Result<HostImage> id = host.createImage(VK_FORMAT_R32G32_UINT, extent);
  Result<HostImage> motion = host.createImage(VK_FORMAT_R16G16_SFLOAT, extent);
  Result<HostImage> reactive = host.createImage(VK_FORMAT_R8_UNORM, extent);
  FrothRenderInfo wanted = info;
  if (keepsHits_) wanted.id = host.describe(*id);
  if (keepsHits_ && info.camera.lens.kind != FROTH_LENS_RAY_MAP) wanted.motion = host.describe(*motion);
  if (keepsReactive_) wanted.reactive = host.describe(*reactive);
  wanted.depth = host.describe(*depth);
  wanted.colour = host.describe(*colour);
  wanted.distance = host.describe(*distance);
  wanted.normal = host.describe(*normal);
  Frame frame;
  frame.status = submit({{method, wanted}}, afterUpdate);
  const std::vector<float> colours = readBack(host, *colour);
  frame.colour = channelsOf(colours, 4, 0, 3, extent);
  frame.alpha = channelsOf(colours, 4, 3, 1, extent);
  frame.distance = channelsOf(readBack(host, *distance), 1, 0, 1, extent);
  frame.normal = channelsOf(readBack(host, *normal), 4, 0, 3, extent);
  frame.depth = channelsOf(readBack(host, *depth), 1, 0, 1, extent);
  if (wanted.id.image) frame.id = idsOf(readBack(host, *id));
  if (wanted.motion.image) frame.motion = channelsOf(readBack(host, *motion), 2, 0, 2, extent);
  if (wanted.reactive.image) frame.reactive = channelsOf(readBack(host, *reactive), 1, 0, 1, extent);
  for (HostImage* image : {&*colour, &*distance, &*normal, &*depth, &*id, &*motion, &*reactive}) {
    host.destroyImage(*image);
  }
  expectSilence(host);
  return frame;
}

Frame Stage::draw(Method method, const View& view) { return draw(method, infoOf(view), {view.width, view.height}); }

FrothInstanceInfo placementOf(const glm::dvec3& position, const glm::vec4& rotation, float scale) {
  FrothInstanceInfo info{};
  for (int axis = 0; axis < 3; ++axis) info.position[axis] = position[axis];
  for (int part = 0; part < 4; ++part) info.rotation[part] = rotation[part];
  info.scale = scale;
  return info;
}

View lookAt(const glm::dvec3& eye, const glm::dvec3& target, uint32_t width, uint32_t height, double tanHalfFovY) {
  View view;
  setPose(view, eye, glm::normalize(target - eye), {-0.1, -1, -0.05});
  view.name = "test";
  view.width = width;
  view.height = height;
  view.fx = view.fy = 0.5 * height / tanHalfFovY;
  view.cx = 0.5 * width;
  view.cy = 0.5 * height;
  return view;
}

HostImage uploadRayMap(const View& view) {
  std::vector<float> texels;
  for (const glm::vec3& d : view.lens.rays->directions) texels.insert(texels.end(), {d.x, d.y, d.z, 0});
  Result<HostImage> image = sharedHost().createImage(VK_FORMAT_R32G32B32A32_SFLOAT, {view.width, view.height});
  EXPECT_TRUE(image) << image.error().message;
  EXPECT_TRUE(sharedHost().writeImage(*image, texels));
  return *image;
}

FrothRenderInfo infoOf(const View& view) {
  FrothRenderInfo info{};
  info.structSize = sizeof(info);
  info.nearRatio = static_cast<float>(view.nearRatio.value_or(0));
  info.nearDepth = static_cast<float>(view.nearDepth.value_or(0));
  info.displayCoded = 1;
  FrothCamera& camera = info.camera;
  for (int axis = 0; axis < 3; ++axis) {
    camera.eye[axis] = view.worldFromCamera[axis * 4 + 3];
    for (int row = 0; row < 3; ++row) {
      camera.viewFromWorld[axis * 3 + row] = static_cast<float>(view.worldFromCamera[axis * 4 + row]);
    }
  }
  const bool isOrthographic = view.lens.kind == LensKind::kOrthographic;
  camera.clipFromView[0] = static_cast<float>(2 * view.fx / view.width);
  camera.clipFromView[5] = static_cast<float>(2 * view.fy / view.height);
  const int shift = isOrthographic ? 12 : 8;
  camera.clipFromView[shift] = static_cast<float>(2 * view.cx / view.width - 1);
  camera.clipFromView[shift + 1] = static_cast<float>(2 * view.cy / view.height - 1);
  camera.clipFromView[isOrthographic ? 15 : 11] = 1.0f;
  camera.clipFromView[isOrthographic ? 10 : 14] = 0.01f;
  camera.viewport = {0, 0, static_cast<float>(view.width), static_cast<float>(view.height), 0, 1};
  if (!isOrthographic) camera.lens = lensOf(view);
  return info;
}

AssetContents bakeForTest(const Foam& foam) {
  Result<BakeResult> baked = bakeFoam(foam, {});
  EXPECT_TRUE(baked) << baked.error().message;
  return baked->contents;
}

RenderedImages renderReference(const Foam& foam, const View& view, double cutoff, const Image* sceneDistance) {
  ReferenceOptions options;
  options.cutoff = cutoff;
  options.sceneDistance = sceneDistance;
  options.nearRatio = view.nearRatio.value_or(0);
  options.nearDepth = view.nearDepth.value_or(0);
  Result<RenderedImages> images = ReferenceRenderer(foam).render(view, options);
  EXPECT_TRUE(images) << images.error().message;
  return *images;
}

double psnr(const Image& a, const Image& b) {
  const Result<ImageDifference> difference = compareImages(a, b);
  EXPECT_TRUE(difference) << difference.error().message;
  return difference->psnr;
}

double overTwoSteps(const Image& a, const Image& b) {
  const Result<ImageDifference> difference = compareImages(a, b);
  EXPECT_TRUE(difference) << difference.error().message;
  return difference->overTwoSteps;
}

}  // namespace froth::test
