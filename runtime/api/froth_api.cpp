// The C entry points: they check what they are given and hand it on.
#include "froth/froth.h"

#include "runtime/api/struct_size.h"
#include "runtime/core/requirements.h"

using namespace froth;

const char* frothResultName(FrothResult result) {
  switch (result) {
#define FROTH_NAME(name) \
  case name:             \
    return #name;
    FROTH_NAME(FROTH_OK)
    FROTH_NAME(FROTH_PENDING)
    FROTH_NAME(FROTH_INCOMPLETE)
    FROTH_NAME(FROTH_ERROR_ARGUMENT)
    FROTH_NAME(FROTH_ERROR_HANDLE)
    FROTH_NAME(FROTH_ERROR_VERSION)
    FROTH_NAME(FROTH_ERROR_FEATURE)
    FROTH_NAME(FROTH_ERROR_FILE)
    FROTH_NAME(FROTH_ERROR_MEMORY)
    FROTH_NAME(FROTH_ERROR_UNSUPPORTED)
    FROTH_NAME(FROTH_ERROR_DEVICE)
    FROTH_NAME(FROTH_ERROR_STATE)
#undef FROTH_NAME
    case FROTH_RESULT_MAX:
      break;
  }
  return "unknown FrothResult";
}

FrothResult frothGetRequirements(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                                 VkPhysicalDevice physicalDevice, FrothRequirements* requirements) {
  const bool canAsk = !physicalDevice || (getInstanceProcAddr && instance);
  if (!requirements || !canAsk) {
    return FROTH_ERROR_ARGUMENT;
  }
  const FrothRequirements found = queryRequirements(getInstanceProcAddr, instance, physicalDevice);
  return writeStruct(found, *requirements) ? FROTH_OK : FROTH_ERROR_ARGUMENT;
}

FrothResult frothRequireFeatures(VkPhysicalDeviceFeatures2* features, const char** missingStructure) {
  if (!features) {
    return FROTH_ERROR_ARGUMENT;
  }
  const char* missing = requireFeatures(*features);
  if (missingStructure) {
    *missingStructure = missing;
  }
  return missing ? FROTH_ERROR_FEATURE : FROTH_OK;
}
