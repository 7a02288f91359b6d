#include "engine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define VK(call) require((call) == VK_SUCCESS, #call)

void require(int is_well, const char* what) {
  if (is_well) return;
  fprintf(stderr, "froth_minimal: %s\n", what);
  exit(1);
}

/* ---- Vulkan ---- */

VkInstance instance;
VkPhysicalDevice gpu;
VkDevice device;
uint32_t queue_family;
static VkQueue queue;
static VkCommandPool pool;
static VkCommandBuffer commands;

static VkPhysicalDeviceVulkan13Features features13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
static VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                      .pNext = &features13};
VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};

void make_instance(void) {
  VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
  VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
  VK(vkCreateInstance(&info, NULL, &instance));
}

void choose_gpu(int (*is_suitable)(VkPhysicalDevice)) {
  VkPhysicalDevice gpus[16];
  uint32_t count = 16;
  require(vkEnumeratePhysicalDevices(instance, &count, gpus) >= 0, "vkEnumeratePhysicalDevices");
  for (uint32_t i = 0; i < count && !gpu; ++i) {
    if (is_suitable(gpus[i])) gpu = gpus[i];
  }
  require(gpu != NULL, "no suitable Vulkan device");
}

void make_device(void) {
  VkQueueFamilyProperties families[16];
  uint32_t count = 16;
  vkGetPhysicalDeviceQueueFamilyProperties(gpu, &count, families);
  while (!(families[queue_family].queueFlags & VK_QUEUE_COMPUTE_BIT)) ++queue_family;
  float priority = 1;
  VkDeviceQueueCreateInfo queue_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = queue_family,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
  VkDeviceCreateInfo device_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                    .pNext = &features,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queue_info};
  VK(vkCreateDevice(gpu, &device_info, NULL, &device));
  vkGetDeviceQueue(device, queue_family, 0, &queue);
  VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .queueFamilyIndex = queue_family};
  VK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
  VkCommandBufferAllocateInfo commands_info = {
      .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = pool, .commandBufferCount = 1};
  VK(vkAllocateCommandBuffers(device, &commands_info, &commands));
}

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(gpu, &memory);
  VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size};
  while (!(needs.memoryTypeBits >> info.memoryTypeIndex & 1) ||
         (memory.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) != wanted) {
    require(++info.memoryTypeIndex < memory.memoryTypeCount, "no memory type fits");
  }
  VkDeviceMemory result;
  VK(vkAllocateMemory(device, &info, NULL, &result));
  return result;
}

VkImage image;
VkImageView image_view;
static VkBuffer buffer; /* to look at the image */
static VkDeviceMemory image_memory, buffer_memory;
static void* texels; /* float [HEIGHT][WIDTH][4] */

void make_image(void) {
  VkImageCreateInfo image_info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                  .imageType = VK_IMAGE_TYPE_2D,
                                  .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                  .extent = {WIDTH, HEIGHT, 1},
                                  .mipLevels = 1,
                                  .arrayLayers = 1,
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
  VK(vkCreateImage(device, &image_info, NULL, &image));
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, image, &needs);
  VK(vkBindImageMemory(device, image, image_memory = allocate(needs, 0), 0));
  VkImageViewCreateInfo view_info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = image_info.format,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  VK(vkCreateImageView(device, &view_info, NULL, &image_view));
  VkBufferCreateInfo buffer_info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                    .size = WIDTH * HEIGHT * 4 * sizeof(float),
                                    .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
  VK(vkCreateBuffer(device, &buffer_info, NULL, &buffer));
  vkGetBufferMemoryRequirements(device, buffer, &needs);
  buffer_memory = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  VK(vkBindBufferMemory(device, buffer, buffer_memory, 0));
  VK(vkMapMemory(device, buffer_memory, 0, VK_WHOLE_SIZE, 0, &texels));
}

VkCommandBuffer begin_commands(void) {
  VK(vkResetCommandPool(device, pool, 0));
  VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  VK(vkBeginCommandBuffer(commands, &begin));
  return commands;
}

void copy_image(VkCommandBuffer to) {
  VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                            .imageExtent = {WIDTH, HEIGHT, 1}};
  vkCmdCopyImageToBuffer(to, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
}

void submit_and_wait(VkCommandBuffer from) {
  VK(vkEndCommandBuffer(from));
  VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &from};
  VK(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
  VK(vkQueueWaitIdle(queue));
}

void destroy_engine(void) {
  vkDestroyImageView(device, image_view, NULL);
  vkDestroyImage(device, image, NULL);
  vkDestroyBuffer(device, buffer, NULL);
  vkFreeMemory(device, image_memory, NULL);
  vkFreeMemory(device, buffer_memory, NULL);
  vkDestroyCommandPool(device, pool, NULL);
  vkDestroyDevice(device, NULL);
  vkDestroyInstance(instance, NULL);
}

/* ---- Pictures ---- */

enum { CHANNELS = 3, PICTURE_BYTES = WIDTH * HEIGHT * CHANNELS };

static unsigned char picture[PICTURE_BYTES], expected[PICTURE_BYTES];

void write_picture(const char* path) {
  const float* values = texels;
  for (int i = 0; i < PICTURE_BYTES; ++i) {
    const float value = values[i / CHANNELS * 4 + i % CHANNELS];
    picture[i] = (unsigned char)(255 * fminf(fmaxf(value, 0), 1) + 0.5f);
  }
  FILE* file = fopen(path, "wb");
  require(file != NULL && fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT) > 0, path);
  require(fwrite(picture, PICTURE_BYTES, 1, file) == 1 && fclose(file) == 0, path);
}

double compare_picture(const char* path) {
  FILE* file = fopen(path, "rb");
  int width = 0, height = 0;
  require(file != NULL && fscanf(file, "P6 %d %d 255", &width, &height) == 2 && width == WIDTH && height == HEIGHT,
          path);
  require(fgetc(file) == '\n' && fread(expected, PICTURE_BYTES, 1, file) == 1, path);
  fclose(file);
  double sum = 0;
  for (int i = 0; i < PICTURE_BYTES; ++i) sum += (picture[i] - expected[i]) * (picture[i] - expected[i]);
  return 10 * log10(255.0 * 255.0 * PICTURE_BYTES / sum); /* +inf: the same */
}
