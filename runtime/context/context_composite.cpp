// The calls that write into the engine's own images.
#include <array>

#include "runtime/context/context.h"
#include "runtime/context/image_checks.h"
#include "runtime/render/pipeline_state.h"

namespace froth {
namespace {

// Of an image whose contents are used.
FrothResult checkHeld(const Messages& messages, const char* call, const char* name, const FrothImage& image) {
  if (!image.image) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s: null", name);
  }
  return image.layoutIn == VK_IMAGE_LAYOUT_UNDEFINED
             ? messages.fail(
                   FROTH_ERROR_ARGUMENT, call,
                   "%s.layoutIn: VK_IMAGE_LAYOUT_UNDEFINED, which drops its contents; name the layout that it is in",
                   name)
             : FROTH_OK;
}

FrothResult checkComposite(const Messages& messages, const char* call, VkFormat format, const VkRect2D& region,
                           const FrothCompositeInfo& info) {
  FrothResult result = checkHeld(messages, call, "foam", info.foam);
  if (result == FROTH_OK) {
    result = checkHeld(messages, call, "target", info.target);
  }
  if (result == FROTH_OK && info.shadowFactor.image) {
    result = checkHeld(messages, call, "shadowFactor", info.shadowFactor);
  }
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "foam", info.foam,
                        std::array{VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT},
                        "R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT", region);
  }
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "target", info.target, std::array{format}, "FrothContextInfo::compositeFormat",
                        region);
  }
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "shadowFactor", info.shadowFactor,
                        std::array{VK_FORMAT_R8_UNORM, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R32_SFLOAT},
                        "R8_UNORM, R16_SFLOAT or R32_SFLOAT", region);
  }
  return result;
}

FrothResult checkDepthExport(const Messages& messages, const char* call, VkFormat format, const VkRect2D& region,
                             const FrothDepthExportInfo& info) {
  FrothResult result = checkHeld(messages, call, "depth", info.depth);
  if (result == FROTH_OK) {
    result = checkHeld(messages, call, "attachment", info.attachment);
  }
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "depth", info.depth, std::array{VK_FORMAT_R32_SFLOAT}, "R32_SFLOAT", region);
  }
  if (result == FROTH_OK) {
    result = checkImage(messages, call, "attachment", info.attachment, std::array{format},
                        "FrothContextInfo::depthExportFormat", region);
  }
  return result;
}

}  // namespace

Context::View* Context::findDrawn(FrothView handle, uint32_t eye, const char* call, uint64_t Eye::*newestCall,
                                  FrothResult& result) {
  View* view = views_.find(handle);
  if (!view) {
    result = messages.fail(FROTH_ERROR_HANDLE, call, "view {%u, %u}: destroyed or never created", handle.index,
                           handle.generation);
  } else if (result = checkEye(*view, eye, call); result != FROTH_OK) {
    return nullptr;
  } else if (result = checkDevice(call); result == FROTH_OK && serial_ == 0) {
    result = messages.fail(FROTH_ERROR_STATE, call, "no frame; call frothUpdate first");
  } else if (result == FROTH_OK && !isNull_ && view->eyes[eye].renderedSerials[0] != serial_ &&
             view->eyes[eye].renderedSerials[1] != serial_) {
    result = messages.fail(FROTH_ERROR_STATE, call,
                           "view {%u, %u}: not drawn in frame %llu; call it after frothRecordRaster or frothRecordWalk",
                           handle.index, handle.generation, static_cast<unsigned long long>(serial_));
  } else if (result == FROTH_OK && view->eyes[eye].*newestCall == serial_) {
    result = messages.fail(FROTH_ERROR_STATE, call, "view {%u, %u}: called already in frame %llu", handle.index,
                           handle.generation, static_cast<unsigned long long>(serial_));
  }
  return result == FROTH_OK ? view : nullptr;
}

FrothResult Context::composite(FrothView handle, VkCommandBuffer commandBuffer, const FrothCompositeInfo& info) {
  constexpr const char* kCall = "frothRecordComposite";
  FrothResult result = FROTH_OK;
  View* view = findDrawn(handle, info.eye, kCall, &Eye::compositedSerial, result);
  if (!view) {
    return result;
  }
  if (compositeFormat_ == VK_FORMAT_UNDEFINED) {
    return messages.fail(FROTH_ERROR_UNSUPPORTED, kCall,
                         "the context was not made for it; set FrothContextInfo::compositeFormat");
  }
  result = checkComposite(messages, kCall, compositeFormat_, view->eyes[info.eye].drawn.region, info);
  if (result != FROTH_OK || isNull_) {
    return result;
  }
  if (!commandBuffer) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "commandBuffer: null");
  }
  view->eyes[info.eye].compositedSerial = serial_;
  view->renderer->composite(commandBuffer, *pipelines_, info, view->eyes[info.eye].drawn.region);
  return FROTH_OK;
}

FrothResult Context::exportDepth(FrothView handle, VkCommandBuffer commandBuffer, const FrothDepthExportInfo& info) {
  constexpr const char* kCall = "frothRecordDepthExport";
  FrothResult result = FROTH_OK;
  View* view = findDrawn(handle, info.eye, kCall, &Eye::exportedSerial, result);
  if (!view) {
    return result;
  }
  if (depthExportFormat_ == VK_FORMAT_UNDEFINED || !view->eyes[info.eye].drawn.isProjection) {
    return messages.fail(FROTH_ERROR_UNSUPPORTED, kCall,
                         view->eyes[info.eye].drawn.isProjection
                             ? "the context was not made for it; set FrothContextInfo::depthExportFormat"
                             : "the view was drawn with a lens that is no projection: its depth is a distance");
  }
  result = checkDepthExport(messages, kCall, depthExportFormat_, view->eyes[info.eye].drawn.region, info);
  if (result != FROTH_OK || isNull_) {
    return result;
  }
  if (!commandBuffer) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "commandBuffer: null");
  }
  view->eyes[info.eye].exportedSerial = serial_;
  view->renderer->exportDepth(commandBuffer, *pipelines_, info, view->eyes[info.eye].drawn.region,
                              view->eyes[info.eye].drawn.isDepthReversed);
  return FROTH_OK;
}

}  // namespace froth
