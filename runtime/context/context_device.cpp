// What a context has of its device: making it, its memory budget, losing it.
#include <algorithm>

#include "runtime/context/context.h"
#include "runtime/context/info_checks.h"
#include "runtime/device/requirements.h"
#include "runtime/render/composite.h"

namespace froth {
namespace {

constexpr VkDeviceSize kStagingBytes = 16u << 20, kLeastStagingBytes = 64u << 10;
constexpr uint32_t kDefaultMostJobs = 4, kMaxMostJobs = 64;

// Views give up this part of what they can besides the excess, so that a few rounds reach the budget.
constexpr double kShrinkAhead = 1.0 / 64;

// While it lives allocations wait for a job, if the context has any.
struct OpenOrders {
  explicit OpenOrders(Device& of) : device(of) {
    if (device.orders) device.orders->open();
  }
  ~OpenOrders() {
    if (device.orders) device.orders->close(device.ledger);
  }
  Device& device;
};

}  // namespace

FrothResult Context::checkInfo(const FrothContextInfo& info, const char* call) const {
  if (info.abiVersion >> 16 != FROTH_ABI_VERSION >> 16) {
    return messages.fail(FROTH_ERROR_VERSION, call,
                         "abiVersion: 0x%08x, this library is 0x%08x; compile with the header of this library",
                         info.abiVersion, FROTH_ABI_VERSION);
  }
  if (const FrothResult result = checkFramesInFlight(messages, call, info.framesInFlight); result != FROTH_OK) {
    return result;
  }
  if (info.mostJobs > kMaxMostJobs) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "mostJobs: %u; at most %u", info.mostJobs, kMaxMostJobs);
  }
  if (info.stagingBytes != 0 && info.stagingBytes < kLeastStagingBytes) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "stagingBytes: %llu; at least %llu, or 0 for %llu",
                         static_cast<unsigned long long>(info.stagingBytes),
                         static_cast<unsigned long long>(kLeastStagingBytes),
                         static_cast<unsigned long long>(kStagingBytes));
  }
  if (!info.hasUploadQueue && info.uploadQueueFamily != 0) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "uploadQueueFamily: %u, and hasUploadQueue is 0; set it to 1, or leave both 0",
                         info.uploadQueueFamily);
  }
  if (!info.allocateMemory != !info.freeMemory) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "allocateMemory, freeMemory: one is null; set both or none");
  }
  if (info.compositeFormat != VK_FORMAT_UNDEFINED && !canComposite(info.compositeFormat)) {
    return messages.fail(FROTH_ERROR_UNSUPPORTED, call,
                         "compositeFormat: VkFormat %d; must be R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT or "
                         "B10G11R11_UFLOAT_PACK32",
                         info.compositeFormat);
  }
  if (!info.device) {
    return FROTH_OK;
  }
  const char* missing = !info.getInstanceProcAddr ? "getInstanceProcAddr"
                        : !info.instance          ? "instance"
                        : !info.physicalDevice    ? "physicalDevice"
                        : !info.enabledFeatures   ? "enabledFeatures"
                                                  : nullptr;
  if (missing) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s: null; a context on a device needs it", missing);
  }
  const FrothResult result = checkContextDevice(info, messages, call);
  return result == FROTH_OK ? checkEngineFormats(info, call) : result;
}

// What the passes into the engine's images need.
FrothResult Context::checkEngineFormats(const FrothContextInfo& info, const char* call) const {
  const bool isPacked = info.compositeFormat == VK_FORMAT_B10G11R11_UFLOAT_PACK32;
  if (isPacked && !info.enabledFeatures->features.shaderStorageImageExtendedFormats) {
    return messages.fail(FROTH_ERROR_FEATURE, call,
                         "compositeFormat: B10G11R11_UFLOAT_PACK32, and the device was made without "
                         "shaderStorageImageExtendedFormats; enable it, or use another format");
  }
  return info.depthExportFormat == VK_FORMAT_UNDEFINED ? FROTH_OK : checkDepthExportDevice(info, messages, call);
}

FrothResult Context::create(const FrothContextInfo& info, const char* call) {
  messages = {info.onMessage, info.messageUser};
  if (const FrothResult result = checkInfo(info, call); result != FROTH_OK) {
    return result;
  }
  framesInFlight_ = info.framesInFlight == 0 ? kDefaultFramesInFlight : info.framesInFlight;
  if (info.runJob) {
    jobs_ = JobRunner(info.runJob, info.jobUser, info.mostJobs == 0 ? kDefaultMostJobs : info.mostJobs);
  } else {
    jobs_ = JobRunner();
  }
  lensClasses_ = info.lensClasses;
  compositeFormat_ = info.compositeFormat;
  depthExportFormat_ = info.depthExportFormat;
  hasExtendedFormats_ = info.enabledFeatures && info.enabledFeatures->features.shaderStorageImageExtendedFormats;
  hasReactiveImages_ = info.reactiveImages != 0;
  hasWalkShaders_ = info.walkShaders != 0;
  hasUploadQueue_ = info.hasUploadQueue != 0;
  uploadSerial_ = completedUploadSerial_ = 0;
  hasBreadcrumbs_ = info.breadcrumbs != 0;
  isNull_ = !info.device;
  device_.budget = info.deviceBudget;
  const Status status = isNull_ ? Status() : createDeviceObjects(info);
  return status ? FROTH_OK : messages.fail(status.error(), call);
}

Status Context::createDeviceObjects(const FrothContextInfo& info) {
  Result<Device> device = Device::create(info.getInstanceProcAddr, info.instance, info.physicalDevice, info.device);
  if (!device) {
    return device.error();
  }
  device_ = *device;
  device_.budget = info.deviceBudget;
  device_.queueFamily = info.queueFamily;
  device_.uploadFamily = info.hasUploadQueue ? info.uploadQueueFamily : info.queueFamily;
  const VkQueueFamilyProperties family = queueFamilyOf(info);
  device_.timestampBits = family.timestampValidBits;
  device_.hasGraphics = (family.queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0;
  device_.callbacks = {info.allocateMemory, info.freeMemory, info.memoryUser};
  if (jobs_.hasThreads()) {
    device_.orders = std::make_shared<MemoryOrders>();
  }
  Result<std::unique_ptr<UploadRing>> ring =
      UploadRing::create(device_, info.stagingBytes == 0 ? kStagingBytes : info.stagingBytes);
  if (!ring) {
    return ring.error();
  }
  ring_ = std::move(*ring);
  Result<std::unique_ptr<RenderPipelines>> pipelines =
      RenderPipelines::create(device_, info.pipelineCache,
                              {.checkIndices = info.checkIndices != 0,
                               .countWork = info.countWork != 0,
                               .floatColours = info.floatColours != 0,
                               .lensClasses = lensClasses_,
                               .hasExtendedFormats = hasExtendedFormats_,
                               .keepsQuarters = hasReactiveImages_ && hasExtendedFormats_,
                               .compositeFormat = compositeFormat_,
                               .depthExportFormat = depthExportFormat_});
  if (!pipelines) {
    return pipelines.error();
  }
  pipelines_ = std::move(*pipelines);
  if (!hasWalkShaders_) {
    return {};
  }
  Result<std::unique_ptr<WalkSets>> walks =
      WalkSets::create(device_, info.pipelineCache, {info.checkIndices != 0, info.countWork != 0}, framesInFlight_);
  if (!walks) {
    return walks.error();
  }
  walks_ = std::move(*walks);
  return {};
}

// ---- Budget ----

void Context::setBudget(uint64_t bytes) {
  device_.budget = bytes;
  device_.ledger.restartPeaks();
  isExcessTold_ = false;
  assets_.forEach([](Asset& asset) { asset.refusePreparing(false); });
}

void Context::describeMemory(FrothMemoryReport& report) const {
  device_.ledger.describe(report);
  report.deviceBudget = device_.budget;
  if (ring_) {
    report.categories[static_cast<uint32_t>(MemoryUse::kUploadsHost)].used = ring_->usedBytes();
  }
}

VkDeviceSize Context::shrinkableBytes() const {
  VkDeviceSize bytes = 0;
  views_.forEach([&](const View& view) { bytes += view.renderer ? view.renderer->shrinkableBytes() : 0; });
  return bytes;
}

// Frames in flight use something that is gone already, or a job has to free it.
bool Context::isMemoryReturning() const {
  bool isReturning = !retired_.empty() || (device_.orders && device_.orders->isGivingBack());
  views_.forEach(
      [&](const View& view) { isReturning = isReturning || (view.renderer && view.renderer->isShrinking()); });
  return isReturning;
}

// What goes anyway goes first, then prepared cells; then all views give up the same part of what they can.
void Context::shrinkViews() {
  const VkDeviceSize excess = device_.excessBytes();
  if (excess == 0 || isMemoryReturning() || dropPrepared(excess)) {
    return;
  }
  if (const VkDeviceSize shrinkable = shrinkableBytes(); shrinkable > 0) {
    const double given = static_cast<double>(excess) / static_cast<double>(shrinkable) + kShrinkAhead;
    views_.forEach([&](const View& view) {
      if (view.renderer) view.renderer->shrink(std::max(0.0, 1 - given));
    });
  }
}

// ---- Memory by jobs ----

void Context::withMemoryJobs(const std::function<void()>& work) {
  takeMemory();
  {
    const OpenOrders orders(device_);
    work();
  }
  orderMemory();
}

// What the last job of memory has done.
void Context::takeMemory() {
  if (!memoryJob_.hasEnded()) {
    return;
  }
  if (const Result<Done> done = memoryJob_.take(); !done) {
    messages.fail(done.error(), "frothUpdate");
  }
  device_.orders->endBatch(device_.ledger);
}

void Context::orderMemory() {
  if (!device_.orders || memoryJob_.isUnderWay()) {
    return;
  }
  if (const std::shared_ptr<MemoryBatch> batch = device_.orders->startBatch()) {
    memoryJob_.start(jobs_, [device = &device_, batch] {
      device->run(*batch);
      return Result<Done>(Done());
    });
  }
}

// ---- Device loss ----

FrothResult Context::checkDevice(const char* call) const {
  return isLost_ ? messages.fail(FROTH_ERROR_DEVICE, call, "the device is lost; call frothRestoreDevice") : FROTH_OK;
}

// Jobs that use the device's objects have ended.
void Context::stopJobs() {
  merging_.job.drop(true);
  rayForms_.job.drop(true);
  for (auto& [shape, job] : making_) job.drop(true);
  making_.clear();
  assets_.forEach([](Asset& asset) { asset.stop(); });
  if (exchange_) exchange_->successor->stop();
  for (const Replacement& replacement : replacements_) {
    if (replacement.successor) replacement.successor->stop();
  }
  memoryJob_.drop(true);
  device_.finishOrders();
}

void Context::loseDevice() {
  stopJobs();
  views_.forEach([](View& view) {
    if (view.breadcrumbs) view.breadcrumbs->keep();
    view.renderer.reset();
    view.prepared.clear();
    view.preparationError.reset();
    view.bits.clear();
  });
  retired_.clear();
  exchange_.reset();
  for (Replacement& replacement : replacements_) {
    if (std::exchange(replacement.successor, nullptr)) replacement.error = FROTH_ERROR_DEVICE;
  }
  levels_.clear();
  assets_.forEach([](Asset& asset) {
    asset.releasePrepared();
    asset.releaseBuffers();
  });
  ring_.reset();
  walks_.reset();
  walkError_.clear();
  pipelines_.reset();
  device_.device = VK_NULL_HANDLE;
  serialsInFlight_.clear();
  isLost_ = true;
}

FrothResult Context::restoreDevice(const FrothContextInfo& info, const char* call) {
  if (!isLost_) {
    return messages.fail(FROTH_ERROR_STATE, call, "the device is not lost; call frothDeviceLost first");
  }
  if (isNull_ != !info.device) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "device: %s, and the context was made %s one",
                         info.device ? "not null" : "null", isNull_ ? "without" : "on");
  }
  FrothResult result = create(info, call);
  views_.forEach([&](View& view) {
    if (result == FROTH_OK) {
      const Status status = createRenderer(view);
      result = status ? FROTH_OK : messages.fail(status.error(), call);
    }
  });
  if (result != FROTH_OK) {
    loseDevice();
    return result;
  }
  isLost_ = false;
  // Without a device only the chunks that were on their way are gone.
  assets_.forEach([&](Asset& asset) {
    if (!isNull_ || asset.hasLevels()) asset.restart(messages);
  });
  return FROTH_OK;
}

}  // namespace froth
