#include "measure/flight/streamed_scene.h"

#include <chrono>
#include <limits>
#include <string_view>
#include <utility>

#include "base/progress_printer.h"
#include "host/make_struct.h"
#include "measure/gpu/texels.h"

namespace froth {
namespace {

// Jobs that a frame at 60 Hz has time for: a chunk takes some milliseconds.
constexpr uint32_t kJobsPerThread = 4;
// What a view wants is known after its first frame; its buffers grow within some frames more.
constexpr uint32_t kRestFrames = 16;
// A chunk that cannot be read is tried for the last time 630 frames after the first.
constexpr uint32_t kMostSettlingFrames = 10000;

}  // namespace

SceneOptions allCellsOf(const SceneOptions& options) {
  SceneOptions whole = options;
  whole.disk = {};
  whole.budget = whole.mostCells = whole.fadeFrames = 0;
  whole.detail = std::numeric_limits<float>::max();
  return whole;
}

Result<std::unique_ptr<StreamedScene>> StreamedScene::create(Host& host, const SceneOptions& options) {
  Result<SimulatedDisk> disk = SimulatedDisk::open(options.asset, options.disk);
  if (!disk) return disk.error();
  std::unique_ptr<StreamedScene> scene(new StreamedScene(host, std::move(*disk), options));
  if (Status begun = scene->begin(); !begun) return begun.error();
  return scene;
}

StreamedScene::~StreamedScene() {
  while (context_ && frothDestroyContext(context_, UINT64_MAX) == FROTH_PENDING) disk_.answerAll();
  if (image_.image) host_.destroyImage(image_);
}

Status StreamedScene::check(FrothResult result, const char* call) const {
  if (result >= FROTH_OK) return {};
  if (!lastMessage_.empty()) return makeError(ErrorKind::kUnsupported, "%s", lastMessage_.c_str());
  return makeError(ErrorKind::kUnsupported, "%s gives %s", call, frothResultName(result));
}

Status StreamedScene::begin() {
  FrothContextInfo info = host_.contextInfo();
  info.deviceBudget = options_.budget;
  info.messageUser = this;
  info.onMessage = [](void* user, FrothSeverity severity, FrothResult, const char* object, const char* text) {
    if (severity != FROTH_SEVERITY_ERROR) return;
    static_cast<StreamedScene*>(user)->lastMessage_ = std::string(object) + ": " + text;
  };
  info.mostJobs = kJobsPerThread * kJobThreads;
  jobs_.giveTo(info);
  if (Status made = check(frothCreateContext(&info, &context_), "frothCreateContext"); !made) return made;
  disk_.answerTo(context_);

  auto streaming = makeStruct<FrothStreamInfo>();
  streaming.detail = options_.detail;
  streaming.mostCells = options_.mostCells;
  if (Status set = check(frothSetStreaming(context_, &streaming), "frothSetStreaming"); !set) return set;
  const FrothReader reader = disk_.reader();
  auto asset = makeStruct<FrothAssetInfo>();
  asset.reader = &reader;
  if (Status opened = check(frothOpenAsset(context_, &asset, &asset_), "frothOpenAsset"); !opened) return opened;
  auto placed = makeStruct<FrothInstanceInfo>();
  placed.asset = asset_;
  FrothInstance instance{};
  if (Status made = check(frothCreateInstance(context_, &placed, &instance), "frothCreateInstance"); !made) return made;
  auto view = makeStruct<FrothViewInfo>();
  view.maxExtent = options_.extent;
  view.measurePasses = 1;
  view.fadeFrames = options_.fadeFrames;
  if (Status made = check(frothCreateView(context_, &view, &view_), "frothCreateView"); !made) return made;
  Result<HostImage> image = host_.createImage(VK_FORMAT_R16G16B16A16_SFLOAT, options_.extent);
  if (!image) return image.error();
  image_ = *image;
  return {};
}

FrothAssetStatus StreamedScene::assetStatus() const {
  auto status = makeStruct<FrothAssetStatus>();
  frothGetAssetStatus(context_, asset_, &status);
  return status;
}

Result<std::vector<uint32_t>> StreamedScene::drawnChunks() const {
  uint32_t count = 0;
  Status asked = check(frothGetChunks(context_, asset_, 0, nullptr, &count), "frothGetChunks");
  if (!asked) return asked.error();
  std::vector<FrothChunk> chunks(count);
  asked = check(frothGetChunks(context_, asset_, count, chunks.data(), &count), "frothGetChunks");
  if (!asked) return asked.error();
  std::vector<uint32_t> drawn;
  for (uint32_t chunk = 0; chunk < count; ++chunk) {
    if (chunks[chunk].state == FROTH_CHUNK_DRAWN) drawn.push_back(chunk);
  }
  return drawn;
}

Status StreamedScene::record(const View& view, VkCommandBuffer commands, uint64_t serial, FlownFrame& frame) {
  auto begun = makeStruct<FrothFrame>();
  begun.serial = serial;
  begun.completedSerial = serial - 1;
  auto status = makeStruct<FrothFrameStatus>();
  const auto start = std::chrono::steady_clock::now();
  const FrothResult updated = frothUpdate(context_, &begun, &status);
  frame.updateMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (Status good = check(updated, "frothUpdate"); !good) return good;
  frame.deviceBytes = status.deviceBytes;
  if (Status completed = completeFrameBefore(); !completed) return completed;
  if (Status copied = check(frothRecordUpload(context_, commands), "frothRecordUpload"); !copied) return copied;

  const FrothAssetStatus asset = assetStatus();
  if (asset.state == FROTH_ASSET_FAILED) return check(asset.error, "frothOpenAsset");
  frame.isReady = asset.state == FROTH_ASSET_READY;
  FrothRenderInfo info = renderInfoOf(view, options_.render);
  info.colour = host_.describe(image_);
  const FrothResult drawn = infoOf(options_.render.method).record(context_, view_, commands, &info);
  frame.isWhole = drawn == FROTH_OK;
  frame.stream = makeStruct<FrothStreamStatus>();
  if (Status good = check(frothGetStreamStatus(context_, &frame.stream), "frothGetStreamStatus"); !good) return good;
  return check(drawn, infoOf(options_.render.method).call);
}

// The counts of a frame are known in the frothUpdate after it.
Status StreamedScene::completeFrameBefore() {
  if (frames_.empty()) return {};
  FlownFrame& before = frames_.back();
  auto status = makeStruct<FrothViewStatus>();
  if (Status asked = check(frothGetViewStatus(context_, view_, &status), "frothGetViewStatus"); !asked) return asked;
  for (uint32_t pass = 0; pass < status.passCount; ++pass) {
    before.gpuMs += status.passes[pass].milliseconds;
    before.isFading = before.isFading || std::string_view(status.passes[pass].name) == "fade";
  }
  if (status.bits != 0) before.isWhole = false;
  return {};
}

Status StreamedScene::draw(const View& view) {
  if (isStopRequested()) return stoppedError();
  const double now = static_cast<double>(frames_.size()) * options_.frameSeconds;
  if (Status read = disk_.advance(now); !read) return read;
  FlownFrame frame;
  const Status drawn =
      host_.submit([&](VkCommandBuffer commands, uint64_t serial) { return record(view, commands, serial, frame); });
  if (!drawn) return drawn;
  jobs_.runAll();
  frames_.push_back(frame);
  return {};
}

Status StreamedScene::settle(const View& view) {
  uint32_t atRest = 0;
  for (uint32_t drawn = 0; drawn < kMostSettlingFrames; ++drawn) {
    if (Status good = draw(view); !good) return good;
    const bool isAtRest = frames_.back().isReady && frames_.back().stream.isSettled;
    atRest = isAtRest ? atRest + 1 : 0;
    if (atRest >= kRestFrames) return {};
  }
  return makeError(ErrorKind::kUnsupported, "%s does not settle in %u frames", options_.asset.string().c_str(),
                   kMostSettlingFrames);
}

Result<FlownImage> StreamedScene::readImage() {
  const Result<std::vector<float>> texels = host_.readImage(image_);
  if (!texels) return texels.error();
  const VkExtent2D extent = options_.extent;
  return FlownImage{imageFromTexels(*texels, 4, 0, 3, extent), imageFromTexels(*texels, 4, 3, 1, extent)};
}

}  // namespace froth
