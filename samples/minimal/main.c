/* The least that an engine writes to show a foam: a device of its own, one asset, one view, frames, a picture. No
 * window.
 *
 *   froth_minimal SCENE.froth IMAGE.ppm [--frames N] [--compare OTHER.ppm --min-psnr X]
 *
 * Exit code 0: well; 1: a call failed, or the picture is another; 2: wrong arguments. */
#include <froth/froth.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine.h"

#define FROTH(call) require((call) >= FROTH_OK, #call) /* what is above FROTH_OK is information */

static void print_message(void* user, FrothSeverity severity, FrothResult code, const char* object, const char* text) {
  (void)user;
  fprintf(stderr, "%s %s: %s: %s\n", severity == FROTH_SEVERITY_ERROR ? "error" : "warning", frothResultName(code),
          object, text);
}

static int is_suitable(VkPhysicalDevice candidate) {
  FrothRequirements requirements = {.structSize = sizeof requirements};
  FROTH(frothGetRequirements(vkGetInstanceProcAddr, instance, candidate, &requirements));
  return requirements.isSatisfied != 0;
}

static FrothContext* froth;
static FrothAsset asset;
static FrothInstance placed;
static FrothView view;

static void make_scene(const char* path) {
  FrothContextInfo context_info = {.structSize = sizeof context_info,
                                   .abiVersion = FROTH_ABI_VERSION,
                                   .getInstanceProcAddr = vkGetInstanceProcAddr,
                                   .instance = instance,
                                   .physicalDevice = gpu,
                                   .device = device,
                                   .enabledFeatures = &features,
                                   .queueFamily = queue_family,
                                   .onMessage = print_message};
  FROTH(frothCreateContext(&context_info, &froth));
  FrothAssetInfo asset_info = {.structSize = sizeof asset_info, .path = path};
  FROTH(frothOpenAsset(froth, &asset_info, &asset)); /* it loads in the frames that follow */
  FrothInstanceInfo instance_info = {.structSize = sizeof instance_info, .asset = asset};
  FROTH(frothCreateInstance(froth, &instance_info, &placed));
  FrothViewInfo view_info = {.structSize = sizeof view_info, .maxExtent = {WIDTH, HEIGHT}};
  FROTH(frothCreateView(froth, &view_info, &view));
}

/* The camera that is stored with the asset, in Froth's terms. */
static FrothCamera start_camera(const FrothAssetStatus* status) {
  const FrothStoredCamera* stored = &status->startView;
  FrothCamera camera = {.viewport = {0, 0, WIDTH, HEIGHT, 0, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    camera.eye[axis] = stored->worldFromCamera[4 * axis + 3];
    for (int row = 0; row < 3; ++row) {
      camera.viewFromWorld[3 * axis + row] = (float)stored->worldFromCamera[4 * axis + row];
    }
  }
  camera.clipFromView[0] = (float)(HEIGHT / (WIDTH * stored->tanHalfFovY));
  camera.clipFromView[5] = (float)(1 / stored->tanHalfFovY);
  camera.clipFromView[11] = 1;     /* w = z */
  camera.clipFromView[14] = 0.01f; /* reversed, infinite depth */
  return camera;
}

static void record_frame(VkCommandBuffer commands, uint64_t serial) {
  FrothFrame frame = {.structSize = sizeof frame, .serial = serial, .completedSerial = serial - 1};
  FROTH(frothUpdate(froth, &frame, NULL));
  FROTH(frothRecordUpload(froth, commands));
  FrothAssetStatus status = {.structSize = sizeof status};
  FROTH(frothGetAssetStatus(froth, asset, &status));
  require(status.state != FROTH_ASSET_FAILED, "the asset cannot be loaded");
  require(status.state != FROTH_ASSET_READY || status.hasStartView,
          "the asset has no start view; bake it with --cameras");
  if (status.state != FROTH_ASSET_READY) return;
  FrothRenderInfo info = {.structSize = sizeof info,
                          .camera = start_camera(&status),
                          .nearRatio = FROTH_NEAR_DEFAULT,
                          .nearDepth = FROTH_NEAR_DEFAULT,
                          .displayCoded = 1}; /* for a file; an engine blends linear light */
  info.colour = (FrothImage){.image = image,
                             .view = image_view,
                             .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                             .extent = {WIDTH, HEIGHT},
                             .layoutIn = VK_IMAGE_LAYOUT_UNDEFINED,
                             .layoutOut = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                             .stageIn = VK_PIPELINE_STAGE_2_COPY_BIT,
                             .stageOut = VK_PIPELINE_STAGE_2_COPY_BIT,
                             .accessOut = VK_ACCESS_2_TRANSFER_READ_BIT};
  FROTH(frothRecordRaster(froth, view, commands, &info));
  copy_image(commands);
}

/* Until the asset is READY and has been drawn `frames` times. A real engine keeps frames in flight; this one waits. */
static void draw(uint32_t frames) {
  FrothAssetStatus status = {.structSize = sizeof status};
  for (uint64_t serial = 1; frames > 0; ++serial) {
    VkCommandBuffer commands = begin_commands();
    record_frame(commands, serial);
    submit_and_wait(commands);
    FROTH(frothGetAssetStatus(froth, asset, &status));
    frames -= status.state == FROTH_ASSET_READY;
  }
}

static void destroy_scene(void) {
  FROTH(frothDestroyView(froth, view));
  FROTH(frothDestroyInstance(froth, placed));
  FROTH(frothCloseAsset(froth, asset));
  require(frothDestroyContext(froth, UINT64_MAX) == FROTH_OK, "frothDestroyContext"); /* the device is idle */
}

int main(int count, char** arguments) {
  uint32_t frames = 60;
  const char* other = NULL;
  double min_psnr = 0;
  for (int i = 3; i + 1 < count; i += 2) {
    if (strcmp(arguments[i], "--frames") == 0) {
      frames = (uint32_t)strtoul(arguments[i + 1], NULL, 10);
    } else if (strcmp(arguments[i], "--compare") == 0) {
      other = arguments[i + 1];
    } else if (strcmp(arguments[i], "--min-psnr") == 0) {
      min_psnr = strtod(arguments[i + 1], NULL);
    } else {
      count = 0;
    }
  }
  if (count < 3 || count % 2 == 0 || frames == 0) {
    fprintf(stderr, "usage: froth_minimal SCENE.froth IMAGE.ppm [--frames N] [--compare OTHER.ppm --min-psnr X]\n");
    return 2;
  }
  make_instance();
  choose_gpu(is_suitable);
  FROTH(frothRequireFeatures(&features, NULL)); /* before the device is made */
  make_device();
  make_image();
  make_scene(arguments[1]);
  draw(frames);
  destroy_scene();
  write_picture(arguments[2]);
  destroy_engine();
  if (!other) return 0;
  const double psnr = compare_picture(other);
  printf("%s against %s: %.2f dB\n", arguments[2], other, psnr);
  return psnr >= min_psnr ? 0 : 1;
}
