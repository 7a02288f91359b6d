// The calls of a frame: update, upload, draw.
#include <algorithm>

#include "runtime/context/context.h"
#include "runtime/context/render_info.h"
#include "runtime/render/device_depth.h"
#include "runtime/render/frame_images.h"
#include "runtime/render/hit_block.h"

namespace froth {

FrothResult Context::checkUploadSerials(const FrothFrame& frame) const {
  constexpr const char* kCall = "frothUpdate";
  const auto serial = static_cast<unsigned long long>(frame.uploadSerial);
  const auto completed = static_cast<unsigned long long>(frame.completedUploadSerial);
  if (!hasUploadQueue_) {
    return serial == 0 && completed == 0
               ? FROTH_OK
               : messages.fail(FROTH_ERROR_ARGUMENT, kCall,
                               "uploadSerial: %llu, completedUploadSerial: %llu; uploads of this context stand in its "
                               "frames; leave both 0, or set FrothContextInfo::hasUploadQueue",
                               serial, completed);
  }
  const uint64_t newest = ring_ ? ring_->newestInFlight() : 0;
  if (frame.uploadSerial <= newest) {
    return messages.fail(FROTH_ERROR_STATE, kCall,
                         "uploadSerial: %llu, and uploads were recorded for %llu; must be above it, and above 0",
                         serial, static_cast<unsigned long long>(newest));
  }
  if (frame.completedUploadSerial >= frame.uploadSerial || frame.completedUploadSerial < completedUploadSerial_) {
    return messages.fail(FROTH_ERROR_STATE, kCall,
                         "completedUploadSerial: %llu, with uploadSerial %llu, after %llu; must be below uploadSerial "
                         "and never shrink",
                         completed, serial, static_cast<unsigned long long>(completedUploadSerial_));
  }
  return FROTH_OK;
}

FrothResult Context::beginFrame(const FrothFrame& frame) {
  constexpr const char* kCall = "frothUpdate";
  if (frame.serial <= serial_) {
    return messages.fail(FROTH_ERROR_STATE, kCall, "serial: %llu after %llu; serials must grow",
                         static_cast<unsigned long long>(frame.serial), static_cast<unsigned long long>(serial_));
  }
  if (frame.completedSerial >= frame.serial || frame.completedSerial < completedSerial_) {
    return messages.fail(FROTH_ERROR_STATE, kCall,
                         "completedSerial: %llu, in frame %llu, after %llu; must be below the frame's and never shrink",
                         static_cast<unsigned long long>(frame.completedSerial),
                         static_cast<unsigned long long>(frame.serial),
                         static_cast<unsigned long long>(completedSerial_));
  }
  if (const FrothResult result = checkUploadSerials(frame); result != FROTH_OK) {
    return result;
  }
  std::erase_if(serialsInFlight_, [&](uint64_t serial) { return serial <= frame.completedSerial; });
  if (serialsInFlight_.size() >= framesInFlight_) {
    return messages.fail(FROTH_ERROR_STATE, kCall,
                         "completedSerial: %llu leaves %zu frames in flight, the context was made for %u; wait for the "
                         "oldest, or raise FrothContextInfo::framesInFlight",
                         static_cast<unsigned long long>(frame.completedSerial), serialsInFlight_.size() + 1,
                         framesInFlight_);
  }
  serialsInFlight_.push_back(frame.serial);
  serial_ = frame.serial;
  drawnBeforeSerial_ = drawnSerial_;
  completedSerial_ = frame.completedSerial;
  uploadSerial_ = hasUploadQueue_ ? frame.uploadSerial : frame.serial;
  completedUploadSerial_ = hasUploadQueue_ ? frame.completedUploadSerial : frame.completedSerial;
  uploadBytesLeft_ = frame.uploadBytes == 0 ? UINT64_MAX : frame.uploadBytes;
  loadMicroseconds_ = frame.loadMicroseconds;
  return FROTH_OK;
}

FrothResult Context::update(const FrothFrame& frame, FrothFrameStatus& status) {
  constexpr const char* kCall = "frothUpdate";
  if (const FrothResult result = checkDevice(kCall); result != FROTH_OK) {
    return result;
  }
  const uint64_t previousSerial = serial_, previousUploadSerial = uploadSerial_;
  if (const FrothResult result = beginFrame(frame); result != FROTH_OK) {
    return result;
  }
  const auto takeBack = [&] {  // the frame has not begun
    serialsInFlight_.pop_back();
    serial_ = previousSerial;
    uploadSerial_ = previousUploadSerial;
  };
  try {
    runFrame(status);
  } catch (...) {
    takeBack();
    throw;
  }
  if (const std::optional<Error> loss = device_.loss->error()) {
    takeBack();
    return messages.fail(*loss, kCall);
  }
  return FROTH_OK;
}

void Context::runFrame(FrothFrameStatus& status) {
  withMemoryJobs([&] {
    std::erase_if(retired_, [&](const auto& retired) { return retired.first <= completedSerial_; });
    if (ring_) {
      ring_->retire(completedUploadSerial_);
    }
    loadAssets();
    finishExchange();
    finishReplacements();
    prepareMerging();
    prepareRayForms();
    shrinkViews();
    isViewRefused_ = false;
    views_.forEachNamed([&](FrothView handle, View& view) { prepareView(handle, view); });
    prepareWalks();
    choosePrepared();
    chooseExchange();
  });

  assets_.forEach([&](const Asset& asset) {
    status.assetsOpening += stateOf(asset) == FROTH_ASSET_OPENING;
    status.uploadBytesQueued += asset.queuedBytes();
  });
  status.uploadBytesQueued += exchange_ ? exchange_->successor->queuedBytes() : 0;
  for (const Replacement& replacement : replacements_) {
    status.uploadBytesQueued += replacement.successor ? replacement.successor->queuedBytes() : 0;
  }
  status.uploadBytesQueued += ring_ ? ring_->stagedBytes() : 0;
  status.deviceBytes = device_.ledger.deviceBytes();
  status.hostBytes = device_.ledger.hostBytes();
  status.excessBytes = device_.excessBytes();
  status.waitUploadSerial = hasUploadQueue_ ? completedUploadSerial_ : 0;
}

bool Context::isDone(uint64_t completedSerial) const {
  const bool isAllDone = completedSerial == UINT64_MAX;
  if (hasUploadQueue_ && !isAllDone && ring_ && ring_->newestInFlight() != 0) {
    return false;
  }
  return std::all_of(serialsInFlight_.begin(), serialsInFlight_.end(),
                     [&](uint64_t serial) { return serial <= completedSerial; });
}

void Context::retire(std::shared_ptr<void> object) {
  if (object) {
    retired_.emplace_back(serial_, std::move(object));
  }
}

void Context::loadAssets() {
  LoadLimit limit = jobs_.hasThreads()       ? LoadLimit::none()
                    : loadMicroseconds_ != 0 ? LoadLimit::ofTime(loadMicroseconds_)
                                             : LoadLimit::ofWork();
  const auto prepare = [this](const AssetShape& shape) { return prepareShape(shape); };
  assets_.forEach([&](Asset& asset) {
    retired_.reserve(retired_.size() + 2);
    asset.load(jobs_, reads_, limit, prepare, messages);
    if (asset.hasFailed() && ring_) {
      const std::shared_ptr<GpuArena> targets = asset.releaseBuffers();
      asset.forgetCopies(*ring_, targets);
      retire(targets);
      retire(asset.releasePrepared());
    }
  });
  loadSuccessor(limit, prepare);
  loadReplacements(limit, prepare);
  updateLevels();
  // Their room is for other jobs, whether an asset still waits for them or not: whoever does finds the pipelines, or
  // asks for them again.
  std::erase_if(making_, [](const auto& made) { return made.second.hasEnded(); });
}

void Context::prepareView(FrothView handle, View& view) {
  if (!view.renderer) {
    return;
  }
  std::erase_if(view.bits, [&](const auto& recorded) { return recorded.first < view.renderer->status().serial; });
  view.bits.reserve(view.bits.size() + 2 * kMostEyes);  // a raster and a walk of each
  view.prepared.clear();
  instances_.forEachNamed([&](FrothInstance name, const Instance& instance) {
    const Asset* asset = assets_.find(instance.asset);
    if (asset->isDecoded() && view.prepared.size() < gpu::kMostInstances) {
      view.prepared.push_back(instance.placement);
      view.prepared.back().handle = name;
      view.prepared.back().asset = &asset->gpu();
    }
  });
  view.visible.reserve(gpu::kMostInstances);
  view.visibleBefore.reserve(gpu::kMostInstances);
  const Status status = view.renderer->prepare(completedSerial_, view.prepared);
  if (status || device_.loss->isTold()) {  // of the loss frothUpdate tells
    view.preparationError.reset();
    return;
  }
  // The view keeps the buffers it had: it goes on drawing what they hold.
  if (isPending(status)) return;
  isViewRefused_ = true;
  if (isPreparedInTheWay()) return;
  const ToldError told{status.error().kind, device_.budget};
  if (view.preparationError == told) return;  // once, not in every frame
  view.preparationError = told;
  messages.fail(resultOf(status.error()), "view", "view {%u, %u}, %s", handle.index, handle.generation,
                status.error().message.c_str());
}

FrothResult Context::recordUpload(VkCommandBuffer commandBuffer) {
  if (serial_ == 0) {
    return messages.fail(FROTH_ERROR_STATE, "frothRecordUpload", "no frame; call frothUpdate first");
  }
  if (const FrothResult result = checkDevice("frothRecordUpload"); result != FROTH_OK || isNull_) {
    return result;
  }
  if (!commandBuffer) {
    return messages.fail(FROTH_ERROR_ARGUMENT, "frothRecordUpload", "commandBuffer: null");
  }
  const uint64_t waiting = std::min(ring_->stagedBytes(), uploadBytesLeft_);
  uint64_t room = uploadBytesLeft_ - waiting;
  assets_.forEach([&](Asset& asset) { room -= asset.stage(*ring_, room); });
  if (exchange_) room -= exchange_->successor->stage(*ring_, room);
  for (const Replacement& replacement : replacements_) {
    if (replacement.successor) room -= replacement.successor->stage(*ring_, room);
  }
  const uint64_t recorded = ring_->record(commandBuffer, uploadSerial_, uploadBytesLeft_);
  uploadBytesLeft_ -= recorded;
  if (recorded == 0 || hasUploadQueue_) {
    return FROTH_OK;  // the semaphore of such uploads orders them before the frames that wait for it
  }
  device_.table.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
  return FROTH_OK;
}

FrothResult Context::dropFrame(uint64_t serial) {
  const auto found = std::find(serialsInFlight_.begin(), serialsInFlight_.end(), serial);
  if (found == serialsInFlight_.end()) {
    return messages.fail(FROTH_ERROR_STATE, "frothDropFrame", "serial: %llu is complete, dropped already, or unknown",
                         static_cast<unsigned long long>(serial));
  }
  serialsInFlight_.erase(found);
  if (ring_ && !hasUploadQueue_) {
    ring_->drop(serial);
  }
  views_.forEach([&](View& view) {
    if (view.renderer) {
      view.renderer->dropFrame(serial);
    }
  });
  if (walks_) {
    walks_->dropFrame(serial);
  }
  assets_.forEach([&](Asset& asset) { asset.dropFrame(serial); });
  return FROTH_OK;
}

FrothResult Context::dropUpload(uint64_t uploadSerial) {
  constexpr const char* kCall = "frothDropUpload";
  if (!hasUploadQueue_) {
    return messages.fail(FROTH_ERROR_STATE, kCall,
                         "uploads of this context stand in its frames; call frothDropFrame for the frame");
  }
  if (uploadSerial <= completedUploadSerial_ || uploadSerial > uploadSerial_) {
    return messages.fail(
        FROTH_ERROR_STATE, kCall,
        "uploadSerial: %llu; only what lies above the last completedUploadSerial, %llu, and was begun, "
        "up to %llu, can be dropped",
        static_cast<unsigned long long>(uploadSerial), static_cast<unsigned long long>(completedUploadSerial_),
        static_cast<unsigned long long>(uploadSerial_));
  }
  if (ring_) {
    ring_->drop(uploadSerial);
  }
  return FROTH_OK;
}

// What the images of hits need of the device and the view.
FrothResult Context::checkHits(const View& view, const FrothRenderInfo& info, const char* call) const {
  if (!wantsHits(info)) {
    return FROTH_OK;
  }
  if (!isNull_ && !hasExtendedFormats_) {
    return messages.fail(
        FROTH_ERROR_FEATURE, call,
        "id, motion, reactive: the device was made without shaderStorageImageExtendedFormats; enable it where "
        "frothGetRequirements says that it is present");
  }
  if (info.reactive.image && !(view.keepsReactive && hasReactiveImages_)) {  // a restored device may lack them
    return messages.fail(FROTH_ERROR_UNSUPPORTED, call,
                         "reactive: the view was not made for it; set FrothViewInfo::keepsReactive and "
                         "FrothContextInfo::reactiveImages");
  }
  return view.keepsHits ? FROTH_OK
                        : messages.fail(FROTH_ERROR_UNSUPPORTED, call,
                                        "id, motion: the view was not made for them; set FrothViewInfo::keepsHits");
}

void Context::gatherVisible(View& view, const FrothRenderInfo& info, uint32_t& bits) const {
  view.visible.clear();
  instances_.forEachNamed([&](FrothInstance handle, const Instance& instance) {
    if ((instance.mask & info.mask) == 0) {
      return;
    }
    const Asset& asset = *assets_.find(instance.asset);
    if (stateOf(asset) != FROTH_ASSET_READY) {
      bits |= FROTH_VIEW_NOT_READY;
      return;
    }
    if (isNull_) {
      return;
    }
    // An instance that came after frothUpdate: the view has no buffers for it before the next one.
    const auto isIt = [&](const RenderInstance& prepared) {
      return isSame(prepared.handle, handle) && prepared.asset == &asset.gpu();
    };
    if (std::none_of(view.prepared.begin(), view.prepared.end(), isIt)) {
      bits |= view.prepared.size() == gpu::kMostInstances ? FROTH_VIEW_INSTANCE_LIMIT : FROTH_VIEW_NOT_READY;
      return;
    }
    RenderInstance& visible = view.visible.emplace_back(instance.placement);
    visible.handle = handle;
    visible.asset = &asset.gpu();
    if (asset.lacksLayers()) bits |= FROTH_VIEW_FEWER_LAYERS;
    const bool hasMoved = instance.movedAfter == drawnBeforeSerial_ && instance.before;
    visible.previous = hasMoved ? &*instance.before : nullptr;
    resolveNearLimits(info, visible);
  });
}

FrothResult Context::checkEye(const View& view, uint32_t eye, const char* call) const {
  return eye < view.eyeCount
             ? FROTH_OK
             : messages.fail(FROTH_ERROR_ARGUMENT, call, "eye: %u, and the view has %u; set FrothViewInfo::eyeCount",
                             eye, view.eyeCount);
}

FrothResult Context::render(RenderMethod method, FrothView handle, VkCommandBuffer commandBuffer,
                            FrothRenderInfo info) {
  const char* call = callOf(method);
  View* view = views_.find(handle);
  if (!view) {
    return messages.fail(FROTH_ERROR_HANDLE, call, "view {%u, %u}: destroyed or never created", handle.index,
                         handle.generation);
  }
  if (const FrothResult result = checkDevice(call); result != FROTH_OK) {
    return result;
  }
  if (serial_ == 0) {
    return messages.fail(FROTH_ERROR_STATE, call, "no frame; call frothUpdate first");
  }
  if (const FrothResult result = checkEye(*view, info.eye, call); result != FROTH_OK) {
    return result;
  }
  Eye& eye = view->eyes[info.eye];
  uint64_t& renderedSerial = eye.renderedSerials[static_cast<size_t>(method)];
  if (renderedSerial == serial_) {
    return messages.fail(FROTH_ERROR_STATE, call, "view {%u, %u}: already drawn in frame %llu; call frothUpdate first",
                         handle.index, handle.generation, static_cast<unsigned long long>(serial_));
  }
  if (const FrothResult result = resolveRenderInfo(messages, call, view->maxExtent, view->lensClasses, info);
      result != FROTH_OK) {
    return result;
  }
  if (const FrothResult result = checkHits(*view, info, call); result != FROTH_OK) {
    return result;
  }
  eye.drawn = {info.camera.scissor, info.camera.lens.kind == FROTH_LENS_PROJECTION, isDepthReversed(info.camera)};
  eye.seenFrom = seenFrom(info);
  uint32_t bits = 0;
  gatherVisible(*view, info, bits);
  if (isNull_) {
    return FROTH_OK;
  }
  if (!commandBuffer) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "commandBuffer: null");
  }
  renderedSerial = serial_;
  drawnSerial_ = serial_;
  bits |= recordView(method, *view, commandBuffer, info);
  if (bits != 0) {
    view->bits.emplace_back(serial_, bits);
  }
  return bits == 0 ? FROTH_OK : FROTH_INCOMPLETE;
}

}  // namespace froth
