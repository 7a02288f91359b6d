// A driver that compiles each shader once. Contexts of a test program share its device, and each would compile its
// passes anew: on lavapipe that is most of the time that tests of images take.
#pragma once

#include <vulkan/vulkan.h>

namespace froth::test {

// For FrothContextInfo::getInstanceProcAddr. Compute pipelines of the same code and constants are the same one, which
// stays until the process ends; their layouts must be alike wherever the code is. Any thread; one device, made before
// any pipeline and there until the process ends.
PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddrKeepingPipelines(VkInstance instance, const char* name);

}  // namespace froth::test
