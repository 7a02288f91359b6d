// Assets, instances, views: checked, made, described, given up.
#include "runtime/context/context.h"

#include <algorithm>
#include <cmath>

#include "runtime/context/info_checks.h"

namespace froth {
namespace {

constexpr double kUnitQuaternionTolerance = 1e-3;  // as for a camera's rotation

}  // namespace

// ---- Assets ----

FrothResult Context::openAsset(const FrothAssetInfo& info, FrothAsset& handle) {
  if (const FrothResult result = checkSource(messages, "frothOpenAsset", info); result != FROTH_OK) {
    return result;
  }
  const std::shared_ptr<Asset> asset = makeAsset(info);
  asset->awaitPrepared();
  handle = assets_.add(asset);
  return FROTH_OK;
}

std::shared_ptr<Asset> Context::makeAsset(const FrothAssetInfo& info) {
  auto asset = std::make_shared<Asset>(sourceOf(info), isNull_ ? nullptr : &device_);
  if (info.keepForQueries) asset->keepForQueries();
  if (!info.layersMayGo) asset->keepLayers();
  if (hasWalkShaders_) asset->keepForWalks(info.prepareRays);
  return asset;
}

// READY: this frame can draw it, for all copies stand in frames that are recorded and not dropped; or are complete, if
// they are submitted on their own.
FrothAssetState Context::stateOf(const Asset& asset) const {
  if (asset.hasFailed()) {
    return FROTH_ASSET_FAILED;
  }
  const uint64_t readable = hasUploadQueue_ ? completedUploadSerial_ : uploadSerial_;
  const bool isUploaded = asset.isStaged() && (!ring_ || ring_->isWithin(&asset, readable));
  const bool isReady = asset.isDecoded() && isUploaded && !asset.awaitsPrepared() && !isLost_;
  return isReady ? FROTH_ASSET_READY : FROTH_ASSET_OPENING;
}

FrothResult Context::describeAsset(FrothAsset handle, FrothAssetStatus& status) const {
  const Asset* asset = assets_.find(handle);
  if (!asset) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothGetAssetStatus", "asset {%u, %u}: closed or never opened",
                         handle.index, handle.generation);
  }
  status = asset->describe();
  status.state = stateOf(*asset);
  return FROTH_OK;
}

FrothResult Context::copyFlightPath(FrothAsset handle, uint32_t capacity, FrothStoredCamera* cameras,
                                    uint32_t& count) const {
  const Asset* asset = assets_.find(handle);
  if (!asset) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothGetFlightPath", "asset {%u, %u}: closed or never opened",
                         handle.index, handle.generation);
  }
  if (capacity > 0 && !cameras) {
    return messages.fail(FROTH_ERROR_ARGUMENT, "frothGetFlightPath", "cameras: null, with capacity %u", capacity);
  }
  const std::span<const FrothStoredCamera> path = asset->flightPath();
  std::copy_n(path.begin(), std::min<size_t>(capacity, path.size()), cameras);
  count = static_cast<uint32_t>(path.size());
  return FROTH_OK;
}

FrothResult Context::closeAsset(FrothAsset handle) {
  const Asset* asset = assets_.find(handle);
  if (!asset) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothCloseAsset", "asset {%u, %u}: closed or never opened", handle.index,
                         handle.generation);
  }
  uint32_t users = 0;
  instances_.forEach([&](const Instance& instance) { users += assets_.find(instance.asset) == asset; });
  if (users > 0) {
    return messages.fail(FROTH_ERROR_STATE, asset->name().c_str(), "%u instances still use it; destroy them first",
                         users);
  }
  if (exchange_ && isSame(exchange_->asset, handle)) {
    abandonExchange();
  }
  retired_.reserve(retired_.size() + 2);  // the asset, and one that was to replace it
  endReplacement(handle);
  std::erase_if(cuts_, [&](const auto& cut) { return isSame(cut.first, handle); });
  levels_.remove(handle);
  dropAsset(assets_.remove(handle));
  return FROTH_OK;
}

FrothResult Context::completeRead(uint64_t request, FrothResult result) {
  const auto number = static_cast<unsigned long long>(request);
  if (result > 0) {
    return messages.fail(FROTH_ERROR_ARGUMENT, "frothCompleteRead",
                         "result: %s (%d) answers nothing; give FROTH_OK or an error, when request %llu is done",
                         frothResultName(result), result, number);
  }
  return reads_.complete(request, result)
             ? FROTH_OK
             : messages.fail(FROTH_ERROR_HANDLE, "frothCompleteRead",
                             "request %llu: it is answered already, or was never made; answer each once", number);
}

// ---- Instances ----

FrothResult Context::readPlacement(const FrothInstanceInfo& info, const char* call, Instance& instance) const {
  if (!assets_.find(info.asset)) {
    return messages.fail(FROTH_ERROR_HANDLE, call, "asset {%u, %u}: closed or never opened", info.asset.index,
                         info.asset.generation);
  }
  double length = 0;
  for (const float part : info.rotation) {
    length += double{part} * part;
  }
  if (length != 0 && !(std::abs(length - 1) <= kUnitQuaternionTolerance)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "rotation: a quaternion of squared length %g; normalize it",
                         length);
  }
  if (!(info.scale >= 0) || !std::isfinite(info.scale)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "scale: %g; must be positive, or 0 for 1", double{info.scale});
  }
  if (!(info.exposure >= 0) || !std::isfinite(info.exposure)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "exposure: %g; must be positive, or 0 for 1",
                         double{info.exposure});
  }
  for (const double part : info.position) {
    if (!std::isfinite(part)) {
      return messages.fail(FROTH_ERROR_ARGUMENT, call, "position: %g; must be finite", part);
    }
  }
  instance.asset = info.asset;
  std::copy_n(info.position, 3, instance.placement.position.begin());
  if (length != 0) {
    std::copy_n(info.rotation, 4, instance.placement.rotation.begin());
  } else {
    instance.placement.rotation = {0, 0, 0, 1};
  }
  instance.placement.scale = info.scale == 0 ? 1 : info.scale;
  instance.placement.userId = info.userId;
  instance.placement.exposure = info.exposure == 0 ? 1 : info.exposure;
  instance.mask = info.mask == 0 ? ~0u : info.mask;
  return FROTH_OK;
}

FrothResult Context::createInstance(const FrothInstanceInfo& info, FrothInstance& handle) {
  auto instance = std::make_unique<Instance>();
  const FrothResult result = readPlacement(info, "frothCreateInstance", *instance);
  if (result == FROTH_OK) {
    instance->movedAfter = drawnSerial_;
    handle = instances_.add(std::move(instance));
  }
  return result;
}

FrothResult Context::setInstance(FrothInstance handle, const FrothInstanceInfo& info) {
  Instance* instance = instances_.find(handle);
  if (!instance) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothSetInstance", "instance {%u, %u}: destroyed or never created",
                         handle.index, handle.generation);
  }
  const RenderInstance old = instance->placement;
  const FrothResult result = readPlacement(info, "frothSetInstance", *instance);
  if (result == FROTH_OK && instance->movedAfter != drawnSerial_) {
    instance->before = old;
    instance->movedAfter = drawnSerial_;
  }
  if (result == FROTH_OK && info.hasJumped) {
    instance->before.reset();
  }
  return result;
}

FrothResult Context::destroyInstance(FrothInstance handle) {
  if (!instances_.find(handle)) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothDestroyInstance", "instance {%u, %u}: destroyed or never created",
                         handle.index, handle.generation);
  }
  instances_.remove(handle);
  return FROTH_OK;
}

// ---- Views ----

FrothResult Context::createView(const FrothViewInfo& info, FrothView& handle) {
  if (const FrothResult result = checkExtent(messages, "frothCreateView", info.maxExtent); result != FROTH_OK) {
    return result;
  }
  if ((info.lensClasses & ~lensClasses_) != 0) {
    return messages.fail(FROTH_ERROR_ARGUMENT, "frothCreateView",
                         "lensClasses: %#x, but the context was made for %#x; raise FrothContextInfo::lensClasses",
                         info.lensClasses, lensClasses_);
  }
  if (info.keepsReactive && !hasReactiveImages_) {
    return messages.fail(FROTH_ERROR_ARGUMENT, "frothCreateView",
                         "keepsReactive: %u, but the context was made without; set FrothContextInfo::reactiveImages",
                         info.keepsReactive);
  }
  if (info.eyeCount > kMostEyes) {
    return messages.fail(FROTH_ERROR_ARGUMENT, "frothCreateView", "eyeCount: %u; at most %u", info.eyeCount, kMostEyes);
  }
  if (info.fadeFrames > kMostFadeFrames) {
    return messages.fail(FROTH_ERROR_ARGUMENT, "frothCreateView", "fadeFrames: %u; at most %u", info.fadeFrames,
                         kMostFadeFrames);
  }
  auto view = std::make_unique<View>();
  view->maxExtent = info.maxExtent;
  view->eyeCount = info.eyeCount == 0 ? 1 : info.eyeCount;
  view->lensClasses = info.lensClasses;
  view->fadeFrames = info.fadeFrames;
  view->measurePasses = info.measurePasses != 0;
  view->keepsReactive = info.keepsReactive != 0;
  view->keepsHits = info.keepsHits != 0 || view->keepsReactive;
  view->reservedCells = info.reserveCells == 0 ? kReservedCells : info.reserveCells;
  const View* like = views_.find(info.startLike);
  if (!like && info.startLike.generation != 0) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothCreateView", "startLike: view {%u, %u}: destroyed or never created",
                         info.startLike.index, info.startLike.generation);
  }
  if (const Status status = createRenderer(*view); !status) {
    return messages.fail(status.error(), "frothCreateView");
  }
  if (like && like->renderer && view->renderer) {
    view->renderer->startLike(*like->renderer);
  }
  for (uint32_t eye = 0; like && eye < std::min(view->eyeCount, like->eyeCount); ++eye) {
    view->eyes[eye].seenFrom = like->eyes[eye].seenFrom;  // what it wants of levels before it draws
  }
  View& added = *view;
  handle = views_.add(std::move(view));
  try {
    prepareView(handle, added);  // room for what is there is made here, and not in the next frame
  } catch (...) {
    views_.remove(handle);
    handle = {};
    throw;
  }
  return FROTH_OK;
}

Status Context::createRenderer(View& view) {
  if (!device_.device) {
    return {};
  }
  const bool canMeasure = device_.timestampBits != 0;
  if (view.measurePasses && !canMeasure) {
    messages.warn(
        FROTH_ERROR_FEATURE, "view",
        "measurePasses: the context's queue family has 0 timestampValidBits; FrothViewStatus::passes stays empty");
  }
  view.breadcrumbs.reset();
  if (hasBreadcrumbs_) {
    Result<std::unique_ptr<Breadcrumbs>> breadcrumbs = Breadcrumbs::create(
        device_, framesInFlight_, view.fadeFrames > 0 ? kFadingRecordingsPerFrame : kRecordingsPerFrame);
    if (!breadcrumbs) {
      return breadcrumbs.error();
    }
    view.breadcrumbs = std::move(*breadcrumbs);
  }
  const GpuAsset* firstAsset = nullptr;
  instances_.forEach([&](const Instance& instance) {
    const Asset* asset = assets_.find(instance.asset);
    if (!firstAsset && asset->isDecoded()) firstAsset = &asset->gpu();
  });
  Result<std::unique_ptr<ViewRenderer>> renderer =
      ViewRenderer::create(device_, {.maxExtent = view.maxExtent,
                                     .lensClasses = view.lensClasses,
                                     .framesInFlight = framesInFlight_,
                                     .measurePasses = view.measurePasses && canMeasure,
                                     .keepsHits = view.keepsHits && hasExtendedFormats_,
                                     .keepsReactive = view.keepsReactive && hasExtendedFormats_,
                                     .fades = view.fadeFrames > 0,
                                     .composites = compositeFormat_ != VK_FORMAT_UNDEFINED,
                                     .exportsDepth = depthExportFormat_ != VK_FORMAT_UNDEFINED,
                                     .breadcrumbs = view.breadcrumbs.get(),
                                     .reservedCells = view.reservedCells,
                                     .firstAsset = firstAsset});
  if (!renderer) {
    return renderer.error();
  }
  view.renderer = std::move(*renderer);
  return {};
}

FrothResult Context::describeView(FrothView handle, FrothViewStatus& status) const {
  const View* view = views_.find(handle);
  if (!view) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothGetViewStatus", "view {%u, %u}: destroyed or never created",
                         handle.index, handle.generation);
  }
  status = view->renderer ? view->renderer->status() : FrothViewStatus{};
  for (const auto& [serial, bits] : view->bits) {
    status.bits |= serial == status.serial ? bits : 0;
  }
  return FROTH_OK;
}

FrothResult Context::listBreadcrumbs(uint32_t capacity, FrothBreadcrumb* breadcrumbs, uint32_t& count) const {
  constexpr const char* kCall = "frothGetBreadcrumbs";
  if (!hasBreadcrumbs_) {
    return messages.fail(FROTH_ERROR_UNSUPPORTED, kCall,
                         "the context was not made for them; set FrothContextInfo::breadcrumbs");
  }
  if (capacity > 0 && !breadcrumbs) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "breadcrumbs: null, with capacity %u", capacity);
  }
  count = 0;
  views_.forEachNamed([&](FrothView handle, const View& view) {
    if (view.breadcrumbs) view.breadcrumbs->list(handle, capacity, breadcrumbs, count);
  });
  return FROTH_OK;
}

FrothResult Context::destroyView(FrothView handle) {
  if (!views_.find(handle)) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothDestroyView", "view {%u, %u}: destroyed or never created",
                         handle.index, handle.generation);
  }
  retired_.reserve(retired_.size() + 1);
  retire(views_.remove(handle));
  return FROTH_OK;
}

}  // namespace froth
