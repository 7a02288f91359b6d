#include "runtime/context/image_checks.h"

#include <algorithm>

namespace froth {

FrothResult checkImage(const Messages& messages, const char* call, const char* name, const FrothImage& image,
                       std::span<const VkFormat> formats, const char* formatNames, const VkRect2D& drawn) {
  if (!image.image) {
    return FROTH_OK;
  }
  if (!image.view) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s.view: null; give a 2D view of the image", name);
  }
  if (const FrothResult result = checkExtension(messages, call, name, image.extension); result != FROTH_OK) {
    return result;
  }
  if (image.samples > VK_SAMPLE_COUNT_1_BIT) {
    return messages.fail(FROTH_ERROR_UNSUPPORTED, call,
                         "%s.samples: %d; one sample per pixel is needed; resolve the image first, depth with "
                         "VK_RESOLVE_MODE_MIN_BIT or VK_RESOLVE_MODE_MAX_BIT",
                         name, image.samples);
  }
  if (std::find(formats.begin(), formats.end(), image.format) == formats.end()) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s.format: VkFormat %d; must be %s", name, image.format,
                         formatNames);
  }
  if (image.stageIn == 0 || (image.stageOut == 0 && image.accessOut != 0)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "%s.%s: 0; name the stages of its %s use, or VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT where a "
                         "fence has waited for it",
                         name, image.stageIn == 0 ? "stageIn" : "stageOut", image.stageIn == 0 ? "last" : "next");
  }
  if (image.layoutOut == VK_IMAGE_LAYOUT_UNDEFINED || image.layoutOut == VK_IMAGE_LAYOUT_PREINITIALIZED) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s.layoutOut: VkImageLayout %d; name the layout of its next use",
                         name, image.layoutOut);
  }
  const uint64_t right = uint64_t{drawn.extent.width} + static_cast<uint32_t>(drawn.offset.x);
  const uint64_t bottom = uint64_t{drawn.extent.height} + static_cast<uint32_t>(drawn.offset.y);
  if (right > image.extent.width || bottom > image.extent.height) {
    return messages.fail(FROTH_ERROR_ARGUMENT, call,
                         "%s.extent: %u x %u, but viewport and scissor reach to %llu x %llu; clip them to the image",
                         name, image.extent.width, image.extent.height, static_cast<unsigned long long>(right),
                         static_cast<unsigned long long>(bottom));
  }
  return FROTH_OK;
}

FrothResult checkExtension(const Messages& messages, const char* call, const char* owner,
                           const FrothExtension* extension) {
  if (!extension) return FROTH_OK;
  return messages.fail(FROTH_ERROR_VERSION, call,
                       "%s.extension: of kind %u, which this library does not know; leave it null, or link the library "
                       "that the header belongs to",
                       owner, extension->kind);
}

}  // namespace froth
