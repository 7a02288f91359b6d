/* What an engine has before Froth comes: a device, an image, submission, picture files. Every failure ends the
 * program. */
#ifndef FROTH_SAMPLES_MINIMAL_ENGINE_H
#define FROTH_SAMPLES_MINIMAL_ENGINE_H

#include <vulkan/vulkan.h>

enum { WIDTH = 480, HEIGHT = 320 };

extern VkInstance instance;
extern VkPhysicalDevice gpu;
extern VkDevice device;
extern uint32_t queue_family;
extern VkPhysicalDeviceFeatures2 features; /* the chain that the device is made with */
extern VkImage image;                      /* RGBA32F, storage and transfer source */
extern VkImageView image_view;

void require(int is_well, const char* what); /* else: prints, exits with 1 */

/* is_suitable tells whether Froth can use a device; `features` is filled in by then. */
void make_instance(void);
void choose_gpu(int (*is_suitable)(VkPhysicalDevice));
void make_device(void);
void make_image(void);
VkCommandBuffer begin_commands(void);
void copy_image(VkCommandBuffer commands); /* in layout TRANSFER_SRC_OPTIMAL, for write_picture */
void submit_and_wait(VkCommandBuffer commands);
void destroy_engine(void);

/* P6, 8 bits, of the newest copy_image(). */
void write_picture(const char* path);
double compare_picture(const char* path); /* [dB] PSNR; +inf: the same */

#endif
