#include "samples/mirror_room/headless.h"

#include <cstdio>
#include <fstream>
#include <numbers>
#include <utility>

#include <nlohmann/json.hpp>

#include "host/frame_files.h"
#include "host/pass_history.h"
#include "samples/mirror_room/pick.h"
#include "samples/mirror_room/stage.h"

namespace froth {
namespace {

constexpr double kSecondsPerFrame = 1.0 / 30;

// The room's camera, swung around the room's centre: from a little to the right to as much to the left.
Pose poseAt(const Room& room, uint32_t frame, uint32_t frames) {
  constexpr double kSwing = 24 * std::numbers::pi / 180;
  const double share = frames > 1 ? static_cast<double>(frame) / (frames - 1) : 0.5;
  const glm::dquat turn = glm::angleAxis((0.5 - share) * kSwing, glm::dvec3(0, 1, 0));
  const glm::dvec3 centre = room.centre.position;
  return {centre + turn * (room.camera.eye - centre), turn * room.camera.worldFromCamera, room.camera.tanHalfFovY};
}

// What a room's frame took on the GPU, by pass.
Status writeTimes(const MirrorRoomOptions& options, const PassHistory& history) {
  std::printf("GPU %.3f ms:", history.total().median);
  nlohmann::ordered_json passes;
  for (const PassHistory::Row& pass : history.passes()) {
    std::printf(" %s %.3f", pass.name, pass.times.median);
    passes[pass.name] = {{"median", pass.times.median}, {"p5", pass.times.p5}, {"p95", pass.times.p95}};
  }
  std::printf("\n");
  const nlohmann::ordered_json root = {{"width", options.extent.width},
                                       {"height", options.extent.height},
                                       {"frames", options.frames},
                                       {"milliseconds", history.total().median},
                                       {"passes", passes}};
  std::ofstream file(options.json);
  file << root.dump(2) << "\n";
  if (file.good()) return {};
  return makeError(ErrorKind::kIo, "%s: cannot be written; check the folder and the free space", options.json.c_str());
}

Status tellPick(RoomStage& stage, const Pose& pose, const MirrorRoomOptions& options) {
  const Result<std::optional<Pick>> pick = pickAt(stage.scene().context(), stage.room(), stage.meshes(), pose,
                                                  options.extent, *options.picked + glm::dvec2(0.5));
  if (!pick) return pick.error();
  std::printf("picked: %s\n", *pick ? describe(**pick).c_str() : "nothing");
  return {};
}

Status drawFrame(Host& host, RoomStage& stage, const Pose& pose) {
  return submitWholeFrame(host, stage.scene(), [&](VkCommandBuffer commands, uint64_t serial) {
    return stage.record(commands, pose, serial, VK_PIPELINE_STAGE_2_COPY_BIT);
  });
}

// One frame after the other: a GPU that waits for pictures to be written slows its clocks down.
Status timeFrames(Host& host, RoomStage& stage, const MirrorRoomOptions& options) {
  PassHistory history;
  for (uint32_t frame = 0; frame < options.frames; ++frame) {
    if (Status drawn = drawFrame(host, stage, poseAt(stage.room(), frame, options.frames)); !drawn) return drawn;
    const GpuTimer::Times times = stage.renderer().times(host.nextSerial() - 1);
    history.add(times.serial, times.passes);
  }
  return writeTimes(options, history);
}

Status showFrames(Host& host, RoomStage& stage, const MirrorRoomOptions& options) {
  FrameFiles files(options);
  Pose pose;
  for (uint32_t frame = 0; frame < options.frames; ++frame) {
    pose = poseAt(stage.room(), frame, options.frames);
    if (Status drawn = drawFrame(host, stage, pose); !drawn) return drawn;
    const Result<std::vector<float>> texels = host.readImage(stage.renderer().result());
    if (!texels) return texels.error();
    if (Status added = files.add(encodePicture(*texels, options.extent)); !added) return added;
    if (Status moved = stage.advance(kSecondsPerFrame); !moved) return moved;
  }
  if (!options.json.empty()) {
    if (Status timed = timeFrames(host, stage, options); !timed) return timed;
  }
  if (options.picked) {
    if (Status told = tellPick(stage, pose, options); !told) return told;
  }
  return files.finish();
}

}  // namespace

Status showHeadless(const MirrorRoomOptions& options) {
  if (options.frames == 0) return makeError(ErrorKind::kUsage, "--frames 0: give at least one frame");
  Result<std::unique_ptr<Host>> host = Host::create(hostOptionsOf(options));
  if (!host) return host.error();
  Result<std::unique_ptr<RoomStage>> stage = RoomStage::create(**host, options);
  if (!stage) return stage.error();
  if (Status ready = waitUntilReady(**host, (*stage)->scene()); !ready) return ready;
  if (Status placed = (*stage)->placeFoam(); !placed) return placed;
  if (Status sized = (*stage)->renderer().setExtent((*stage)->scene(), options.extent); !sized) return sized;
  const Status shown = showFrames(**host, **stage, options);
  return shown ? (*host)->checkSilence() : shown;
}

}  // namespace froth
