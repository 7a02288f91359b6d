// What the runtime needs of a Vulkan device: one list for the query, for enabling, and for the check at
// creation.
#pragma once

#include "froth/froth.h"
#include "runtime/device/messages.h"

namespace froth {

FrothRequirements queryRequirements(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                                    VkPhysicalDevice physicalDevice);

// The structure that the caller's chain lacks for a required feature, after setting all bits that have a
// place; null: none.
const char* requireFeatures(VkPhysicalDeviceFeatures2& features);

// Repeats the query for a context and looks whether its features were enabled, its queue family can compute, and that
// of uploads can copy. The message names everything that is missing.
FrothResult checkContextDevice(const FrothContextInfo& info, const Messages& messages, const char* call);

// Of FrothContextInfo::queueFamily, of a device that passed checkContextDevice.
VkQueueFamilyProperties queueFamilyOf(const FrothContextInfo& info);

// What frothRecordDepthExport needs besides, of a device that passed checkContextDevice.
// FrothContextInfo::depthExportFormat is set.
FrothResult checkDepthExportDevice(const FrothContextInfo& info, const Messages& messages, const char* call);

}  // namespace froth
