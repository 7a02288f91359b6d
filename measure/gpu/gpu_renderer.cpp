#include "measure/gpu/gpu_renderer_state.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/progress_printer.h"
#include "froth/froth_stream.h"
#include "host/make_struct.h"
#include "measure/gpu/gpu_camera.h"
#include "measure/gpu/texels.h"
#include "reference/camera/ray_map.h"
#include "reference/image/distances.h"

namespace froth {
namespace {

// Each frothUpdate at least doubles what overflowed, so this reaches any size that fits into memory.
constexpr int kMaxRedraws = 32;

ErrorKind errorKindOf(FrothResult result) {
  return result == FROTH_ERROR_FILE || result == FROTH_ERROR_VERSION ? ErrorKind::kBadInput : ErrorKind::kUnsupported;
}

VkExtent2D extentOf(const View& view) { return {view.width, view.height}; }

}  // namespace

FrothRenderInfo renderInfoOf(const View& view, const GpuRenderOptions& options) {
  FrothRenderInfo info{};
  info.structSize = sizeof(info);
  info.cutoff = options.cutoff > 0 ? options.cutoff : -1.0f;
  info.nearRatio = view.nearRatio ? static_cast<float>(*view.nearRatio) : FROTH_NEAR_DEFAULT;
  info.nearDepth = view.nearDepth ? static_cast<float>(*view.nearDepth) : FROTH_NEAR_DEFAULT;
  info.displayCoded = options.isLinear ? 0 : 1;
  info.maxSteps = options.maxSteps;
  info.maxEntries = options.maxEntries;
  info.tileForm = options.tileForm;
  info.camera = cameraOf(view, options.ends);
  for (int axis = 0; axis < 2; ++axis) info.camera.jitter[axis] = options.jitter[axis];
  return info;
}

GpuRenderer::State::~State() {
  if (host) destroyImages();
  for (HostImage* image : {&rays, &sceneDepth}) {
    if (image->image) host->destroyImage(*image);
  }
  if (context) frothDestroyContext(context, UINT64_MAX);  // every submission was waited for
}

Error GpuRenderer::State::error(FrothResult result, const char* call) const {
  if (!lastMessage.empty()) return makeError(errorKindOf(result), "%s", lastMessage.c_str());
  return makeError(errorKindOf(result), "%s gives %s", call, frothResultName(result));
}

Status GpuRenderer::State::check(FrothResult result, const char* call) const {
  if (result >= FROTH_OK) return {};
  return error(result, call);
}

Status GpuRenderer::State::createContext(const GpuDeviceOptions& deviceOptions) {
  options = deviceOptions;
  Result<std::unique_ptr<Host>> created = Host::create({options.device, options.validate});
  if (!created) return created.error();
  host = std::move(*created);

  FrothContextInfo info = host->contextInfo();
  info.checkIndices = options.checkIndices ? 1 : 0;
  info.floatColours = options.floatColours ? 1 : 0;
  info.countWork = options.countWork ? 1 : 0;
  info.lensClasses = options.lensClasses;
  info.walkShaders = options.castsRays ? 1 : 0;
  info.messageUser = this;
  info.onMessage = [](void* user, FrothSeverity severity, FrothResult, const char* object, const char* text) {
    if (severity != FROTH_SEVERITY_ERROR) return;
    static_cast<State*>(user)->lastMessage = fmt::format("{}: {}", object, text);
  };
  return check(frothCreateContext(&info, &context), "frothCreateContext");
}

Status GpuRenderer::State::closeAsset() {
  while (!instances.empty()) {
    if (Status gone = check(frothDestroyInstance(context, instances.back()), "frothDestroyInstance"); !gone) {
      return gone;
    }
    instances.pop_back();
  }
  if (hasAsset) {
    if (Status gone = check(frothCloseAsset(context, asset), "frothCloseAsset"); !gone) return gone;
  }
  hasAsset = false;
  return {};
}

Status GpuRenderer::State::openAsset(const AssetInput& input, const Progress& progress) {
  const std::string path = input.path.string();
  FrothAssetInfo info{};
  info.structSize = sizeof(info);
  info.layers = input.layers;
  info.keepForQueries = options.castsRays ? 1 : 0;
  info.prepareRays = options.prepareRays;
  if (input.bytes.empty()) {
    info.path = path.c_str();
  } else {
    info.data = input.bytes.data();
    info.dataSize = input.bytes.size();
  }
  if (Status opened = check(frothOpenAsset(context, &info, &asset), "frothOpenAsset"); !opened) return opened;
  hasAsset = true;

  for (uint64_t frame = 0;; ++frame) {
    if (!report(progress, "upload", frame, 0)) return stoppedError();
    if (Status submitted = submitFrame(); !submitted) return submitted;
    FrothAssetStatus status{};
    status.structSize = sizeof(status);
    if (Status asked = check(frothGetAssetStatus(context, asset, &status), "frothGetAssetStatus"); !asked) return asked;
    if (status.state == FROTH_ASSET_FAILED) return error(status.error, "frothOpenAsset");
    if (status.state == FROTH_ASSET_READY) return {};
  }
}

Result<std::vector<FrothChunk>> GpuRenderer::State::chunks() const {
  uint32_t count = 0;
  Status asked = check(frothGetChunks(context, asset, 0, nullptr, &count), "frothGetChunks");
  if (!asked) return asked.error();
  std::vector<FrothChunk> chunks(count);
  asked = check(frothGetChunks(context, asset, count, chunks.data(), &count), "frothGetChunks");
  if (!asked) return asked.error();
  return chunks;
}

Status GpuRenderer::State::place(const std::vector<FrothInstanceInfo>& placements) {
  for (FrothInstanceInfo info : placements) {
    info.structSize = sizeof(info);
    info.asset = asset;
    FrothInstance instance{};
    if (Status placed = check(frothCreateInstance(context, &info, &instance), "frothCreateInstance"); !placed) {
      return placed;
    }
    instances.push_back(instance);
  }
  return {};
}

void GpuRenderer::State::destroyImages() {
  for (HostImage* image : {&colour, &distance, &normal}) {
    if (image->image) host->destroyImage(*image);
  }
}

Status GpuRenderer::State::setExtent(VkExtent2D wanted, bool wantsAllChannels) {
  const bool hasAllChannels = normal.image != VK_NULL_HANDLE;
  if (wanted.width == extent.width && wanted.height == extent.height && wantsAllChannels == hasAllChannels) return {};

  destroyImages();
  if (extent.width > 0) {
    if (Status gone = check(frothDestroyView(context, view), "frothDestroyView"); !gone) return gone;
  }
  extent = {};
  FrothViewInfo info{};
  info.structSize = sizeof(info);
  info.maxExtent = wanted;
  info.measurePasses = options.measurePasses ? 1 : 0;
  info.lensClasses = options.lensClasses;
  info.keepsHits = options.keepsHits ? 1 : 0;
  if (Status made = check(frothCreateView(context, &info, &view), "frothCreateView"); !made) return made;
  extent = wanted;

  const auto make = [&](HostImage& image, VkFormat format) -> Status {
    Result<HostImage> made = host->createImage(format, wanted);
    if (!made) return made.error();
    image = *made;
    return {};
  };
  if (!wantsAllChannels) return make(colour, VK_FORMAT_R16G16B16A16_SFLOAT);
  if (Status made = make(colour, VK_FORMAT_R32G32B32A32_SFLOAT); !made) return made;
  if (Status made = make(distance, VK_FORMAT_R32_SFLOAT); !made) return made;
  return make(normal, VK_FORMAT_R16G16B16A16_SFLOAT);
}

Status GpuRenderer::State::setRayMap(const View& wanted) {
  if (wanted.lens.kind != LensKind::kRayMap || wanted.lens.rays == uploadedRays) return {};
  if (rays.image) host->destroyImage(rays);
  uploadedRays.reset();
  Result<HostImage> made = host->createImage(VK_FORMAT_R32G32B32A32_SFLOAT, extentOf(wanted));
  if (!made) return made.error();
  rays = *made;
  std::vector<float> texels;
  texels.reserve(wanted.lens.rays->directions.size() * 4);
  for (const glm::vec3& d : wanted.lens.rays->directions) texels.insert(texels.end(), {d.x, d.y, d.z, 0.0f});
  if (Status written = host->writeImage(rays, texels); !written) return written;
  uploadedRays = wanted.lens.rays;
  return {};
}

Status GpuRenderer::State::setSceneDepth(const View& wanted, const GpuRenderOptions& drawing) {
  if (sceneDepth.image) host->destroyImage(sceneDepth);
  if (!drawing.ends) return {};
  const bool isProjection = lensClassesOf(wanted) != FROTH_LENS_CLASS_MAPPED;
  Result<HostImage> made =
      host->createImage(isProjection ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_R32_SFLOAT, extentOf(wanted));
  if (!made) return made.error();
  sceneDepth = *made;
  View jittered = wanted;  // whose rays the pixels have
  jittered.cx += drawing.jitter.x;
  jittered.cy += drawing.jitter.y;
  return host->writeImage(sceneDepth, sceneDepthOf(jittered, *drawing.ends));
}

Status GpuRenderer::State::submitFrame(const std::function<Status(VkCommandBuffer)>& record) {
  return host->submit([&](VkCommandBuffer commands, uint64_t serial) -> Status {
    FrothFrame frame{};
    frame.structSize = sizeof(frame);
    frame.serial = serial;
    frame.completedSerial = serial - 1;
    if (Status updated = check(frothUpdate(context, &frame, nullptr), "frothUpdate"); !updated) return updated;
    if (Status copied = check(frothRecordUpload(context, commands), "frothRecordUpload"); !copied) return copied;
    return record ? record(commands) : Status();
  });
}

// Of an asset without levels always.
Result<bool> GpuRenderer::State::isSettled() const {
  auto status = makeStruct<FrothStreamStatus>();
  const Status asked = check(frothGetStreamStatus(context, &status), "frothGetStreamStatus");
  if (!asked) return asked.error();
  return status.isSettled != 0;
}

Result<FrothViewStatus> GpuRenderer::State::drawAndAsk(const FrothRenderInfo& wanted, Method method) {
  FrothRenderInfo info = wanted;
  info.colour = host->describe(colour);
  if (distance.image) info.distance = host->describe(distance);
  if (normal.image) info.normal = host->describe(normal);
  if (info.camera.lens.kind == FROTH_LENS_RAY_MAP) info.camera.lens.rayMap = host->describeInput(rays);
  if (sceneDepth.image) info.sceneDepth = host->describeInput(sceneDepth);

  const auto record = [&](VkCommandBuffer commands) {
    return check(infoOf(method).record(context, view, commands, &info), infoOf(method).call);
  };
  FrothViewStatus status{};
  bool wasSettled = !hasLevels;
  for (int attempt = 0; attempt <= kMaxRedraws; ++attempt) {
    if (isStopRequested()) return stoppedError();
    if (Status drawn = submitFrame(record); !drawn) return drawn.error();
    // The counts of a frame are known in the frothUpdate after it.
    if (Status updated = submitFrame(); !updated) return updated.error();
    status = {};
    status.structSize = sizeof(status);
    if (Status asked = check(frothGetViewStatus(context, view, &status), "frothGetViewStatus"); !asked) {
      return asked.error();
    }
    const Result<bool> settled = isSettled();
    if (!settled) return settled.error();
    // What a camera wants is known after its first frame, and may be there before the next one.
    const bool isOfWanted = *settled && wasSettled;
    wasSettled = *settled || !hasLevels;
    if (!isOfWanted) {
      attempt = -1;  // another cut is drawn next, which may want more room
    } else if ((status.bits & (FROTH_VIEW_CELL_OVERFLOW | FROTH_VIEW_PAIR_OVERFLOW)) == 0) {
      break;
    }
  }
  if (status.bits & FROTH_VIEW_NO_WALK_GRAPH) {
    return makeError(ErrorKind::kUnsupported, "the asset holds no walk graph; use --renderer raster");
  }
  if (Status silent = checkSilence(status.indexViolations); !silent) return silent.error();
  return status;
}

Status GpuRenderer::State::checkSilence(uint32_t indexViolations) {
  if (indexViolations > 0) {
    return makeError(ErrorKind::kUnsupported, "shaders met %u indices out of range; this is a fault of Froth",
                     indexViolations);
  }
  const std::vector<std::string> messages = host->validationMessages();
  if (messages.empty()) return {};
  host->forgetValidationMessages();  // told once
  return makeError(ErrorKind::kUnsupported, "%zu validation messages; the first: %s", messages.size(),
                   messages.front().c_str());
}

Result<RenderedImages> GpuRenderer::State::readImages(bool readsNormal) {
  Result<std::vector<float>> colours = host->readImage(colour);
  if (!colours) return colours.error();
  RenderedImages images;
  images.colour = imageFromTexels(*colours, 4, 0, 3, extent);
  images.alpha = imageFromTexels(*colours, 4, 3, 1, extent);
  if (!distance.image) return images;
  Result<std::vector<float>> distances = host->readImage(distance);
  if (!distances) return distances.error();
  images.distance = imageFromTexels(*distances, 1, 0, 1, extent);
  markMissingDistances(images.distance);
  if (!readsNormal) return images;
  Result<std::vector<float>> normals = host->readImage(normal);
  if (!normals) return normals.error();
  images.normal = imageFromTexels(*normals, 4, 0, 3, extent);
  return images;
}

GpuRenderer::GpuRenderer() : state_(std::make_unique<State>()) {}
GpuRenderer::~GpuRenderer() = default;

Result<std::unique_ptr<GpuRenderer>> GpuRenderer::create(const GpuDeviceOptions& options) {
  std::unique_ptr<GpuRenderer> renderer(new GpuRenderer());
  if (Status made = renderer->state_->createContext(options); !made) return made.error();
  return renderer;
}

Status GpuRenderer::load(const AssetInput& asset, const Progress& progress,
                         const std::vector<FrothInstanceInfo>& placements) {
  state_->lastMessage.clear();
  if (Status closed = state_->closeAsset(); !closed) return closed;
  if (Status opened = state_->openAsset(asset, progress); !opened) return opened;
  const Result<std::vector<FrothChunk>> chunks = state_->chunks();
  if (!chunks) return chunks.error();
  state_->hasLevels = std::ranges::any_of(*chunks, [](const FrothChunk& chunk) { return chunk.level > 0; });
  return state_->place(placements);
}

Result<GpuFrame> GpuRenderer::State::drawAndRead(const View& wanted, const GpuRenderOptions& drawing,
                                                 bool wantsAllChannels) {
  if (Status ready = setExtent(extentOf(wanted), wantsAllChannels); !ready) return ready.error();
  if (Status ready = setRayMap(wanted); !ready) return ready.error();
  if (Status ready = setSceneDepth(wanted, drawing); !ready) return ready.error();
  const Result<FrothViewStatus> status = drawAndAsk(renderInfoOf(wanted, drawing), drawing.method);
  if (!status) return status.error();
  Result<RenderedImages> images = readImages(drawing.readsNormal);
  if (!images) return images.error();
  return GpuFrame{std::move(*images), *status};
}

Result<GpuFrame> GpuRenderer::render(const View& view, const GpuRenderOptions& options) {
  return state_->drawAndRead(view, options, true);
}

Result<GpuFrame> GpuRenderer::renderColour(const View& view, const GpuRenderOptions& options) {
  return state_->drawAndRead(view, options, false);
}

Result<FrothViewStatus> GpuRenderer::draw(const View& view, const GpuRenderOptions& options) {
  if (Status ready = state_->setExtent(extentOf(view), options.isFull); !ready) return ready.error();
  if (Status ready = state_->setRayMap(view); !ready) return ready.error();
  if (Status ready = state_->setSceneDepth(view, options); !ready) return ready.error();
  return state_->drawAndAsk(renderInfoOf(view, options), options.method);
}

Status GpuRenderer::setStreaming(const GpuStreaming& streaming) {
  Status set = state_->check(frothSetBudget(state_->context, streaming.budget), "frothSetBudget");
  if (!set) return set;
  auto info = makeStruct<FrothStreamInfo>();
  info.detail = streaming.detail;
  info.mostCells = streaming.mostCells;
  return state_->check(frothSetStreaming(state_->context, &info), "frothSetStreaming");
}

Result<DrawnChunks> GpuRenderer::drawnChunks() const {
  const Result<std::vector<FrothChunk>> chunks = state_->chunks();
  if (!chunks) return chunks.error();
  DrawnChunks drawn;
  for (const FrothChunk& chunk : *chunks) {
    if (chunk.state != FROTH_CHUNK_DRAWN) continue;
    drawn.bytes += chunk.deviceBytes;
    drawn.liveCells += chunk.liveCount;
  }
  return drawn;
}

const HostDeviceInfo& GpuRenderer::device() const { return state_->host->info; }

FrothAssetStatus GpuRenderer::assetStatus() const {
  FrothAssetStatus status{};
  status.structSize = sizeof(status);
  frothGetAssetStatus(state_->context, state_->asset, &status);  // fails, and leaves zero, without one
  return status;
}

}  // namespace froth
