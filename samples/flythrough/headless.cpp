#include "samples/flythrough/headless.h"

#include <utility>
#include <vector>

#include "host/frame_files.h"
#include "samples/flythrough/cameras_json.h"

namespace froth {
namespace {

Status flyPath(Host& host, Scene& scene, Painter& painter, const CameraPath& path, const FlythroughOptions& options) {
  FrameFiles files(options);
  for (uint32_t frame = 0; frame < options.frames; ++frame) {
    const double share = options.frames > 1 ? static_cast<double>(frame) / (options.frames - 1) : 0.0;
    Status drawn = submitWholeFrame(host, scene, [&](VkCommandBuffer commands, uint64_t) {
      return painter.record(commands, scene, options.picture, path.at(share), VK_PIPELINE_STAGE_2_COPY_BIT);
    });
    if (!drawn) return drawn;
    const Result<std::vector<float>> texels = host.readImage(painter.result());
    if (!texels) return texels.error();
    if (Status added = files.add(encodePicture(*texels, options.extent)); !added) return added;
  }
  return files.finish();
}

}  // namespace

Status flyHeadless(const FlythroughOptions& options) {
  if (options.frames == 0) return makeError(ErrorKind::kUsage, "--frames 0: give at least one frame");
  std::vector<Pose> keys;
  if (!options.cameras.empty()) {
    Result<std::vector<Pose>> read = readKeyPoses(options.cameras);
    if (!read) return read.error();
    keys = std::move(*read);
  }
  Result<std::unique_ptr<Host>> host = Host::create({options.device, options.validate});
  if (!host) return host.error();
  Result<std::unique_ptr<Scene>> scene = Scene::create((*host)->contextInfo(), options.asset);
  if (!scene) return scene.error();
  if (Status ready = waitUntilReady(**host, **scene); !ready) return ready;
  Painter painter(**host);
  if (Status sized = painter.setExtent(**scene, options.extent); !sized) return sized;
  const Result<CameraPath> path = (*scene)->path(std::move(keys));
  if (!path) return path.error();
  const Status flown = flyPath(**host, **scene, painter, *path, options);
  return flown ? (*host)->checkSilence() : flown;
}

}  // namespace froth
