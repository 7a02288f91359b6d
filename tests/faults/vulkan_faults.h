// The driver as a careless one would be: the n-th call that can fail does, and what is made and not destroyed
// is known.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace froth::test {

// Of all calls through getInstanceProcAddr. One thread at a time.
struct VulkanFaults {
  // Given to frothCreateContext in the place of the loader's. Pipelines are made once per shader and kept, so
  // that a scenario can run hundreds of times; clear() destroys them.
  static PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name);
  static void clear(VkDevice device);

  // From now on the call with this number (from 0) gives `code`.
  static void arm(size_t number, VkResult code);
  static void disarm();

  static size_t calls;                       // that can fail, since arm()
  static std::string struck;                 // the call that was made to fail; empty: none
  static std::map<void*, std::string> live;  // objects and memory that are not destroyed, and the calls that made them
  static std::vector<std::string> misuse;    // destroyed twice, or never made
  static std::vector<std::string> unnamed;   // destroyed, and never named for captures: the calls that made them
};

}  // namespace froth::test
