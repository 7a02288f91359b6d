#include "runtime/context/info_checks.h"

#include "froth/froth_walk.h"
#include "runtime/asset/asset_source.h"

namespace froth {
namespace {

constexpr uint32_t kMaxViewExtent = 16384;
constexpr uint32_t kMaxFramesInFlight = 8;

}  // namespace

FrothResult checkSource(const Messages& messages, const char* call, const FrothAssetInfo& info) {
  const bool hasBytes = info.data && info.dataSize > 0;
  const int sources = (info.path ? 1 : 0) + (hasBytes ? 1 : 0) + (info.reader ? 1 : 0);
  if (sources != 1) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "path, data, reader: %s; give a path, or data and dataSize, or a reader",
                         sources == 0 ? "none is set" : "more than one is set");
  }
  if (info.reader && !info.reader->read) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "reader.read: null; give the function that reads");
  }
  if (info.reader && info.reader->size == 0) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "reader.size: 0; give the bytes of the whole asset");
  }
  if (info.path && !*info.path) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "path: empty; give the path of a .froth file");
  }
  if (info.layers > kLayerCount) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "layers: %u; at most %u, or 0 for all", info.layers, kLayerCount);
  }
  if (info.prepareRays > FROTH_PREPARE_RADIANCE) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "prepareRays: %u; must be a FrothRayPreparation",
                         info.prepareRays);
  }
  return FROTH_OK;
}

FrothResult checkSourceAtHand(const Messages& messages, const char* call, const FrothAssetInfo& info) {
  if (info.reader) {
    return messages.fail(
        FROTH_ERROR_UNSUPPORTED, call,
        "reader: its answers may come later; give path or data, or ask ahead of time and keep the answer");
  }
  return checkSource(messages, call, info);
}

FrothResult checkExtent(const Messages& messages, const char* call, VkExtent2D extent) {
  if (extent.width > 0 && extent.height > 0 && extent.width <= kMaxViewExtent && extent.height <= kMaxViewExtent) {
    return FROTH_OK;
  }
  return messages.fail(FROTH_ERROR_ARGUMENT, call, "maxExtent: %u x %u; must be 1 to %u each", extent.width,
                       extent.height, kMaxViewExtent);
}

FrothResult checkFramesInFlight(const Messages& messages, const char* call, uint32_t framesInFlight) {
  return framesInFlight <= kMaxFramesInFlight
             ? FROTH_OK
             : messages.fail(FROTH_ERROR_ARGUMENT, call, "framesInFlight: %u; at most %u", framesInFlight,
                             kMaxFramesInFlight);
}

}  // namespace froth
