#include "samples/flythrough/headless.h"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "samples/flythrough/cameras_json.h"
#include "samples/flythrough/picture_file.h"

namespace froth {
namespace {

constexpr uint32_t kMaxSheetPictures = 12;

// Host::submit() waits, so the frame before is always complete.
Status submitFrame(Host& host, Scene& scene, const std::function<Status(VkCommandBuffer)>& draw) {
  return host.submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
    if (Status begun = scene.beginFrame(commands, serial, serial - 1); !begun) return begun;
    return draw(commands);
  });
}

Status waitUntilReady(Host& host, Scene& scene) {
  while (!scene.isReady()) {
    if (Status loaded = submitFrame(host, scene, [](VkCommandBuffer) { return Status(); }); !loaded)
      return loaded;
  }
  return {};
}

// A file should show the whole foam: a frame that overflowed is drawn again, as beginFrame() made room.
Status drawWhole(Host& host, Scene& scene, Painter& painter, Picture picture, const Pose& pose) {
  constexpr int kMaxAttempts = 32;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    Status drawn = submitFrame(host, scene, [&](VkCommandBuffer commands) {
      return painter.record(commands, scene, picture, pose, VK_PIPELINE_STAGE_2_COPY_BIT);
    });
    if (!drawn) return drawn;
    // What a frame met is known at the start of the next one.
    drawn = submitFrame(host, scene, [](VkCommandBuffer) { return Status(); });
    if (!drawn) return drawn;
    const Result<FrothViewStatus> status = scene.viewStatus();
    if (!status) return status.error();
    if ((status->bits & (FROTH_VIEW_CELL_OVERFLOW | FROTH_VIEW_PAIR_OVERFLOW)) == 0) return {};
  }
  return makeError(ErrorKind::kUnsupported, "a frame still overflows after %d attempts; use a smaller --size",
                   kMaxAttempts);
}

std::filesystem::path framePath(const FlythroughOptions& options, uint32_t frame) {
  char name[32];
  std::snprintf(name, sizeof(name), "frame_%04u.png", frame);
  return options.output / name;
}

// Evenly spread over the flight, the first frame among them.
bool isOnSheet(uint32_t frame, uint32_t frames) {
  const uint64_t shown = std::min(frames, kMaxSheetPictures);
  return frame == 0 || frame * shown / frames != (frame - 1) * shown / frames;
}

Status compareWithExpected(const FlythroughOptions& options, const Picture8& last) {
  const Result<Picture8> expected = readPicture(options.compare);
  if (!expected) return expected.error();
  const Result<double> psnr = comparePictures(*expected, last);
  if (!psnr) return psnr.error();
  std::printf("last frame against %s: %.2f dB\n", options.compare.c_str(), *psnr);
  if (*psnr >= options.minPsnr) return {};
  return makeError(ErrorKind::kUnsupported, "the last frame is %.2f dB from %s, below --min-psnr %.2f", *psnr,
                   options.compare.c_str(), options.minPsnr);
}

Status checkSilence(const Host& host) {
  const std::vector<std::string> messages = host.validationMessages();
  if (messages.empty()) return {};
  return makeError(ErrorKind::kUnsupported, "%zu validation messages; the first: %s", messages.size(),
                   messages.front().c_str());
}

Status flyPath(Host& host, Scene& scene, Painter& painter, const CameraPath& path,
               const FlythroughOptions& options) {
  std::vector<Picture8> sheet;
  Picture8 picture;
  for (uint32_t frame = 0; frame < options.frames; ++frame) {
    const double share = options.frames > 1 ? static_cast<double>(frame) / (options.frames - 1) : 0.0;
    if (Status drawn = drawWhole(host, scene, painter, options.picture, path.at(share)); !drawn) return drawn;
    const Result<std::vector<float>> texels = host.readImage(painter.result());
    if (!texels) return texels.error();
    picture = encodePicture(*texels, options.extent);
    if (Status written = writePicture(framePath(options, frame), picture); !written) return written;
    if (isOnSheet(frame, options.frames)) sheet.push_back(picture);
  }
  if (Status written = writePicture(options.output / "contact_sheet.png", contactSheet(sheet)); !written)
    return written;
  std::printf("%u frames and contact_sheet.png in %s\n", options.frames, options.output.c_str());
  return options.compare.empty() ? Status() : compareWithExpected(options, picture);
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
  return flown ? checkSilence(**host) : flown;
}

}  // namespace froth
