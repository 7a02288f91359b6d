#include "tests/faults/engine.h"
#include "host/make_struct.h"

#include <cstring>

#include <gtest/gtest.h>

#include "froth/froth_query.h"
#include "froth/froth_walk.h"
#include "tests/faults/host_faults.h"
#include "tests/faults/vulkan_faults.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent{24, 24};

// A call of the runtime, in which allocations may fail.
template <class Function, class... Args>
auto call(Function function, Args... args) {
  const HostFaults::Zone zone;
  return function(args...);
}

}  // namespace

Engine::~Engine() {
  if (host_) {
    host_->destroyImage(rasterImage_);
    host_->destroyImage(walkImage_);
  }
}

FrothContextInfo Engine::contextInfo() {
  auto info = makeStruct<FrothContextInfo>();
  if (host_) {
    info = host_->contextInfo();
    info.getInstanceProcAddr = VulkanFaults::getInstanceProcAddr;
  }
  info.abiVersion = FROTH_ABI_VERSION;
  info.onMessage = [](void* user, FrothSeverity severity, FrothResult code, const char*, const char* text) {
    const HostFaults::Pause pause;
    static_cast<Engine*>(user)->messages.push_back({severity, code, text});
  };
  info.messageUser = this;
  info.walkShaders = 1;
  info.breadcrumbs = 1;
  return info;
}

FrothReader Engine::reader() {
  auto reader = makeStruct<FrothReader>();
  reader.user = this;
  reader.size = bytes_.size();
  reader.read = [](void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
    const Engine& engine = *static_cast<Engine*>(user);
    std::memcpy(destination, engine.bytes_.data() + offset, size);
    EXPECT_EQ(frothCompleteRead(engine.context_, request, FROTH_OK), FROTH_OK);
  };
  return reader;
}

FrothResult Engine::start() {
  const FrothContextInfo info = contextInfo();
  return call(frothCreateContext, &info, &context_);
}

FrothResult Engine::makeObjects() {
  FrothResult result = FROTH_OK;
  if (asset_.generation == 0) {
    auto info = makeStruct<FrothAssetInfo>();
    const FrothReader fromReader = reader();
    if (source_ == Source::kReader) {
      info.reader = &fromReader;
    } else {
      info.data = bytes_.data();
      info.dataSize = bytes_.size();
      info.bytesStay = 1;
    }
    info.keepForQueries = 1;
    result = call(frothOpenAsset, context_, &info, &asset_);
  }
  if (result == FROTH_OK && instance_.generation == 0) {
    auto info = makeStruct<FrothInstanceInfo>();
    info.asset = asset_;
    result = call(frothCreateInstance, context_, &info, &instance_);
  }
  if (result == FROTH_OK && view_.generation == 0) {
    auto info = makeStruct<FrothViewInfo>();
    info.maxExtent = kExtent;
    info.measurePasses = 1;
    result = call(frothCreateView, context_, &info, &view_);
  }
  return result;
}

FrothRenderInfo Engine::renderInfo(const HostImage& image) const {
  auto info = makeStruct<FrothRenderInfo>();
  FrothCamera& camera = info.camera;
  camera.eye[2] = 1e6 - 1;  // where the sample lies
  camera.viewFromWorld[0] = camera.viewFromWorld[4] = camera.viewFromWorld[8] = 1;
  camera.clipFromView[0] = camera.clipFromView[5] = camera.clipFromView[11] = 1;
  camera.clipFromView[14] = 0.1f;
  camera.viewport = {0, 0, kExtent.width, kExtent.height, 0, 1};
  info.colour = host_ ? host_->describe(image) : FrothImage{};
  if (!host_) {  // checked, not used
    info.colour.image = reinterpret_cast<VkImage>(1);
    info.colour.view = reinterpret_cast<VkImageView>(1);
    info.colour.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    info.colour.extent = kExtent;
    info.colour.layoutOut = VK_IMAGE_LAYOUT_GENERAL;
    info.colour.stageIn = VK_PIPELINE_STAGE_2_COPY_BIT;
  }
  return info;
}

FrothResult Engine::recordFrame(VkCommandBuffer commands) {
  auto frame = makeStruct<FrothFrame>();
  frame.serial = serial_ + 1;
  frame.completedSerial = serial_;
  auto status = makeStruct<FrothFrameStatus>();
  FrothResult result = call(frothUpdate, context_, &frame, &status);
  if (result != FROTH_OK) return result;
  serial_ = frame.serial;
  result = call(frothRecordUpload, context_, commands);
  if (result != FROTH_OK) return result;
  const auto raysInfo = makeStruct<FrothWalkInfo>();
  VkDescriptorSet set = VK_NULL_HANDLE;
  result = call(frothRecordWalkSet, context_, commands, &raysInfo, &set);
  if (result < 0) return result;
  const FrothRenderInfo rasterInfo = renderInfo(rasterImage_), walkInfo = renderInfo(walkImage_);
  result = call(frothRecordRaster, context_, view_, commands, &rasterInfo);
  if (result < 0) return result;
  result = call(frothRecordWalk, context_, view_, commands, &walkInfo);
  if (result < 0) return result;
  auto viewStatus = makeStruct<FrothViewStatus>();
  return call(frothGetViewStatus, context_, view_, &viewStatus);
}

FrothResult Engine::drawFrame() {
  if (!host_) return recordFrame(nullptr);
  for (HostImage* image : {&rasterImage_, &walkImage_}) {
    if (!image->image) *image = *host_->createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
  }
  const uint64_t previousSerial = serial_;
  FrothResult result = FROTH_OK;
  const Status submitted = host_->submit([&](VkCommandBuffer commands, uint64_t) -> Status {
    result = recordFrame(commands);
    if (result < 0) return makeError(ErrorKind::kUnsupported, "not submitted");
    return {};
  });
  if (!submitted) {
    EXPECT_LT(result, 0) << submitted.error().message;
    if (serial_ != previousSerial) {  // begun, and will not be submitted
      EXPECT_EQ(frothDropFrame(context_, serial_), FROTH_OK);
    }
    return result;
  }
  raster = *host_->readImage(rasterImage_);
  walk = *host_->readImage(walkImage_);
  return result;
}

FrothResult Engine::query() {
  auto cast = makeStruct<FrothCastInfo>();
  FrothRay ray{};
  ray.origin[2] = 1e6 - 1;
  ray.direction[2] = 1;
  FrothRayHit hit;
  FrothResult result = call(frothCastRays, context_, &cast, &ray, &hit, 1);
  if (result != FROTH_OK) return result;
  auto location = makeStruct<FrothLocation>();
  result = call(frothLocate, context_, instance_, ray.origin, &location);
  if (result != FROTH_OK) return result;
  auto sphere = makeStruct<FrothSphere>();
  sphere.centre[2] = 1e6;
  sphere.radius = 1;
  auto contact = makeStruct<FrothContact>();
  return call(frothOverlapSphere, context_, &sphere, &contact);
}

bool Engine::isAssetReady() {
  auto status = makeStruct<FrothAssetStatus>();
  EXPECT_EQ(frothGetAssetStatus(context_, asset_, &status), FROTH_OK);
  if (status.state == FROTH_ASSET_FAILED) {
    EXPECT_EQ(status.error, messages.back().code);
    EXPECT_EQ(frothDestroyInstance(context_, instance_), FROTH_OK);
    EXPECT_EQ(frothCloseAsset(context_, asset_), FROTH_OK);
    instance_ = {};
    asset_ = {};
  }
  return status.state == FROTH_ASSET_READY;
}

bool Engine::recover(FrothResult result) {
  if (result == FROTH_ERROR_MEMORY) return true;  // nothing was changed: again
  if (result != FROTH_ERROR_DEVICE) return false;
  EXPECT_EQ(frothDeviceLost(context_), FROTH_OK);
  EXPECT_TRUE(VulkanFaults::live.empty()) << "nothing stays on a lost device";
  const FrothContextInfo info = contextInfo();
  return frothRestoreDevice(context_, &info) == FROTH_OK;
}

FrothResult Engine::stop() {
  FrothResult result = FROTH_OK;
  const auto finish = [&](FrothResult given, auto& handle) {
    if (given == FROTH_OK) handle = {};
    result = given;
    return given == FROTH_OK;
  };
  if (view_.generation != 0 && !finish(call(frothDestroyView, context_, view_), view_)) return result;
  if (instance_.generation != 0 && !finish(call(frothDestroyInstance, context_, instance_), instance_)) return result;
  if (asset_.generation != 0 && !finish(call(frothCloseAsset, context_, asset_), asset_)) return result;
  finish(call(frothDestroyContext, context_, UINT64_MAX), context_);
  return result;
}

}  // namespace froth::test
