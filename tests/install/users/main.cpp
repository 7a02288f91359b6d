// A C++17 program that loads Vulkan's functions itself, as with volk.
#define VK_NO_PROTOTYPES
#include <froth/froth_query.h>

#include <iostream>

int main() {
  VkPhysicalDeviceVulkan13Features features13{};
  features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  VkPhysicalDeviceVulkan12Features features12{};
  features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features12.pNext = &features13;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &features12;
  const char* missing = nullptr;
  if (frothRequireFeatures(&features, &missing) != FROTH_OK || !features12.bufferDeviceAddress) return 1;

  FrothContextInfo info{};
  info.structSize = sizeof(info);
  info.abiVersion = FROTH_ABI_VERSION;
  FrothContext* context = nullptr;
  if (frothCreateContext(&info, &context) != FROTH_OK) return 2;
  FrothViewInfo viewInfo{};
  viewInfo.structSize = sizeof(viewInfo);
  viewInfo.maxExtent = {1280, 720};
  FrothView view{};
  if (frothCreateView(context, &viewInfo, &view) != FROTH_OK) return 3;
  if (frothDestroyView(context, view) != FROTH_OK) return 4;
  if (frothDestroyView(context, view) != FROTH_ERROR_HANDLE) return 5;
  frothDestroyContext(context, UINT64_MAX);
  std::cout << "well\n";
}
