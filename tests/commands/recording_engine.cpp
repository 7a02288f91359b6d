#include "tests/commands/recording_engine.h"
#include "host/make_struct.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "froth/froth_stream.h"
#include "tests/format/level_sample.h"
#include "tests/format/sample_asset.h"

namespace froth::test {
namespace {

constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkPipelineStageFlags2 kCopy = VK_PIPELINE_STAGE_2_COPY_BIT;
constexpr VkAccessFlags2 kCopyRead = VK_ACCESS_2_TRANSFER_READ_BIT, kCopyWrite = VK_ACCESS_2_TRANSFER_WRITE_BIT;
constexpr uint32_t kFadeFrames = 3;
const VkCommandBuffer kCommands = reinterpret_cast<VkCommandBuffer>(1);             // never reaches the driver
constexpr VkDeviceAddress kRays = VkDeviceAddress{1} << 61, kHits = kRays + 65536;  // in no buffer of the runtime's

Host& sharedHost() {
  static const std::unique_ptr<Host> host = [] {
    Result<std::unique_ptr<Host>> created = Host::create({.device = {}, .useGraphics = true});
    if (!created) {
      ADD_FAILURE() << created.error().message;
      std::abort();
    }
    return std::move(*created);
  }();
  return *host;
}

void check(FrothResult result, const char* call) {
  ASSERT_EQ(result, FROTH_OK) << call << ": " << frothResultName(result);
}

void aim(FrothCamera& camera, CameraKind kind) {
  constexpr VkExtent2D extent = RecordingEngine::kExtent;
  camera.eye[2] = 1e6 - 1;  // where the sample lies
  camera.viewFromWorld[0] = camera.viewFromWorld[4] = camera.viewFromWorld[8] = 1;
  camera.viewport = {0, 0, extent.width, extent.height, 0, 1};
  if (kind == CameraKind::kProjection) {
    camera.clipFromView[0] = camera.clipFromView[5] = camera.clipFromView[11] = 1;
    camera.clipFromView[14] = 0.1f;
  } else if (kind == CameraKind::kParallel) {
    camera.clipFromView[0] = camera.clipFromView[5] = camera.clipFromView[15] = 1;
    camera.clipFromView[10] = 0.1f;
  } else {
    camera.lens.kind = kind == CameraKind::kFisheye ? FROTH_LENS_FISHEYE : FROTH_LENS_RAY_MAP;
    if (kind == CameraKind::kRayMap) return;
    camera.lens.focal[0] = camera.lens.focal[1] = 20;
    camera.lens.centre[0] = extent.width / 2;
    camera.lens.centre[1] = extent.height / 2;
  }
}

std::vector<FrothImage*> outputsOf(FrothRenderInfo& info) {
  return {&info.colour, &info.distance, &info.normal, &info.depth, &info.id, &info.motion, &info.reactive};
}

}  // namespace

RecordingEngine::RecordingEngine(uint32_t instanceCount, VkFormat compositeFormat, uint32_t reserveCells,
                                 bool hasLevels)
    : compositeFormat_(compositeFormat) {
  FrothContextInfo info = sharedHost().contextInfo();
  info.getInstanceProcAddr = CommandStream::getInstanceProcAddr;
  info.onMessage = [](void*, FrothSeverity, FrothResult, const char* object, const char* text) {
    ADD_FAILURE() << object << ": " << text;
  };
  info.lensClasses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
  info.walkShaders = 1;
  info.reactiveImages = 1;
  info.compositeFormat = compositeFormat;
  info.depthExportFormat = kDepthFormat;
  check(frothCreateContext(&info, &context_), "frothCreateContext");
  bytes_ = *encodeAsset(hasLevels ? makeLevelSample() : makeSampleAsset({.chunkCount = 2, .localBits = 16}));
  auto asset = makeStruct<FrothAssetInfo>();
  asset.data = bytes_.data();
  asset.dataSize = bytes_.size();
  asset.bytesStay = 1;
  asset.prepareRays = hasLevels ? FROTH_PREPARE_RADIANCE : FROTH_PREPARE_NOTHING;
  check(frothOpenAsset(context_, &asset, &asset_), "frothOpenAsset");
  auto streaming = makeStruct<FrothStreamInfo>();
  streaming.detail = 1e9f;  // level 0, from wherever the camera is
  check(frothSetStreaming(context_, &streaming), "frothSetStreaming");
  instances_.resize(instanceCount);
  for (FrothInstance& instance : instances_) {
    auto placement = makeStruct<FrothInstanceInfo>();
    placement.asset = asset_;
    placement.mask = 1;
    check(frothCreateInstance(context_, &placement, &instance), "frothCreateInstance");
  }
  const FrothViewInfo view{sizeof(FrothViewInfo), kExtent, 1, info.lensClasses,           1, 2,
                           reserveCells,          {},      1, hasLevels ? kFadeFrames : 0};
  check(frothCreateView(context_, &view, &view_), "frothCreateView");
}

RecordingEngine::~RecordingEngine() {
  check(frothDestroyView(context_, view_), "frothDestroyView");
  for (const FrothInstance instance : instances_) {
    check(frothDestroyInstance(context_, instance), "frothDestroyInstance");
  }
  check(frothCloseAsset(context_, asset_), "frothCloseAsset");
  check(frothDestroyContext(context_, UINT64_MAX), "frothDestroyContext");
}

// Read by copies in the frame before and after the runtime wrote it.
FrothImage RecordingEngine::output(VkFormat format) {
  FrothImage image{};
  image.image = reinterpret_cast<VkImage>(++images_);
  image.view = reinterpret_cast<VkImageView>(images_);
  stream.nameView(image.view, image.image);
  image.format = format;
  image.extent = kExtent;
  image.layoutIn = VK_IMAGE_LAYOUT_UNDEFINED;
  image.layoutOut = VK_IMAGE_LAYOUT_GENERAL;
  image.stageIn = image.stageOut = kCopy;
  image.accessOut = kCopyRead;
  use(image, kCopy, kCopyRead, false);
  return image;
}

// Written by a copy in this frame, and in the next one.
FrothImage RecordingEngine::input(VkFormat format) {
  FrothImage image = output(format);
  image.layoutIn = image.layoutOut = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  image.accessIn = image.accessOut = kCopyWrite;
  stream.hazards.wait({kCopy, kCopyRead, kCopy, kCopyWrite});
  use(image, kCopy, kCopyWrite, true);
  return image;
}

void RecordingEngine::use(const FrothImage& image, VkPipelineStageFlags2 stage, VkAccessFlags2 access, bool isWrite) {
  stream.hazards.use(CommandStream::rangeOf(image.image), {stage, access, isWrite, false, 0, "the engine"});
}

FrothRenderInfo RecordingEngine::renderInfo(const FrameForm& form, uint32_t eye) {
  auto info = makeStruct<FrothRenderInfo>();
  info.eye = eye;
  aim(info.camera, form.camera);
  info.mask = form.isEmpty ? 2 : 0;
  info.colour = output(form.colour);
  if (form.camera == CameraKind::kRayMap) info.camera.lens.rayMap = input(VK_FORMAT_R32G32B32A32_SFLOAT);
  info.depth = output(VK_FORMAT_R32_SFLOAT);
  if (!form.isFull) return info;
  info.distance = output(VK_FORMAT_R32_SFLOAT);
  info.normal = output(VK_FORMAT_R16G16B16A16_SFLOAT);
  info.id = output(VK_FORMAT_R32G32_UINT);
  info.sceneDepth = input(VK_FORMAT_R32_SFLOAT);
  if (form.camera == CameraKind::kRayMap) return info;
  info.motion = output(VK_FORMAT_R16G16_SFLOAT);
  info.reactive = output(VK_FORMAT_R8_UNORM);
  aim(info.previousCamera, form.camera);
  return info;
}

void RecordingEngine::readOutputs(const FrothRenderInfo& info) {
  FrothRenderInfo given = info;
  for (const FrothImage* image : outputsOf(given)) {
    if (image->image) use(*image, kCopy, kCopyRead, false);
  }
  for (const FrothImage& image : {info.sceneDepth, info.camera.lens.rayMap}) {
    if (image.image) use(image, kCopy, kCopyWrite, true);
  }
}

// A fragment shader of the engine's walks rays too.
void RecordingEngine::recordRays() {
  const auto info = makeStruct<FrothWalkInfo>();
  VkDescriptorSet set = VK_NULL_HANDLE;
  check(frothRecordWalkSet(context_, kCommands, &info, &set), "frothRecordWalkSet");
  stream.hazards.use(stream.sets[set][0].range, {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_UNIFORM_READ_BIT,
                                                 false, false, 0, "the engine's shader"});
  for (const FrothRayKind kind : {FROTH_RAY_TRANSMITTANCE, FROTH_RAY_CLOSEST, FROTH_RAY_RADIANCE}) {
    check(frothRecordRays(context_, kCommands, kRays, kHits + 65536 * kind, 8, kind), "frothRecordRays");
  }
  stream.hazards.wait({VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                       VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT},
                      {kHits, kHits + 4 * 65536});  // the engine's, before the next frame writes them
}

// What comes over the engine's own picture.
void RecordingEngine::recordOver(const FrothRenderInfo& info, bool isProjection) {
  const auto asInput = [](FrothImage image) {
    image.layoutIn = VK_IMAGE_LAYOUT_GENERAL;
    image.stageIn = kCopy;
    image.accessIn = kCopyRead;
    return image;
  };
  auto composite = makeStruct<FrothCompositeInfo>();
  composite.eye = info.eye;
  composite.foam = asInput(info.colour);
  composite.target = input(compositeFormat_);
  composite.shadowFactor = input(VK_FORMAT_R32_SFLOAT);
  check(frothRecordComposite(context_, view_, kCommands, &composite), "frothRecordComposite");
  use(composite.target, kCopy, kCopyWrite, true);
  use(composite.shadowFactor, kCopy, kCopyWrite, true);
  use(composite.foam, kCopy, kCopyRead, false);
  if (!isProjection) return;
  auto depth = makeStruct<FrothDepthExportInfo>();
  depth.eye = info.eye;
  depth.depth = asInput(info.depth);
  depth.attachment = input(kDepthFormat);
  check(frothRecordDepthExport(context_, view_, kCommands, &depth), "frothRecordDepthExport");
  use(depth.attachment, kCopy, kCopyWrite, true);
  use(depth.depth, kCopy, kCopyRead, false);
}

void RecordingEngine::recordFrame(const FrameForm& form) {
  auto frame = makeStruct<FrothFrame>();
  frame.serial = ++serial_;
  frame.completedSerial = serial_ < 2 ? 0 : serial_ - 2;
  stream.complete(frame.completedSerial);
  stream.hazards.beginFrame(serial_);
  auto status = makeStruct<FrothFrameStatus>();
  check(frothUpdate(context_, &frame, &status), "frothUpdate");
  images_ = 0;  // the same in each frame
  check(frothRecordUpload(context_, kCommands), "frothRecordUpload");
  auto asset = makeStruct<FrothAssetStatus>();
  check(frothGetAssetStatus(context_, asset_, &asset), "frothGetAssetStatus");
  if (asset.state != FROTH_ASSET_READY) return;
  recordRays();
  for (uint32_t eye = 0; eye < 2; ++eye) {
    const FrothRenderInfo raster = renderInfo(form, eye);
    EXPECT_GE(frothRecordRaster(context_, view_, kCommands, &raster), FROTH_OK);
    readOutputs(raster);
    recordOver(raster, form.camera == CameraKind::kProjection || form.camera == CameraKind::kParallel);
    const FrothRenderInfo walk = renderInfo(form, eye);
    EXPECT_GE(frothRecordWalk(context_, view_, kCommands, &walk), FROTH_OK);
    readOutputs(walk);
  }
}

}  // namespace froth::test
