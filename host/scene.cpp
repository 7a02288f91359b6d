#include "host/scene.h"

#include <algorithm>
#include <utility>

namespace froth {
namespace {

// What a call that fills a status tells. call(status): the call's result.
template <class Answer, class Call>
Result<Answer> askStatus(const Scene& scene, const char* name, Call&& call) {
  Answer answer{};
  answer.structSize = sizeof(answer);
  if (Status asked = scene.check(call(&answer), name); !asked) return asked.error();
  return answer;
}

}  // namespace

Status Scene::check(FrothResult result, const char* call) const {
  if (result >= FROTH_OK) return {};  // what is positive is information, such as an asset that is still loading
  const bool isFileFault = result == FROTH_ERROR_FILE || result == FROTH_ERROR_VERSION;
  const ErrorKind kind = isFileFault ? ErrorKind::kBadInput : ErrorKind::kUnsupported;
  const std::string fault = http_ ? http_->lastFault() : "";
  if (!fault.empty()) return makeError(kind, "%s: %s", lastMessage_.c_str(), fault.c_str());
  if (!lastMessage_.empty()) return makeError(kind, "%s", lastMessage_.c_str());
  return makeError(kind, "%s gives %s", call, frothResultName(result));
}

Result<std::unique_ptr<Scene>> Scene::create(FrothContextInfo info, const std::string& asset, const SceneUses& uses) {
  std::unique_ptr<Scene> scene(new Scene());
  info.messageUser = scene.get();
  info.onMessage = [](void* user, FrothSeverity severity, FrothResult, const char* object, const char* text) {
    if (severity == FROTH_SEVERITY_ERROR) static_cast<Scene*>(user)->lastMessage_ = std::string(object) + ": " + text;
  };
  Status made = scene->check(frothCreateContext(&info, &scene->context_), "frothCreateContext");
  if (!made) return made.error();

  scene->uses_ = uses;
  if (Status opened = scene->open(asset); !opened) return opened.error();

  // An instance may exist before its asset is ready: it appears once it is.
  FrothInstanceInfo instanceInfo{};
  instanceInfo.structSize = sizeof(instanceInfo);
  instanceInfo.asset = scene->assetHandle_;
  made = scene->check(frothCreateInstance(scene->context_, &instanceInfo, &scene->instance_), "frothCreateInstance");
  if (!made) return made.error();
  return scene;
}

FrothAssetInfo Scene::assetInfo() const {
  FrothAssetInfo info{};
  info.structSize = sizeof(info);
  info.keepForQueries = uses_.isQueried ? 1 : 0;
  info.prepareRays = uses_.prepareRays;
  return info;
}

Status Scene::open(const std::string& asset) {
  FrothAssetInfo info = assetInfo();
  FrothReader reader{};
  if (isUrl(asset)) {
    Result<std::unique_ptr<HttpReader>> http = HttpReader::open(asset, context_);
    if (!http) return http.error();
    http_ = std::move(*http);
    reader = http_->reader();
    info.reader = &reader;
  } else {
    info.path = asset.c_str();
  }
  return check(frothOpenAsset(context_, &info, &assetHandle_), "frothOpenAsset");
}

Status Scene::replace(const std::string& path) {
  FrothAssetInfo info = assetInfo();
  info.path = path.c_str();
  return check(frothReplaceAsset(context_, assetHandle_, &info), "frothReplaceAsset");
}

Result<FrothReplacementStatus> Scene::replacement() const {
  return askStatus<FrothReplacementStatus>(*this, "frothGetReplacement", [&](FrothReplacementStatus* status) {
    return frothGetReplacement(context_, assetHandle_, status);
  });
}

Scene::~Scene() {
  if (!context_ || frothDestroyContext(context_, UINT64_MAX) != FROTH_PENDING) return;
  http_.reset();  // answers what is under way
  frothDestroyContext(context_, UINT64_MAX);
}

Status Scene::setExtent(VkExtent2D extent, bool keepsHits) {
  if (extent_.width > 0) {
    if (Status gone = check(frothDestroyView(context_, view_), "frothDestroyView"); !gone) return gone;
    extent_ = {};
  }
  FrothViewInfo info{};
  info.structSize = sizeof(info);
  info.maxExtent = extent;
  info.measurePasses = 1;
  info.keepsHits = keepsHits ? 1 : 0;
  if (Status made = check(frothCreateView(context_, &info, &view_), "frothCreateView"); !made) return made;
  extent_ = extent;
  return {};
}

Status Scene::beginFrame(VkCommandBuffer commands, uint64_t serial, uint64_t completedSerial) {
  FrothFrame frame{};
  frame.structSize = sizeof(frame);
  frame.serial = serial;
  frame.completedSerial = completedSerial;
  frame_.structSize = sizeof(frame_);
  if (Status updated = check(frothUpdate(context_, &frame, &frame_), "frothUpdate"); !updated) return updated;
  if (Status copied = check(frothRecordUpload(context_, commands), "frothRecordUpload"); !copied) return copied;

  asset_.structSize = sizeof(asset_);
  if (Status asked = check(frothGetAssetStatus(context_, assetHandle_, &asset_), "frothGetAssetStatus"); !asked) {
    return asked;
  }
  if (asset_.state == FROTH_ASSET_FAILED) return check(asset_.error, "frothOpenAsset");
  return isReady() && levelCount_ == 0 ? countLevels() : Status();
}

Status Scene::countLevels() {
  const Result<std::vector<FrothChunk>> found = chunks();
  if (!found) return found.error();
  for (const FrothChunk& chunk : *found) levelCount_ = std::max(levelCount_, chunk.level + 1);
  return {};
}

Result<std::vector<FrothChunk>> Scene::chunks() const {
  std::vector<FrothChunk> chunks(asset_.chunkCount);
  uint32_t count = 0;
  const FrothResult copied = frothGetChunks(context_, assetHandle_, asset_.chunkCount, chunks.data(), &count);
  if (Status got = check(copied, "frothGetChunks"); !got) return got.error();
  chunks.resize(std::min<size_t>(chunks.size(), count));
  return chunks;
}

Result<FrothStreamStatus> Scene::streamStatus() const {
  return askStatus<FrothStreamStatus>(
      *this, "frothGetStreamStatus", [&](FrothStreamStatus* status) { return frothGetStreamStatus(context_, status); });
}

Status Scene::draw(VkCommandBuffer commands, Method method, FrothRenderInfo info) {
  info.structSize = sizeof(info);
  info.nearRatio = FROTH_NEAR_DEFAULT;
  info.nearDepth = FROTH_NEAR_DEFAULT;
  return check(infoOf(method).record(context_, view_, commands, &info), infoOf(method).call);
}

Status Scene::place(FrothInstanceInfo placement) {
  placement.structSize = sizeof(placement);
  placement.asset = assetHandle_;
  return check(frothSetInstance(context_, instance_, &placement), "frothSetInstance");
}

Result<FrothViewStatus> Scene::viewStatus() const {
  return askStatus<FrothViewStatus>(*this, "frothGetViewStatus", [&](FrothViewStatus* status) {
    return frothGetViewStatus(context_, view_, status);
  });
}

Result<CameraPath> Scene::path(std::vector<Pose> keys) const {
  if (!keys.empty()) return CameraPath(std::move(keys));

  std::vector<FrothStoredCamera> stored(asset_.flightPathCount);
  uint32_t count = 0;
  const FrothResult copied = frothGetFlightPath(context_, assetHandle_, asset_.flightPathCount, stored.data(), &count);
  if (Status got = check(copied, "frothGetFlightPath"); !got) return got.error();
  for (const FrothStoredCamera& camera : stored) keys.push_back(poseOf(camera));
  if (keys.empty() && asset_.hasStartView) keys.push_back(poseOf(asset_.startView));
  if (keys.empty()) return orbitPath(asset_.boundsMin, asset_.boundsMax);
  return CameraPath(std::move(keys));
}

Status submitFrame(Host& host, Scene& scene, const RecordFrame& record) {
  return host.submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
    if (Status begun = scene.beginFrame(commands, serial, serial - 1); !begun) return begun;
    return record(commands, serial);
  });
}

Status waitUntilReady(Host& host, Scene& scene) {
  while (!scene.isReady()) {
    if (Status loaded = submitFrame(host, scene, [](VkCommandBuffer, uint64_t) { return Status(); }); !loaded) {
      return loaded;
    }
  }
  return {};
}

Status submitWholeFrame(Host& host, Scene& scene, const RecordFrame& record) {
  constexpr int kMaxAttempts = 32;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    Status drawn = submitFrame(host, scene, record);
    if (!drawn) return drawn;
    // What a frame met is known at the start of the next one.
    drawn = submitFrame(host, scene, [](VkCommandBuffer, uint64_t) { return Status(); });
    if (!drawn) return drawn;
    const Result<FrothViewStatus> status = scene.viewStatus();
    if (!status) return status.error();
    if ((status->bits & (FROTH_VIEW_CELL_OVERFLOW | FROTH_VIEW_PAIR_OVERFLOW)) == 0) return {};
  }
  return makeError(ErrorKind::kUnsupported,
                   "a frame still overflows after %d attempts; use a smaller --size or a larger budget", kMaxAttempts);
}

}  // namespace froth
