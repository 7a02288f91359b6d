#include "measure/flight/streamed_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include <glm/glm.hpp>

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
// What an application sets itself, whatever is streamed.
constexpr uint32_t kLimitBits = FROTH_VIEW_ENTRY_LIMIT | FROTH_VIEW_STEP_LIMIT;
// Between copies, of the box of the asset.
constexpr double kCopyGap = 0.05;

// The nearest places of a grid, the origin first.
std::vector<glm::ivec3> nearestPlaces(uint32_t count) {
  const int reach = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(count)))) - 1;
  std::vector<glm::ivec3> places;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) places.emplace_back(x, y, z);
    }
  }
  const auto squaredDistance = [](const glm::ivec3& p) { return p.x * p.x + p.y * p.y + p.z * p.z; };
  std::ranges::stable_sort(places, {}, squaredDistance);
  places.resize(count);
  return places;
}

}  // namespace

SceneOptions allCellsOf(const SceneOptions& options) {
  SceneOptions whole = options;
  whole.disk = {};
  whole.budget = whole.mostCells = whole.fadeFrames = whole.reserveCells = 0;
  whole.detail = kAllCells;
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
  if (Status opened = openAssets(); !opened) return opened;
  auto view = makeStruct<FrothViewInfo>();
  view.maxExtent = options_.extent;
  view.measurePasses = 1;
  view.fadeFrames = options_.fadeFrames;
  view.reserveCells = options_.reserveCells;
  if (Status made = check(frothCreateView(context_, &view, &view_), "frothCreateView"); !made) return made;
  Result<HostImage> image = host_.createImage(VK_FORMAT_R16G16B16A16_SFLOAT, options_.extent);
  if (!image) return image.error();
  image_ = *image;
  return {};
}

Status StreamedScene::openAssets() {
  const FrothReader reader = disk_.reader();
  auto info = makeStruct<FrothAssetInfo>();
  info.reader = &reader;
  assets_.resize(options_.copies);
  for (FrothAsset& asset : assets_) {
    if (Status opened = check(frothOpenAsset(context_, &info, &asset), "frothOpenAsset"); !opened) return opened;
  }
  return placeCopy(0);
}

// The bounds of an asset are known when it is READY, so until then the first copy stands alone.
Status StreamedScene::placeCopies(bool& arePlaced) {
  arePlaced = true;
  for (size_t copy = 0; copy < assets_.size(); ++copy) {
    const FrothAssetStatus status = statusOf(assets_[copy]);
    if (status.state == FROTH_ASSET_FAILED) return check(status.error, "frothOpenAsset");
    arePlaced = arePlaced && status.state == FROTH_ASSET_READY && copy < placed_;
    if (status.state != FROTH_ASSET_READY || copy != placed_) continue;
    if (Status made = placeCopy(copy); !made) return made;
  }
  return {};
}

Status StreamedScene::placeCopy(size_t copy) {
  const FrothAssetStatus status = assetStatus();
  const glm::ivec3 place = nearestPlaces(options_.copies)[copy];
  auto info = makeStruct<FrothInstanceInfo>();
  info.asset = assets_[copy];
  for (int axis = 0; axis < 3; ++axis) {
    info.position[axis] = (1 + kCopyGap) * (status.boundsMax[axis] - status.boundsMin[axis]) * place[axis];
  }
  FrothInstance instance{};
  ++placed_;
  return check(frothCreateInstance(context_, &info, &instance), "frothCreateInstance");
}

FrothAssetStatus StreamedScene::statusOf(FrothAsset asset) const {
  auto status = makeStruct<FrothAssetStatus>();
  frothGetAssetStatus(context_, asset, &status);
  return status;
}

Result<std::vector<uint32_t>> StreamedScene::drawnChunks() const {
  std::vector<uint32_t> drawn;
  uint32_t before = 0;
  for (const FrothAsset asset : assets_) {
    uint32_t count = 0;
    Status asked = check(frothGetChunks(context_, asset, 0, nullptr, &count), "frothGetChunks");
    if (!asked) return asked.error();
    std::vector<FrothChunk> chunks(count);
    asked = check(frothGetChunks(context_, asset, count, chunks.data(), &count), "frothGetChunks");
    if (!asked) return asked.error();
    for (uint32_t chunk = 0; chunk < count; ++chunk) {
      if (chunks[chunk].state == FROTH_CHUNK_DRAWN) drawn.push_back(before + chunk);
    }
    before += count;
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

  if (Status placed = placeCopies(frame.isReady); !placed) return placed;
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
  before.passes.assign(status.passes, status.passes + status.passCount);
  for (const FrothPassTime& pass : before.passes) {
    before.gpuMs += pass.milliseconds;
    before.isFading = before.isFading || std::string_view(pass.name) == "fade";
  }
  before.isLimited = (status.bits & kLimitBits) != 0;
  if ((status.bits & ~kLimitBits) != 0) before.isWhole = false;
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
