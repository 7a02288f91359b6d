/* The names that the C blocks of README.md and docs/EMBEDDING.md take from the text around them. */
#include <froth/froth_breadcrumbs.h>
#include <froth/froth_files.h>
#include <froth/froth_host.h>
#include <froth/froth_pool.h>
#include <froth/froth_quality.h>
#include <froth/froth_query.h>
#include <froth/froth_reader.h>
#include <froth/froth_stream.h>
#include <froth/froth_walk.h>
#include <math.h>
#include <stdio.h>

extern VkInstance instance;
extern VkPhysicalDevice gpu;
extern VkDevice device;
extern VkPhysicalDeviceFeatures2 features;
extern VkCommandBuffer cmd, commandBuffer, uploadCmd, graphicsCmd;
extern VkSemaphore uploadSemaphore;
extern VkImage image, imageBefore;
extern VkImageView imageView;
extern uint32_t width, height, family, graphicsFamily;
extern uint64_t n, done, newestCompleted, uploads, completedUploads;
extern double x, y, z;
extern float dx, dy, dz, nearest;

extern void* pack;
extern FrothFile* file;
extern FrothJobPool* ioPool;
extern uint64_t sceneOffset;
extern uint64_t sceneSize, request;
extern void readScene(void* user, uint64_t number, uint64_t offset, uint64_t size, void* destination);

extern void* heap;
extern void* allocateHost(void* user, size_t size, size_t alignment);
extern void releaseHost(void* user, void* pointer, size_t size, size_t alignment);

extern FrothContext* froth;
extern FrothContextInfo context_info;
extern FrothAsset asset;
extern FrothInstance placed;
extern FrothView view;
extern FrothFrameStatus status;
extern FrothRenderInfo render;
extern FrothCamera camera;
extern FrothStoredCamera stored;
