// Checks an image of the caller's, and that no struct has extensions.
#pragma once

#include <span>

#include "froth/froth.h"
#include "runtime/device/messages.h"

namespace froth {

// FROTH_OK for null. The image must have a view, one sample, one of the formats, a layout to be left in, and hold what
// is drawn. `call` names the entry point, `name` the field in messages.
FrothResult checkImage(const Messages& messages, const char* call, const char* name, const FrothImage& image,
                       std::span<const VkFormat> formats, const char* formatNames, const VkRect2D& drawn);

// FROTH_OK for null: this version knows no kind. `owner` names the struct in messages.
FrothResult checkExtension(const Messages& messages, const char* call, const char* owner,
                           const FrothExtension* extension);

}  // namespace froth
