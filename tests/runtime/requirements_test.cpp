#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;
using ::testing::IsNull;
using ::testing::NotNull;

const FrothRequirement* findItem(const FrothRequirements& requirements, const std::string& name) {
  for (uint32_t i = 0; i < requirements.itemCount; ++i) {
    if (requirements.items[i].name == name) return &requirements.items[i];
  }
  return nullptr;
}

TEST(Requirements, AreListedInGeneralWithoutADevice) {
  auto requirements = makeStruct<FrothRequirements>();
  ASSERT_EQ(frothGetRequirements(nullptr, nullptr, nullptr, &requirements), FROTH_OK);
  EXPECT_EQ(requirements.apiVersion, VK_API_VERSION_1_3);
  EXPECT_FALSE(requirements.isSatisfied);
  for (const char* name : {"Vulkan 1.3", "bufferDeviceAddress", "synchronization2"}) {
    const FrothRequirement* item = findItem(requirements, name);
    ASSERT_THAT(item, NotNull()) << name;
    EXPECT_THAT(item->loss, IsNull()) << name << " is required";
    EXPECT_FALSE(item->isPresent) << name;
  }
  EXPECT_THAT(findItem(requirements, "timestampComputeAndGraphics")->loss, HasSubstr("times"));
  EXPECT_THAT(findItem(requirements, "shaderStorageImageExtendedFormats")->loss, HasSubstr("id, motion and reactive"));
  EXPECT_THAT(findItem(requirements, "dynamicRendering")->loss, HasSubstr("frothRecordDepthExport"));
}

TEST(Requirements, AreMetByTheDeviceOfTheTests) {
  Result<std::unique_ptr<Host>> host = Host::create({});
  ASSERT_TRUE(host) << host.error().message;
  auto requirements = makeStruct<FrothRequirements>();
  const VkInstance instance = (*host)->instance;
  ASSERT_EQ(frothGetRequirements(vkGetInstanceProcAddr, instance, (*host)->physicalDevice, &requirements), FROTH_OK);
  EXPECT_TRUE(requirements.isSatisfied);
  EXPECT_TRUE(findItem(requirements, "bufferDeviceAddress")->isPresent);
}

TEST(Requirements, RefuseADeviceWithoutItsInstance) {
  auto requirements = makeStruct<FrothRequirements>();
  const auto device = reinterpret_cast<VkPhysicalDevice>(&requirements);
  EXPECT_EQ(frothGetRequirements(nullptr, nullptr, device, &requirements), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothGetRequirements(nullptr, nullptr, nullptr, nullptr), FROTH_ERROR_ARGUMENT);
}

// A driver of Vulkan 1.1 without the features, behind the caller's own vkGetInstanceProcAddr.
PFN_vkVoidFunction VKAPI_CALL getOldDriverProcAddr(VkInstance, const char* name) {
  if (std::strcmp(name, "vkGetPhysicalDeviceProperties") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(+[](VkPhysicalDevice, VkPhysicalDeviceProperties* properties) {
      *properties = {};
      properties->apiVersion = VK_API_VERSION_1_1;
    });
  }
  if (std::strcmp(name, "vkGetPhysicalDeviceQueueFamilyProperties") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(
        +[](VkPhysicalDevice, uint32_t* count, VkQueueFamilyProperties* families) {
          *count = 1;
          if (families) families[0] = {VK_QUEUE_COMPUTE_BIT, 1, 0, {}};
        });
  }
  if (std::strcmp(name, "vkGetPhysicalDeviceFeatures2") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(+[](VkPhysicalDevice, VkPhysicalDeviceFeatures2*) {});
  }
  return nullptr;
}

TEST(Requirements, NameWhatAnOldDriverLacksBeforeAndAtContextCreation) {
  int dummy = 0;
  std::vector<LoggedMessage> messages;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  auto info = makeStruct<FrothContextInfo>();
  info.abiVersion = FROTH_ABI_VERSION;
  info.getInstanceProcAddr = getOldDriverProcAddr;
  info.instance = reinterpret_cast<VkInstance>(&dummy);
  info.physicalDevice = reinterpret_cast<VkPhysicalDevice>(&dummy);
  info.device = reinterpret_cast<VkDevice>(&dummy);
  info.enabledFeatures = &features;
  info.onMessage = logMessage;
  info.messageUser = &messages;

  auto requirements = makeStruct<FrothRequirements>();
  ASSERT_EQ(frothGetRequirements(info.getInstanceProcAddr, info.instance, info.physicalDevice, &requirements),
            FROTH_OK);
  EXPECT_FALSE(requirements.isSatisfied);
  EXPECT_FALSE(findItem(requirements, "synchronization2")->isPresent);
  EXPECT_TRUE(findItem(requirements, "a queue family with VK_QUEUE_COMPUTE_BIT")->isPresent);

  FrothContext* context = nullptr;
  EXPECT_EQ(frothCreateContext(&info, &context), FROTH_ERROR_FEATURE);
  EXPECT_THAT(context, IsNull());
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_THAT(messages[0].text, HasSubstr("Vulkan 1.3, bufferDeviceAddress, synchronization2"));
  EXPECT_THAT(messages[0].text, HasSubstr("maxComputeWorkGroupSize[0] >= 256, maxComputeWorkGroupInvocations >= 256"));
}

TEST(RequireFeatures, SetsTheBitsInTheCallersChainAndLeavesTheOthers) {
  VkPhysicalDeviceVulkan13Features features13{};
  features13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  features13.maintenance4 = VK_TRUE;
  VkPhysicalDeviceVulkan12Features features12{};
  features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features12.pNext = &features13;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &features12;
  const char* missing = "unset";
  ASSERT_EQ(frothRequireFeatures(&features, &missing), FROTH_OK);
  EXPECT_THAT(missing, IsNull());
  EXPECT_TRUE(features12.bufferDeviceAddress);
  EXPECT_TRUE(features13.synchronization2);
  EXPECT_TRUE(features13.maintenance4);
  EXPECT_FALSE(features12.shaderFloat16);
}

TEST(RequireFeatures, AcceptsTheSingleFeatureStructures) {
  VkPhysicalDeviceSynchronization2Features synchronization{};
  synchronization.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES;
  VkPhysicalDeviceVulkan12Features features12{};
  features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features12.pNext = &synchronization;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &features12;
  EXPECT_EQ(frothRequireFeatures(&features, nullptr), FROTH_OK);
  EXPECT_TRUE(synchronization.synchronization2);
}

TEST(RequireFeatures, NamesTheStructureThatTheChainLacks) {
  VkPhysicalDeviceVulkan12Features features12{};
  features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &features12;
  const char* missing = nullptr;
  EXPECT_EQ(frothRequireFeatures(&features, &missing), FROTH_ERROR_FEATURE);
  EXPECT_STREQ(missing, "VkPhysicalDeviceVulkan13Features");
}

class ContextCreation : public RuntimeGpuTest {};

TEST_F(ContextCreation, NamesAFeatureThatWasNotEnabled) {
  VkPhysicalDeviceFeatures2 nothing{};
  nothing.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  FrothContextInfo info = host_->contextInfo();
  info.enabledFeatures = &nothing;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_FEATURE);
  EXPECT_THAT(context_, IsNull());
  EXPECT_THAT(lastText(), HasSubstr("bufferDeviceAddress, synchronization2"));
}

TEST_F(ContextCreation, NamesAQueueFamilyThatDoesNotExist) {
  FrothContextInfo info = host_->contextInfo();
  info.queueFamily = 77;
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("queueFamily: 77; those with VK_QUEUE_COMPUTE_BIT are 0"));
}

TEST_F(ContextCreation, WorksTwiceOnOneDevice) {
  createContext(host_->contextInfo());
  const FrothContextInfo info = host_->contextInfo();
  FrothContext* second = nullptr;
  EXPECT_EQ(frothCreateContext(&info, &second), FROTH_OK);
  frothDestroyContext(second, UINT64_MAX);
}

}  // namespace
}  // namespace froth
