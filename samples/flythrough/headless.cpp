#include "samples/flythrough/headless.h"

#include <tuple>
#include <utility>
#include <vector>

#include "host/frame_files.h"
#include "samples/flythrough/cameras_json.h"
#include "samples/flythrough/foam_follower.h"
#include "samples/flythrough/stream_report.h"

namespace froth {
namespace {

// Until what is wanted from this place is drawn. The first frame tells from where; figures are of its beginning.
Status settle(Host& host, Scene& scene, const RecordFrame& record) {
  constexpr uint32_t kMostIdleFrames = 600;  // a chunk that fails is tried again after up to 480
  FrothStreamStatus before{};
  for (uint32_t frame = 0, idle = 0; idle < kMostIdleFrames; ++frame) {
    if (Status drawn = submitFrame(host, scene, record); !drawn) return drawn;
    const Result<FrothStreamStatus> status = scene.streamStatus();
    if (!status) return status.error();
    if (frame > 0 && status->isSettled) return {};
    const auto progressOf = [](const FrothStreamStatus& s) {
      return std::tuple(s.drawnChunks, s.residentChunks, s.comingChunks, s.usedBytes, s.evictions, s.retries);
    };
    const bool isWaiting = status->comingChunks > 0;  // for a disk or a server, whose time is not that of frames
    idle = !isWaiting && progressOf(*status) == progressOf(before) ? idle + 1 : 0;
    before = *status;
  }
  return makeError(
      ErrorKind::kUnsupported,
      "what is wanted is not drawn, and nothing has changed in %u frames; raise --budget, or lower --detail",
      kMostIdleFrames);
}

// Waits for the next foam, and shows it.
Status showNext(Host& host, Scene& scene, FoamFollower& follower) {
  if (Status baked = follower.waitForAsset(); !baked) return baked;
  if (Status begun = scene.replace(follower.asset()); !begun) return begun;
  while (true) {
    const Status loaded = submitFrame(host, scene, [](VkCommandBuffer, uint64_t) { return Status(); });
    if (!loaded) return loaded;
    const Result<FrothReplacementStatus> status = scene.replacement();
    if (!status) return status.error();
    if (status->state == FROTH_REPLACEMENT_FAILED) return scene.check(status->error, "frothReplaceAsset");
    if (status->state == FROTH_REPLACEMENT_DONE) return {};
  }
}

Status flyPath(Host& host, Scene& scene, Painter& painter, const CameraPath& path, const FlythroughOptions& options) {
  FrameFiles files(options);
  StreamReport report(options, scene.levelCount());
  for (uint32_t frame = 0; frame < options.frames; ++frame) {
    const double share = options.frames > 1 ? static_cast<double>(frame) / (options.frames - 1) : 0.0;
    if (options.follower && frame > 0) {
      if (Status shown = showNext(host, scene, *options.follower); !shown) return shown;
    }
    StreamFigures figures;
    const auto record = [&](VkCommandBuffer commands, uint64_t) -> Status {
      Result<StreamFigures> read = readFigures(scene);
      if (!read) return read.error();
      figures = std::move(*read);
      return painter.record(commands, scene, options.picture, path.at(share), VK_PIPELINE_STAGE_2_COPY_BIT);
    };
    if (options.isSettled) {
      if (Status settled = settle(host, scene, record); !settled) return settled;
    }
    if (Status drawn = submitWholeFrame(host, scene, record); !drawn) return drawn;
    report.add(figures);
    const Result<std::vector<float>> texels = host.readImage(painter.result());
    if (!texels) return texels.error();
    if (Status added = files.add(encodePicture(*texels, options.extent)); !added) return added;
  }
  const Status reported = report.finish();
  return reported ? files.finish() : reported;
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
  if (Status set = applySettings(**scene, options.streaming); !set) return set;
  if (Status ready = waitUntilReady(**host, **scene); !ready) return ready;
  Painter painter(**host);
  if (Status sized = painter.setExtent(**scene, options.extent); !sized) return sized;
  const Result<CameraPath> path = (*scene)->path(std::move(keys));
  if (!path) return path.error();
  const Status flown = flyPath(**host, **scene, painter, *path, options);
  return flown ? (*host)->checkSilence() : flown;
}

}  // namespace froth
