// The calls that write into the engine's own images.
#include "runtime/core/context.h"
#include "runtime/core/image_checks.h"
#include "runtime/render/pipeline_state.h"

namespace froth {
namespace {

// Zero: all pixels of `image`. FROTH_OK: not empty, at an offset >= 0.
FrothResult resolveRegion(const Messages& messages, const char* call, const FrothImage& image, VkRect2D& region) {
  if (region.extent.width == 0 && region.extent.height == 0) {
    region = {{0, 0}, image.extent};
  }
  if (region.extent.width > 0 && region.extent.height > 0 && region.offset.x >= 0 && region.offset.y >= 0) {
    return FROTH_OK;
  }
  return messages.fail(FROTH_ERROR_ARGUMENT, call, "region: %u x %u pixels at (%d, %d); at least one at an offset >= 0 is needed",
                       region.extent.width, region.extent.height, region.offset.x, region.offset.y);
}

FrothResult resolveComposite(const Messages& messages, const char* call, VkFormat format, FrothCompositeInfo& info) {
  if (!info.foam.image || !info.target.image) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s: null", info.foam.image ? "target" : "foam");
  }
  FrothResult result = resolveRegion(messages, call, info.foam, info.region);
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "foam", info.foam, {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT},
                        "R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT", info.region);
  }
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "target", info.target, {format}, "FrothContextInfo::compositeFormat", info.region);
  }
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "shadowFactor", info.shadowFactor,
                        {VK_FORMAT_R8_UNORM, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R32_SFLOAT},
                        "R8_UNORM, R16_SFLOAT or R32_SFLOAT", info.region);
  }
  return result;
}

}  // namespace

// The view, if it was drawn in this frame and the call was not made yet; else null, and a message.
Context::View* Context::findDrawn(FrothView handle, const char* call, uint64_t View::*newestCall, FrothResult& result) {
  View* view = views_.find(handle);
  if (!view) {
    result = messages.fail(FROTH_ERROR_HANDLE, call, "view {%u, %u}: destroyed or never created", handle.index,
                           handle.generation);
  } else if (result = checkDevice(call); result == FROTH_OK && serial_ == 0) {
    result = messages.fail(FROTH_ERROR_STATE, call, "no frame; call frothUpdate first");
  } else if (result == FROTH_OK && !isNull_ && view->renderedSerials[0] != serial_ && view->renderedSerials[1] != serial_) {
    result = messages.fail(FROTH_ERROR_STATE, call, "view {%u, %u}: not drawn in frame %llu; call it after frothRasterize or frothWalk",
                           handle.index, handle.generation, static_cast<unsigned long long>(serial_));
  } else if (result == FROTH_OK && view->*newestCall == serial_) {
    result = messages.fail(FROTH_ERROR_STATE, call, "view {%u, %u}: called already in frame %llu", handle.index,
                           handle.generation, static_cast<unsigned long long>(serial_));
  }
  return result == FROTH_OK ? view : nullptr;
}

FrothResult Context::composite(FrothView handle, VkCommandBuffer commandBuffer, FrothCompositeInfo info) {
  constexpr const char* kCall = "frothComposite";
  FrothResult result = FROTH_OK;
  View* view = findDrawn(handle, kCall, &View::compositedSerial, result);
  if (!view) {
    return result;
  }
  if (compositeFormat_ == VK_FORMAT_UNDEFINED) {
    return messages.fail(FROTH_ERROR_UNSUPPORTED, kCall, "the context was not made for it; set FrothContextInfo::compositeFormat");
  }
  if (result = resolveComposite(messages, kCall, compositeFormat_, info); result != FROTH_OK || isNull_) {
    return result;
  }
  if (!commandBuffer) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "commandBuffer: null");
  }
  view->compositedSerial = serial_;
  view->renderer->composite(commandBuffer, *pipelines_, info);
  return FROTH_OK;
}

}  // namespace froth
