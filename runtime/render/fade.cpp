#include "runtime/render/fade.h"

#include "runtime/render/frame_images.h"
#include "runtime/render/image_barriers.h"

namespace froth {
namespace {

// The first recording leaves the image as both use it.
void handOn(FrothImage& before, FrothImage& now, const ImageUse& use) {
  before.layoutOut = now.layoutIn = use.layout;
  before.stageOut = now.stageIn = use.stage;
  before.accessOut = now.accessIn = use.access;
}

}  // namespace

FadeInfos splitForFade(const FrothRenderInfo& info) {
  FadeInfos infos{info, info};
  FrothRenderInfo &before = infos.before, &now = infos.now;
  for (FrothImage* image :
       {&before.distance, &before.normal, &before.depth, &before.id, &before.motion, &before.reactive}) {
    *image = {};
  }
  handOn(before.colour, now.colour, kImageWritten);
  handOn(before.sceneDepth, now.sceneDepth, kImageSampled);
  handOn(before.camera.lens.rayMap, now.camera.lens.rayMap, kImageSampled);
  return infos;
}

void recordFade(const Recording& recording, float weight) {
  recording.run("fade", [&] {
    recording.wait();
    const PassRecorder& recorder = recording.parts().front().recorder;
    const VkExtent2D& extent = recording.info.camera.scissor.extent;
    const gpu::FadeConstants constants{.frame = recorder.frame,
                                       .kept = recording.view.spaces.front()->buffers[ViewBuffer::kFade].address,
                                       .weight = weight,
                                       .padding = 0};
    recorder.bind(isWideColour(recording.info) ? Pass::kFade32 : Pass::kFade16);
    recorder.vk.vkCmdPushConstants(recorder.commandBuffer, recorder.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                   sizeof(constants), &constants);
    recorder.vk.vkCmdDispatch(recorder.commandBuffer, groupsOver(extent.width, gpu::kSubTileSize),
                              groupsOver(extent.height, gpu::kSubTileSize), 1);
  });
}

}  // namespace froth
